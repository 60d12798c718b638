/* test_params.c -- options by name: every shape, every fallback, and what wrong input is told. */
#include "host/params.h"
#include <ambit/registry.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

static const ambit_param all[] = {
  { "tolerance", "s", "", "1e-10", "One number." },
  { "offset", "m", "3", "0, 0, 1/4", "A vector." },
  { "inertia", "kg m^2", "3x3", "1,0,0, 0,1,0, 0,0,1", "A matrix." },
  { "axis", "1", "axis", "z", "A direction." },
  { "verbose", "1", "flag", "true", "A flag." },
  { "order", "1", "integer", "20", "An integer." },
  { "stepper", "1", "rk4|rk8pd|msbdf", "rk8pd", "A choice." },
  { "limit", "s", "", "", "May be absent." },
  { NULL, NULL, NULL, NULL, NULL },
};
enum { TOLERANCE, OFFSET, INERTIA = 4, AXIS = 13, VERBOSE = 16, ORDER, STEPPER, LIMIT, DOUBLES };

static const ambit_param strict[] = { { "mass", "kg", "", NULL, "How heavy it is." },
  { NULL, NULL, NULL, NULL, NULL } };

static void takes_fallbacks(void **state) {
  double v[DOUBLES];
  (void)state;
  assert_int_equal(ambit_params_count(all), 8);
  assert_int_equal(ambit_params_doubles(all), DOUBLES);
  assert_int_equal(ambit_params_count(NULL), 0);
  assert_int_equal(ambit_params_doubles(NULL), 0);
  assert_int_equal(ambit_params_resolve(all, "solver `x`", 0, NULL, v, NULL), AMBIT_OK);
  assert_true(v[TOLERANCE] == 1e-10 && v[OFFSET] == 0 && v[OFFSET + 2] == 0.25);
  for (int i = 0; i < 9; i++) assert_true(v[INERTIA + i] == (i % 4 == 0));
  assert_true(v[AXIS] == 0 && v[AXIS + 1] == 0 && v[AXIS + 2] == 1);
  assert_true(v[VERBOSE] == 1 && v[ORDER] == 20 && v[STEPPER] == 1 && isnan(v[LIMIT]));
}

/* the doubles after one option was given */
static void resolve(double v[DOUBLES], const char *name, const char *text) {
  ambit_option given = { name, text };
  ambit_failure f = { 0 };
  if (ambit_params_resolve(all, "solver `x`", 1, &given, v, &f) != AMBIT_OK) fail_msg("%s", f.message);
}

static void reads_values(void **state) {
  double v[DOUBLES];
  (void)state;
  resolve(v, "tolerance", "0.1");
  assert_true(v[TOLERANCE] == 0.1);
  resolve(v, "tolerance", "inf");
  assert_true(v[TOLERANCE] == INFINITY);
  resolve(v, "tolerance", "1/3");
  assert_true(fabs(v[TOLERANCE] - 1.0 / 3) <= 0x1p-54);
  resolve(v, "offset", "1, -2,3e2");
  assert_true(v[OFFSET] == 1 && v[OFFSET + 1] == -2 && v[OFFSET + 2] == 300);
  resolve(v, "axis", "-x");
  assert_true(v[AXIS] == -1 && v[AXIS + 1] == 0 && v[AXIS + 2] == 0);
  resolve(v, "axis", "0,3,4");
  assert_true(v[AXIS] == 0 && v[AXIS + 1] == 3 && v[AXIS + 2] == 4);
  resolve(v, "verbose", "false");
  assert_true(v[VERBOSE] == 0);
  resolve(v, "order", "-7");
  assert_true(v[ORDER] == -7);
  resolve(v, "stepper", "msbdf");
  assert_true(v[STEPPER] == 2);
  resolve(v, "limit", "5");
  assert_true(v[LIMIT] == 5);
}

static void assert_refused(const ambit_param *param, size_t n, const ambit_option *given, const char *part) {
  double v[DOUBLES];
  ambit_failure f = { 0 };
  assert_int_equal(ambit_params_resolve(param, "solver `x`", n, given, v, &f), AMBIT_INVALID);
  if (!strstr(f.message, part) || !strstr(f.message, "solver `x`"))
    fail_msg("\"%s\" expected, got: %s", part, f.message);
}

static void refuses_wrong_values(void **state) {
  static const char *const wrong[][3] = {
    { "tolerance", "small", "one number in s" },
    { "tolerance", "", "one number" },
    { "tolerance", "[1, 2]", "one number" },
    { "tolerance", "1,2", "one number" },
    { "tolerance", "nan", "one number" },
    { "offset", "1,2", "3 numbers" },
    { "offset", "1,2,3,4", "3 numbers" },
    { "offset", "1,,3", "3 numbers" },
    { "offset", "1,2,3,", "3 numbers" },
    { "inertia", "1", "9 numbers (3x3)" },
    { "axis", "w", "an axis" },
    { "axis", "0,0,0", "an axis" },
    { "axis", "0,inf,0", "an axis" },
    { "verbose", "yes", "true or false" },
    { "order", "2.5", "an integer" },
    { "order", "1e300", "an integer" },
    { "order", "inf", "an integer" },
    { "stepper", "rk8p", "did you mean `rk8pd`?" },
    { "stepper", "rk8", "rk4|rk8pd|msbdf" },
  };
  (void)state;
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    ambit_option given = { wrong[i][0], wrong[i][1] };
    assert_refused(all, 1, &given, wrong[i][2]);
    assert_refused(all, 1, &given, wrong[i][0]);
  }
}

static void refuses_wrong_names(void **state) {
  ambit_option near = { "tolerence", "1" }, twice[] = { { "order", "3" }, { "order", "4" } };
  (void)state;
  assert_refused(all, 1, &near, "did you mean `tolerance`?");
  assert_refused(all, 1, &near, "stepper"); /* the whole list */
  assert_refused(all, 2, twice, "given twice");
  assert_refused(NULL, 1, &near, "no options");
  assert_refused(strict, 0, NULL, "needs the option `mass`");
}

static void stops_at_a_null_name(void **state) {
  double v[DOUBLES];
  ambit_option given[] = { { "order", "3" }, { NULL, NULL } };
  (void)state;
  assert_int_equal(ambit_params_resolve(all, "solver `x`", 2, given, v, NULL), AMBIT_OK);
  assert_true(v[ORDER] == 3);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(takes_fallbacks),
    cmocka_unit_test(reads_values),
    cmocka_unit_test(refuses_wrong_values),
    cmocka_unit_test(refuses_wrong_names),
    cmocka_unit_test(stops_at_a_null_name),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
