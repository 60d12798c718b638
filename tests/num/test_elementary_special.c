/* test_elementary_special.c -- exact values, ends of domains, infinities, over- and underflow, empty operands, no
** slow path. */
#include "elementary_oracle.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <cmocka.h>

#define I(lo, hi)                                                                                                      \
  { lo, hi }
#define HALF_PI_DOWN 0x1.921fb54442d18p+0
#define HALF_PI_UP 0x1.921fb54442d19p+0
#define TINIEST 0x1p-1074
#define EMPTY                                                                                                          \
  { INFINITY, -INFINITY }
#define ENTIRE                                                                                                         \
  { -INFINITY, INFINITY }
#define LENGTH(array) (sizeof(array) / sizeof *(array))

static ambit_interval between(double lo, double hi) { return (ambit_interval) { lo, hi }; }

static ambit_interval apply(uint32_t op, ambit_interval a, ambit_interval b) {
  /* among eleven equal ones, so that wide and single lanes both see it */
  double alo[11], ahi[11], blo[11], bhi[11], rlo[11], rhi[11];
  for (int i = 0; i < 11; i++) alo[i] = a.lo, ahi[i] = a.hi, blo[i] = b.lo, bhi[i] = b.hi;
  ambit_elementary(op, 11, alo, ahi, blo, bhi, rlo, rhi);
  ambit_interval r;
  ambit_elementary(op, 1, alo, ahi, blo, bhi, &r.lo, &r.hi);
  for (int i = 0; i < 11; i++) assert_true(rlo[i] == r.lo && rhi[i] == r.hi);
  return r;
}

typedef struct expectation {
  uint32_t op;
  ambit_interval a, b, want; /* want: tightest */
} expectation;

/* got contains want and is at most `ulps` doubles wider on each side */
static void expect(const expectation *e, int ulps) {
  ambit_interval r = apply(e->op, e->a, e->b);
  double lo = e->want.lo, hi = e->want.hi;
  if (!ambit_interval_is_empty(e->want))
    for (int i = 0; i < ulps; i++) lo = nextafter(lo, -INFINITY), hi = nextafter(hi, INFINITY);
  if (!(lo <= r.lo && r.lo <= e->want.lo && e->want.hi <= r.hi && r.hi <= hi))
    fail_msg("op %u ([%a, %a], [%a, %a]) = [%a, %a], expected [%a, %a]", (unsigned)e->op, e->a.lo, e->a.hi, e->b.lo,
        e->b.hi, r.lo, r.hi, e->want.lo, e->want.hi);
}

