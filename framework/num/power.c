/* power.c -- x^n by repeated squaring in double-double arithmetic.
**
** A double-double (h, l) with |l| <= ulp(h)/2 stands for h + l. A product of two of them, computed as below, has a
** relative error of at most 5 * 2^-106 (Joldes, Muller, Popescu, ACM TOMS 44, 2017, DWTimesDW1); a power with m = |n|
** uses at most 2 log2(m) products, and the error of a factor that is squared doubles: at most (2m - 1) times the
** error of one. So the relative error is below m * 2^-102; the inverse adds less than 2^-102. E below is m * 2^-100.
** While every product is exact (no low part and no remainder), the power is exact. Where exponents could leave the
** range in which products split exactly, directed rounding of plain products takes over: for nonnegative numbers each
** rounded product bounds the true one.
*/
#include "num/power.h"
#include "num/rounding.h"
#include <float.h>
#include <math.h>
#include <stdbool.h>

typedef struct power {
  double h, l;
  bool exact, safe; /* safe: all exponents stayed within the range of exact products */
} power;

#define LEAST 0x1p-480 /* products of two factors above this split exactly */
#define MOST 0x1p+500

static power factor(double x) { return (power) { x, 0, true, x >= LEAST && x <= MOST }; }

static power product(power a, power b) {
  double h = a.h * b.h, rest = fma(a.h, b.h, -h);
  double low = rest + (a.h * b.l + a.l * b.h), sum = h + low;
  power r = { sum, low - (sum - h), a.exact && b.exact && rest == 0, a.safe && b.safe };
  r.safe = r.safe && sum >= LEAST && sum <= MOST;
  return r;
}

static power inverse(power a) {
  double q = 1 / a.h, rest = fma(-q, a.h, 1.0);
  double low = (rest - q * a.l) / a.h, sum = q + low;
  return (power) { sum, low - (sum - q), a.exact && rest == 0, a.safe };
}

static uint32_t size_of(int32_t n) { return n < 0 ? 0u - (uint32_t)n : (uint32_t)n; }

static power raise(double x, int32_t n) {
  power result = factor(1), square = factor(x);
  for (uint32_t m = size_of(n);;) {
    if (m & 1) result = product(result, square);
    m >>= 1;
    if (!m) break;
    square = product(square, square);
  }
  return n < 0 ? inverse(result) : result;
}

/* nearest mode: +1, -1 or 0 steps from h that bound the power */
static AMBIT_WORKER bool bounds(double x, int32_t n, double *lo, double *hi) {
  power p = raise(x, n);
  if (!p.safe) return false;
  double error = p.exact ? 0 : p.h * (double)size_of(n) * 0x1p-100;
  *lo = p.l - error < 0 ? nextafter(p.h, 0) : p.h;
  *hi = p.l + error > 0 ? nextafter(p.h, INFINITY) : p.h;
  return true;
}

/* upward mode; an infinite or underflowed value is still a bound */
static AMBIT_WORKER double plain_up(double x, uint32_t m) {
  double result = 1;
  for (; m; m >>= 1) {
    if (m & 1) result = result * x;
    if (m > 1) x = x * x;
  }
  return result;
}

/* upward mode: |product| from below by negating one factor */
static AMBIT_WORKER double plain_down(double x, uint32_t m) {
  double result = 1;
  for (; m; m >>= 1) {
    if (m & 1) result = -(-result * x);
    if (m > 1) x = -(-x * x);
  }
  return result;
}

static AMBIT_WORKER double invert_up(double x) { return 1 / x; }
static AMBIT_WORKER double invert_down(double x) { return -(-1 / x); }

/* Both 1/(x^m) and (1/x)^m bound the inverse power; far out one of them keeps more. */
static void directed(double x, int32_t n, double *lo, double *hi) {
  uint32_t m = size_of(n);
  ambit_rounding old = ambit_round_up();
  if (n > 0) {
    *lo = plain_down(x, m);
    *hi = plain_up(x, m);
  } else {
    double inverse_lo = plain_down(invert_down(x), m), inverse_hi = plain_up(invert_up(x), m);
    double below = invert_down(plain_up(x, m)), above = invert_up(plain_down(x, m));
    *lo = below > inverse_lo ? below : inverse_lo;
    *hi = above < inverse_hi ? above : inverse_hi;
  }
  ambit_rounding_restore(old);
}

static void enclose(double x, int32_t n, double *lo, double *hi) {
  if (x == 0 || x == INFINITY) {
    *lo = *hi = (x == 0) == (n > 0) ? 0 : INFINITY;
    return;
  }
  ambit_rounding old = ambit_round_nearest();
  bool known = bounds(x, n, lo, hi);
  ambit_rounding_restore(old);
  if (!known) directed(x, n, lo, hi);
}

double ambit_power_down(double x, int32_t n) {
  double lo, hi;
  enclose(x, n, &lo, &hi);
  return lo;
}

double ambit_power_up(double x, int32_t n) {
  double lo, hi;
  enclose(x, n, &lo, &hi);
  return hi;
}
