/* The gradient plugin: conformance; derivatives and slopes of every operation against MPFR; what is given up. */
#include "arithmetic_case.h"
#include "arithmetic/gradient/gradient.h"
#include <string.h>

#define BITS 300

static const char *const name[] = {
#define NAME(op, arity, symbol) #op,
  AMBIT_OPS(NAME)
#undef NAME
};
static const int arity[] = {
#define ARITY(op, n, symbol) n,
  AMBIT_OPS(ARITY)
#undef ARITY
};

enum { VARIABLES = 2, SLOTS = 3, DOUBLES = sizeof(element) / 8 + 16 };

typedef struct bench { /* variables 0 and 1 in slots 0 and 1, a result in slot 2 */
  arithmetic_loader l;
  void *ctx;
  double block[SLOTS * DOUBLES];
} bench;

static bench *open_as(const char *interface_id) {
  bench *b = calloc(1, sizeof *b);
  const char *problem = arithmetic_load_as(&b->l, "gradient", interface_id);
  if (problem) fail_msg("%s", problem);
  assert_int_equal(b->l.plugin->open(&b->l.scope->host, NULL, VARIABLES, &b->ctx), AMBIT_OK);
  assert_int_equal(b->l.full.elem(b->ctx), DOUBLES * 8);
  return b;
}

static void close_bench(bench *b) {
  arithmetic_unload(&b->l);
  free(b);
}

static element *slot(bench *b, int i) { return (element *)(void *)(b->block + i * DOUBLES); }

static uint32_t apply(bench *b, uint32_t op, int32_t n, const double x[2], const double y[2]) {
  const uint32_t dst = 2, first = 0, second = op == AMBIT_OP_POWN ? (uint32_t)n : arity[op] == 2;
  b->l.full.set(b->ctx, slot(b, 0), 1, &x[0], &x[1], 0);
  b->l.full.set(b->ctx, slot(b, 1), 1, &y[0], &y[1], 1);
  b->l.full.enter(b->ctx);
  uint32_t flags = b->l.full.run[op](&b->l.full, b->ctx, b->block, 1, 1, 1, &dst, &first, &second);
  b->l.full.leave(b->ctx);
  return flags;
}

/* -- MPFR: the operation and its derivatives in closed form */

static void value_at(uint32_t op, int32_t n, mpfr_t r, mpfr_t x, mpfr_t y) {
  switch (op) {
  case AMBIT_OP_ADD: mpfr_add(r, x, y, MPFR_RNDN); break;
  case AMBIT_OP_SUB: mpfr_sub(r, x, y, MPFR_RNDN); break;
  case AMBIT_OP_NEG: mpfr_neg(r, x, MPFR_RNDN); break;
  case AMBIT_OP_MUL: mpfr_mul(r, x, y, MPFR_RNDN); break;
  case AMBIT_OP_SQR: mpfr_sqr(r, x, MPFR_RNDN); break;
  case AMBIT_OP_POWN: mpfr_pow_si(r, x, n, MPFR_RNDN); break;
  case AMBIT_OP_DIV: mpfr_div(r, x, y, MPFR_RNDN); break;
  case AMBIT_OP_SQRT: mpfr_sqrt(r, x, MPFR_RNDN); break;
  case AMBIT_OP_EXP: mpfr_exp(r, x, MPFR_RNDN); break;
  case AMBIT_OP_LOG: mpfr_log(r, x, MPFR_RNDN); break;
  case AMBIT_OP_SIN: mpfr_sin(r, x, MPFR_RNDN); break;
  case AMBIT_OP_COS: mpfr_cos(r, x, MPFR_RNDN); break;
  case AMBIT_OP_TAN: mpfr_tan(r, x, MPFR_RNDN); break;
  case AMBIT_OP_ASIN: mpfr_asin(r, x, MPFR_RNDN); break;
  case AMBIT_OP_ACOS: mpfr_acos(r, x, MPFR_RNDN); break;
  case AMBIT_OP_ATAN: mpfr_atan(r, x, MPFR_RNDN); break;
  case AMBIT_OP_ATAN2: mpfr_atan2(r, x, y, MPFR_RNDN); break;
  case AMBIT_OP_SINH: mpfr_sinh(r, x, MPFR_RNDN); break;
  case AMBIT_OP_COSH: mpfr_cosh(r, x, MPFR_RNDN); break;
  case AMBIT_OP_TANH: mpfr_tanh(r, x, MPFR_RNDN); break;
  case AMBIT_OP_ABS: mpfr_abs(r, x, MPFR_RNDN); break;
  case AMBIT_OP_MIN: mpfr_min(r, x, y, MPFR_RNDN); break;
  default: mpfr_max(r, x, y, MPFR_RNDN); break;
  }
}

