/* A step of taylor_model from inside: over a box of starts and parameters of
**   x' = p x^2, y' = p x y, z' = u, u' = FALL
** whose solutions are known, x = x0 / (1 - p x0 t), y = y0 / (1 - p x0 t), z = z0 + u0 t + FALL t^2 / 2, u = u0 + FALL
** t, the tube holds them, the transfer holds their derivatives by the start, `reach` what these make of a remainder,
** and A the derivatives of the right-hand side near the tube. MPFR is the judge. */
#include "solver/taylor_model/proof.c"
#include "kit/arithmetic_loader.h"
#include "kit/tape_builder.h"
#include "num/random.h"
#include <mpfr.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define STATES 4
#define INPUTS (STATES + 1) /* the parameter behind them */
#define ORDER_MAX 6
#define FALL (-1.0)
#define BITS 400

enum { X, Y, Z, U, P };

typedef struct sample {
  flow f;
  worker w;
  tape_builder tape;
  arithmetic_loader arithmetic;
  double tail_in[INPUTS], dtail_in[INPUTS * STATES], tail_out[STATES], dtail_out[STATES * STATES];
  double size[STATES], eps[STATES], deps[STATES * STATES], excess[STATES], dexcess[STATES * STATES];
  double box_mid[STATES * (ORDER_MAX + 1)], box_rad[STATES * (ORDER_MAX + 1)];
  double slope_mid[STATES * (ORDER_MAX + 1) * STATES], slope_rad[STATES * (ORDER_MAX + 1) * STATES];
  double near_mid[STATES], near_rad[STATES], A[STATES * STATES], group_mid[INPUTS], group_rad[INPUTS];
  double group_rest[STATES], transfer_mid[STATES * STATES], transfer_rad[STATES * STATES], reach[STATES];
  double unit[STATES], weight[STATES], local[STATES], scratch[4 * STATES], seed[STATES], zero[STATES], tube_lo[STATES],
      tube_hi[STATES], pad[STATES];
} sample;

static ambit_random draws = { 1 };
static double between(double lo, double hi) { return ambit_random_in(&draws, (ambit_interval) { lo, hi }); }
static uint32_t below(uint32_t n) { return (uint32_t)(ambit_random_bits(&draws) >> 32) % n; }

static const ambit_tape *right_hand_side(tape_builder *b) {
  tape_begin(b);
  uint32_t one = tape_constant(b, 1, 1), fall = tape_constant(b, FALL, FALL);
  uint32_t x = tape_input(b, AMBIT_DEGREE_ANY), y = tape_input(b, AMBIT_DEGREE_ANY);
  (void)tape_input(b, AMBIT_DEGREE_ANY);
  uint32_t u = tape_input(b, AMBIT_DEGREE_ANY), p = tape_input(b, 0), px = tape_op(b, AMBIT_OP_MUL, p, x);
  const uint32_t out[STATES] = { tape_op(b, AMBIT_OP_MUL, px, x), tape_op(b, AMBIT_OP_MUL, px, y), u, fall };
  const ambit_tape *tape = tape_seal(b, one);
  b->tape.nout = STATES;
  memcpy(b->out, out, sizeof out);
  return tape;
}

