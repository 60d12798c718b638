/* test_elementary_kernel.c -- the promise of the kernels itself, |h + l - f| <= E |h|, against MPFR at 300 bits.
**
** Inclusion tests do not see a bound that is too small by a factor of 8; this one does. The proof is in
** tests/num/proof.
*/
#define AMBIT_LANES 1
#include "elementary_oracle.h"
#include "num/elementary_composed.h"
#include "num/power_kernel.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <cmocka.h>

#define COUNT 40000
#define PRECISION 300

typedef struct sample {
  pair y;
  int scale;     /* the value is (h + l) 2^scale */
  bool declined; /* proves nothing */
} sample;

static sample of(pair y) { return (sample) { y, 0, false }; }
static sample of_angle(pair y, angle a) { return (sample) { y, 0, a.declined != 0 }; }

static sample kernel(uint32_t op, double x, double v) {
  bits k = 0;
  pair y;
  switch (op) {
  case AMBIT_OP_EXP: y = exp_kernel(x, &k); break;
  case AMBIT_OP_SINH: y = sinh_kernel(x, &k); break;
  case AMBIT_OP_COSH: y = cosh_kernel(x, &k); break;
  case AMBIT_OP_LOG: return of(log_kernel(x));
  case AMBIT_OP_SIN: return of_angle(sin_kernel(angle_reduce(x), 0), angle_reduce(x));
  case AMBIT_OP_COS: return of_angle(sin_kernel(angle_reduce(x), 64), angle_reduce(x));
  case AMBIT_OP_TAN: return of_angle(tan_kernel(angle_reduce(x)), angle_reduce(x));
  case AMBIT_OP_ASIN: return of(asin_kernel(x));
  case AMBIT_OP_ACOS: return of(acos_kernel(x));
  case AMBIT_OP_ATAN: return of(pair_flip(atan_kernel((pair) { fabs(x), 0 }, (pair) { 1, 0 }), sign_bit(x)));
  case AMBIT_OP_ATAN2: return of(atan2_kernel(x, v));
  default: return of(tanh_kernel(x));
  }
  return (sample) { y, (int)(int64_t)k, false };
}

/* (h + l - f) / h at 300 bits */
static double relative_error(uint32_t op, double x, double v, sample s) {
  mpfr_t f, a, b;
  mpfr_inits2(PRECISION, f, a, b, (mpfr_ptr)0);
  mpfr_set_d(a, x, MPFR_RNDN);
  mpfr_set_d(b, v, MPFR_RNDN);
  image_evaluate(f, op, a, b, 0);
  mpfr_div_2si(f, f, s.scale, MPFR_RNDN);
  mpfr_sub_d(f, f, s.y.h, MPFR_RNDN);
  mpfr_sub_d(f, f, s.y.l, MPFR_RNDN);
  if (s.y.h != 0) mpfr_div_d(f, f, s.y.h, MPFR_RNDN);
  double e = fabs(mpfr_get_d(f, MPFR_RNDN));
  mpfr_clears(f, a, b, (mpfr_ptr)0);
  return e;
}

typedef struct promise {
  uint32_t op;
  double error, least, most; /* the range of |x|; for LOG of x */
} promise;

static const promise promises[] = { { AMBIT_OP_EXP, AMBIT_ERROR_EXP, 0, 1400 },
  { AMBIT_OP_LOG, AMBIT_ERROR_LOG, 0x1p-1074, DBL_MAX }, { AMBIT_OP_SIN, AMBIT_ERROR_SIN, 0x1p-28, 0x1p39 },
  { AMBIT_OP_COS, AMBIT_ERROR_SIN, 0, 0x1p39 }, { AMBIT_OP_TAN, AMBIT_ERROR_TAN, 0x1p-28, 0x1p39 },
  { AMBIT_OP_ASIN, AMBIT_ERROR_ASIN, 0x1p-28, 1 }, { AMBIT_OP_ACOS, AMBIT_ERROR_ACOS, 0, 1 },
  { AMBIT_OP_ATAN, AMBIT_ERROR_ATAN, 0x1p-28, 0x1p100 }, { AMBIT_OP_ATAN2, AMBIT_ERROR_ATAN, 0x1p-400, 0x1p400 },
  { AMBIT_OP_SINH, AMBIT_ERROR_SINH, 0x1p-28, 1400 }, { AMBIT_OP_COSH, AMBIT_ERROR_COSH, 0, 1400 },
  { AMBIT_OP_TANH, AMBIT_ERROR_TANH, 0x1p-28, 22 } };

/* the promise at this size of the result */
static double promised(const promise *p, double h) {
  double size = fabs(h);
  if ((p->op == AMBIT_OP_SIN || p->op == AMBIT_OP_COS) && size >= AMBIT_SIN_LEAST) return AMBIT_ERROR_SIN_FAR;
  if (p->op == AMBIT_OP_TAN && size >= AMBIT_TAN_LEAST && size <= AMBIT_TAN_MOST) return AMBIT_ERROR_TAN_FAR;
  if (p->op == AMBIT_OP_ATAN2 && size <= AMBIT_ATAN_SMALL) return AMBIT_ERROR_ATAN_NEAR;
  return p->error;
}

