/* power_rare.c -- one interval's integer power where the kernels decline: zeros, infinities, over- and underflow,
** subnormal numbers, and powers too near a double for a pair of doubles to tell.
**
** |x|^k, k = |n|, in 256-bit integers: w 2^e with 2^255 <= w < 2^256, each product cut off. The relative error of a
** product is below 2^-255, doubles with each squaring, and so stays below 2 k 2^-255 <= 2^-223: the true power lies in
** [w, w + 2^33] 2^e, and its inverse within 2^34 units of the quotient. The bounds are the tightest doubles unless one
** lies within this span, 2^-222 relative, of a power that is not exact; then the bound is 1 ulp further out.
*/
#include <ambit/interval.h>
#include "num/power_variant.h"
#include <float.h>

#define WORDS 4
#define SPAN_BIT 34

__extension__ typedef unsigned __int128 wide;

typedef struct big {
  uint64_t w[WORDS]; /* least word first */
  int64_t e;
  bool exact; /* nothing was cut off */
} big;

static bool top_bit(const uint64_t *w) { return w[WORDS - 1] >> 63; }

/* w := 2 w + bit; the bit that leaves */
static bool shift_in(uint64_t *w, bool bit) {
  bool carry = bit;
  for (int i = 0; i < WORDS; i++) {
    bool out = w[i] >> 63;
    w[i] = w[i] << 1 | (uint64_t)carry;
    carry = out;
  }
  return carry;
}

static big big_of(double x) {
  int e;
  double m = frexp(x, &e); /* [1/2, 1) */
  return (big) { { 0, 0, 0, (uint64_t)(m * 0x1p53) << 11 }, (int64_t)e - 256, true };
}

static big multiply(const big *a, const big *b) {
  uint64_t p[2 * WORDS] = { 0 };
  for (int i = 0; i < WORDS; i++) {
    uint64_t carry = 0;
    for (int j = 0; j < WORDS; j++) {
      wide t = (wide)a->w[i] * b->w[j] + p[i + j] + carry;
      p[i + j] = (uint64_t)t, carry = (uint64_t)(t >> 64);
    }
    p[i + WORDS] = carry;
  }
  big r = { { 0 }, a->e + b->e + 256, a->exact && b->exact };
  if (!top_bit(p + WORDS)) { /* the product of the heads is at least 2^510 */
    for (int i = 2 * WORDS - 1; i > 0; i--) p[i] = p[i] << 1 | p[i - 1] >> 63;
    p[0] <<= 1;
    r.e--;
  }
  for (int i = 0; i < WORDS; i++) {
    r.w[i] = p[i + WORDS];
    r.exact = r.exact && p[i] == 0;
  }
  return r;
}

static big raise(double x, uint32_t k) {
  big base = big_of(x), r = base;
  for (int bit = 30 - __builtin_clz(k); bit >= 0; bit--) {
    r = multiply(&r, &r);
    if (k >> bit & 1) r = multiply(&r, &base);
  }
  return r;
}

static bool is_power_of_two(const big *a) { return a->w[3] == 1ull << 63 && !(a->w[2] | a->w[1] | a->w[0]); }

/* 1/a, cut off: floor(2^511 / w) by long division; a no power of two */
static big invert(const big *a) {
  big r = { { 0 }, -511 - a->e, false };
  uint64_t rest[WORDS] = { 0, 0, 0, 1ull << 63 }; /* 2^255 <= w */
  for (int step = 0; step < 256; step++) {
    bool carry = shift_in(rest, false), fits = carry;
    for (int i = WORDS - 1; i >= 0 && !fits; i--) {
      if (rest[i] < a->w[i]) break;
      fits = rest[i] > a->w[i] || i == 0;
    }
    if (fits) {
      uint64_t borrow = 0;
      for (int i = 0; i < WORDS; i++) {
        wide t = (wide)rest[i] - a->w[i] - borrow;
        rest[i] = (uint64_t)t, borrow = (uint64_t)(t >> 64) & 1;
      }
    }
    shift_in(r.w, fits);
  }
  return r;
}

/* Do bits [SPAN_BIT, to) of w all have this value? */
static bool uniform(const big *a, int to, bool value) {
  for (int i = SPAN_BIT; i < to; i++)
    if ((a->w[i / 64] >> (i % 64) & 1) != value) return false;
  return true;
}
static bool is_whole(const big *a, int64_t shift) { /* are bits [0, shift) all zero? */
  for (int i = 0; i < shift && i < 64 * WORDS; i++)
    if (a->w[i / 64] >> (i % 64) & 1) return false;
  return true;
}

/* the doubles that bound a in the outward direction */
static double round_big(const big *a, bool up) {
  int64_t top = a->e + 255;
  if (top > 1023) return up ? INFINITY : DBL_MAX;
  int64_t unit = top - 52 < -1074 ? -1074 : top - 52, shift = unit - a->e; /* shift >= 203: all in the top word */
  uint64_t count = shift < 256 ? a->w[WORDS - 1] >> (shift - 192) : 0;
  if (a->exact)
    count += up && !is_whole(a, shift);
  else if (up)
    count += shift <= 256 && uniform(a, (int)shift, true) ? 2 : 1;
  else
    count -= count > 0 && shift < 256 && uniform(a, (int)shift, false);
  if (count > (uint64_t)1 << 53) count++; /* 2^53 + 1 is no double, and conversion might round it down */
  return ldexp((double)count, (int)unit);
}

static uint32_t size_of(int32_t n) { return n < 0 ? 0u - (uint32_t)n : (uint32_t)n; }

/* x^n at x in [0, inf], the limit at its ends */
static double power(double x, int32_t n, bool up) {
  if (x == 0 || x == INFINITY) return (x == 0) == (n > 0) ? 0 : INFINITY;
  big a = raise(x, size_of(n));
  if (n < 0) {
    if (is_power_of_two(&a))
      a.e = -510 - a.e;
    else
      a = invert(&a);
  }
  return round_big(&a, up);
}

static double signed_up(double x, int32_t n) { return x < 0 ? -power(-x, n, false) : power(x, n, true); }

/* n > 0 */
static ambit_interval whole(ambit_interval a, int32_t n) {
  if (n % 2) return (ambit_interval) { -signed_up(-a.lo, n), signed_up(a.hi, n) };
  return (ambit_interval) { power(ambit_interval_mig(a), n, false), power(ambit_interval_mag(a), n, true) };
}

/* n < 0, the powers of the positive part of a, a.hi > 0 */
static ambit_interval inverse(ambit_interval a, int32_t n) {
  return (ambit_interval) { power(a.hi, n, false), a.lo > 0 ? power(a.lo, n, true) : INFINITY };
}

/* n < 0: both sides of 0 */
static ambit_interval inverses(ambit_interval a, int32_t n) {
  ambit_interval r = AMBIT_EMPTY;
  if (a.hi > 0) r = inverse(a, n);
  if (a.lo < 0) {
    ambit_interval left = inverse((ambit_interval) { -a.hi, -a.lo }, n);
    r = ambit_interval_hull(r, n % 2 ? (ambit_interval) { -left.hi, -left.lo } : left);
  }
  return r;
}

void ambit_power_rare(int32_t n, double alo, double ahi, double *lo, double *hi) {
  ambit_interval a = ambit_interval_of(alo, ahi), r = AMBIT_EMPTY;
  if (!ambit_interval_is_empty(a)) r = n > 0 ? whole(a, n) : inverses(a, n);
  *lo = r.lo, *hi = r.hi;
}