/* 1 / sqrt(1 - x^2) or 1 / (1 + x^2) */
static void arc_derivative(mpfr_t r, mpfr_t x, int sign) {
  mpfr_sqr(r, x, MPFR_RNDN);
  if (sign < 0) mpfr_neg(r, r, MPFR_RNDN);
  mpfr_add_ui(r, r, 1, MPFR_RNDN);
  if (sign < 0) mpfr_sqrt(r, r, MPFR_RNDN);
  mpfr_ui_div(r, 1, r, MPFR_RNDN);
}

static void inverse_square(mpfr_t r, int (*f)(mpfr_t, mpfr_srcptr, mpfr_rnd_t), mpfr_t x) {
  f(r, x, MPFR_RNDN);
  mpfr_sqr(r, r, MPFR_RNDN);
  mpfr_ui_div(r, 1, r, MPFR_RNDN);
}

/* of a smooth operation, by x or by y */
static void derivative_at(uint32_t op, int32_t n, int by_y, mpfr_t r, mpfr_t x, mpfr_t y) {
  mpfr_t t;
  mpfr_init2(t, BITS);
  mpfr_set_si(r, op == AMBIT_OP_NEG || (op == AMBIT_OP_SUB && by_y) ? -1 : 1, MPFR_RNDN);
  switch (op) {
  case AMBIT_OP_MUL: mpfr_set(r, by_y ? x : y, MPFR_RNDN); break;
  case AMBIT_OP_SQR: mpfr_mul_2ui(r, x, 1, MPFR_RNDN); break;
  case AMBIT_OP_POWN:
    mpfr_pow_si(r, x, n - 1, MPFR_RNDN);
    mpfr_mul_si(r, r, n, MPFR_RNDN);
    if (n == 0) mpfr_set_zero(r, 1);
    break;
  case AMBIT_OP_DIV:
    mpfr_sqr(t, y, MPFR_RNDN);
    mpfr_div(r, by_y ? x : y, t, MPFR_RNDN);
    if (by_y) mpfr_neg(r, r, MPFR_RNDN);
    break;
  case AMBIT_OP_SQRT:
    mpfr_sqrt(r, x, MPFR_RNDN);
    mpfr_d_div(r, 0.5, r, MPFR_RNDN);
    break;
  case AMBIT_OP_EXP: mpfr_exp(r, x, MPFR_RNDN); break;
  case AMBIT_OP_LOG: mpfr_ui_div(r, 1, x, MPFR_RNDN); break;
  case AMBIT_OP_SIN: mpfr_cos(r, x, MPFR_RNDN); break;
  case AMBIT_OP_COS:
    mpfr_sin(r, x, MPFR_RNDN);
    mpfr_neg(r, r, MPFR_RNDN);
    break;
  case AMBIT_OP_TAN: inverse_square(r, mpfr_cos, x); break;
  case AMBIT_OP_ASIN: arc_derivative(r, x, -1); break;
  case AMBIT_OP_ACOS:
    arc_derivative(r, x, -1);
    mpfr_neg(r, r, MPFR_RNDN);
    break;
  case AMBIT_OP_ATAN: arc_derivative(r, x, 1); break;
  case AMBIT_OP_ATAN2:
    mpfr_sqr(r, x, MPFR_RNDN), mpfr_sqr(t, y, MPFR_RNDN);
    mpfr_add(t, t, r, MPFR_RNDN);
    mpfr_div(r, by_y ? x : y, t, MPFR_RNDN);
    if (by_y) mpfr_neg(r, r, MPFR_RNDN);
    break;
  case AMBIT_OP_SINH: mpfr_cosh(r, x, MPFR_RNDN); break;
  case AMBIT_OP_COSH: mpfr_sinh(r, x, MPFR_RNDN); break;
  case AMBIT_OP_TANH: inverse_square(r, mpfr_cosh, x); break;
  default: break;
  }
  mpfr_clear(t);
}