static void sample_open(sample *s, uint32_t order) {
  memset(s, 0, sizeof *s);
  const char *problem = arithmetic_load(&s->arithmetic, "interval");
  if (problem) fail_msg("%s", problem);
  const ambit_host *host = &s->arithmetic.scope->host;
  const ambit_tape *tape = right_hand_side(&s->tape);
  s->f = (flow) { .host = host, .jet = host->service(host, AMBIT_JET_SERVICE), .nx = STATES, .np = 1, .ns = 1 };
  s->f.problem.rhs = tape, s->f.options.slope_order = order, s->f.options.tolerance = 1;
  s->w = (worker) { .flow = &s->f, .tail_in = s->tail_in, .dtail_in = s->dtail_in, .tail_out = s->tail_out };
  worker *w = &s->w;
  w->dtail_out = s->dtail_out, w->size = s->size, w->eps = s->eps, w->deps = s->deps, w->excess = s->excess;
  w->dexcess = s->dexcess, w->box_mid = s->box_mid, w->box_rad = s->box_rad, w->slope_mid = s->slope_mid;
  w->slope_rad = s->slope_rad, w->near_mid = s->near_mid, w->near_rad = s->near_rad, w->A = s->A;
  w->group_mid = s->group_mid, w->group_rad = s->group_rad, w->group_rest = s->group_rest;
  w->transfer_mid = s->transfer_mid, w->transfer_rad = s->transfer_rad, w->reach = s->reach, w->scratch = s->scratch;
  w->seed = s->seed, w->zero = s->zero, w->tube_lo = s->tube_lo, w->tube_hi = s->tube_hi;
  w->unit = s->unit, w->weight = s->weight, w->local = s->local;
  const ambit_arithmetic *a = &s->arithmetic.full;
  assert_int_equal(s->f.jet->open(host, tape, a, s->arithmetic.ctx, order, STATES, NULL, &w->box), AMBIT_OK);
  assert_int_equal(s->f.jet->open(host, tape, a, s->arithmetic.ctx, 0, STATES, NULL, &w->near), AMBIT_OK);
}

static void sample_close(sample *s) {
  s->f.jet->close(s->w.box);
  s->f.jet->close(s->w.near);
  arithmetic_unload(&s->arithmetic);
}

/* with so few digits that corners of boxes are doubles */
static double coarse(double lo, double hi) { return floor(between(lo, hi) * 0x1p20) * 0x1p-20; }

static void draw(sample *s) {
  static const double radius[] = { 0, 0, 0x1p-40, 0x1p-10, 0x1p-4 }, unsure[] = { 0, 0, 0x1p-50, 0x1p-14 };
  for (size_t i = 0; i < INPUTS; i++) s->group_mid[i] = coarse(-2, 2), s->group_rad[i] = radius[below(5)];
  for (size_t i = 0; i < STATES; i++) {
    s->group_rest[i] = between(0, 1e-3), s->pad[i] = between(0, 1e-3);
    s->size[i] = s->unit[i] = ldexp(1, (int)below(7) - 3), s->local[i] = ldexp(between(0, 1), -(int)below(40));
    s->tube_lo[i] = INFINITY, s->tube_hi[i] = -INFINITY;
  }
  double error = unsure[below(4)], h = error > 0 ? coarse(0.01, 0.1) : between(0.01, 0.1);
  s->w.step = (span) { below(2) ? h : -h, error, h + 2 * error };
  h = s->w.step.h;
  switch (below(3)) {
  case 0: /* the parabola ends near 0, where rounding before shows */
    s->group_mid[Z] = -h - 0.5 * FALL * h * h, s->group_mid[U] = 1, s->group_rad[Z] = s->group_rad[U] = 0;
    break;
  case 1: /* it has its top inside */ s->group_mid[Z] = 0, s->group_mid[U] = -0.5 * FALL * h, s->group_rad[U] = 0;
  default: break;
  }
}

/* a start, a parameter, a time in the step, one of its end, one near the tube: corners as often as not */
typedef struct choice {
  double start[INPUTS], time, end, off[STATES];
} choice;

static double end_or_inside(double lo, double hi) {
  uint32_t way = below(4);
  double inside = lo < hi ? between(lo, hi) : lo;
  return way == 0 ? lo : way == 1 ? inside : hi;
}

static choice choose(const sample *s) {
  choice c;
  const span *step = &s->w.step;
  for (size_t i = 0; i < INPUTS; i++)
    c.start[i] = end_or_inside(s->group_mid[i] - s->group_rad[i], s->group_mid[i] + s->group_rad[i]);
  c.time = below(2) ? step->h : step->h * between(0, 1);
  c.end = end_or_inside(step->h - step->error, step->h + step->error);
  for (size_t i = 0; i < STATES; i++) c.off[i] = end_or_inside(-1, 1);
  return c;
}

