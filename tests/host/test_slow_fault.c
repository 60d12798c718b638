/* test_slow_fault.c -- a slow path of the elementary functions that gives reversed bounds: what is computed stays
** sound, and it is said who is broken. */
#include "host/trust.h"
#include <ambit/registry.h>
#include "host/slow.h"
#include "num/interval.h"
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>
#include <cmocka.h>

static void says_who_is_broken(void **state) {
  ambit_interval s, huge = { 1e300, 1e300 };
  ambit_failure f = { 0 };
  (void)state;
  ambit_trust_shadows();
  ambit_registry *r = ambit_registry_open(AMBIT_LYING_DIR);
  assert_non_null(r);
  assert_int_equal(ambit_slow_sound(&f), AMBIT_OK);
  ambit_interval_op(AMBIT_OP_SIN, &s, huge, huge);
  assert_true(s.lo == -1 && s.hi == 1); /* -0.8178..., MPFR */
  assert_int_equal(ambit_slow_sound(&f), AMBIT_BROKEN);
  assert_string_equal(f.message, "service `elementary` is broken: it gave the bounds [0.5, 0.25]");
  ambit_registry_close(r);
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(says_who_is_broken) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
