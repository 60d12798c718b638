/* Interval functions against MPFR: inclusion at sampled points, tightness at end points, set semantics, any ambient
** mode. */
#include "num/interval.h"
#include "num/rounding.h"
#include "oracle.h"
#include <fenv.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <cmocka.h>

#define ROUNDS 20000

static ambit_interval random_interval(uint64_t *state) {
  double a = oracle_double(state), b = oracle_double(state);
  uint64_t kind = oracle_random(state) % 8;
  if (kind == 0) return (ambit_interval) { a, a };
  if (kind == 1) return (ambit_interval) { a, a < DBL_MAX ? nextafter(a, INFINITY) : a };
  if (kind == 2) return (ambit_interval) { -INFINITY, a };
  if (kind == 3) return (ambit_interval) { a, INFINITY };
  return a <= b ? (ambit_interval) { a, b } : (ambit_interval) { b, a };
}

/* a point of x: an end, or one in between */
static double point_of(ambit_interval x, uint64_t *state) {
  double lo = x.lo == -INFINITY ? -DBL_MAX : x.lo, hi = x.hi == INFINITY ? DBL_MAX : x.hi;
  uint64_t r = oracle_random(state) % 4;
  if (r == 0) return lo;
  if (r == 1) return hi;
  double p = lo / 2 + hi / 2;
  if (r == 2) p = oracle_double(state);
  return p < lo ? lo : p > hi ? hi : p;
}

static void check_inclusion(
    uint32_t op, ambit_interval a, ambit_interval b, int32_t n, ambit_interval r, uint32_t flags, uint64_t *state) {
  for (int i = 0; i < 6; i++) {
    double x = point_of(a, state), y = point_of(b, state);
    double lo = oracle_rounded(op, x, y, n, MPFR_RNDD), hi = oracle_rounded(op, x, y, n, MPFR_RNDU);
    if (isnan(lo)) {
      assert_true(flags & AMBIT_F_PARTIAL);
      continue;
    }
    /* the true value lies in [lo, hi], neighbouring doubles: r must reach past it on both sides */
    if (!(r.lo <= lo && r.hi >= hi))
      fail_msg("op %u misses f(%a, %a)^%d: [%a, %a], truth in [%a, %a]", op, x, y, n, r.lo, r.hi, lo, hi);
  }
}

static void every_operation_encloses(void **unused) {
  (void)unused;
  uint64_t state = 1;
  for (int i = 0; i < ROUNDS; i++)
    for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++) {
      ambit_interval a = random_interval(&state), b = random_interval(&state), r;
      int32_t n = (int32_t)(oracle_random(&state) % 25) - 12;
      uint32_t flags = op == AMBIT_OP_POWN ? ambit_interval_pown(&r, a, n) : ambit_interval_op(op, &r, a, b);
      assert_false(isnan(r.lo) || isnan(r.hi));
      check_inclusion(op, a, b, n, r, flags, &state);
    }
}

static bool is_basic(uint32_t op) { return op <= AMBIT_OP_SQRT || op >= AMBIT_OP_ABS; }

static void points_are_tightest(void **unused) {
  (void)unused;
  uint64_t state = 2;
  for (int i = 0; i < ROUNDS; i++)
    for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++) {
      double x = oracle_double(&state), y = oracle_double(&state);
      int32_t n = (int32_t)(oracle_random(&state) % 25) - 12;
      double lo = oracle_rounded(op, x, y, n, MPFR_RNDD), hi = oracle_rounded(op, x, y, n, MPFR_RNDU);
      if (isnan(lo)) continue;
      ambit_interval r, a = { x, x }, b = { y, y };
      if (op == AMBIT_OP_POWN)
        ambit_interval_pown(&r, a, n);
      else
        ambit_interval_op(op, &r, a, b);
      if (op != AMBIT_OP_POWN && is_basic(op)) {
        if (r.lo != lo || r.hi != hi)
          fail_msg("op %u(%a, %a): [%a, %a] is not the tightest [%a, %a]", op, x, y, r.lo, r.hi, lo, hi);
      } else if (fabs(x) < 1e3 && fabs(x) > 1e-3) { /* away from over- and underflow: at most one ulp on each side */
        if (r.lo < nextafter(lo, -INFINITY) || r.hi > nextafter(hi, INFINITY))
          fail_msg("op %u(%a, %a)^%d: [%a, %a] is too wide for [%a, %a]", op, x, y, n, r.lo, r.hi, lo, hi);
      }
    }
}