static int is_inside(mpfr_t x, double mid, double rad) {
  mpfr_t off;
  mpfr_init2(off, BITS);
  mpfr_sub_d(off, x, mid, MPFR_RNDN);
  int inside = mpfr_cmpabs_ui(off, 0) == 0 || (mpfr_abs(off, off, MPFR_RNDN), mpfr_cmp_d(off, rad) <= 0);
  mpfr_clear(off);
  return inside;
}

/* r := 1 / (1 - p x0 t) */
static void growth(mpfr_t r, const choice *c, double t) {
  mpfr_set_d(r, c->start[P], MPFR_RNDN);
  mpfr_mul_d(r, r, c->start[X], MPFR_RNDN);
  mpfr_mul_d(r, r, t, MPFR_RNDN);
  mpfr_ui_sub(r, 1, r, MPFR_RNDN);
  mpfr_ui_div(r, 1, r, MPFR_RNDN);
}

static void state(mpfr_t r, const choice *c, size_t i, double t) {
  mpfr_t fall;
  switch (i) {
  case X:
  case Y:
    growth(r, c, t);
    mpfr_mul_d(r, r, c->start[i], MPFR_RNDN);
    return;
  default:
    mpfr_init2(fall, BITS);
    mpfr_set_d(fall, FALL, MPFR_RNDN);
    mpfr_mul_d(fall, fall, t, MPFR_RNDN);
    if (i == Z) mpfr_mul_d(fall, fall, t, MPFR_RNDN), mpfr_div_ui(fall, fall, 2, MPFR_RNDN);
    mpfr_set_d(r, i == Z ? c->start[U] : 0, MPFR_RNDN);
    mpfr_mul_d(r, r, t, MPFR_RNDN);
    mpfr_add_d(r, r, c->start[i], MPFR_RNDN);
    mpfr_add(r, r, fall, MPFR_RNDN);
    mpfr_clear(fall);
  }
}

/* of state i by the start of state j */
static void derivative(mpfr_t r, const choice *c, size_t i, size_t j, double t) {
  mpfr_set_zero(r, 1);
  if (i >= Z) {
    mpfr_set_d(r, i == j ? 1 : i == Z && j == U ? t : 0, MPFR_RNDN);
    return;
  }
  if (j > i) return;
  growth(r, c, t);
  if (i == Y && j == Y) return;
  mpfr_sqr(r, r, MPFR_RNDN);
  if (i == Y) {
    mpfr_mul_d(r, r, c->start[Y], MPFR_RNDN);
    mpfr_mul_d(r, r, c->start[P], MPFR_RNDN);
    mpfr_mul_d(r, r, t, MPFR_RNDN);
  }
}

static void check_tube(const sample *s, const choice *c, double t) {
  mpfr_t r;
  mpfr_init2(r, BITS);
  for (size_t i = 0; i < STATES; i++) {
    state(r, c, i, t);
    assert_true(is_inside(r, s->near_mid[i], s->near_rad[i]));
    assert_true(mpfr_cmp_d(r, s->tube_lo[i]) >= 0 && mpfr_cmp_d(r, s->tube_hi[i]) <= 0);
  }
  mpfr_clear(r);
}

static void check_transfer(const sample *s, const choice *c) {
  mpfr_t r, sum;
  mpfr_init2(r, BITS), mpfr_init2(sum, BITS);
  for (size_t i = 0; i < STATES; i++) {
    mpfr_set_zero(sum, 1);
    for (size_t j = 0; j < STATES; j++) {
      derivative(r, c, i, j, c->end);
      assert_true(is_inside(r, s->transfer_mid[i * STATES + j], s->transfer_rad[i * STATES + j]));
      derivative(r, c, i, j, c->time);
      mpfr_abs(r, r, MPFR_RNDN);
      mpfr_mul_d(r, r, s->group_rest[j], MPFR_RNDN);
      mpfr_add(sum, sum, r, MPFR_RNDN);
    }
    assert_true(mpfr_cmp_d(sum, s->reach[i]) <= 0);
  }
  mpfr_clear(r), mpfr_clear(sum);
}

