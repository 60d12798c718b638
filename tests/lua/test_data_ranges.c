/* Random data around and between expressions whose digits cancel, against exact rationals: the outer range holds the
** true one, the inner range, samples and counterexamples are inside, and verdicts are true. `test.lua.data_ranges
** 100000` runs at full length.
*/
#include <gmp.h>
#include <lauxlib.h>
#include <lua.h>
#include <lualib.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define SHORT 6000
#define VERIFY_EACH 50 /* a verdict costs as much as many samples */
#define TEXT_MAX 4096
#define DEPTH 3

static long tries = SHORT;

/* ---- random numbers and expressions: Lua text and the exact value */

static uint64_t state = 0x9e3779b97f4a7c15u;

static uint32_t draw(uint32_t n) { /* below n; xorshift64* (Vigna 2016) */
  state ^= state >> 12;
  state ^= state << 25;
  state ^= state >> 27;
  return (uint32_t)((state * 0x2545f4914f6cdd1du) >> 33) % n;
}

typedef struct text {
  char s[TEXT_MAX];
  size_t n;
} text;

static void put(text *t, const char *format, ...) {
  va_list list;
  va_start(list, format);
  int more = vsnprintf(t->s + t->n, TEXT_MAX - t->n, format, list);
  va_end(list);
  assert_true(more >= 0 && t->n + (size_t)more < TEXT_MAX);
  t->n += (size_t)more;
}

static void power_of_ten(mpz_t x, unsigned long n) { mpz_ui_pow_ui(x, 10, n); }

/* "-123.456": an integer over 10^places */
static void put_decimal(text *t, const mpz_t digits, unsigned places) {
  char *all = mpz_get_str(NULL, 10, digits);
  put(t, "%se-%u", all, places);
  free(all);
}

static void literal(text *t, mpq_t x) {
  mpz_t digits;
  unsigned places = draw(16), n = 1 + draw(14);
  mpz_init(digits);
  for (unsigned i = 0; i < n; i++) {
    mpz_mul_ui(digits, digits, 10);
    mpz_add_ui(digits, digits, i ? draw(10) : 1 + draw(9));
  }
  mpq_set_z(x, digits);
  switch (draw(4)) {
  case 0: { /* a quotient */
    unsigned long q = 1 + draw(99);
    put(t, "N\"%lu/%lu\"", mpz_fdiv_ui(digits, 1000), q);
    mpq_set_ui(x, mpz_fdiv_ui(digits, 1000), q);
    mpq_canonicalize(x);
    break;
  }
  case 1: /* a double */
    places = draw(2000);
    put(t, "N(%u)", places);
    mpq_set_ui(x, places, 1);
    break;
  default: {
    mpz_t ten;
    mpz_init(ten);
    power_of_ten(ten, places);
    put(t, "N\"");
    put_decimal(t, digits, places);
    put(t, "\"");
    mpq_set_den(x, ten);
    mpq_canonicalize(x);
    mpz_clear(ten);
  }
  }
  mpz_clear(digits);
}

/* Minus a decimal that has the first `places` digits of x: most of them cancel. */
static void cancel(text *t, mpq_t x, unsigned places) {
  mpz_t ten, digits;
  mpq_t y;
  mpz_inits(ten, digits, NULL);
  mpq_init(y);
  power_of_ten(ten, places);
  mpz_mul(digits, mpq_numref(x), ten);
  mpz_tdiv_q(digits, digits, mpq_denref(x));
  put(t, " - N\"");
  put_decimal(t, digits, places);
  put(t, "\"");
  mpq_set_num(y, digits);
  mpq_set_den(y, ten);
  mpq_canonicalize(y);
  mpq_sub(x, x, y);
  mpq_clear(y);
  mpz_clears(ten, digits, NULL);
}

static void expression(text *t, mpq_t x, int depth) {
  if (depth == 0 || draw(5) == 0) {
    literal(t, x);
    return;
  }
  static const char sign[] = "+-*/";
  mpq_t y;
  mpq_init(y);
  uint32_t op = draw(4);
  put(t, "(");
  expression(t, x, depth - 1);
  text second = { .n = 0 };
  expression(&second, y, depth - 1);
  if (op == 3 && mpq_sgn(y) == 0) op = 0;
  put(t, " %c %s", sign[op], second.s);
  if (op == 0) mpq_add(x, x, y);
  if (op == 1) mpq_sub(x, x, y);
  if (op == 2) mpq_mul(x, x, y);
  if (op == 3) mpq_div(x, x, y);
  if (draw(2)) cancel(t, x, draw(30));
  put(t, ")");
  mpq_clear(y);
}

