/* test_values.c -- functions over points and sets against MPFR: nothing is missed, nothing is wider than an ulp, what
** is a double is met exactly, and domains end where they end. */
#include "described.h"
#include "num/rounding.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

#define ROUNDS 40000

/* 0: tightest, 1: one double further out, 2: more, or inward */
static int excess(double got, double want, double outward) {
  if (got == want) return 0;
  return got == nextafter(want, outward) ? 1 : 2;
}

static void judge_point(uint32_t op, double x, double y, size_t *loose) {
  ambit_interval r, a = { x, x }, b = { y, y };
  uint32_t flags = ambit_interval_op(op, &r, a, b);
  double lo = judge_rounded(op, x, y, MPFR_RNDD), hi = judge_rounded(op, x, y, MPFR_RNDU);
  int low = excess(r.lo, lo, -INFINITY), high = excess(r.hi, hi, INFINITY);
  if (low > 1 || high > 1 || (flags & ~AMBIT_F_UNBOUNDED) || (flags != 0) != (r.hi == INFINITY || r.lo == -INFINITY))
    fail_msg("%s(%a, %a) = [%a, %a], flags %u: expected [%a, %a]", name_of(op), x, y, r.lo, r.hi, flags, lo, hi);
  *loose += low || high;
}

static void points_are_nearly_always_tightest(void **state) {
  (void)state;
  EACH_FUNCTION(op) {
    uint64_t seed = 88172645463325252u + op;
    size_t loose = 0;
    for (int i = 0; i < ROUNDS; i++) {
      double x = hard_argument(op, &seed), y = i % 3 ? hard_number(&seed) : oracle_uniform(&seed, -2, 2) * x;
      if (isfinite(y)) judge_point(op, x, y, &loose);
    }
    print_message("%-6s tightest: %.3f %%\n", name_of(op), 100 - 100.0 * (double)loose / ROUNDS);
    assert_true(loose < ROUNDS / 25); /* pow: 745 times the error of a logarithm */
  }
}

/* sets: the bounds are those at the ends, which points were judged at; inside is inside */
static void sets_hold_their_points(void **state) {
  (void)state;
  EACH_FUNCTION(op) {
    uint64_t seed = 1234567 + op;
    for (int i = 0; i < ROUNDS / 4; i++) {
      double x[2] = { hard_argument(op, &seed), hard_argument(op, &seed) },
             y[2] = { hard_number(&seed), hard_number(&seed) };
      if (!isfinite(y[0]) || !isfinite(y[1])) continue;
      ambit_interval a = { fmin(x[0], x[1]), fmax(x[0], x[1]) }, b = { fmin(y[0], y[1]), fmax(y[0], y[1]) }, r;
      ambit_interval_op(op, &r, a, b);
      for (int k = 0; k < 6; k++) {
        double s = k < 2 ? x[k] : fmin(fmax(a.lo + oracle_uniform(&seed, 0, 1) * (a.hi - a.lo), a.lo), a.hi);
        double t = k < 2 ? y[k] : fmin(fmax(b.lo + oracle_uniform(&seed, 0, 1) * (b.hi - b.lo), b.lo), b.hi);
        if (!isfinite(s) || !isfinite(t) || !is_inside(op, s)) continue;
        double lo = judge_rounded(op, s, t, MPFR_RNDD), hi = judge_rounded(op, s, t, MPFR_RNDU);
        if (!(r.lo <= lo && hi <= r.hi))
          fail_msg("%s([%a, %a], [%a, %a]) misses the value at %a, %a", name_of(op), a.lo, a.hi, b.lo, b.hi, s, t);
      }
    }
  }
}

