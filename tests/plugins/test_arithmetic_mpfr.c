/* The mpfr plugin: conformance at several precisions; operations against MPFR at points of random sets, at the full
** precision; special sets; texts; limits. */
#include "arithmetic_case.h"
#include "arithmetic/mpfr/sets.h"
#include <string.h>

static void kit_at_precision(const char *text, bool isotonic) {
  arithmetic_loader l;
  size_t fallbacks = 0;
  case_load(&l, "mpfr");
  const ambit_option option = { "precision", text };
  arithmetic_kit kit = { .plugin = l.plugin,
    .full = &l.full,
    .host = &l.scope->host,
    .isotonic = isotonic,
    .seed = 99,
    .noption = 1,
    .option = &option,
    .oracle = case_oracle,
    .finding = case_finding,
    .fallback = case_fallback,
    .user = &fallbacks,
    .effort = 0.3 };
  assert_int_equal(l.plugin->rigorous, 1);
  assert_int_equal(arithmetic_kit_run(&kit), 0);
  assert_int_equal(fallbacks, 0);
  arithmetic_unload(&l);
}

static void passes_the_kit(void **state) {
  (void)state;
  kit_at_precision("128", true);
  kit_at_precision("2", true);
  kit_at_precision("53", true);
  kit_at_precision("700", true);
}

/* -- one operation, with the result as MPFR numbers */

typedef struct bench {
  arithmetic_loader l;
  void *ctx;
  char *block;
  size_t elem;
} bench;

static bench open_at(double precision) {
  bench b;
  case_load(&b.l, "mpfr");
  assert_int_equal(b.l.plugin->open(&b.l.scope->host, &precision, 0, &b.ctx), AMBIT_OK);
  b.elem = b.l.full.elem(b.ctx);
  b.block = calloc(3, b.elem);
  return b;
}

static void close_bench(bench *b) {
  b->l.plugin->close(b->ctx);
  arithmetic_unload(&b->l);
  free(b->block);
}

static set result_of(bench *b) {
  const context *c = b->ctx;
  set x;
  mpfr_ptr bound[2] = { x.lo, x.hi };
  for (int i = 0; i < 2; i++) {
    half *h = (half *)(void *)(b->block + 2 * b->elem + (size_t)i * c->half);
    mpfr_custom_init_set(bound[i], (int)h->kind, (mpfr_exp_t)h->exponent, c->precision, h->digits);
  }
  return x;
}

static uint32_t apply(bench *b, uint32_t op, int32_t n, const double x[2], const double y[2]) {
  const uint32_t dst = 2, first = 0, second = op == AMBIT_OP_POWN ? (uint32_t)n : 1;
  b->l.full.set(b->ctx, b->block, 1, &x[0], &x[1], -1);
  b->l.full.set(b->ctx, b->block + b->elem, 1, &y[0], &y[1], -1);
  b->l.full.enter(b->ctx);
  uint32_t flags = b->l.full.run[op](&b->l.full, b->ctx, b->block, 1, 1, 1, &dst, &first, &second);
  b->l.full.leave(b->ctx);
  return flags;
}

/* -- inclusion of points, at 400 bits, for results of 128 */

static void value_at(uint32_t op, int32_t n, mpfr_t r, mpfr_t x, mpfr_t y) {
  switch (op) {
  case AMBIT_OP_SIN: mpfr_sin(r, x, MPFR_RNDN); break;
  case AMBIT_OP_COS: mpfr_cos(r, x, MPFR_RNDN); break;
  case AMBIT_OP_TAN: mpfr_tan(r, x, MPFR_RNDN); break;
  case AMBIT_OP_ATAN2: mpfr_atan2(r, x, y, MPFR_RNDN); break;
  case AMBIT_OP_POWN: mpfr_pow_si(r, x, n, MPFR_RNDN); break;
  case AMBIT_OP_MUL: mpfr_mul(r, x, y, MPFR_RNDN); break;
  default: mpfr_div(r, x, y, MPFR_RNDN); break;
  }
}

