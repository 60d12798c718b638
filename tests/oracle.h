/* oracle.h -- MPFR as the judge: tightest bounds of an operation at a point, and operands that hurt. */
#ifndef AMBIT_TEST_ORACLE_H
#define AMBIT_TEST_ORACLE_H
#include <ambit/tape.h>
#include <float.h>
#include <math.h>
#include <mpfr.h>
#include <stdbool.h>
#include <stdint.h>

/* Rounded value of op(x, y) (POWN: exponent n); NaN outside the domain. Finite x, y. */
static inline double oracle_rounded(uint32_t op, double x, double y, int32_t n, mpfr_rnd_t rounding) {
  mpfr_t a, b, r;
  mpfr_init2(a, 53), mpfr_init2(b, 53), mpfr_init2(r, 53);
  mpfr_set_emin(-1073), mpfr_set_emax(1024); /* the exponents of doubles */
  mpfr_set_d(a, x, MPFR_RNDN), mpfr_set_d(b, y, MPFR_RNDN);
  int t = 0;
  switch (op) {
  case AMBIT_OP_ADD: t = mpfr_add(r, a, b, rounding); break;
  case AMBIT_OP_SUB: t = mpfr_sub(r, a, b, rounding); break;
  case AMBIT_OP_NEG: t = mpfr_neg(r, a, rounding); break;
  case AMBIT_OP_MUL: t = mpfr_mul(r, a, b, rounding); break;
  case AMBIT_OP_SQR: t = mpfr_sqr(r, a, rounding); break;
  case AMBIT_OP_POWN:
    if (x == 0 && n < 0)
      mpfr_set_nan(r);
    else
      t = mpfr_pow_si(r, a, n, rounding);
    break;
  case AMBIT_OP_DIV:
    if (y == 0)
      mpfr_set_nan(r);
    else
      t = mpfr_div(r, a, b, rounding);
    break;
  case AMBIT_OP_SQRT: t = mpfr_sqrt(r, a, rounding); break;
  case AMBIT_OP_EXP: t = mpfr_exp(r, a, rounding); break;
  case AMBIT_OP_LOG:
    if (x <= 0)
      mpfr_set_nan(r);
    else
      t = mpfr_log(r, a, rounding);
    break;
  case AMBIT_OP_SIN: t = mpfr_sin(r, a, rounding); break;
  case AMBIT_OP_COS: t = mpfr_cos(r, a, rounding); break;
  case AMBIT_OP_TAN: t = mpfr_tan(r, a, rounding); break;
  case AMBIT_OP_ASIN: t = mpfr_asin(r, a, rounding); break;
  case AMBIT_OP_ACOS: t = mpfr_acos(r, a, rounding); break;
  case AMBIT_OP_ATAN: t = mpfr_atan(r, a, rounding); break;
  case AMBIT_OP_ATAN2:
    if (x == 0 && y == 0)
      mpfr_set_nan(r);
    else {
      if (x == 0) mpfr_set_zero(a, 1); /* the signs of zeros are not sets: angle in (-pi, pi] */
      t = mpfr_atan2(r, a, b, rounding);
    }
    break;
  case AMBIT_OP_SINH: t = mpfr_sinh(r, a, rounding); break;
  case AMBIT_OP_COSH: t = mpfr_cosh(r, a, rounding); break;
  case AMBIT_OP_TANH: t = mpfr_tanh(r, a, rounding); break;
  case AMBIT_OP_ABS: t = mpfr_abs(r, a, rounding); break;
  case AMBIT_OP_MIN: t = mpfr_min(r, a, b, rounding); break;
  case AMBIT_OP_MAX: t = mpfr_max(r, a, b, rounding); break;
  default: mpfr_set_nan(r); break;
  }
  t = mpfr_check_range(r, t, rounding);
  mpfr_subnormalize(r, t, rounding);
  double value = mpfr_get_d(r, rounding);
  mpfr_clear(a), mpfr_clear(b), mpfr_clear(r);
  return value;
}

/* Reproducible random numbers (xorshift64*, Vigna 2016). */
static inline uint64_t oracle_random(uint64_t *state) {
  *state ^= *state >> 12;
  *state ^= *state << 25;
  *state ^= *state >> 27;
  return *state * 0x2545F4914F6CDD1Dull;
}

static inline double oracle_uniform(uint64_t *state, double lo, double hi) {
  double u = (double)(oracle_random(state) >> 11) * 0x1p-53;
  return lo + (hi - lo) * u;
}

/* A finite double: everyday size, any exponent, or one that hurts. */
static inline double oracle_double(uint64_t *state) {
  static const double nasty[] = { 0.0, -0.0, 1, -1, 2, 0.5, DBL_MIN, -DBL_MIN, 0x1p-1074, -0x1p-1074, DBL_MAX, -DBL_MAX,
    0x1.fffffffffffffp-1, 0x1.0000000000001p0, 0x1.921fb54442d18p+0, 0x1.921fb54442d18p+1, -0x1.921fb54442d19p+1, 1e300,
    1e-300, 709.782712893384, 745.1332191019412, 3, 10, 0x1p53 };
  uint64_t r = oracle_random(state);
  if (r % 8 == 0) return nasty[(r >> 8) % (sizeof nasty / sizeof *nasty)];
  if (r % 8 == 1) {
    int exponent = (int)((r >> 8) % 2098) - 1074;
    return ldexp(oracle_uniform(state, -1, 1), exponent);
  }
  return oracle_uniform(state, -10, 10);
}
#endif