static void expect(uint32_t op, ambit_interval a, ambit_interval b, ambit_interval want, uint32_t want_flags) {
  ambit_interval r;
  uint32_t flags = ambit_interval_op(op, &r, a, b);
  if (r.lo != want.lo || r.hi != want.hi || flags != want_flags)
    fail_msg(
        "op %u: [%a, %a] flags %u, expected [%a, %a] flags %u", op, r.lo, r.hi, flags, want.lo, want.hi, want_flags);
}

#define I(lo, hi) ((ambit_interval) { lo, hi })

static void special_sets(void **unused) {
  (void)unused;
  const uint32_t P = AMBIT_F_PARTIAL, U = AMBIT_F_UNBOUNDED, E = AMBIT_F_EMPTY;
  for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++)
    if (op != AMBIT_OP_POWN) expect(op, AMBIT_EMPTY, I(1, 2), AMBIT_EMPTY, E);
  expect(AMBIT_OP_MUL, I(0, 0), AMBIT_ENTIRE, I(0, 0), 0);
  expect(AMBIT_OP_MUL, I(0, 1), I(1, INFINITY), I(0, INFINITY), U);
  expect(AMBIT_OP_ADD, AMBIT_ENTIRE, I(1, 1), AMBIT_ENTIRE, U);
  expect(AMBIT_OP_DIV, I(1, 1), I(0, 0), AMBIT_EMPTY, P | E);
  expect(AMBIT_OP_DIV, I(1, 2), I(0, 4), I(0.25, INFINITY), P | U);
  expect(AMBIT_OP_DIV, I(1, 2), I(-4, 0), I(-INFINITY, -0.25), P | U);
  expect(AMBIT_OP_DIV, I(-2, -1), I(0, 4), I(-INFINITY, -0.25), P | U);
  expect(AMBIT_OP_DIV, I(1, 2), I(-1, 1), AMBIT_ENTIRE, P | U);
  expect(AMBIT_OP_DIV, I(0, 0), I(-1, 1), I(0, 0), P);
  expect(AMBIT_OP_DIV, I(1, INFINITY), I(1, INFINITY), I(0, INFINITY), U);
  expect(AMBIT_OP_SQRT, I(-4, 9), I(0, 0), I(0, 3), P);
  expect(AMBIT_OP_SQRT, I(-4, -1), I(0, 0), AMBIT_EMPTY, P | E);
  expect(AMBIT_OP_LOG, I(-1, 1), I(0, 0), I(-INFINITY, 0), P | U);
  expect(AMBIT_OP_LOG, I(-1, 0), I(0, 0), AMBIT_EMPTY, P | E);
  expect(AMBIT_OP_ASIN, I(2, 3), I(0, 0), AMBIT_EMPTY, P | E);
  expect(AMBIT_OP_ATAN2, I(0, 0), I(0, 0), AMBIT_EMPTY, P | E);
  expect(AMBIT_OP_TAN, I(1, 2), I(0, 0), AMBIT_ENTIRE, P | U);
  expect(AMBIT_OP_SQR, I(-3, 2), I(0, 0), I(0, 9), 0);
  expect(AMBIT_OP_ABS, I(-3, 2), I(0, 0), I(0, 3), 0);
  expect(AMBIT_OP_SIN, AMBIT_ENTIRE, I(0, 0), I(-1, 1), 0);
  expect(AMBIT_OP_EXP, AMBIT_ENTIRE, I(0, 0), I(0, INFINITY), U);
}