static void random_set(uint64_t *state, double x[2]) {
  double a = oracle_double(state), w = oracle_uniform(state, 0, oracle_random(state) % 2 ? 0.5 : 8);
  if (oracle_random(state) % 4 == 0) a = oracle_uniform(state, -1e6, 1e6);
  if (oracle_random(state) % 8 == 0) a = 0;
  x[0] = a - w, x[1] = a + w;
  if (oracle_random(state) % 8 == 0) x[0] = 0, x[1] = fabs(a);
  if (oracle_random(state) % 8 == 0) x[0] = -fabs(a), x[1] = 0;
  if (oracle_random(state) % 8 == 0) x[1] = x[0];
}

static void contains_its_points(void **unused) {
  (void)unused;
  static const uint32_t ops[] = { AMBIT_OP_SIN, AMBIT_OP_COS, AMBIT_OP_TAN, AMBIT_OP_ATAN2, AMBIT_OP_POWN, AMBIT_OP_MUL,
    AMBIT_OP_DIV };
  uint64_t state = 17;
  bench b = open_at(128);
  mpfr_t x, y, r;
  mpfr_set_emin(mpfr_get_emin_min()), mpfr_set_emax(mpfr_get_emax_max());
  mpfr_inits2(400, x, y, r, (mpfr_ptr)NULL);
  for (int i = 0; i < 20000; i++) {
    uint32_t op = ops[oracle_random(&state) % 7];
    int32_t n = (int32_t)(oracle_random(&state) % 31) - 15;
    double box[2][2];
    random_set(&state, box[0]), random_set(&state, box[1]);
    uint32_t flags = apply(&b, op, n, box[0], box[1]);
    set z = result_of(&b);
    for (int k = 0; k < 4; k++) {
      mpfr_set_d(x, k & 1 ? box[0][0] : oracle_uniform(&state, box[0][0], box[0][1]), MPFR_RNDN);
      mpfr_set_d(y, k & 2 ? box[1][1] : oracle_uniform(&state, box[1][0], box[1][1]), MPFR_RNDN);
      if (mpfr_zero_p(x)) mpfr_set_zero(x, 1);
      value_at(op, n, r, x, y);
      bool outside = !mpfr_number_p(r) || (op == AMBIT_OP_ATAN2 && mpfr_zero_p(x) && mpfr_zero_p(y));
      if (outside ? !(flags & AMBIT_F_PARTIAL) : !(mpfr_cmp(z.lo, r) <= 0 && mpfr_cmp(r, z.hi) <= 0))
        fail_msg("op %u, n = %d over [%a, %a], [%a, %a] misses a point, flags %u", op, n, box[0][0], box[0][1],
            box[1][0], box[1][1], flags);
    }
  }
  mpfr_clears(x, y, r, (mpfr_ptr)NULL);
  close_bench(&b);
}

/* -- sin, cos and tan: extrema and poles at any size; the true range by the number of quarters passed */

static long quarter_of(double x, int shift) { /* floor(x / (pi/2)) + shift, at 2000 bits */
  mpfr_t q, p;
  mpfr_inits2(2000, q, p, (mpfr_ptr)NULL);
  mpfr_const_pi(p, MPFR_RNDN);
  mpfr_mul_d(q, p, 0.5, MPFR_RNDN);
  mpfr_d_div(q, x, q, MPFR_RNDN);
  mpfr_floor(q, q);
  mpfr_fmod_ui(p, q, 4, MPFR_RNDN);
  long r = (mpfr_get_si(p, MPFR_RNDN) + 8 + shift) % 4;
  mpfr_clears(q, p, (mpfr_ptr)NULL);
  return r;
}

/* does [x, x + w], w < pi/2, pass a multiple of pi/2 that is `shift` quarters after one of 2 pi? */
static bool passes(const double x[2], long shift) {
  long before = quarter_of(x[0], 0), after = quarter_of(x[1], 0);
  return before != after && after == shift;
}