/* df/dx at a solution that is `off` pads away: 2 p x, p y, p x */
static void check_growth(const sample *s, const choice *c) {
  mpfr_t at[2], r, part;
  mpfr_init2(r, BITS), mpfr_init2(part, BITS);
  for (size_t i = 0; i < 2; i++) {
    mpfr_init2(at[i], BITS);
    state(at[i], c, i, c->time);
    mpfr_set_d(part, s->pad[i], MPFR_RNDN);
    mpfr_mul_d(part, part, c->off[i], MPFR_RNDN);
    mpfr_add(at[i], at[i], part, MPFR_RNDN);
  }
  static const struct {
    size_t row, column, of;
    unsigned long times;
  } entry[] = { { X, X, X, 2 }, { Y, X, Y, 1 }, { Y, Y, X, 1 } };
  for (size_t k = 0; k < sizeof entry / sizeof *entry; k++) {
    mpfr_mul_d(r, at[entry[k].of], c->start[P], MPFR_RNDN);
    mpfr_mul_ui(r, r, entry[k].times, MPFR_RNDN);
    mpfr_mul_d(r, r, s->w.step.length, MPFR_RNDN);
    assert_true(is_inside(r, 0, s->A[entry[k].row * STATES + entry[k].column]));
  }
  assert_true(s->A[Z * STATES + U] >= s->w.step.length);
  mpfr_clear(at[0]), mpfr_clear(at[1]), mpfr_clear(r), mpfr_clear(part);
}

/* exp(A) local by 200 terms, whatever the weights in which the bound takes its norm */
static void check_exponential(sample *s) {
  double apart[STATES];
  long double term[STATES], sum[STATES], next[STATES];
  ambit_rounding old = ambit_round_up();
  exponentiate(&s->w, apart);
  ambit_rounding_restore(old);
  for (size_t i = 0; i < STATES; i++) sum[i] = term[i] = s->local[i];
  for (int k = 1; k <= 200; k++) {
    for (size_t i = 0; i < STATES; i++) {
      next[i] = 0;
      for (size_t j = 0; j < STATES; j++) next[i] += (long double)s->A[i * STATES + j] * term[j] / k;
    }
    for (size_t i = 0; i < STATES; i++) sum[i] += term[i] = next[i];
  }
  for (size_t i = 0; i < STATES; i++) {
    assert_true(apart[i] >= (double)(sum[i] * (1 - 1e-15L)));
    assert_true(apart[i] <= (double)(sum[i] * (1 + 1e-12L)) + 1e-20 * s->weight[i]);
  }
}

/* 0: not proved */
static AMBIT_WORKER int run(sample *s) {
  piece p = { 0 };
  if (solve_box(&s->w, &p) || !prove_box(&s->w)) return 0;
  find_tube(&s->w);
  transfer(&s->w, 0);
  return find_growth(&s->w, &p, s->pad);
}

static void steps_hold_their_solutions(void **unused) {
  (void)unused;
  static const uint32_t order[] = { 2, 3, ORDER_MAX };
  for (size_t k = 0; k < sizeof order / sizeof *order; k++) {
    sample s;
    int proved = 0;
    sample_open(&s, order[k]);
    for (int n = 0; n < 1500; n++) {
      draw(&s);
      ambit_rounding old = ambit_round_up();
      int known = run(&s);
      ambit_rounding_restore(old);
      proved += known;
      if (known) check_exponential(&s);
      for (int i = 0; i < 12 && known; i++) {
        choice c = choose(&s);
        check_tube(&s, &c, c.time);
        check_transfer(&s, &c);
        check_growth(&s, &c);
      }
    }
    assert_true(proved > 1200);
    sample_close(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(steps_hold_their_solutions) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
