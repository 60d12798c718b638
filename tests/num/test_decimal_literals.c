/* test_decimal_literals.c -- the literals of IEEE 1788-2015 (clauses 9.7, 12.11): the grammar by examples, tightest
** bounds of random ones against MPFR, and texts that were damaged at random.
*/
#include "elementary_oracle.h"
#include "num/decimal.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>

#define LENGTH(array) (sizeof(array) / sizeof *(array))
#define PRECISION 6000

typedef struct accepted {
  const char *text;
  double lo, hi;
} accepted;

static void expect(const char *text, double lo, double hi) {
  ambit_interval x = { 0, 0 };
  ambit_failure f = { 0 };
  if (ambit_decimal_read(text, &x, NULL, &f) != AMBIT_OK) fail_msg("%s: %s", text, f.message);
  if (x.lo != lo || x.hi != hi) fail_msg("%s: [%a, %a], expected [%a, %a]", text, x.lo, x.hi, lo, hi);
}

static void grammar(void **state) {
  const double inf = INFINITY, max = DBL_MAX, tiny = 0x1p-1074;
  const accepted table[] = { { "[ ]", inf, -inf }, { "[]", inf, -inf }, { "[empty]", inf, -inf },
    { "[ Empty  ]", inf, -inf }, { "  [\tENTIRE ]\n", -inf, inf }, { "[,]", -inf, inf }, { "[ , ]", -inf, inf },
    { "[-inf , INF  ]", -inf, inf }, { "[ -Infinity, +infinity ]", -inf, inf }, { "[1,]", 1, inf }, { "[1, ]", 1, inf },
    { "[,-1]", -inf, -1 }, { "[ 1.0  ]", 1, 1 }, { "[-Inf, 1.0]", -inf, 1 }, { "[1.0E+400 ]", max, inf },
    { "[ -4/2, 10/5 ]", -2, 2 }, { "[ -1/10, 1/10 ]", -0x1.999999999999ap-4, 0x1.999999999999ap-4 },
    { "[0.1, 0.1]", 0x1.9999999999999p-4, 0x1.999999999999ap-4 }, { "[+1.5, 2.]", 1.5, 2 }, { "[.5]", 0.5, 0.5 },
    { "[0x1.3p-1, 0X1P+1]", 0x1.3p-1, 2 }, { "[-0x1.8p0, 0x.8p1]", -1.5, 1 },
    { "[0x1.00000000000008p0]", 1, 0x1.0000000000001p0 }, { "1e-400", 0, tiny }, { "-1E400", -inf, -max },
    { "[10000000000000001/10000000000000000, 10000000000000002/10000000000000001]", 1, 0x1.0000000000001p0 },
    { "100000000000000000000000000000000000000001/100000000000000000000000000000000000000000", 1, 0x1.0000000000001p0 },
    { "-99999999999999999999999999999999/100000000000000000000000000000000", -1, -0x1.fffffffffffffp-1 },
    { "18014398509481986/36028797018963972", 0.5, 0.5 }, { "10?", 9.5, 10.5 }, { "10?3", 7, 13 }, { "0?", -0.5, 0.5 },
    { "0.0?", -0x1.999999999999ap-5, 0x1.999999999999ap-5 }, { "2.500?5", 0x1.3f5c28f5c28f5p+1, 0x1.40a3d70a3d70bp+1 },
    { "3.56?1", 0x1.c666666666666p+1, 0x1.c8f5c28f5c290p+1 }, { "3.56?1e2", 355, 357 }, { "3.56?1E+2", 355, 357 },
    { "3560?2", 3558, 3562 }, { "3.56?2u", 0x1.c7ae147ae147ap+1, 0x1.ca3d70a3d70a4p+1 },
    { "3.56?2D", 0x1.c51eb851eb851p+1, 0x1.c7ae147ae147bp+1 }, { "10?u", 10, 10.5 }, { "10?d", 9.5, 10 },
    { "-10?u", -10, -9.5 }, { "-10?d", -10.5, -10 }, { "-10?2", -12, -8 }, { "10??", -inf, inf },
    { "-10??", -inf, inf }, { "10??u", 10, inf }, { "-10??u", -10, inf }, { "10??d", -inf, 10 }, { "10??D", -inf, 10 },
    { "10??de-1", -inf, 1 }, { "0.0?e3", -50, 50 }, { "1.0e3", 1000, 1000 }, { "10?18", -8, 28 },
    { "10?3e380", max, inf }, { "5.?2", 3, 7 }, { ".5?1", 0x1.9999999999999p-2, 0x1.3333333333334p-1 },
    { "-5?10u", -5, 5 }, { "5?10d", -5, 5 }, { "10?0", 10, 10 },
    { "10?e-1", 0x1.e666666666666p-1, 0x1.0cccccccccccdp+0 },
    { "1234567890123456789012345678901234567890?1", 0x1.d064903ae06dfp+129, 0x1.d064903ae06e0p+129 } };
  (void)state;
  for (size_t i = 0; i < LENGTH(table); i++) expect(table[i].text, table[i].lo, table[i].hi);
  char text[1200]; /* a radius beyond every double */
  const char *const direction[] = { "", "u", "d" };
  for (int k = 0; k < 3; k++) {
    snprintf(text, sizeof text, "10?18%0400d%s", 0, direction[k]);
    expect(text, k == 1 ? 10 : -inf, k == 2 ? 10 : inf);
  }
}

