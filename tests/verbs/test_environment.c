/* test_environment.c -- a C host that rounds otherwise or flushes subnormal numbers is told so by every verb. */
#include "num/environment.h"
#include <ambit/evaluate.h>
#include "verbs/scene.h"
#include "num/outward.h"
#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

static ambit_status evaluate(scene *s, ambit_failure *f) {
  ambit_expr x = scene_unknown(s, "x", 1, 2);
  ambit_evaluate_request q = {
    .graph = s->graph, .registry = s->registry, .arithmetic = "interval", .nexpr = 1, .expr = &x
  };
  ambit_interval out;
  return ambit_evaluate(&q, &out, NULL, NULL, f);
}

static void assert_refused_here(scene *s) {
  ambit_failure f = { 0 };
  bool standard = ambit_environment_is_standard();
  ambit_status status = evaluate(s, &f);
  fesetenv(FE_DFL_ENV);
  assert_false(standard);
  assert_int_equal(status, AMBIT_INVALID);
  assert_non_null(strstr(f.message, "fesetenv"));
}

static void refuses_other_environments(void **state) {
  static const int mode[] = { FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO };
  (void)state;
  scene *s = scene_open();
  for (int i = 0; i < 3; i++) {
    fesetround(mode[i]);
    assert_refused_here(s);
  }
#if defined(__SSE2__)
  static const unsigned flush[] = { 0x8000u, 0x0040u };
  for (int i = 0; i < 2; i++) {
    _mm_setcsr(_mm_getcsr() | flush[i]);
    assert_refused_here(s);
  }
#endif
  ambit_failure f = { 0 };
  assert_true(ambit_environment_is_standard());
  assert_int_equal(evaluate(s, &f), AMBIT_OK);
  scene_close(s);
}

static void rounds_outward_in_every_mode(void **state) {
  static const int mode[] = { FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO };
  (void)state;
  for (int i = 0; i < 4; i++) {
    fesetround(mode[i]);
    bool outward = ambit_interval_rounds_outward();
    fesetenv(FE_DFL_ENV);
    assert_true(outward);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(refuses_other_environments),
    cmocka_unit_test(rounds_outward_in_every_mode),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