static bool is_kinked(uint32_t op) { return op == AMBIT_OP_ABS || op == AMBIT_OP_MIN || op == AMBIT_OP_MAX; }

/* -- random boxes within the domains, now and then touching their ends */

static void any_box(uint64_t *state, uint32_t op, double x[2]) {
  double c = oracle_uniform(state, -4, 4);
  double w = oracle_random(state) % 4 == 0 ? 0 : ldexp(oracle_uniform(state, 0, 3), -(int)(oracle_random(state) % 40));
  if (op == AMBIT_OP_ASIN || op == AMBIT_OP_ACOS) c = oracle_uniform(state, -1, 1), w = w / 4;
  if (op == AMBIT_OP_TAN) c = oracle_uniform(state, -1, 1), w = w / 8;
  x[0] = c - w, x[1] = c + w;
  if (op == AMBIT_OP_ASIN || op == AMBIT_OP_ACOS) x[0] = fmax(x[0], -1), x[1] = fmin(x[1], 1);
  if (op == AMBIT_OP_LOG || op == AMBIT_OP_SQRT) x[0] = fabs(c), x[1] = x[0] + w;
  if (op == AMBIT_OP_LOG && x[0] == 0) x[0] = x[1] = 1;
  if (oracle_random(state) % 16 == 0) x[0] = fmin(x[0], 0), x[1] = fmax(x[1], 0); /* to 0, the end of some domains */
}

static double within(uint64_t *state, const double x[2]) {
  switch (oracle_random(state) % 3) {
  case 0: return x[0];
  case 1: return x[1];
  default: return fmin(fmax(oracle_uniform(state, x[0], x[1]), x[0]), x[1]);
  }
}

typedef struct numbers {
  mpfr_t x, y, cx, cy, value, at_centre, low, high, term;
} numbers;

static void numbers_open(numbers *m) {
  mpfr_inits2(BITS, m->x, m->y, m->cx, m->cy, m->value, m->at_centre, m->low, m->high, m->term, (mpfr_ptr)NULL);
}
static void numbers_close(numbers *m) {
  mpfr_clears(m->x, m->y, m->cx, m->cy, m->value, m->at_centre, m->low, m->high, m->term, (mpfr_ptr)NULL);
}

/* low, high += [-n, h] d */
static void add_term(numbers *m, double n, double h, mpfr_t d) {
  bool up = mpfr_sgn(d) >= 0;
  mpfr_mul_d(m->term, d, up ? -n : h, MPFR_RNDN);
  mpfr_add(m->low, m->low, m->term, MPFR_RNDN);
  mpfr_mul_d(m->term, d, up ? h : -n, MPFR_RNDN);
  mpfr_add(m->high, m->high, m->term, MPFR_RNDN);
}