static void counts_extrema(void **unused) {
  (void)unused;
  uint64_t state = 5;
  bench b = open_at(60);
  for (int i = 0; i < 4000; i++) {
    double scale = ldexp(1, (int)(oracle_random(&state) % 50)), x[2];
    if (i % 8 == 0) scale = ldexp(1, (int)(oracle_random(&state) % 1000));
    x[0] = oracle_uniform(&state, -scale, scale), x[1] = x[0] + oracle_uniform(&state, 0, 1.5);
    if (x[1] - x[0] > 1.55) continue;
    apply(&b, AMBIT_OP_SIN, 0, x, x);
    set z = result_of(&b);
    assert_int_equal(mpfr_cmp_si(z.hi, 1) == 0, passes(x, 1));
    assert_int_equal(mpfr_cmp_si(z.lo, -1) == 0, passes(x, 3));
    apply(&b, AMBIT_OP_COS, 0, x, x);
    z = result_of(&b);
    assert_int_equal(mpfr_cmp_si(z.hi, 1) == 0, passes(x, 0));
    assert_int_equal(mpfr_cmp_si(z.lo, -1) == 0, passes(x, 2));
    uint32_t flags = apply(&b, AMBIT_OP_TAN, 0, x, x);
    assert_int_equal((flags & AMBIT_F_PARTIAL) != 0, passes(x, 1) || passes(x, 3));
  }
  close_bench(&b);
}

/* -- special sets */

static void expect(
    uint32_t op, int32_t n, double x0, double x1, double y0, double y1, double lo, double hi, uint32_t flags) {
  bench b = open_at(53);
  const double x[2] = { x0, x1 }, y[2] = { y0, y1 };
  double rlo, rhi;
  uint32_t raised = apply(&b, op, n, x, y);
  b.l.full.bounds(b.ctx, b.block + 2 * b.elem, 1, &rlo, &rhi);
  if (rlo != lo || rhi != hi || raised != flags)
    fail_msg("op %u, n = %d over [%a, %a], [%a, %a]: [%a, %a] flags %u, expected [%a, %a] flags %u", op, n, x0, x1, y0,
        y1, rlo, rhi, raised, lo, hi, flags);
  close_bench(&b);
}

static void special_sets(void **state) {
  (void)state;
  const uint32_t P = AMBIT_F_PARTIAL, U = AMBIT_F_UNBOUNDED, E = AMBIT_F_EMPTY;
  const double inf = INFINITY, pi = 0x1.921fb54442d18p+1, above_pi = 0x1.921fb54442d19p+1;
  expect(AMBIT_OP_ADD, 0, inf, -inf, -inf, inf, inf, -inf, E);
  expect(AMBIT_OP_SUB, 0, 1, inf, 1, inf, -inf, inf, U);
  expect(AMBIT_OP_MUL, 0, 0, 0, -inf, inf, 0, 0, 0);
  expect(AMBIT_OP_MUL, 0, -inf, 0, 0, inf, -inf, 0, U);
  expect(AMBIT_OP_MUL, 0, -2, 3, -5, 7, -15, 21, 0);
  expect(AMBIT_OP_DIV, 0, 1, 1, 0, 0, inf, -inf, P | E);
  expect(AMBIT_OP_DIV, 0, 1, 2, 0, 4, 0.25, inf, P | U);
  expect(AMBIT_OP_DIV, 0, -2, -1, -4, 0, 0.25, inf, P | U);
  expect(AMBIT_OP_DIV, 0, -2, 1, 0, 4, -inf, inf, P | U);
  expect(AMBIT_OP_DIV, 0, 0, 0, -1, 1, 0, 0, P);
  expect(AMBIT_OP_DIV, 0, 1, inf, 2, inf, 0, inf, U);
  expect(AMBIT_OP_DIV, 0, 1, 2, -1, 1, -inf, inf, P | U);
  expect(AMBIT_OP_SQRT, 0, -4, 9, 0, 0, 0, 3, P);
  expect(AMBIT_OP_SQRT, 0, -4, -1, 0, 0, inf, -inf, P | E);
  expect(AMBIT_OP_LOG, 0, 0, 1, 0, 0, -inf, 0, P | U);
  expect(AMBIT_OP_LOG, 0, -1, 0, 0, 0, inf, -inf, P | E);
  expect(AMBIT_OP_EXP, 0, -inf, 0, 0, 0, 0, 1, 0);
  expect(AMBIT_OP_EXP, 0, 1000, 1000, 0, 0, DBL_MAX, inf, U); /* beyond every double, and sound */
  expect(AMBIT_OP_EXP, 0, -1000, -1000, 0, 0, 0, 0x1p-1074, 0);
  expect(AMBIT_OP_ASIN, 0, 2, 3, 0, 0, inf, -inf, P | E);
  expect(AMBIT_OP_COSH, 0, -inf, 0, 0, 0, 1, inf, U);
  expect(AMBIT_OP_SIN, 0, -inf, inf, 0, 0, -1, 1, 0);
  expect(AMBIT_OP_TAN, 0, 1, inf, 0, 0, -inf, inf, P | U);
  expect(AMBIT_OP_ATAN2, 0, 0, 0, 0, 0, inf, -inf, P | E);
  expect(AMBIT_OP_ATAN2, 0, 0, 0, -2, -1, pi, above_pi, 0);
  expect(AMBIT_OP_ATAN2, 0, -1, 0, -2, -1, -above_pi, above_pi, 0);
  expect(AMBIT_OP_ATAN2, 0, -0.0, 0, 1, inf, 0, 0, 0);
  expect(AMBIT_OP_ATAN2, 0, 0, 1, -1, 0, pi / 2, above_pi, P);
  expect(AMBIT_OP_ATAN2, 0, 0, 0, -1, 1, 0, above_pi, P);
  expect(AMBIT_OP_ATAN2, 0, 1, inf, 1, inf, 0, 0x1.921fb54442d19p+0, 0);
  expect(AMBIT_OP_POWN, -3, -2, -1, 0, 0, -1, -0.125, 0);
  expect(AMBIT_OP_POWN, -2, 0, 2, 0, 0, 0.25, inf, P | U);
  expect(AMBIT_OP_POWN, -3, -2, 0, 0, 0, -inf, -0.125, P | U);
  expect(AMBIT_OP_POWN, -1, -1, 1, 0, 0, -inf, inf, P | U);
  expect(AMBIT_OP_POWN, -1, 0, 0, 0, 0, inf, -inf, P | E);
  expect(AMBIT_OP_POWN, 0, -inf, inf, 0, 0, 1, 1, 0);
  expect(AMBIT_OP_POWN, 4, -3, 2, 0, 0, 0, 81, 0);
  expect(AMBIT_OP_POWN, 3, -inf, 2, 0, 0, -inf, 8, U);
  expect(AMBIT_OP_POWN, INT32_MAX, -1, 1, 0, 0, -1, 1, 0);
  expect(AMBIT_OP_POWN, INT32_MIN, -1, -1, 0, 0, 1, 1, 0);
  expect(AMBIT_OP_POWN, INT32_MIN, 2, 2, 0, 0, 0, 0x1p-1074, 0);
}