static void refusals(void **state) {
  static const char *const malformed[] = { "10?2?", "10??5", "10?ud", "10 ?2", "?2", ".?2", "[10?2]", "[1,2,3]",
    "[1 2]", "[", "]", "[1", "1]", "[1/0]", "1/-2", "1/+2", "- 1", "[- 1, 2]", "1e", "1e+", "0x", "0xp3", "0x1p",
    "[1;2]", "[entir]", "[emptyset]", "infinity", "-inf", "[+]", "[1//2]", "1/2/3", "[foo, bar]", "1?2e", "1 _2",
    "[1,2]]", "0x1?2" };
  static const char *const decorated[] = { "[1,2]_com", "[empty]_trv", "[1,2]_dac", "3.56?1_def", "[nai]", "[ NaI ]",
    "[1.0, 2.0]_ill", "1_com", "[,]_trv" };
  static const char *const reversed[] = { "[2, 1]", "[1, -inf]", "[inf, 0]", "[1e400, 1]", "[1/2, 1/3]" };
  static const char *const hollow[] = { "[inf, inf]", "[-inf, -inf]", "[inf]", "[,-inf]", "[+infinity,]" };
  const struct {
    const char *const *text;
    size_t n;
    const char *part;
  } table[] = { { malformed, LENGTH(malformed), "is no number" }, { decorated, LENGTH(decorated), "decorations" },
    { reversed, LENGTH(reversed), "above the upper" }, { hollow, LENGTH(hollow), "no real number" } };
  (void)state;
  for (size_t k = 0; k < LENGTH(table); k++)
    for (size_t i = 0; i < table[k].n; i++) {
      ambit_interval x;
      ambit_failure f = { 0 };
      const char *text = table[k].text[i];
      if (ambit_decimal_read(text, &x, NULL, &f) != AMBIT_INVALID)
        fail_msg("%s was read as [%a, %a]", text, x.lo, x.hi);
      if (!strstr(f.message, table[k].part)) fail_msg("%s: \"%s\" does not say \"%s\"", text, f.message, table[k].part);
    }
}

/* ---- random literals */

static size_t put_digits(char *text, uint64_t *s, int most) {
  size_t n = 1 + (size_t)random_below(s, most);
  for (size_t i = 0; i < n; i++) text[i] = (char)('0' + random_below(s, 10));
  text[n] = '\0';
  return n;
}

static double bound_of(const mpfr_t v, mpfr_rnd_t mode) { return mpfr_get_d(v, mode); }

/* p/q, an integer over an integer */
static void quotient(uint64_t *s) {
  char p[80], q[80], text[200];
  mpfr_t a, b;
  mpfr_inits2(PRECISION, a, b, (mpfr_ptr)0);
  put_digits(p, s, 60);
  do put_digits(q, s, 60);
  while (strspn(q, "0") == strlen(q));
  snprintf(text, sizeof text, "%s%s/%s", random_bits(s) & 1 ? "-" : "", p, q);
  double bound[2];
  for (int up = 0; up < 2; up++) {
    mpfr_set_str(a, p, 10, MPFR_RNDN);
    if (*text == '-') mpfr_neg(a, a, MPFR_RNDN);
    mpfr_set_str(b, q, 10, MPFR_RNDN);
    mpfr_div(a, a, b, up ? MPFR_RNDU : MPFR_RNDD);
    bound[up] = bound_of(a, up ? MPFR_RNDU : MPFR_RNDD);
  }
  expect(text, bound[0], bound[1]);
  mpfr_clears(a, b, (mpfr_ptr)0);
}