/* the change from the centre to (x, y) must be sum_j slope_j (x_j - c_j), stored slopes being times the reach */
static void judge_slopes(bench *b, numbers *m, uint32_t op, int32_t n, double x, double y) {
  const element *r = slot(b, 2);
  const gradient_context *c = b->ctx;
  if (!(r->known & KNOWN_SLOPE)) return;
  mpfr_set_d(m->cx, slot(b, 0)->centre.h, MPFR_RNDN), mpfr_set_d(m->cy, slot(b, 1)->centre.h, MPFR_RNDN);
  value_at(op, n, m->at_centre, m->cx, m->cy);
  mpfr_sub(m->cx, m->x, m->cx, MPFR_RNDN), mpfr_sub(m->cy, m->y, m->cy, MPFR_RNDN);
  mpfr_set_zero(m->low, 1), mpfr_set_zero(m->high, 1);
  for (int j = 0; j < VARIABLES; j++) {
    double reach = part_of(c, slot(b, j), SLOPE)[c->width + (size_t)j];
    if (reach == 0) continue;
    mpfr_div_d(m->term, j ? m->cy : m->cx, reach, MPFR_RNDN);
    mpfr_set(j ? m->cy : m->cx, m->term, MPFR_RNDN);
    const double *s = part_in(c, r, SLOPE);
    add_term(m, s[j], s[c->width + (size_t)j], j ? m->cy : m->cx);
  }
  mpfr_sub(m->value, m->value, m->at_centre, MPFR_RNDN);
  mpfr_sub(m->low, m->low, m->value, MPFR_RNDN), mpfr_sub(m->high, m->high, m->value, MPFR_RNDN);
  if (mpfr_cmp_d(m->low, 1e-80) > 0 || mpfr_cmp_d(m->high, -1e-80) < 0)
    fail_msg("%s, n = %d: slopes do not allow the change to (%a, %a)", name[op], n, x, y);
}

static void judge_derivatives(bench *b, numbers *m, uint32_t op, int32_t n, double x, double y) {
  double lo[VARIABLES], hi[VARIABLES];
  if (!b->l.full.gradient(b->ctx, slot(b, 2), lo, hi) || is_kinked(op)) return;
  for (int j = 0; j < arity[op] && !(op == AMBIT_OP_POWN && j); j++) {
    derivative_at(op, n, j, m->value, m->x, m->y);
    double down = mpfr_get_d(m->value, MPFR_RNDD), up = mpfr_get_d(m->value, MPFR_RNDU);
    if (!(lo[j] <= up && down <= hi[j]))
      fail_msg("%s, n = %d: derivative %d at (%a, %a) is %a, outside [%a, %a]", name[op], n, j, x, y, up, lo[j], hi[j]);
  }
}

/* a result is at most a few ulp wide where the operands are points */
static void judge_width(bench *b, uint32_t op, int32_t n, double x, double y) {
  double lo[VARIABLES], hi[VARIABLES];
  assert_true(b->l.full.gradient(b->ctx, slot(b, 2), lo, hi) || op == AMBIT_OP_SQRT || op == AMBIT_OP_ASIN ||
              op == AMBIT_OP_ACOS || op == AMBIT_OP_POWN || op == AMBIT_OP_DIV || op == AMBIT_OP_ATAN2);
  if (!b->l.full.gradient(b->ctx, slot(b, 2), lo, hi) || is_kinked(op)) return;
  for (int j = 0; j < VARIABLES; j++)
    if (hi[j] - lo[j] > 1e-13 * fmax(fabs(lo[j]), fabs(hi[j])))
      fail_msg("%s, n = %d at (%a, %a): derivative %d in [%a, %a]", name[op], n, x, y, j, lo[j], hi[j]);
}

