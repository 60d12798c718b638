/* The real plugin: conformance, domains, and no NaN as a bound. */
#include "arithmetic_case.h"

static void passes_the_kit(void **state) {
  (void)state;
  arithmetic_loader l;
  size_t fallbacks;
  case_load(&l, "real");
  assert_int_equal(l.plugin->rigorous, 0);
  assert_int_equal(case_run(&l, false, &fallbacks), 0);
  assert_int_equal(fallbacks, 0);
  arithmetic_unload(&l);
}

static void middle_of_a_set(void **state) {
  (void)state;
  static const struct {
    double lo, hi, want;
  } sets[] = { { 1, 2, 1.5 }, { 0.1, 0.1, 0.1 }, { -INFINITY, INFINITY, 0 }, { -INFINITY, 3, -DBL_MAX },
    { 3, INFINITY, DBL_MAX }, { -DBL_MAX, DBL_MAX, 0 }, { DBL_MAX / 2, DBL_MAX, 0.75 * DBL_MAX } };
  arithmetic_loader l;
  case_load(&l, "real");
  for (size_t i = 0; i < sizeof sets / sizeof *sets; i++) {
    double x, lo, hi;
    l.full.set(l.ctx, &x, 1, &sets[i].lo, &sets[i].hi, -1);
    l.full.bounds(l.ctx, &x, 1, &lo, &hi);
    assert_true(lo == sets[i].want && hi == sets[i].want);
  }
  arithmetic_unload(&l);
}

static uint32_t apply(const arithmetic_loader *l, uint32_t op, double a, double b, double *lo, double *hi) {
  double block[3], values[2] = { a, b };
  const uint32_t r = 2, x = 0, y = op == AMBIT_OP_POWN ? (uint32_t)-2 : 1;
  l->full.set(l->ctx, block, 2, values, values, -1);
  uint32_t flags = l->full.run[op](&l->full, l->ctx, block, 1, 1, 1, &r, &x, &y);
  l->full.bounds(l->ctx, block + 2, 1, lo, hi);
  return flags;
}

static void outside_the_domain_is_empty(void **state) {
  (void)state;
  static const struct {
    uint32_t op;
    double a, b;
  } cases[] = { { AMBIT_OP_DIV, 1, 0 }, { AMBIT_OP_DIV, 0, 0 }, { AMBIT_OP_SQRT, -1, 0 }, { AMBIT_OP_LOG, 0, 0 },
    { AMBIT_OP_LOG, -1, 0 }, { AMBIT_OP_ASIN, 2, 0 }, { AMBIT_OP_ACOS, -2, 0 }, { AMBIT_OP_ATAN2, 0, 0 },
    { AMBIT_OP_ATAN2, -0.0, -0.0 }, { AMBIT_OP_POWN, 0, 0 } };
  arithmetic_loader l;
  case_load(&l, "real");
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    double lo, hi;
    assert_int_equal(apply(&l, cases[i].op, cases[i].a, cases[i].b, &lo, &hi), AMBIT_F_PARTIAL | AMBIT_F_EMPTY);
    assert_true(lo == INFINITY && hi == -INFINITY);
  }
  arithmetic_unload(&l);
}

static void overflow_is_unbounded(void **state) {
  (void)state;
  arithmetic_loader l;
  double lo, hi;
  case_load(&l, "real");
  assert_int_equal(apply(&l, AMBIT_OP_EXP, 1000, 0, &lo, &hi), AMBIT_F_UNBOUNDED);
  assert_true(lo == DBL_MAX && hi == INFINITY);
  assert_int_equal(apply(&l, AMBIT_OP_MUL, -1e200, 1e200, &lo, &hi), AMBIT_F_UNBOUNDED);
  assert_true(lo == -INFINITY && hi == -DBL_MAX);
  assert_int_equal(apply(&l, AMBIT_OP_ATAN2, -0.0, -1, &lo, &hi), 0);
  assert_true(lo > 3.14 && hi < 3.15); /* the angle is pi, whatever the sign of zero */
  arithmetic_unload(&l);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(passes_the_kit),
    cmocka_unit_test(middle_of_a_set),
    cmocka_unit_test(outside_the_domain_is_empty),
    cmocka_unit_test(overflow_is_unbounded),
  };
  return cmocka_run_group_tests_name("arithmetic real", tests, NULL, NULL);
}