static bool in_range(const promise *p, double x) { return fabs(x) >= p->least && fabs(x) <= p->most; }

/* near a break point of the tables, a multiple of 1/128, pi/256 or ln2/128, where the rests are largest; or
** hard_argument */
static double argument(const promise *p, uint64_t *s) {
  double k = (double)(random_bits(s) % 1024), step = 1.0 / 128, x;
  switch (random_bits(s) % 4) {
  case 0: step = PI_DOWN / 256; break;
  case 1: step = 0x1.62e42fefa39efp-8; break;
  case 2: break;
  default: return hard_argument(p->op, s);
  }
  x = beside(k * step, s);
  if (random_bits(s) % 4 == 0) x += step * (random_unit(s) - 0.5);
  if (p->op == AMBIT_OP_LOG) return fabs(x);
  return random_bits(s) & 1 ? x : -x;
}

static void keeps(const promise *p) {
  uint64_t seed = 362436069362436069u;
  for (int tried = 0; tried < COUNT; tried++) {
    double x = argument(p, &seed), v = p->op == AMBIT_OP_ATAN2 ? argument(p, &seed) : 1;
    if (!in_range(p, x) || !in_range(p, v)) continue;
    sample s = kernel(p->op, x, v);
    if (s.declined) continue;
    double e = relative_error(p->op, x, v, s);
    if (!(e <= promised(p, s.y.h)))
      fail_msg("op %u at (%a, %a): error %a exceeds %a", (unsigned)p->op, x, v, e, promised(p, s.y.h));
    if (!(s.y.h + s.y.l == s.y.h))
      fail_msg("op %u at (%a, %a): (%a, %a) is not normalised", (unsigned)p->op, x, v, s.y.h, s.y.l);
  }
}

static void kernels_keep_their_promise(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof promises / sizeof *promises; i++) keeps(&promises[i]);
}

/* m^n in [1, 2) 2^k */
static void powers_keep_their_promise(void **state) {
  uint64_t seed = 1234567u;
  mpfr_t f;
  (void)state;
  mpfr_init2(f, PRECISION);
  mpfr_set_emax(mpfr_get_emax_max());
  for (int tried = 0; tried < COUNT; tried++) {
    int32_t n = 1 + (int32_t)(random_bits(&seed) >> (33 + random_below(&seed, 31)) & 0x7ffffffe);
    double m = 1 + random_scaled(&seed, 0, 0, 40);
    power a;
    power_kernel(&a, &m, 1, exponent_of(n));
    mpfr_set_d(f, m, MPFR_RNDN);
    mpfr_pow_si(f, f, n, MPFR_RNDN);
    mpfr_div_2si(f, f, (long)a.k, MPFR_RNDN);
    mpfr_sub_d(f, f, a.y.h, MPFR_RNDN);
    mpfr_sub_d(f, f, a.y.l, MPFR_RNDN);
    double e = fabs(mpfr_get_d(f, MPFR_RNDN)) / a.y.h;
    if (!(e <= AMBIT_ERROR_POWER * n)) fail_msg("%a^%d: error %a exceeds %a", m, n, e, AMBIT_ERROR_POWER * n);
  }
  mpfr_clear(f);
}

static double pair_gap(pair y, pair z) { return fabs((y.h - z.h) + (y.l - z.l)); }

/* the fast range reaches the multiples of pi/2 that doubles come near to */
static void neighbours_of_pi_are_fast(void **state) {
  (void)state;
  for (int k = 1; k < 1000; k++) assert_false(angle_reduce(k * (PI_DOWN / 2)).declined);
  assert_true(angle_reduce(0x1.1p39).declined);
  /* the doubles nearest to multiples n of pi/128 by continued fractions: |x - n pi/128| is 2^-58.9, 2^-57.6, 2^-56.2,
  ** n 2^-92 is 2^-50.6, 2^-49.4, 2^-47.9 */
  static const double near[] = { 0x1.065c829d68730p+36, 0x1.47f3a344c28fcp+37, 0x1.aa56543fc9baep+38 };
  for (size_t k = 0; k < sizeof near / sizeof *near; k++) {
    assert_true(angle_reduce(near[k]).declined && angle_reduce(-near[k]).declined);
    assert_false(angle_reduce(nextafter(near[k], 0)).declined);
  }
  assert_true(pair_gap(sin_kernel(angle_reduce(PI_DOWN), 0),
                  (pair) { 0x1.1a62633145c07p-53, -0x1.f1976b7ed8fbcp-109 }) < 0x1p-115);
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(kernels_keep_their_promise),
    cmocka_unit_test(powers_keep_their_promise), cmocka_unit_test(neighbours_of_pi_are_fast) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