static void derivatives_and_slopes(void **unused) {
  (void)unused;
  bench *b = open_as(AMBIT_ARITHMETIC);
  uint64_t state = 7;
  numbers m;
  numbers_open(&m);
  mpfr_set_emin(mpfr_get_emin_min()), mpfr_set_emax(mpfr_get_emax_max());
  for (int i = 0; i < 1500; i++)
    for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++) {
      double box[2][2];
      int32_t n = (int32_t)(oracle_random(&state) % 17) - 8;
      any_box(&state, op, box[0]), any_box(&state, AMBIT_OP_ADD, box[1]);
      uint32_t flags = apply(b, op, n, box[0], box[1]);
      if (flags & AMBIT_F_PARTIAL) {
        assert_true((slot(b, 2)->known & ~VARIES) == 0);
        continue;
      }
      if (box[0][0] == box[0][1] && box[1][0] == box[1][1]) judge_width(b, op, n, box[0][0], box[1][0]);
      for (int k = 0; k < 4; k++) {
        double x = within(&state, box[0]), y = within(&state, box[1]);
        mpfr_set_d(m.x, x, MPFR_RNDN), mpfr_set_d(m.y, y, MPFR_RNDN);
        judge_derivatives(b, &m, op, n, x, y);
        value_at(op, n, m.value, m.x, m.y);
        judge_slopes(b, &m, op, n, x, y);
      }
    }
  numbers_close(&m);
  close_bench(b);
}

/* -- what is known where */

static void expect(uint32_t op, double x0, double x1, double y0, double y1, uint32_t known, double lo, double hi) {
  bench *b = open_as(AMBIT_ARITHMETIC);
  const double x[2] = { x0, x1 }, y[2] = { y0, y1 };
  double dlo[VARIABLES], dhi[VARIABLES];
  apply(b, op, -1, x, y);
  if ((slot(b, 2)->known & ~VARIES) != known)
    fail_msg("%s over [%g, %g], [%g, %g]: knows %d, expected %d", name[op], x0, x1, y0, y1,
        (int)(slot(b, 2)->known & ~VARIES), (int)known);
  assert_int_equal(b->l.full.gradient(b->ctx, slot(b, 2), dlo, dhi) != 0, (known & KNOWN_DERIVATIVE) != 0);
  if (known & KNOWN_DERIVATIVE) assert_true(dlo[0] == lo && dhi[0] == hi);
  close_bench(b);
}

static void gives_up_where_it_must(void **state) {
  (void)state;
  const uint32_t D = KNOWN_DERIVATIVE, S = KNOWN_SLOPE;
  expect(AMBIT_OP_SQRT, 0, 1, 0, 0, S, 0, 0); /* the slopes from the centre are bounded */
  expect(AMBIT_OP_SQRT, -1, 1, 0, 0, 0, 0, 0);
  expect(AMBIT_OP_ASIN, 0, 1, 0, 0, S, 0, 0);
  expect(AMBIT_OP_LOG, 0, 1, 0, 0, 0, 0, 0);
  expect(AMBIT_OP_TAN, 1, 2, 0, 0, 0, 0, 0);
  expect(AMBIT_OP_DIV, 1, 2, -1, 1, 0, 0, 0);
  expect(AMBIT_OP_DIV, 1, 2, 0, 1, 0, 0, 0);
  expect(AMBIT_OP_DIV, 1, 2, 2, 4, D | S, 0.25, 0.5);
  expect(AMBIT_OP_POWN, -1, 1, 0, 0, 0, 0, 0);
  expect(AMBIT_OP_ATAN2, -1, 1, -2, -1, 0, 0, 0);        /* across the cut */
  expect(AMBIT_OP_ATAN2, -1, 0, -2, -1, 0, 0, 0);        /* pi at 0, near -pi below */
  expect(AMBIT_OP_ATAN2, 0, 0, -2, -1, D | S, -1, -0.5); /* along the cut: all points have the angle pi */
  expect(AMBIT_OP_ATAN2, -1, 1, -1, 1, 0, 0, 0);
  expect(AMBIT_OP_ABS, -1, 2, 0, 0, D | S, -1, 1);
  expect(AMBIT_OP_ABS, 0, 2, 0, 0, D | S, 1, 1);
  expect(AMBIT_OP_ABS, -3, -1, 0, 0, D | S, -1, -1);
  expect(AMBIT_OP_MAX, 0, 2, 1, 3, D | S, 0, 1);
  expect(AMBIT_OP_MAX, 3, 4, 1, 3, D | S, 1, 1);
  expect(AMBIT_OP_MIN, 3, 4, 1, 3, D | S, 0, 0);
  expect(AMBIT_OP_EXP, 0, 1000, 0, 0, 0, 0, 0); /* overflow: no bounded derivative */
  expect(AMBIT_OP_SUB, -INFINITY, INFINITY, 0, 1, D, 1, 1);
}