/* 2^(2^30) needs 2^30 bits of pi: nothing is said about its angle, and fast. */
static void gives_up_on_gigantic_angles(void **state) {
  (void)state;
  bench b = open_at(64);
  const double two[2] = { 2, 2 };
  const uint32_t power = 1u << 30, base = 0, point = 1, result = 2;
  apply(&b, AMBIT_OP_EXP, 0, two, two);
  b.l.full.enter(b.ctx);
  b.l.full.run[AMBIT_OP_POWN](&b.l.full, b.ctx, b.block, 1, 1, 1, &point, &base, &power);
  b.l.full.run[AMBIT_OP_SIN](&b.l.full, b.ctx, b.block, 1, 1, 1, &result, &point, &point);
  set z = result_of(&b);
  assert_true(mpfr_cmp_si(z.lo, -1) == 0 && mpfr_cmp_si(z.hi, 1) == 0);
  uint32_t flags = b.l.full.run[AMBIT_OP_TAN](&b.l.full, b.ctx, b.block, 1, 1, 1, &result, &point, &point);
  b.l.full.leave(b.ctx);
  assert_int_equal(flags, AMBIT_F_PARTIAL | AMBIT_F_UNBOUNDED);
  close_bench(&b);
}

/* -- texts */

static bool text_is(bench *b, const char *text, const char *lo, const char *hi) {
  mpfr_t x, y;
  if (!b->l.full.set_text(b->ctx, b->block + 2 * b->elem, text)) return false;
  set z = result_of(b);
  mpfr_inits2(mpfr_get_prec(z.lo), x, y, (mpfr_ptr)NULL);
  mpfr_set_str(x, lo, 10, MPFR_RNDD), mpfr_set_str(y, hi, 10, MPFR_RNDU);
  bool same = mpfr_equal_p(x, z.lo) && mpfr_equal_p(y, z.hi);
  mpfr_clears(x, y, (mpfr_ptr)NULL);
  return same;
}

