/* The Taylor-model plugin for each instruction set: conformance, the caller's floating-point environment, refusals,
** special sets, what cancels. */
#include "taylor_case.h"
#include <fenv.h>
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

enum { X, Y, R, S, SLOTS = 6 };

static void passes_the_kit(void **state) {
  (void)state;
  for (int v = 0; v < 3; v++) {
    arithmetic_loader l;
    size_t fallbacks;
    const char *problem = arithmetic_load_as(&l, "taylor_model", taylor_variant[v]);
    if (problem) fail_msg("%s", problem);
    assert_int_equal(l.plugin->rigorous, 1);
    assert_int_equal(case_run(&l, false, &fallbacks), 0);
    assert_int_equal(fallbacks, 0);
    arithmetic_unload(&l);
  }
}

static void set_pair(taylor_case *c, double xlo, double xhi, double ylo, double yhi) {
  c->a->set(c->ctx, taylor_at(c, X, 0), 1, &xlo, &xhi, 0);
  c->a->set(c->ctx, taylor_at(c, Y, 0), 1, &ylo, &yhi, 1);
}

static void bounds_of(const taylor_case *c, uint32_t slot, double *lo, double *hi) {
  c->a->bounds(c->ctx, taylor_at(c, slot, 0), 1, lo, hi);
}

/* -- any rounding mode, flush-to-zero, denormals-are-zero: the same bits as in a clean environment */

static void every_operation(taylor_case *c, double *bounds) {
  for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++) {
    taylor_run(c, op, R, X, op == AMBIT_OP_POWN ? 5 : Y);
    bounds_of(c, R, &bounds[2 * op], &bounds[2 * op + 1]);
  }
  c->t->product(c->ctx, taylor_at(c, R, 0), taylor_at(c, X, 0), taylor_at(c, Y, 0));
  bounds_of(c, R, &bounds[2 * AMBIT_OP_COUNT], &bounds[2 * AMBIT_OP_COUNT + 1]);
}

static void ignores_the_environment(void **state) {
  (void)state;
  static const double box[][4] = { { 0.25, 0.5, 0.5, 0.75 }, { 0x1p-1074, 0x1p-1030, 0x1p-1050, 0x1p-1024 } };
  static const int mode[] = { FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO };
  double clean[2 * AMBIT_OP_COUNT + 2], other[2 * AMBIT_OP_COUNT + 2];
  taylor_case c;
  taylor_open(&c, 0, 2, 4, SLOTS, 1);
  for (size_t b = 0; b < sizeof box / sizeof *box; b++) {
    set_pair(&c, box[b][0], box[b][1], box[b][2], box[b][3]);
    every_operation(&c, clean);
    for (int m = 0; m < 4; m++) {
      fesetround(mode[m]);
#if defined(__x86_64__)
      _mm_setcsr(_mm_getcsr() | 0x8040);
#endif
      set_pair(&c, box[b][0], box[b][1], box[b][2], box[b][3]);
      every_operation(&c, other);
#if defined(__x86_64__)
      assert_int_equal(_mm_getcsr() & 0x8040, 0x8040);
      _mm_setcsr(_mm_getcsr() & ~0x8040u);
#endif
      assert_int_equal(fegetround(), mode[m]);
      fesetround(FE_TONEAREST);
      assert_memory_equal(clean, other, sizeof clean);
    }
  }
  taylor_close(&c);
}

/* -- refusals */

static ambit_status try_open(arithmetic_loader *l, double order, double boxes, uint32_t nvar) {
  const double option[] = { order, boxes };
  void *ctx = NULL;
  return l->full.open(&l->scope->host, option, nvar, &ctx);
}