/* A small positive number as text and value, often below the doubles' spacing. */
static void small(text *t, mpq_t x) {
  mpz_t digits;
  mpz_init_set_ui(digits, 1 + draw(99999));
  unsigned places = 4 + draw(20);
  put_decimal(t, digits, places);
  mpz_t ten;
  mpz_init(ten);
  power_of_ten(ten, places);
  mpq_set_num(x, digits);
  mpq_set_den(x, ten);
  mpq_canonicalize(x);
  mpz_clears(digits, ten, NULL);
}

/* A datum, and the exact ends of its range. */
static void datum(text *t, mpq_t lo, mpq_t hi) {
  mpq_t x, r;
  mpq_inits(x, r, NULL);
  text centre = { .n = 0 }, size = { .n = 0 };
  expression(&centre, x, DEPTH);
  small(&size, r);
  uint32_t kind = draw(3);
  if (kind == 0) {
    put(t, "around(%s, \"%s\")", centre.s, size.s);
  } else if (kind == 1) { /* r % of |x| */
    put(t, "around(%s, \"%s%%\")", centre.s, size.s);
    mpq_t percent;
    mpq_init(percent);
    mpq_set_ui(percent, 1, 100);
    mpq_mul(r, r, percent);
    mpq_abs(percent, x);
    mpq_mul(r, r, percent);
    mpq_clear(percent);
  } else {
    put(t, "between(%s, %s + N\"%s\")", centre.s, centre.s, size.s);
  }
  mpq_add(hi, x, r);
  if (kind == 2)
    mpq_set(lo, x);
  else
    mpq_sub(lo, x, r);
  mpq_clears(x, r, NULL);
}

/* ---- what Ambit says of it */

static const char chunk[] =
    "local ambit, core = require 'ambit', require 'ambit.core'\n"
    "local still = ambit.ode { states = { 'x' }, equations = function(s) return { x = 0 * s.x } end }\n"
    "local head = 'local N, around, between = ... return '\n"
    "return function(text, limit)\n"
    "  local e = load(head .. text)(ambit.number, ambit.around, ambit.between)\n"
    "  local leaf = core.leaves { e }[1]\n"
    "  if not leaf then return end\n"
    "  local drawn, verdict = ambit.sample { e, n = 8, points = 'random' }, nil\n"
    "  local x = drawn\n"
    "  if limit then\n"
    "    local r = ambit.verify { still, initial = { e }, t = { 0, 1 }, budget = 4,\n"
    "      safe = function(s) return s.x - load(head .. limit)(ambit.number) end }\n"
    "    verdict = r.status\n"
    "    x = r.counterexample and r.counterexample.initial.x or x\n"
    "  end\n"
    "  return leaf.lo, leaf.hi, leaf.inner_lo, leaf.inner_hi, drawn.lo, drawn.hi, x.lo, x.hi, verdict\n"
    "end\n";

typedef struct answer {
  double lo, hi, inner_lo, inner_hi, drawn_lo, drawn_hi, example_lo, example_hi;
  const char *verdict;
} answer;

static lua_State *open_lua(void) {
  lua_State *L = luaL_newstate();
  assert_non_null(L);
  luaL_openlibs(L);
  if (luaL_dostring(L, chunk)) fail_msg("%s", lua_tostring(L, -1));
  return L;
}

/* false: no tolerance is left, so the datum is a number */
static bool ask(lua_State *L, const char *source, const char *limit, answer *a) {
  lua_settop(L, 1);
  lua_pushvalue(L, 1);
  lua_pushstring(L, source);
  lua_pushstring(L, limit);
  if (lua_pcall(L, 2, 9, 0)) fail_msg("%s: %s", source, lua_tostring(L, -1));
  if (lua_isnil(L, 2)) return false;
  double *to[] = { &a->lo, &a->hi, &a->inner_lo, &a->inner_hi, &a->drawn_lo, &a->drawn_hi, &a->example_lo,
    &a->example_hi };
  for (int i = 0; i < 8; i++) *to[i] = lua_tonumber(L, i + 2);
  a->verdict = lua_tostring(L, 10);
  return true;
}