static void reads_texts(void **state) {
  (void)state;
  bench b = open_at(200);
  static const char *const pi = "3.1415926535897932384626433832795028841971693993751058209749445923078164062862089986";
  assert_true(text_is(&b, "0.1", "0.1", "0.1"));
  assert_true(text_is(&b, "-2.5e-3", "-2.5e-3", "-2.5e-3"));
  assert_true(text_is(&b, ".75", "0.75", "0.75"));
  assert_true(text_is(&b, "0x1.8p-3", "0.1875", "0.1875"));
  assert_true(
      text_is(&b, "0xA/0x3", "3.3333333333333333333333333333333333333333333333333333333333333333333333333333333",
          "3.3333333333333333333333333333333333333333333333333333333333333333333333333333334"));
  assert_true(text_is(&b, "1/4", "0.25", "0.25"));
  assert_true(text_is(&b, "pi", pi, pi));
  assert_true(text_is(&b, "1e-400", "1e-400", "1e-400"));
  assert_true(text_is(&b, "9007199254740993", "9007199254740993", "9007199254740993"));
  static const char *const bad[] = { "", "x", "1/0", "1/", "1/2/3", "1 2", "nan", "inf", "[1, 2]", "3.5?1", "1e5m" };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
    if (b.l.full.set_text(b.ctx, b.block, bad[i])) fail_msg("\"%s\" is taken for a number", bad[i]);
  close_bench(&b);
}

/* -- limits, and what is put back */

static void refuses_precisions(void **state) {
  (void)state;
  static const double bad[] = { 1, 0, -128, 1000001, 1e18, NAN, INFINITY };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    arithmetic_loader l;
    void *ctx;
    case_load(&l, "mpfr");
    assert_int_equal(l.plugin->open(&l.scope->host, &bad[i], 0, &ctx), AMBIT_INVALID);
    assert_non_null(strstr(l.scope->failure.message, "expected 2 to 1000000"));
    arithmetic_unload(&l);
  }
}

static void refuses_more_than_memory(void **state) {
  (void)state;
  bench b = open_at(1e6);
  const double zero = 0;
  const uint32_t nothing = 0;
  const ambit_tape tape = {
    .size = sizeof tape, .nslot = 1, .nconst = 1, .nout = 1, .lo = &zero, .hi = &zero, .out = &nothing
  };
  ambit_block *block;
  ambit_failure f = { 0 };
  assert_int_not_equal(ambit_block_open(&tape, &b.l.full, b.ctx, (size_t)1 << 40, &block, &f), AMBIT_OK);
  assert_non_null(strstr(f.message, "bytes need 2.75e+17 bytes"));
  close_bench(&b);
}

static void uses_its_own_range_and_puts_the_other_back(void **state) {
  (void)state;
  bench b = open_at(100);
  const double x[2] = { 1, 2 }, small[2] = { 1e-200, 1e-200 };
  double lo, hi;
  mpfr_set_emin(-500), mpfr_set_emax(500);
  mpfr_clear_flags();
  apply(&b, AMBIT_OP_EXP, 0, x, x);
  b.l.full.bounds(b.ctx, b.block, 1, &lo, &hi);
  b.l.full.set_text(b.ctx, b.block, "0.1");
  apply(&b, AMBIT_OP_MUL, 0, small, small);
  assert_true(mpfr_cmp_d(result_of(&b).hi, 1e-300) < 0);
  assert_int_equal(mpfr_get_emin(), -500);
  assert_int_equal(mpfr_get_emax(), 500);
  assert_int_equal(mpfr_flags_save(), 0);
  mpfr_set_emin(mpfr_get_emin_min()), mpfr_set_emax(mpfr_get_emax_max());
  close_bench(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(contains_its_points),
    cmocka_unit_test(counts_extrema),
    cmocka_unit_test(special_sets),
    cmocka_unit_test(gives_up_on_gigantic_angles),
    cmocka_unit_test(reads_texts),
    cmocka_unit_test(refuses_precisions),
    cmocka_unit_test(refuses_more_than_memory),
    cmocka_unit_test(uses_its_own_range_and_puts_the_other_back),
    cmocka_unit_test(passes_the_kit),
  };
  return cmocka_run_group_tests_name("arithmetic mpfr", tests, NULL, NULL);
}
