/* Literals both ways against MPFR: tightest in, outward out, in every ambient mode and locale. */
#include "num/decimal.h"
#include "num/rounding.h"
#include "oracle.h"
#include <fenv.h>
#include <locale.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

static ambit_interval read(const char *text) {
  ambit_interval x = { 0, 0 };
  ambit_failure f = { 0 };
  if (ambit_decimal_read(text, &x, NULL, &f) != AMBIT_OK) fail_msg("%s: %s", text, f.message);
  return x;
}

static void expect(const char *text, double lo, double hi) {
  ambit_interval x = read(text);
  if (x.lo != lo || x.hi != hi) fail_msg("%s: [%a, %a], expected [%a, %a]", text, x.lo, x.hi, lo, hi);
}

static double nearest_below(const char *text) {
  mpfr_t r;
  mpfr_init2(r, 53);
  int t = mpfr_strtofr(r, text, NULL, 0, MPFR_RNDD);
  mpfr_set_emin(-1073);
  mpfr_set_emax(1024);
  t = mpfr_check_range(r, t, MPFR_RNDD);
  mpfr_subnormalize(r, t, MPFR_RNDD);
  double d = mpfr_get_d(r, MPFR_RNDD);
  mpfr_clear(r);
  return d;
}

static double nearest_above(const char *text) {
  char negative[300];
  snprintf(negative, sizeof negative, "%s%s", *text == '-' ? "" : "-", *text == '-' ? text + 1 : text);
  return -nearest_below(negative);
}

static void literals(void **unused) {
  (void)unused;
  expect("1", 1, 1);
  expect(" -0.5 ", -0.5, -0.5);
  expect("0x1.8p3", 12, 12);
  expect("0.1", 0x1.9999999999999p-4, 0x1.999999999999ap-4);
  expect("1/3", 0x1.5555555555555p-2, 0x1.5555555555556p-2);
  expect("-1/4", -0.25, -0.25);
  expect("pi", 0x1.921fb54442d18p+1, 0x1.921fb54442d19p+1);
  expect("-pi", -0x1.921fb54442d19p+1, -0x1.921fb54442d18p+1);
  expect("[1, 2]", 1, 2);
  expect("[ 0.1 , 0.1 ]", 0x1.9999999999999p-4, 0x1.999999999999ap-4);
  expect("[1]", 1, 1);
  expect("[1,]", 1, INFINITY);
  expect("[,1]", -INFINITY, 1);
  expect("[,]", -INFINITY, INFINITY);
  expect("[-inf, +inf]", -INFINITY, INFINITY);
  expect("[entire]", -INFINITY, INFINITY);
  expect("[empty]", INFINITY, -INFINITY);
  expect("[]", INFINITY, -INFINITY);
  expect("3.5?", 3.4499999999999997, 3.5500000000000003);
  expect("10?2", 8, 12);
  expect("10?2u", 10, 12);
  expect("10?2d", 8, 10);
  expect("-10?2u", -10, -8);
  expect("10??", -INFINITY, INFINITY);
  expect("10??u", 10, INFINITY);
  expect("1.0?5e1", 5, 15);
  expect("1e400", DBL_MAX, INFINITY);
  expect("1.5?1e-9223372036854775808", 0, 0x1p-1074);
  expect("5?e-99999999999999999999", 0, 0x1p-1074);
  expect("5?e99999999999999999999", DBL_MAX, INFINITY);
  expect("1e-400", 0, 0x1p-1074);
}

static void refused(const char *text, const char *part) {
  ambit_interval x;
  ambit_failure f = { 0 };
  assert_int_equal(ambit_decimal_read(text, &x, NULL, &f), AMBIT_INVALID);
  if (!strstr(f.message, part)) fail_msg("%s: \"%s\" does not say \"%s\"", text, f.message, part);
}

static void bad_text(void **unused) {
  (void)unused;
  const char *const bad[] = { "", "abc", "nan", "inf", "1,5", "1 2", "[1, 2", "[1; 2]", "0x", "1/", "1/0", "1/-3",
    "--1", "[nan]", "pie", "[1,2]x", ".", "e5", "+" };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) refused(bad[i], "is no number");
  refused("[2, 1]", "lower bound");
  refused("[inf, inf]", "no real number");
}

static void rest_and_tolerance(void **unused) {
  (void)unused;
  ambit_interval x;
  const char *rest;
  assert_int_equal(ambit_decimal_read("35 mm", &x, &rest, NULL), AMBIT_OK);
  assert_string_equal(rest, "mm");
  bool relative;
  assert_int_equal(ambit_decimal_tolerance("50 %", &x, &relative, NULL, NULL), AMBIT_OK);
  assert_true(relative && x.lo == 0.5 && x.hi == 0.5);
  assert_int_equal(ambit_decimal_tolerance("0.25 mm", &x, &relative, &rest, NULL), AMBIT_OK);
  assert_true(!relative && x.lo == 0.25);
  assert_string_equal(rest, "mm");
  assert_int_equal(ambit_decimal_tolerance("-1%", &x, &relative, NULL, NULL), AMBIT_INVALID);
}