static void refuses(void **state) {
  (void)state;
  arithmetic_loader l;
  case_load(&l, "taylor_model");
  assert_int_equal(try_open(&l, 12, 16, 40), AMBIT_NOMEM); /* 2e11 monomials; the scope keeps the first message */
  if (!strstr(l.scope->failure.message, "2.06379e+11 monomials")) fail_msg("%s", l.scope->failure.message);
  assert_int_equal(try_open(&l, 61, 16, 1), AMBIT_INVALID);
  assert_int_equal(try_open(&l, -1, 16, 1), AMBIT_INVALID);
  assert_int_equal(try_open(&l, NAN, 16, 1), AMBIT_INVALID);
  assert_int_equal(try_open(&l, 3, 1000, 1), AMBIT_INVALID);
  assert_int_equal(try_open(&l, 60, 16, 4000000000u), AMBIT_NOMEM);
  assert_int_equal(try_open(&l, 3, 16, 20), AMBIT_OK);
  assert_int_equal(try_open(&l, 60, 0, 1), AMBIT_OK);
  assert_int_equal(try_open(&l, 60, 256, 0), AMBIT_OK);
  arithmetic_unload(&l);
}

/* -- what the polynomial is for */

static void remembers(void **state) {
  (void)state;
  taylor_case c;
  double lo, hi;
  taylor_open(&c, 0, 2, 3, SLOTS, 1);
  set_pair(&c, 1, 3, -1, 5);
  taylor_run(&c, AMBIT_OP_ADD, R, X, Y), taylor_run(&c, AMBIT_OP_SUB, S, R, Y); /* x + y - y */
  bounds_of(&c, S, &lo, &hi);
  assert_true(lo == 1 && hi == 3);
  taylor_run(&c, AMBIT_OP_SUB, R, X, X);
  bounds_of(&c, R, &lo, &hi);
  assert_true(lo == 0 && hi == 0);
  taylor_run(&c, AMBIT_OP_DIV, R, X, X);
  bounds_of(&c, R, &lo, &hi);
  assert_true(lo == 1 && hi == 1);
  taylor_run(&c, AMBIT_OP_MUL, R, X, Y), taylor_run(&c, AMBIT_OP_SUB, S, R, R);
  bounds_of(&c, S, &lo, &hi);
  assert_true(lo == 0 && hi == 0);
  taylor_run(&c, AMBIT_OP_MAX, R, X, Y), taylor_run(&c, AMBIT_OP_SUB, S, R, Y); /* max(x - y, 0) in [0, 4] */
  bounds_of(&c, S, &lo, &hi);
  assert_true(lo > -2.001 && lo <= 0 && hi >= 4 && hi < 4.001); /* intervals: [-4, 6] */
  taylor_close(&c);
}

static void special_sets(void **state) {
  (void)state;
  taylor_case c;
  double lo, hi;
  taylor_open(&c, 0, 2, 3, SLOTS, 1);
  set_pair(&c, -1, 1, -INFINITY, 2);
  assert_int_equal(taylor_run(&c, AMBIT_OP_MUL, R, X, Y), AMBIT_F_UNBOUNDED);
  assert_int_equal(taylor_run(&c, AMBIT_OP_SQRT, R, X, X), AMBIT_F_PARTIAL);
  bounds_of(&c, R, &lo, &hi);
  assert_true(lo == 0 && hi == 1);
  assert_int_equal(taylor_run(&c, AMBIT_OP_DIV, R, X, X), AMBIT_F_PARTIAL | AMBIT_F_UNBOUNDED);
  set_pair(&c, -2, -1, 2, 1); /* y is empty */
  assert_int_equal(taylor_run(&c, AMBIT_OP_ADD, R, X, Y), AMBIT_F_EMPTY);
  assert_int_equal(taylor_run(&c, AMBIT_OP_LOG, R, X, X), AMBIT_F_PARTIAL | AMBIT_F_EMPTY);
  set_pair(&c, -DBL_MAX, DBL_MAX, 1e300, 1e308);
  taylor_run(&c, AMBIT_OP_MUL, R, X, Y);
  bounds_of(&c, R, &lo, &hi);
  assert_true(lo == -INFINITY && hi == INFINITY);
  taylor_run(&c, AMBIT_OP_SUB, R, Y, Y);
  bounds_of(&c, R, &lo, &hi);
  assert_true(lo <= 0 && hi >= 0 && !isnan(lo) && !isnan(hi));
  taylor_close(&c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(passes_the_kit),
    cmocka_unit_test(ignores_the_environment),
    cmocka_unit_test(refuses),
    cmocka_unit_test(remembers),
    cmocka_unit_test(special_sets),
  };
  return cmocka_run_group_tests_name("arithmetic taylor_model", tests, NULL, NULL);
}
