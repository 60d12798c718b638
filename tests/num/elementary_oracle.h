/* elementary_oracle.h -- what the tests of the elementary functions compare with: MPFR, and arguments that are hard
** for them. */
#ifndef ELEMENTARY_ORACLE_H
#define ELEMENTARY_ORACLE_H
#include "num/elementary.h"
#include "num/elementary_variant.h"
#include <float.h>
#include <mpfr.h>
#include <stdint.h>
#include <string.h>

#define PI_DOWN 0x1.921fb54442d18p+1
#define PI_UP 0x1.921fb54442d19p+1

typedef int (*oracle_function)(mpfr_t, const mpfr_t, mpfr_rnd_t);

static inline oracle_function oracle_of(uint32_t op) {
  static const oracle_function f[AMBIT_ELEMENTARY_COUNT] = { mpfr_exp, mpfr_log, mpfr_sin, mpfr_cos, mpfr_tan,
    mpfr_asin, mpfr_acos, mpfr_atan, NULL, mpfr_sinh, mpfr_cosh, mpfr_tanh };
  return f[op - AMBIT_OP_EXP];
}

/* The tightest doubles around op at (x, y): two directed evaluations. */
static inline void oracle_point(uint32_t op, double x, double y, double *lo, double *hi) {
  MPFR_DECL_INIT(a, 53);
  MPFR_DECL_INIT(b, 53);
  MPFR_DECL_INIT(v, 53);
  mpfr_set_d(a, x, MPFR_RNDN);
  mpfr_set_d(b, y, MPFR_RNDN);
  for (int up = 0; up < 2; up++) {
    mpfr_rnd_t mode = up ? MPFR_RNDU : MPFR_RNDD;
    if (op == AMBIT_OP_ATAN2)
      mpfr_atan2(v, a, b, mode);
    else
      oracle_of(op)(v, a, mode);
    *(up ? hi : lo) = mpfr_get_d(v, mode);
  }
}

/* floor((x - shift pi)/pi) as an exact integer, modulo 2^30 */
static inline long oracle_half_period(double x, double shift) {
  mpfr_t a, pi;
  mpfr_init2(a, 2400), mpfr_init2(pi, 2400);
  mpfr_const_pi(pi, MPFR_RNDN);
  mpfr_set_d(a, x, MPFR_RNDN);
  mpfr_div(a, a, pi, MPFR_RNDN);
  mpfr_sub_d(a, a, shift, MPFR_RNDN);
  mpfr_floor(a, a);
  mpfr_fmod_ui(a, a, 1u << 30, MPFR_RNDN);
  long r = mpfr_get_si(a, MPFR_RNDN) & 0x3fffffff;
  mpfr_clear(a), mpfr_clear(pi);
  return r;
}

static inline ambit_interval oracle_hull(uint32_t op, ambit_interval x) {
  ambit_interval a, b;
  oracle_point(op, x.lo, 0, &a.lo, &a.hi);
  oracle_point(op, x.hi, 0, &b.lo, &b.hi);
  return (ambit_interval) { fmin(a.lo, b.lo), fmax(a.hi, b.hi) };
}

static inline ambit_interval oracle_wave(uint32_t op, ambit_interval x) {
  if (x.hi - x.lo > 7) return (ambit_interval) { -1, 1 };
  double shift = op == AMBIT_OP_SIN ? 0.5 : 0;
  ambit_interval r = oracle_hull(op, x);
  long last = oracle_half_period(x.hi, shift), count = (last - oracle_half_period(x.lo, shift)) & 0x3fffffff;
  if (count >= 2) return (ambit_interval) { -1, 1 };
  if (count == 1) *(last % 2 == 0 ? &r.hi : &r.lo) = last % 2 == 0 ? 1 : -1;
  if (op == AMBIT_OP_COS && x.lo <= 0 && x.hi >= 0) r.hi = 1;
  return r;
}

/* angles are monotone along the edges of a box, so that its corners decide, unless it meets the cut */
static inline ambit_interval oracle_atan2(ambit_interval y, ambit_interval x) {
  if (y.lo < 0 && y.hi >= 0 && x.lo < 0) return (ambit_interval) { -PI_UP, PI_UP };
  ambit_interval r = AMBIT_EMPTY;
  for (int i = 0; i < 4; i++) {
    double v = i & 1 ? y.hi : y.lo, u = i & 2 ? x.hi : x.lo;
    if (v == 0 && u == 0) continue;
    ambit_interval c;
    oracle_point(AMBIT_OP_ATAN2, fabs(v) > 0 ? v : 0, u, &c.lo, &c.hi); /* -0 would be below the cut */
    r.lo = fmin(r.lo, c.lo), r.hi = fmax(r.hi, c.hi);
  }
  return r;
}