static void random_literals(void **unused) {
  (void)unused;
  uint64_t state = 5;
  char text[200];
  for (int i = 0; i < 20000; i++) {
    int digits = (int)(oracle_random(&state) % 40) + 1, n = 0;
    if (oracle_random(&state) % 2) text[n++] = '-';
    int point = (int)(oracle_random(&state) % (unsigned)digits);
    for (int k = 0; k < digits; k++) {
      text[n++] = (char)('0' + oracle_random(&state) % 10);
      if (k == point) text[n++] = '.';
    }
    snprintf(text + n, sizeof text - (size_t)n, "e%d", (int)(oracle_random(&state) % 700) - 360);
    const int mode[] = { FE_TONEAREST, FE_UPWARD, FE_DOWNWARD };
    fesetround(mode[i % 3]);
    ambit_interval x = read(text);
    assert_int_equal(fegetround(), mode[i % 3]);
    fesetround(FE_TONEAREST);
    if (x.lo != nearest_below(text) || x.hi != nearest_above(text)) fail_msg("%s: [%a, %a]", text, x.lo, x.hi);
  }
}

/* text <= x (direction -1) or >= x (direction +1), exactly */
static bool on_side(const char *text, double x, int direction) {
  mpfr_t r;
  mpfr_init2(r, 4000);
  mpfr_set_str(r, text, 10, MPFR_RNDN);
  int order = mpfr_cmp_d(r, x);
  mpfr_clear(r);
  return order * direction >= 0;
}

static void printing(void **unused) {
  (void)unused;
  uint64_t state = 6;
  char text[3 * AMBIT_DECIMAL_MAX];
  for (int i = 0; i < 20000; i++) {
    double x = oracle_double(&state);
    ambit_decimal_shortest(text, x);
    assert_true(strtod(text, NULL) == x);
    int digits = (int)(oracle_random(&state) % 17) + 1;
    ambit_decimal_down(text, x, digits);
    assert_true(on_side(text, x, -1));
    ambit_decimal_up(text, x, digits);
    assert_true(on_side(text, x, 1));
    double y = oracle_double(&state);
    ambit_interval v = { x < y ? x : y, x < y ? y : x };
    ambit_decimal_interval(text, v, 3);
    ambit_interval back = read(text);
    assert_true(back.lo <= v.lo && back.hi >= v.hi);
  }
  ambit_decimal_interval(text, (ambit_interval) { 2.336179171099, 2.384881903659 }, 3);
  assert_string_equal(text, "[2.3361, 2.3849]");
  ambit_decimal_interval(text, (ambit_interval) { 2.5, 2.5 }, 3);
  assert_string_equal(text, "2.5");
  ambit_decimal_interval(text, AMBIT_EMPTY, 3);
  assert_string_equal(text, "[empty]");
  assert_int_equal(ambit_decimal_shortest(text, -INFINITY), 4);
}

/* Bounds of any widths, some ulps or many decades: what is shown lies inside, in order. */
static void printing_inward(void **unused) {
  (void)unused;
  uint64_t seed = 5;
  for (int i = 0; i < 100000; i++) {
    double a = oracle_uniform(&seed, -2, 2) * pow(10, oracle_uniform(&seed, -20, 20));
    double b = i % 3 ? a + oracle_uniform(&seed, -1, 1) * pow(10, oracle_uniform(&seed, -16, 2)) * fabs(a)
                     : nextafter(a, INFINITY);
    ambit_interval x = { fmin(a, b), fmax(a, b) }, lo, hi;
    char text[3 * AMBIT_DECIMAL_MAX], *comma;
    ambit_decimal_inner(text, x, 1 + i % 17);
    if (x.lo == x.hi || !(comma = strchr(text, ','))) continue;
    *comma = '\0';
    comma[strlen(comma + 1)] = '\0'; /* the bracket */
    assert_int_equal(ambit_decimal_read(text + 1, &lo, NULL, NULL), AMBIT_OK);
    assert_int_equal(ambit_decimal_read(comma + 1, &hi, NULL, NULL), AMBIT_OK);
    if (!(lo.hi >= x.lo && hi.lo <= x.hi && lo.lo <= hi.hi)) fail_msg("[%a, %a]: %s,%s", x.lo, x.hi, text, comma + 1);
  }
  char text[3 * AMBIT_DECIMAL_MAX];
  ambit_decimal_inner(text, (ambit_interval) { 0.49331, 0.58959 }, 3);
  assert_string_equal(text, "[0.4934, 0.5895]");
}

static void locales(void **unused) {
  (void)unused;
  if (!setlocale(LC_NUMERIC, "de_DE.UTF-8") && !setlocale(LC_NUMERIC, "fr_FR.UTF-8")) {
    print_message("no locale with a decimal comma is installed: skipped\n");
    skip();
  }
  expect("0.5", 0.5, 0.5);
  char text[AMBIT_DECIMAL_MAX];
  ambit_decimal_shortest(text, 0.5);
  setlocale(LC_NUMERIC, "C");
  assert_string_equal(text, "0.5");
}

/* tolower('I') is not i there */
static void turkish(void **unused) {
  (void)unused;
  if (!setlocale(LC_CTYPE, "tr_TR.UTF-8") && !setlocale(LC_CTYPE, "tr_TR")) {
    print_message("no Turkish locale is installed: skipped\n");
    skip();
  }
  expect("PI", 0x1.921fb54442d18p+1, 0x1.921fb54442d19p+1);
  expect("[-INF, Infinity]", -INFINITY, INFINITY);
  expect("[ENTIRE]", -INFINITY, INFINITY);
  setlocale(LC_CTYPE, "C");
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(literals),
    cmocka_unit_test(bad_text),
    cmocka_unit_test(rest_and_tolerance),
    cmocka_unit_test(random_literals),
    cmocka_unit_test(printing),
    cmocka_unit_test(printing_inward),
    cmocka_unit_test(locales),
    cmocka_unit_test(turkish),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