/* ---- comparison */

static int against(double x, const mpq_t y) { /* sign of x - y */
  mpq_t q;
  mpq_init(q);
  mpq_set_d(q, x);
  int order = mpq_cmp(q, y);
  mpq_clear(q);
  return order;
}

typedef struct tally {
  long data, empty, samples, refuted, proved;
  double widest; /* gap between the ranges, per magnitude */
} tally;

static void within(const char *what, const char *source, double a, double b, const mpq_t lo, const mpq_t hi) {
  if (against(a, lo) < 0 || against(b, hi) > 0) fail_msg("%s: %s [%a, %a] is outside", source, what, a, b);
}

static void check(const char *source, const answer *a, const mpq_t lo, const mpq_t hi, const mpq_t limit, tally *n) {
  if (against(a->lo, lo) > 0 || against(a->hi, hi) < 0)
    fail_msg("%s: the outer range [%a, %a] misses values", source, a->lo, a->hi);
  n->data++;
  if (a->inner_lo > a->inner_hi) {
    n->empty++;
  } else {
    within("the inner range", source, a->inner_lo, a->inner_hi, lo, hi);
    within("a sample", source, a->drawn_lo, a->drawn_hi, lo, hi);
    if (a->verdict) within("a counterexample", source, a->example_lo, a->example_hi, lo, hi);
    n->samples++;
    double size = fmax(fabs(a->lo), fabs(a->hi)), gap = fmax(a->inner_lo - a->lo, a->hi - a->inner_hi);
    n->widest = fmax(n->widest, gap / size);
  }
  if (a->verdict && strcmp(a->verdict, "proved") == 0) {
    n->proved++;
    if (mpq_cmp(hi, limit) > 0) fail_msg("%s: a false condition was proved", source);
  }
  if (a->verdict && strcmp(a->verdict, "refuted") == 0) {
    n->refuted++;
    if (mpq_cmp(hi, limit) <= 0) fail_msg("%s: a true condition was refuted", source);
  }
}

/* A limit near the upper end, inside or outside of the range: x <= it is what verify is asked. */
static void draw_limit(text *t, mpq_t limit, const mpq_t hi) {
  mpz_t ten;
  text unused = { .n = 0 };
  mpq_set(limit, hi);
  cancel(&unused, limit, 18 + draw(12)); /* limit = hi - a decimal next to it */
  mpq_sub(limit, hi, limit);
  mpz_init(ten);
  power_of_ten(ten, 30);
  mpz_t digits;
  mpz_init(digits);
  mpz_mul(digits, mpq_numref(limit), ten);
  mpz_tdiv_q(digits, digits, mpq_denref(limit));
  mpz_add_ui(digits, digits, draw(3)); /* exactly that decimal, or a little above */
  put(t, "N\"");
  put_decimal(t, digits, 30);
  put(t, "\"");
  mpq_set_num(limit, digits);
  mpq_set_den(limit, ten);
  mpq_canonicalize(limit);
  mpz_clears(ten, digits, NULL);
}

static void test_random_data(void **unused) {
  (void)unused;
  lua_State *L = open_lua();
  tally n = { 0 };
  mpq_t lo, hi, limit;
  mpq_inits(lo, hi, limit, NULL);
  for (long i = 0; i < tries; i++) {
    text source = { .n = 0 }, bound = { .n = 0 };
    answer a;
    datum(&source, lo, hi);
    bool verify = i % VERIFY_EACH == 0;
    if (verify) draw_limit(&bound, limit, hi);
    if (ask(L, source.s, verify ? bound.s : NULL, &a)) check(source.s, &a, lo, hi, limit, &n);
  }
  mpq_clears(lo, hi, limit, NULL);
  lua_close(L);
  print_message("%ld tries: %ld data, %ld of them with an empty inner range, %ld samples, %ld refuted, %ld proved; the "
                "ranges are at most %.2g of the magnitude apart\n",
      tries, n.data, n.empty, n.samples, n.refuted, n.proved, n.widest);
  assert_true(n.data > 9 * tries / 10 && n.samples > n.data / 2);
  assert_true(n.refuted > 0 && n.proved > 0);
  assert_true(n.widest <= 0x1p-46);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(test_random_data) };
  if (argc > 1) tries = strtol(argv[1], NULL, 10);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