static void doubles_are_met_exactly(void **state) {
  (void)state;
  static const struct {
    uint32_t op;
    double x, y, want;
  } exact[] = { { AMBIT_OP_LOG1P, 0, 0, 0 }, { AMBIT_OP_EXPM1, 0, 0, 0 }, { AMBIT_OP_ASINH, 0, 0, 0 },
    { AMBIT_OP_ACOSH, 1, 0, 0 }, { AMBIT_OP_ATANH, 0, 0, 0 }, { AMBIT_OP_LOG2, 0x1p-1074, 0, -1074 },
    { AMBIT_OP_LOG2, 1, 0, 0 }, { AMBIT_OP_LOG2, 0x1p1023, 0, 1023 }, { AMBIT_OP_LOG10, 1e22, 0, 22 },
    { AMBIT_OP_LOG10, 1000, 0, 3 }, { AMBIT_OP_EXP2, -1074, 0, 0x1p-1074 }, { AMBIT_OP_EXP2, 10, 0, 1024 },
    { AMBIT_OP_CBRT, -27, 0, -3 }, { AMBIT_OP_CBRT, 0x1p-1074, 0, 0x1p-358 }, { AMBIT_OP_CBRT, 1e15, 0, 1e5 },
    { AMBIT_OP_HYPOT, 3, -4, 5 }, { AMBIT_OP_HYPOT, 0x3p1000, 0x1p1002, 0x5p1000 }, { AMBIT_OP_HYPOT, 0, -7, 7 },
    { AMBIT_OP_HYPOT, 0x3p-1074, 0x4p-1074, 0x5p-1074 }, { AMBIT_OP_POW, 1, 1e300, 1 }, { AMBIT_OP_POW, 5, 0, 1 },
    { AMBIT_OP_POW, 5, 1, 5 } };
  for (size_t i = 0; i < sizeof exact / sizeof *exact; i++) {
    ambit_interval r, x = { exact[i].x, exact[i].x }, y = { exact[i].y, exact[i].y };
    assert_int_equal(ambit_interval_op(exact[i].op, &r, x, y), 0);
    if (r.lo != exact[i].want || r.hi != exact[i].want) fail_msg("%s(%a)", name_of(exact[i].op), exact[i].x);
  }
}

static void domains_end_where_they_end(void **state) {
  (void)state;
  EACH_FUNCTION(op) {
    const ambit_function_facts *f = &ambit_function_of(op)->facts;
    ambit_interval r, y = { 0.5, 0.5 };
    if (f->least > -INFINITY) {
      assert_true(ambit_interval_op(op, &r, (ambit_interval) { f->least - 2, f->least - 1 }, y) ==
                  (AMBIT_F_PARTIAL | AMBIT_F_EMPTY));
      uint32_t end = ambit_interval_op(op, &r, (ambit_interval) { f->least, f->least }, y);
      assert_true(f->open ? end == (AMBIT_F_PARTIAL | AMBIT_F_EMPTY) : end == 0);
      assert_true(ambit_interval_op(op, &r, (ambit_interval) { f->least - 1, f->least + 0.5 }, y) & AMBIT_F_PARTIAL);
    }
    if (f->most < INFINITY) {
      uint32_t end = ambit_interval_op(op, &r, (ambit_interval) { f->most, f->most + 1 }, y);
      assert_true(end & AMBIT_F_PARTIAL);
      assert_true(f->open ? (end & AMBIT_F_EMPTY) != 0 : !(end & AMBIT_F_EMPTY));
    }
    assert_int_equal(ambit_interval_op(op, &r, AMBIT_EMPTY, y), AMBIT_F_EMPTY);
    ambit_interval_op(op, &r, AMBIT_ENTIRE, AMBIT_ENTIRE);
    assert_true(r.lo <= r.hi);
  }
}

/* bounds at infinities are limits, never NaN; and any rounding mode gives the same bits */
static void modes_do_not_matter(void **state) {
  (void)state;
  EACH_FUNCTION(op) {
    uint64_t seed = 4711 + op;
    for (int i = 0; i < 2000; i++) {
      double x = hard_argument(op, &seed), y = hard_number(&seed);
      ambit_interval r, up, a = { x, i % 2 ? x : INFINITY }, b = { isfinite(y) ? y : 1, INFINITY };
      uint32_t flags = ambit_interval_op(op, &r, a, b);
      ambit_rounding old = ambit_round_up();
      uint32_t other = ambit_interval_op(op, &up, a, b);
      ambit_rounding_restore(old);
      assert_int_equal(flags, other);
      assert_memory_equal(&r, &up, sizeof r);
      assert_false(isnan(r.lo) || isnan(r.hi));
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(points_are_nearly_always_tightest),
    cmocka_unit_test(sets_hold_their_points), cmocka_unit_test(doubles_are_met_exactly),
    cmocka_unit_test(domains_end_where_they_end), cmocka_unit_test(modes_do_not_matter) };
  return cmocka_run_group_tests_name("functions: values", tests, NULL, NULL);
}