static void powers(void **unused) {
  (void)unused;
  ambit_interval r;
  assert_int_equal(ambit_interval_pown(&r, I(-1, 2), 3), 0);
  assert_true(r.lo == -1 && r.hi == 8);
  assert_int_equal(ambit_interval_pown(&r, I(-2, 1), 4), 0);
  assert_true(r.lo == 0 && r.hi == 16);
  assert_int_equal(ambit_interval_pown(&r, I(-2, 1), -1), AMBIT_F_PARTIAL | AMBIT_F_UNBOUNDED);
  assert_true(r.lo == -INFINITY && r.hi == INFINITY);
  assert_int_equal(ambit_interval_pown(&r, I(-2, 0), -2), AMBIT_F_PARTIAL | AMBIT_F_UNBOUNDED);
  assert_true(r.lo == 0.25 && r.hi == INFINITY);
  assert_int_equal(ambit_interval_pown(&r, I(0, 0), -3), AMBIT_F_PARTIAL | AMBIT_F_EMPTY);
  assert_int_equal(ambit_interval_pown(&r, I(0, 0), 0), 0);
  assert_true(r.lo == 1 && r.hi == 1);
  assert_int_equal(ambit_interval_pown(&r, I(2, 2), INT32_MIN), 0);
  assert_true(r.lo == 0 && r.hi == 0x1p-1074);
}

static void ambient_environment_does_not_matter(void **unused) {
  (void)unused;
  const int mode[] = { FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO };
  uint64_t state = 3;
  for (int i = 0; i < 2000; i++)
    for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++) {
      ambit_interval a = random_interval(&state), b = random_interval(&state), first = I(0, 0);
      for (int m = 0; m < 4; m++) {
        ambit_interval r;
        fesetround(mode[m]);
        if (op == AMBIT_OP_POWN)
          ambit_interval_pown(&r, a, 5);
        else
          ambit_interval_op(op, &r, a, b);
        assert_int_equal(fegetround(), mode[m]);
        fesetround(FE_TONEAREST);
        if (m == 0) first = r;
        assert_true(r.lo == first.lo && r.hi == first.hi);
      }
    }
}

static void measures(void **unused) {
  (void)unused;
  assert_true(ambit_interval_mid(I(-DBL_MAX, DBL_MAX)) == 0);
  assert_true(ambit_interval_mid(I(DBL_MAX, DBL_MAX)) == DBL_MAX);
  assert_true(ambit_interval_mid(AMBIT_ENTIRE) == 0 && isnan(ambit_interval_mid(AMBIT_EMPTY)));
  assert_true(ambit_interval_width(I(1, 3)) == 2 && ambit_interval_width(AMBIT_EMPTY) == 0);
  assert_true(ambit_interval_width(I(-1, 0x1p-1074)) > 1);
  assert_true(ambit_interval_width(I(-INFINITY, 5)) == INFINITY && ambit_interval_width(AMBIT_ENTIRE) == INFINITY);
  assert_true(ambit_interval_rad(I(-INFINITY, -1e308)) == INFINITY && ambit_interval_rad(AMBIT_ENTIRE) == INFINITY);
  assert_true(ambit_interval_is_empty(ambit_interval_of(2, 1)) && ambit_interval_is_empty(ambit_interval_of(NAN, 1)));
  assert_true(ambit_interval_is_empty(ambit_interval_of(INFINITY, INFINITY)));
  assert_true(ambit_interval_is_empty(ambit_interval_intersect(I(0, 1), I(2, 3))));
  uint64_t state = 4;
  for (int i = 0; i < ROUNDS; i++) {
    ambit_interval x = random_interval(&state);
    if (!ambit_interval_is_bounded(x)) continue;
    double mid = ambit_interval_mid(x), rad = ambit_interval_rad(x);
    ambit_interval back = ambit_interval_add(I(mid, mid), I(-rad, rad));
    assert_true(ambit_interval_contains(x, mid) && back.lo <= x.lo && back.hi >= x.hi);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_operation_encloses),
    cmocka_unit_test(points_are_tightest),
    cmocka_unit_test(special_sets),
    cmocka_unit_test(powers),
    cmocka_unit_test(ambient_environment_does_not_matter),
    cmocka_unit_test(measures),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