/* "m?re": integers of up to 40 digits, so that middle and radius are exact */
static void uncertain(uint64_t *s) {
  char m[80], r[80], text[300];
  size_t n = put_digits(m, s, 40), point = (size_t)random_below(s, (int)n);
  bool negative = random_bits(s) & 1, bare = random_below(s, 4) == 0;
  int exponent = random_below(s, 700) - 350, direction = random_below(s, 3);
  put_digits(r, s, 20);
  snprintf(text, sizeof text, "%s%.*s.%s?%s%se%d", negative ? "-" : "", (int)point, m, m + point, bare ? "" : r,
      direction == 0   ? ""
      : direction == 1 ? "u"
                       : "d",
      exponent);
  mpfr_t middle, radius, unit, v;
  mpfr_inits2(PRECISION, middle, radius, unit, v, (mpfr_ptr)0);
  double bound[2];
  for (int up = 0; up < 2; up++) {
    mpfr_rnd_t mode = up ? MPFR_RNDU : MPFR_RNDD;
    mpfr_set_str(middle, m, 10, MPFR_RNDN);
    if (negative) mpfr_neg(middle, middle, MPFR_RNDN);
    mpfr_set_d(radius, 0.5, MPFR_RNDN);
    if (!bare) mpfr_set_str(radius, r, 10, MPFR_RNDN);
    if (direction == (up ? 2 : 1)) mpfr_set_zero(radius, 1);
    if (up)
      mpfr_add(v, middle, radius, mode);
    else
      mpfr_sub(v, middle, radius, mode);
    int power = exponent - (int)(n - point);
    mpfr_ui_pow_ui(unit, 10, (unsigned long)abs(power), MPFR_RNDN); /* exact: 10^400 has fewer bits */
    if (power < 0)
      mpfr_div(v, v, unit, mode);
    else
      mpfr_mul(v, v, unit, mode);
    bound[up] = bound_of(v, mode);
  }
  expect(text, bound[0], bound[1]);
  mpfr_clears(middle, radius, unit, v, (mpfr_ptr)0);
}

static void random_literals(void **state) {
  uint64_t seed = 2463534242u;
  (void)state;
  for (int i = 0; i < 2000; i++) quotient(&seed), uncertain(&seed);
}

/* Damaged literals are read or refused; never a NaN, a reversed pair or a rest outside the text. */
static void damaged(void **state) {
  static const char *const whole[] = { "[1,2]", "[ -1/3 , 2.5e-3 ]", "3.56?2ue10", "-10??d", "[empty]", "[ entire ]",
    "0x1.8p-3", "[-inf, +infinity]", "12345678901234567890?12", "1/3", "pi", "[1,2]_com", "1e400" };
  static const char letters[] = "0123456789+-.,/?[]_eEpPxXuUdD infaty\t";
  uint64_t seed = 88172645463325252u;
  (void)state;
  for (int i = 0; i < 200000; i++) {
    char text[64];
    snprintf(text, sizeof text, "%s", whole[random_below(&seed, (int)LENGTH(whole))]);
    for (int k = random_below(&seed, 4); k >= 0; k--) {
      size_t n = strlen(text), at = (size_t)random_below(&seed, (int)n + 1);
      char letter = letters[random_below(&seed, (int)sizeof letters - 1)];
      switch (random_below(&seed, 3)) {
      case 0: text[at] = at < n ? letter : '\0'; break;
      case 1: memmove(text + at, text + at + (at < n), n - at + (at == n)); break;
      default:
        if (n + 1 < sizeof text) memmove(text + at + 1, text + at, n - at + 1), text[at] = letter;
      }
    }
    ambit_interval x = { NAN, NAN };
    ambit_failure f = { 0 };
    const char *rest = NULL;
    ambit_status status = ambit_decimal_read(text, &x, &rest, &f);
    if (status == AMBIT_OK) {
      bool proper = x.lo <= x.hi && x.lo < INFINITY && x.hi > -INFINITY;
      bool empty = x.lo == INFINITY && x.hi == -INFINITY;
      if (!proper && !empty) fail_msg("\"%s\" was read as [%a, %a]", text, x.lo, x.hi);
      assert_true(rest > text && rest <= text + strlen(text));
    } else {
      assert_int_equal(status, AMBIT_INVALID);
      assert_non_null(strstr(f.message, text));
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(grammar), cmocka_unit_test(refusals),
    cmocka_unit_test(random_literals), cmocka_unit_test(damaged) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