static void the_mean_value_form_is_used(void **state) {
  (void)state;
  bench *b = open_as(AMBIT_ARITHMETIC);
  const double x[2] = { 0.99, 1.01 };
  double lo, hi;
  apply(b, AMBIT_OP_SQR, 0, x, x); /* then x^2 - x about 1: natural [-0.03, 0.03], true [-0.01, 0.01] nearly */
  memcpy(slot(b, 1), slot(b, 2), DOUBLES * 8);
  const uint32_t dst = 2, square = 1, first = 0;
  b->l.full.enter(b->ctx);
  b->l.full.run[AMBIT_OP_SUB](&b->l.full, b->ctx, b->block, 1, 1, 1, &dst, &square, &first);
  b->l.full.leave(b->ctx);
  b->l.full.bounds(b->ctx, slot(b, 2), 1, &lo, &hi);
  assert_true(lo <= -0.0099 && lo > -0.0102 && hi >= 0.0101 && hi < 0.0102);
  close_bench(b);
}

/* -- the two variants */

static void variants_agree(void **unused) {
  (void)unused;
  bench *b[2] = { open_as(AMBIT_ARITHMETIC), open_as("ambit.arithmetic.portable/1") };
  uint64_t state = 3;
  for (int i = 0; i < 4000; i++) {
    uint32_t op = (uint32_t)(oracle_random(&state) % AMBIT_OP_COUNT);
    int32_t n = (int32_t)(oracle_random(&state) % 9) - 4;
    double x[2], y[2], lo[2][VARIABLES], hi[2][VARIABLES];
    int32_t known[2];
    any_box(&state, op, x), any_box(&state, op, y);
    for (int v = 0; v < 2; v++) {
      apply(b[v], op, n, x, y);
      known[v] = b[v]->l.full.gradient(b[v]->ctx, slot(b[v], 2), lo[v], hi[v]);
    }
    assert_int_equal(known[0], known[1]);
    assert_true(slot(b[0], 2)->value.n == slot(b[1], 2)->value.n && slot(b[0], 2)->value.h == slot(b[1], 2)->value.h);
    for (int j = 0; known[0] && j < VARIABLES; j++) assert_true(lo[0][j] == lo[1][j] && hi[0][j] == hi[1][j]);
  }
  close_bench(b[0]), close_bench(b[1]);
}

static void passes_the_kit(void **state) {
  (void)state;
  static const char *const variant[] = { AMBIT_ARITHMETIC, "ambit.arithmetic.portable/1" };
  for (int v = 0; v < 2; v++) {
    arithmetic_loader l;
    size_t fallbacks;
    const char *problem = arithmetic_load_as(&l, "gradient", variant[v]);
    if (problem) fail_msg("%s", problem);
    assert_int_equal(l.plugin->rigorous, 1);
    assert_int_equal(case_run(&l, true, &fallbacks), 0);
    assert_int_equal(fallbacks, 0);
    arithmetic_unload(&l);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(derivatives_and_slopes),
    cmocka_unit_test(gives_up_where_it_must),
    cmocka_unit_test(the_mean_value_form_is_used),
    cmocka_unit_test(variants_agree),
    cmocka_unit_test(passes_the_kit),
  };
  return cmocka_run_group_tests_name("arithmetic gradient", tests, NULL, NULL);
}
