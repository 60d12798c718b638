/* test_service_rational.c -- exact quotients against MPFR: bounds of decimals and quotients, the order of instants that
** are nearer than doubles are, and what is refused. */
#include <ambit/rational.h>
#include <ambit/registry.h>
#include "num/random.h"
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <mpfr.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

#define BITS 4000

static int set_up(void **state) {
  *state = ambit_registry_open(NULL);
  return *state ? 0 : 1;
}

static int tear_down(void **state) {
  ambit_registry_close(*state);
  return 0;
}

static const ambit_rational_service *find(ambit_registry *r) {
  const ambit_plugin *plugin;
  ambit_failure f = { 0 };
  if (ambit_registry_plugin(r, "service", "rational", &plugin, &f) != AMBIT_OK) fail_msg("%s", f.message);
  assert_null(plugin->get("ambit.rational/2"));
  const ambit_rational_service *s = plugin->get(AMBIT_RATIONAL_SERVICE);
  assert_non_null(s);
  return s;
}

static ambit_rational *number(const ambit_rational_service *s, const char *text) {
  ambit_rational *x = s->open();
  if (!s->read(x, text)) fail_msg("%s is refused", text);
  return x;
}

static void encloses_decimals_and_quotients(void **state) {
  const ambit_rational_service *s = find(*state);
  ambit_random random = { 1 };
  mpfr_t p, q;
  mpfr_inits2(BITS, p, q, (mpfr_ptr)0);
  for (int i = 0; i < 20000; i++) {
    char text[2][64], both[130];
    for (int k = 0; k < 2; k++)
      snprintf(text[k], sizeof text[k], "%" PRIu64 ".%" PRIu64 "e%d", ambit_random_bits(&random) >> (random.state % 64),
          ambit_random_bits(&random) >> 20, (int)(ambit_random_bits(&random) % 300) - 150);
    bool is_quotient = i % 2, negative = i % 3 == 0;
    mpfr_set_str(p, text[0], 10, MPFR_RNDN); /* exact: BITS are enough */
    if (mpfr_set_str(q, text[1], 10, MPFR_RNDN) != 0 || mpfr_zero_p(q)) is_quotient = false;
    snprintf(both, sizeof both, "%s%s%s%s", negative ? "-" : "", text[0], is_quotient ? "/" : "",
        is_quotient ? text[1] : "");
    ambit_rational *x = number(s, both);
    double lo, hi;
    s->enclose(x, &lo, &hi);
    s->close(x);
    if (is_quotient) mpfr_div(p, p, q, MPFR_RNDN);
    if (negative) mpfr_neg(p, p, MPFR_RNDN);
    if (lo != mpfr_get_d(p, MPFR_RNDD) || hi != mpfr_get_d(p, MPFR_RNDU)) fail_msg("%s: [%a, %a]", both, lo, hi);
  }
  mpfr_clears(p, q, (mpfr_ptr)0);
}

/* 10^6 instants k p against m q, one unit of the 40th place apart or none */
static void orders_instants(void **state) {
  const ambit_rational_service *s = find(*state);
  ambit_rational *zero = s->open(), *a = s->open(), *b = s->open();
  ambit_rational *third = number(s, "1/3"), *near = number(s, "0.3333333333333333333333333333333333333333"),
                 *same = number(s, "0.7/2.1");
  for (uint32_t k = 0; k < 1000000; k++) {
    s->go(a, zero, third, k), s->go(b, zero, near, k);
    if (s->compare(a, b) != (k > 0) || s->compare(b, a) != -(k > 0)) fail_msg("%" PRIu32, k);
    s->go(b, third, same, k - (k > 0));
    if (s->compare(a, b) != (k == 0 ? -1 : 0)) fail_msg("%" PRIu32 " of one number", k);
  }
  s->close(zero), s->close(a), s->close(b), s->close(third), s->close(near), s->close(same);
}

static void computes(void **state) {
  const ambit_rational_service *s = find(*state);
  static const struct {
    const char *a, *b, *result;
    uint32_t op;
    int32_t n;
  } known[] = { { "0.1", "0.2", "0.3", AMBIT_OP_ADD, 0 }, { "0.1", "0.2", "-1/10", AMBIT_OP_SUB, 0 },
    { "1/3", "3", "1", AMBIT_OP_MUL, 0 }, { "0.1", "0.7", "1/7", AMBIT_OP_DIV, 0 }, { "-2", "9", "4", AMBIT_OP_SQR, 0 },
    { "-0.5", "9", "0.5", AMBIT_OP_ABS, 0 }, { "0.5", "9", "-0.5", AMBIT_OP_NEG, 0 },
    { "-0.2", "9", "-125", AMBIT_OP_POWN, -3 }, { "1.1", "9", "1.331", AMBIT_OP_POWN, 3 } };
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    ambit_rational *a = number(s, known[i].a), *b = number(s, known[i].b), *c = number(s, known[i].result);
    assert_true(s->apply(a, known[i].op, b, known[i].n));
    assert_int_equal(s->compare(a, c), 0);
    s->close(a), s->close(b), s->close(c);
  }
  ambit_rational *x = s->open(), *zero = s->open();
  double lo, hi;
  s->set(x, 0x1.8p-1074), s->set(x, 0x1p-1074);
  s->enclose(x, &lo, &hi);
  assert_true(lo == 0x1p-1074 && hi == lo);
  s->close(x);
  x = number(s, "1e400");
  s->enclose(x, &lo, &hi);
  assert_true(lo == DBL_MAX && hi == INFINITY);
  assert_false(s->apply(x, AMBIT_OP_DIV, zero, 0));
  assert_true(s->apply(x, AMBIT_OP_NEG, zero, 0));
  s->enclose(x, &lo, &hi);
  assert_true(lo == -INFINITY && hi == -DBL_MAX);
  s->set(x, -DBL_MAX);
  s->enclose(x, &lo, &hi);
  assert_true(lo == -DBL_MAX && hi == -DBL_MAX);
  static const int32_t far[] = { 1001, -1001, INT32_MAX, INT32_MIN }; /* at most 1000 times */
  for (size_t i = 0; i < sizeof far / sizeof *far; i++) {
    s->set(x, 1);
    assert_false(s->apply(x, AMBIT_OP_POWN, zero, far[i]));
  }
  static const char *const bad[] = { "", "-", "pi", ".", "1..2", "1.2.3", "1/0", "1/", "/3", "0x1p3", "1e", "1e99999",
    "1e 5", "1.25e9223372036854775807", "1.25e-9223372036854775808", "1.25e-99999999999999999999", "1/1e-999999999999",
    "[1, 2]", "1 2", "inf" };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
    if (s->read(x, bad[i])) fail_msg("`%s` is read", bad[i]);
  assert_false(s->apply(x, AMBIT_OP_SIN, zero, 0));
  s->close(x), s->close(zero);
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test_setup_teardown(
                                          encloses_decimals_and_quotients, set_up, tear_down),
    cmocka_unit_test_setup_teardown(orders_instants, set_up, tear_down),
    cmocka_unit_test_setup_teardown(computes, set_up, tear_down) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