/* The tightest enclosure of op over finite operands inside the domain. */
static inline ambit_interval oracle_image(uint32_t op, ambit_interval x, ambit_interval y) {
  switch (op) {
  case AMBIT_OP_SIN:
  case AMBIT_OP_COS: return oracle_wave(op, x);
  case AMBIT_OP_TAN:
    if (x.hi - x.lo > 4 || oracle_half_period(x.lo, 0.5) != oracle_half_period(x.hi, 0.5)) return AMBIT_ENTIRE;
    return oracle_hull(op, x);
  case AMBIT_OP_ATAN2: return oracle_atan2(x, y);
  case AMBIT_OP_COSH: {
    ambit_interval r = oracle_hull(op, x);
    if (x.lo <= 0 && x.hi >= 0) r.lo = 1;
    return r;
  }
  default: return oracle_hull(op, x);
  }
}

/* ---- arguments ---- */
static inline uint64_t random_bits(uint64_t *state) {
  *state ^= *state << 13, *state ^= *state >> 7, *state ^= *state << 17;
  return *state;
}
static inline double random_unit(uint64_t *state) { return (double)(random_bits(state) >> 11) * 0x1p-53; }
static inline double double_of(uint64_t bits) {
  double x;
  memcpy(&x, &bits, sizeof x);
  return x;
}
/* up to 4 doubles beside x */
static inline double beside(double x, uint64_t *state) {
  for (uint64_t k = random_bits(state) % 5; k-- > 0;) x = nextafter(x, random_bits(state) & 1 ? INFINITY : -INFINITY);
  return x;
}

static inline double hard_positive(uint64_t *s) {
  switch (random_bits(s) % 8) {
  case 0: return beside(1, s);
  case 1: return 1 + ldexp(random_unit(s) - 0.5, -(int)(random_bits(s) % 52));
  case 2: return double_of(1 + random_bits(s) % 0xfffffffffffff);
  case 3: return double_of(1 + random_bits(s) % 1000);
  case 4: return beside(ldexp(1, (int)(random_bits(s) % 2000) - 1000), s);
  case 5: return beside((1 + (double)(random_bits(s) % 512) / 512) * ldexp(1, (int)(random_bits(s) % 5) - 2), s);
  case 6: return double_of(0x7fefffffffffffff - random_bits(s) % 100);
  default: return double_of(1 + random_bits(s) % 0x7fefffffffffffff);
  }
}

/* any sign; break points of every reduction, neighbours of multiples of pi/2 and ln 2, tiny, subnormal, huge, edges
** of overflow */
static inline double hard_real(uint64_t *s) {
  double sign = random_bits(s) & 1 ? 1 : -1, k = (double)(random_bits(s) % 4096);
  switch (random_bits(s) % 18) {
  case 0: return sign * double_of(random_bits(s) % 0x7ff0000000000000);
  case 1: return sign * ldexp(random_unit(s), -(int)(random_bits(s) % 1070));
  case 2: return sign * double_of(random_bits(s) % 0x10000000000000);
  case 3: return sign * double_of(random_bits(s) % 20);
  case 4: return beside(sign * k * (PI_DOWN / 2), s);
  case 5: return beside(sign * (k * 25 + 0.5) * (PI_DOWN / 128), s);
  case 6: return sign * ldexp(random_unit(s), (int)(random_bits(s) % 60));
  case 7: return sign * (double)(random_bits(s) % 1000000000) * (PI_DOWN / 2);
  case 8: return sign * 1000 * random_unit(s);
  case 9: return sign * ldexp(1 + random_unit(s), 36 + (int)(random_bits(s) % 6));
  case 10: return beside(sign * (k + 0.5) / 32, s);
  case 11: return beside(sign * 32 / (k + 0.5), s);
  case 12: return beside(sign * k * 0x1.62e42fefa39efp-2, s);
  case 13: return sign * (690 + 60 * random_unit(s));
  case 14: return sign * (1 - ldexp(random_unit(s), -(int)(random_bits(s) % 53)));
  case 15: return sign * random_unit(s);
  default: return sign * 10 * random_unit(s);
  }
}

/* a hard argument in the domain of op */
static inline double hard_argument(uint32_t op, uint64_t *s) {
  if (op == AMBIT_OP_LOG) return hard_positive(s);
  double x = hard_real(s);
  if (op != AMBIT_OP_ASIN && op != AMBIT_OP_ACOS) return x;
  while (fabs(x) > 1) x = random_bits(s) % 4 ? 1 / x : hard_real(s);
  return x;
}
#endif