#define ONE(OP, a, want)                                                                                               \
  { AMBIT_OP_##OP, a, I(1, 1), want }
#define TWO(y, x, want)                                                                                                \
  { AMBIT_OP_ATAN2, y, x, want }

static void exact_values(void **state) {
  static const expectation table[] = { ONE(EXP, I(0, 0), I(1, 1)), ONE(EXP, I(-0.0, 0), I(1, 1)),
    ONE(LOG, I(1, 1), I(0, 0)), ONE(SIN, I(0, 0), I(0, 0)), ONE(SIN, I(-0.0, 0), I(0, 0)), ONE(COS, I(0, 0), I(1, 1)),
    ONE(COS, I(-0.0, 0), I(1, 1)), ONE(TAN, I(0, 0), I(0, 0)), ONE(TAN, I(-0.0, 0), I(0, 0)),
    ONE(ASIN, I(0, 0), I(0, 0)), ONE(ACOS, I(1, 1), I(0, 0)), ONE(ATAN, I(0, 0), I(0, 0)), ONE(SINH, I(0, 0), I(0, 0)),
    ONE(COSH, I(0, 0), I(1, 1)), ONE(COSH, I(-0.0, -0.0), I(1, 1)), ONE(TANH, I(0, 0), I(0, 0)),
    TWO(I(0, 0), I(1, 1), I(0, 0)), TWO(I(0, 0), I(0, 3), I(0, 0)), TWO(I(-0.0, 0), I(2, 2), I(0, 0)),
    ONE(TANH, I(-1e9, 1e9), I(-1, 1)), ONE(SIN, I(-2, 5), I(-1, 1)), ONE(COS, I(0, 4), I(-1, 1)) };
  (void)state;
  for (size_t i = 0; i < LENGTH(table); i++) expect(&table[i], 0);
}

static void empty_operands(void **state) {
  static const ambit_interval nothing[] = { { INFINITY, -INFINITY }, { 2, 1 }, { NAN, NAN }, { 0, NAN },
    { INFINITY, INFINITY }, { -INFINITY, -INFINITY } };
  (void)state;
  for (uint32_t op = AMBIT_OP_EXP; op <= AMBIT_OP_TANH; op++)
    for (size_t i = 0; i < LENGTH(nothing); i++) {
      ambit_interval r = apply(op, nothing[i], between(1, 2));
      assert_true(r.lo == INFINITY && r.hi == -INFINITY);
      if (op == AMBIT_OP_ATAN2) r = apply(op, between(1, 2), nothing[i]);
      assert_true(r.lo == INFINITY && r.hi == -INFINITY);
    }
}

static void domains(void **state) {
  static const expectation table[] = { ONE(LOG, I(-1, 0), EMPTY), ONE(LOG, I(0, 0), EMPTY), ONE(LOG, I(-0.0, 0), EMPTY),
    ONE(LOG, I(-INFINITY, -3), EMPTY), ONE(LOG, I(-1, 1), I(-INFINITY, 0)), ONE(LOG, I(0, 1), I(-INFINITY, 0)),
    ONE(LOG, I(-5, INFINITY), I(-INFINITY, INFINITY)), ONE(LOG, I(1, INFINITY), I(0, INFINITY)),
    ONE(ASIN, I(1.5, 2), EMPTY), ONE(ASIN, I(-9, -1.5), EMPTY),
    ONE(ASIN, I(-INFINITY, INFINITY), I(-HALF_PI_UP, HALF_PI_UP)), ONE(ASIN, I(1, 1), I(HALF_PI_DOWN, HALF_PI_UP)),
    ONE(ASIN, I(1, 3), I(HALF_PI_DOWN, HALF_PI_UP)), ONE(ACOS, I(2, 3), EMPTY), ONE(ACOS, I(-3, -2), EMPTY),
    ONE(ACOS, I(-7, 7), I(0, PI_UP)), ONE(ACOS, I(1, 9), I(0, 0)), ONE(ACOS, I(-1, -1), I(PI_DOWN, PI_UP)),
    ONE(ACOS, I(0, 0), I(HALF_PI_DOWN, HALF_PI_UP)), ONE(ACOS, I(-TINIEST, TINIEST), I(HALF_PI_DOWN, HALF_PI_UP)),
    ONE(TAN, I(1.5, 1.6), ENTIRE), ONE(TAN, I(-2, 2), ENTIRE), ONE(TAN, I(0, INFINITY), ENTIRE),
    ONE(TAN, ENTIRE, ENTIRE), ONE(TAN, I(HALF_PI_DOWN, HALF_PI_UP), ENTIRE) };
  (void)state;
  for (size_t i = 0; i < LENGTH(table); i++) expect(&table[i], 0);
}

static void infinities(void **state) {
  static const expectation table[] = { ONE(EXP, ENTIRE, I(0, INFINITY)), ONE(EXP, I(-INFINITY, 0), I(0, 1)),
    ONE(EXP, I(0, INFINITY), I(1, INFINITY)), ONE(SIN, I(5, INFINITY), I(-1, 1)), ONE(COS, ENTIRE, I(-1, 1)),
    ONE(ATAN, ENTIRE, I(-HALF_PI_UP, HALF_PI_UP)), ONE(ATAN, I(0, INFINITY), I(0, HALF_PI_UP)),
    ONE(ATAN, I(1e300, INFINITY), I(HALF_PI_DOWN, HALF_PI_UP)), ONE(SINH, ENTIRE, ENTIRE),
    ONE(SINH, I(0, INFINITY), I(0, INFINITY)), ONE(COSH, ENTIRE, I(1, INFINITY)),
    ONE(COSH, I(-INFINITY, 0), I(1, INFINITY)), ONE(TANH, ENTIRE, I(-1, 1)), ONE(TANH, I(0, INFINITY), I(0, 1)),
    TWO(ENTIRE, ENTIRE, I(-PI_UP, PI_UP)), TWO(I(0, INFINITY), ENTIRE, I(0, PI_UP)),
    TWO(ENTIRE, I(0, INFINITY), I(-HALF_PI_UP, HALF_PI_UP)), TWO(ENTIRE, I(1, 1), I(-HALF_PI_UP, HALF_PI_UP)),
    TWO(I(1, 1), ENTIRE, I(0, PI_UP)), TWO(I(-1, -1), I(1, INFINITY), I(-0x1.921fb54442d19p-1, 0)),
    TWO(I(1, INFINITY), I(0, 0), I(HALF_PI_DOWN, HALF_PI_UP)) };
  (void)state;
  for (size_t i = 0; i < LENGTH(table); i++) expect(&table[i], 1);
}

static void overflow(void **state) {
  static const expectation table[] = { ONE(EXP, I(1000, 1000), I(DBL_MAX, INFINITY)),
    ONE(EXP, I(710, 1e308), I(DBL_MAX, INFINITY)), ONE(EXP, I(-1000, -1000), I(0, TINIEST)),
    ONE(EXP, I(-1e308, -800), I(0, TINIEST)), ONE(SINH, I(800, 800), I(DBL_MAX, INFINITY)),
    ONE(SINH, I(-800, -800), I(-INFINITY, -DBL_MAX)), ONE(COSH, I(-800, -720), I(DBL_MAX, INFINITY)),
    TWO(I(TINIEST, TINIEST), I(DBL_MAX, DBL_MAX), I(0, TINIEST)),
    TWO(I(-TINIEST, -TINIEST), I(DBL_MAX, DBL_MAX), I(-TINIEST, 0)),
    TWO(I(DBL_MAX, DBL_MAX), I(TINIEST, TINIEST), I(HALF_PI_DOWN, HALF_PI_UP)),
    TWO(I(TINIEST, TINIEST), I(-DBL_MAX, -1), I(PI_DOWN, PI_UP)) };
  (void)state;
  for (size_t i = 0; i < LENGTH(table); i++) expect(&table[i], 0);
}

static void the_cut(void **state) {
  static const expectation table[] = { TWO(I(0, 0), I(0, 0), EMPTY), TWO(I(-0.0, 0), I(-0.0, 0), EMPTY),
    TWO(I(-1, 1), I(-1, 1), I(-PI_UP, PI_UP)), TWO(I(-1, 0), I(-2, -1), I(-PI_UP, PI_UP)),
    TWO(I(-TINIEST, 0), I(-2, 3), I(-PI_UP, PI_UP)), TWO(I(0, 1), I(-2, 0), I(HALF_PI_DOWN, PI_UP)),
    TWO(I(0, 0), I(-2, -1), I(PI_DOWN, PI_UP)), TWO(I(-0.0, -0.0), I(-2, -1), I(PI_DOWN, PI_UP)),
    TWO(I(0, 0), I(-2, 0), I(PI_DOWN, PI_UP)), TWO(I(0, 0), I(-2, 2), I(0, PI_UP)),
    TWO(I(-1, 1), I(0, 1), I(-HALF_PI_UP, HALF_PI_UP)), TWO(I(-1, 1), I(0, 0), I(-HALF_PI_UP, HALF_PI_UP)),
    TWO(I(-1, 0), I(0, 1), I(-HALF_PI_UP, 0)), TWO(I(-1, 0), I(0, 0), I(-HALF_PI_UP, -HALF_PI_DOWN)),
    TWO(I(0, 1), I(0, 1), I(0, HALF_PI_UP)), TWO(I(0, 2), I(-1, 3), I(0, PI_UP)) };
  (void)state;
  for (size_t i = 0; i < LENGTH(table); i++) expect(&table[i], 0);
}

static double edge_argument(uint32_t op, int i, uint64_t *s) {
  if (op != AMBIT_OP_ATAN2)
    return (i & 1 ? 1 : -1) *
           (op == AMBIT_OP_EXP && !(i & 1) ? 700 + 50 * random_unit(s) : 708.5 + 2.2 * random_unit(s));
  return (i & 1 ? 1 : -1) * double_of(1 + random_bits(s) % 0x7fefffffffffffff);
}
/* results that over- or underflow, and angles of points far out or close in */
static void edges_of_the_range(void **state) {
  static const uint32_t op[] = { AMBIT_OP_EXP, AMBIT_OP_SINH, AMBIT_OP_COSH, AMBIT_OP_ATAN2 };
  uint64_t seed = 2463534242u;
  (void)state;
  for (size_t k = 0; k < LENGTH(op); k++)
    for (int i = 0; i < 4000; i++) {
      double x = edge_argument(op[k], i, &seed), y = edge_argument(op[k], i >> 1, &seed);
      expectation e = { op[k], { x, x }, { y, y }, EMPTY };
      oracle_slow(op[k], x, y, &e.want.lo, &e.want.hi);
      expect(&e, 1);
    }
}

/* Without a slow path the range of the function is the answer, and the derivative's sign is unknown. */
static void coarse_without_a_slow_path(void **state) {
  (void)state;
  ambit_elementary_set_slow(NULL);
  static const expectation table[] = { ONE(SIN, I(1e300, 1e300), I(-1, 1)), ONE(COS, I(-1e22, -1e22), I(-1, 1)),
    ONE(TAN, I(1e15, 1e15), ENTIRE), ONE(SIN, I(1e15, 0x1.c6bf526340001p49), I(-1, 1)) };
  for (size_t i = 0; i < LENGTH(table); i++) expect(&table[i], 0);
  for (uint32_t op = AMBIT_OP_EXP; op <= AMBIT_OP_TANH; op++) {
    uint64_t seed = 77;
    for (int i = 0; i < 200; i++) {
      double x = hard_argument(op, &seed);
      ambit_interval coarse, want;
      ambit_elementary_coarse(op, x, 1, &coarse.lo, &coarse.hi);
      oracle_slow(op, x, 1, &want.lo, &want.hi);
      assert_true(coarse.lo <= want.lo && want.hi <= coarse.hi);
    }
  }
}

static int calls;
static void counting(uint32_t op, double x, double y, double *lo, double *hi) {
  calls++, oracle_slow(op, x, y, lo, hi);
}

/* Ordinary arguments never load it; huge angles get their tightest bounds from it. */
static void slow_path_only_where_needed(void **state) {
  uint64_t seed = 99;
  (void)state;
  ambit_elementary_set_slow(counting);
  for (uint32_t op = AMBIT_OP_EXP; op <= AMBIT_OP_TANH; op++)
    for (int i = 0; i < 500; i++) {
      double x = hard_argument(op, &seed);
      if (op >= AMBIT_OP_SIN && op <= AMBIT_OP_TAN) x = 1e6 * (random_unit(&seed) - 0.5);
      apply(op, between(x, x), between(-3, 1e300));
    }
  assert_int_equal(calls, 0);
  /* sin 1e22 = -0.85220084976718880177... (the well-known test of argument reduction, K. C. Ng 1992) */
  static const expectation table[] = { ONE(SIN, I(1e22, 1e22), I(-0x1.b453ab76bf398p-1, -0x1.b453ab76bf397p-1)) };
  expect(&table[0], 0);
  assert_true(calls > 0);
  ambit_elementary_set_slow(NULL);
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(exact_values), cmocka_unit_test(empty_operands),
    cmocka_unit_test(domains), cmocka_unit_test(infinities), cmocka_unit_test(overflow), cmocka_unit_test(the_cut),
    cmocka_unit_test(edges_of_the_range), cmocka_unit_test(coarse_without_a_slow_path),
    cmocka_unit_test(slow_path_only_where_needed) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
