/* valencia's power series from inside: the defect of the middle curve, and the residuals of the columns, enclose
**   half f(p) - p'  and  half (df/dx c + df/dp reach) - c'
** for f = (x y + p (t - CENTRE), e^x + p y) along curves that solve nothing, at many sigma, states in the box,
** parameters, instants and lengths of step. MPFR is the judge. Where all coefficients are positive the largest value is
** attained at sigma = 1, so that a radius or a tail left out shows. */
#include "solver/valencia/valencia.h"
#include "kit/arithmetic_loader.h"
#include "kit/tape_builder.h"
#include "num/random.h"
#include <mpfr.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define STATES 2
#define UNKNOWNS 2
#define STAGES 3
#define POINTS (STAGES + 1)
#define MONOMIALS (1 + UNKNOWNS)
#define COLUMNS (UNKNOWNS + STATES)
#define CENTRE 1e9 /* s: a double there is 1.2e-7 wide */
#define BITS 400

typedef struct sample {
  valencia s;
  tape_builder tape;
  arithmetic_loader arithmetic;
  double curve[STATES * MONOMIALS * POINTS], frame[STATES * STATES * POINTS], w[STATES];
  double middle[1], reach[UNKNOWNS], loose[1], tail[2 * (STATES + 1) * (COLUMNS + 2) + 2 * STATES];
  interval residual[COLUMNS * STATES], defect[STATES];
} sample;

static ambit_random draws = { 1 };
static uint32_t below(uint32_t n) { return (uint32_t)(ambit_random_bits(&draws) >> 32) % n; }
static double between(double lo, double hi) { return ambit_random_in(&draws, (ambit_interval) { lo, hi }); }

static const ambit_tape *right_hand_side(tape_builder *b) {
  tape_begin(b);
  uint32_t one = tape_constant(b, 1, 1), centre = tape_constant(b, CENTRE, CENTRE);
  uint32_t x = tape_input(b, AMBIT_DEGREE_ANY), y = tape_input(b, AMBIT_DEGREE_ANY), p = tape_input(b, 0);
  uint32_t t = tape_input(b, 1);
  uint32_t since = tape_op(b, AMBIT_OP_SUB, t, centre), xy = tape_op(b, AMBIT_OP_MUL, x, y);
  uint32_t force = tape_op(b, AMBIT_OP_MUL, p, since), power = tape_unary(b, AMBIT_OP_EXP, x);
  uint32_t f = tape_op(b, AMBIT_OP_ADD, xy, force);
  uint32_t g = tape_op(b, AMBIT_OP_ADD, power, tape_op(b, AMBIT_OP_MUL, p, y));
  const ambit_tape *tape = tape_seal(b, one);
  b->tape.nout = STATES, b->out[0] = f, b->out[1] = g;
  return tape;
}

static void sample_open(sample *x) {
  const char *problem = arithmetic_load(&x->arithmetic, "interval");
  if (problem) fail_msg("%s", problem);
  const ambit_host *host = &x->arithmetic.scope->host;
  const ambit_tape *tape = right_hand_side(&x->tape);
  const ambit_jet_service *jet = host->service(host, AMBIT_JET_SERVICE);
  const ambit_arithmetic *arithmetic = &x->arithmetic.full;
  void *ctx = x->arithmetic.ctx;
  x->s = (valencia) { .host = host, .nx = STATES, .np = 1, .nu = UNKNOWNS, .ndir = STATES + 1, .jet = jet };
  x->s.terms.n = MONOMIALS, x->s.stages.n = STAGES, x->s.ncolumn = COLUMNS;
  x->s.problem.rhs = tape, x->s.problem.uses_time = 1;
  x->s.curve = x->curve, x->s.frame = x->frame, x->s.w = x->w, x->s.middle = x->middle, x->s.reach = x->reach;
  x->s.loose = x->loose, x->s.tail = x->tail, x->s.residual = x->residual, x->s.defect = x->defect;
  assert_int_equal(jet->open(host, tape, arithmetic, ctx, STAGES + 2, 0, NULL, &x->s.centre), AMBIT_OK);
  assert_int_equal(jet->open(host, tape, arithmetic, ctx, STAGES, COLUMNS, NULL, &x->s.box), AMBIT_OK);
}

static void sample_close(sample *x) {
  x->s.jet->close(x->s.box);
  x->s.jet->close(x->s.centre);
  arithmetic_unload(&x->arithmetic);
}

static interval ulps_above(double x, int n) {
  double hi = x;
  for (int k = 0; k < n; k++) hi = nextafter(hi, INFINITY);
  return (interval) { x, hi };
}

/* scale 0: nothing but time moves */
static void draw(sample *x, double scale, int positive) {
  double least = positive ? 0 : -scale;
  for (size_t k = 0; k < sizeof x->curve / sizeof *x->curve; k++) x->curve[k] = between(least, scale);
  for (size_t k = 0; k < sizeof x->frame / sizeof *x->frame; k++) x->frame[k] = between(least, scale);
  for (size_t j = 0; j < STATES; j++) x->w[j] = scale * between(0, 1);
  x->middle[0] = 1 + between(least, scale), x->loose[0] = scale * between(0, 1);
  for (size_t j = 0; j < UNKNOWNS; j++) x->reach[j] = between(least, scale);
  double time = CENTRE;
  for (uint32_t n = below(5); n-- > 0;) time = nextafter(time, INFINITY);
  x->s.time = ulps_above(time, (int)below(4));
  x->s.half = ulps_above(positive ? between(2, 4) : between(0.1, 1), (int)below(4));
}

/* A choice of all that the bounds are for: corners as often as not. */
typedef struct choice {
  double sigma, half, time, xi[UNKNOWNS], z[STATES], loose;
} choice;

static double end_or_inside(double lo, double hi) {
  uint32_t way = below(4);
  double inside = lo < hi ? between(lo, hi) : lo;
  return way == 0 ? lo : way == 3 ? inside : hi;
}

static choice choose(const sample *x) {
  choice c = { .sigma = end_or_inside(-1, 1), .half = end_or_inside(x->s.half.lo, x->s.half.hi) };
  c.time = end_or_inside(x->s.time.lo, x->s.time.hi);
  for (size_t j = 0; j < UNKNOWNS; j++) c.xi[j] = end_or_inside(-1, 1);
  for (size_t j = 0; j < STATES; j++) c.z[j] = end_or_inside(-x->w[j], x->w[j]);
  c.loose = end_or_inside(-x->loose[0], x->loose[0]);
  return c;
}

/* r := the polynomial c at sigma, or its derivative */
static void polynomial(mpfr_t r, const double *c, double sigma, int derivative) {
  mpfr_set_zero(r, 1);
  for (int m = STAGES; m >= derivative; m--) {
    mpfr_t term;
    mpfr_init2(term, BITS);
    mpfr_set_d(term, c[m], MPFR_RNDN);
    if (derivative) mpfr_mul_si(term, term, m, MPFR_RNDN);
    mpfr_mul_d(r, r, sigma, MPFR_RNDN);
    mpfr_add(r, r, term, MPFR_RNDN);
    mpfr_clear(term);
  }
}

/* sum += c(sigma) factor */
static void add_polynomial(mpfr_t sum, const double *c, double sigma, double factor) {
  mpfr_t r;
  mpfr_init2(r, BITS);
  polynomial(r, c, sigma, 0);
  mpfr_mul_d(r, r, factor, MPFR_RNDN);
  mpfr_add(sum, sum, r, MPFR_RNDN);
  mpfr_clear(r);
}

typedef struct place {
  mpfr_t x[STATES], p, since;
} place;

/* the states, the parameter and the time since CENTRE; about the middle only, or anywhere in the box */
static void place_open(place *at, const sample *x, const choice *c, int in_box) {
  for (size_t i = 0; i < STATES; i++) {
    mpfr_init2(at->x[i], BITS);
    mpfr_set_zero(at->x[i], 1);
    for (size_t k = 0; k < MONOMIALS; k++)
      if (k == 0 || in_box)
        add_polynomial(at->x[i], x->curve + (i * MONOMIALS + k) * POINTS, c->sigma, k ? c->xi[k - 1] : 1);
    for (size_t j = 0; j < STATES && in_box; j++)
      add_polynomial(at->x[i], x->frame + (i * STATES + j) * POINTS, c->sigma, c->z[j]);
  }
  mpfr_init2(at->p, BITS), mpfr_init2(at->since, BITS);
  mpfr_set_d(at->p, x->middle[0], MPFR_RNDN);
  mpfr_add_d(at->p, at->p, c->loose, MPFR_RNDN);
  mpfr_t part;
  mpfr_init2(part, BITS);
  for (size_t j = 0; j < UNKNOWNS && in_box; j++) {
    mpfr_set_d(part, x->reach[j], MPFR_RNDN);
    mpfr_mul_d(part, part, c->xi[j], MPFR_RNDN);
    mpfr_add(at->p, at->p, part, MPFR_RNDN);
  }
  mpfr_set_d(at->since, c->half, MPFR_RNDN);
  mpfr_mul_d(at->since, at->since, c->sigma, MPFR_RNDN);
  mpfr_add_d(at->since, at->since, c->time, MPFR_RNDN);
  mpfr_sub_d(at->since, at->since, CENTRE, MPFR_RNDN);
  mpfr_clear(part);
}

static void place_close(place *at) {
  for (size_t i = 0; i < STATES; i++) mpfr_clear(at->x[i]);
  mpfr_clear(at->p), mpfr_clear(at->since);
}

/* r := half r - the derivative of c; must be within */
static void finish(mpfr_t r, const choice *at, const double *c, interval bound) {
  mpfr_t slope;
  mpfr_init2(slope, BITS);
  polynomial(slope, c, at->sigma, 1);
  mpfr_mul_d(r, r, at->half, MPFR_RNDN);
  mpfr_sub(r, r, slope, MPFR_RNDN);
  assert_true(mpfr_cmp_d(r, bound.lo) >= 0);
  assert_true(mpfr_cmp_d(r, bound.hi) <= 0);
  mpfr_clear(slope);
}

static void check_defect(const sample *x, const choice *c) {
  place at;
  mpfr_t f[STATES], force;
  place_open(&at, x, c, 0);
  mpfr_init2(f[0], BITS), mpfr_init2(f[1], BITS), mpfr_init2(force, BITS);
  mpfr_mul(f[0], at.x[0], at.x[1], MPFR_RNDN);
  mpfr_mul(force, at.p, at.since, MPFR_RNDN);
  mpfr_add(f[0], f[0], force, MPFR_RNDN);
  mpfr_exp(f[1], at.x[0], MPFR_RNDN);
  mpfr_mul(force, at.p, at.x[1], MPFR_RNDN);
  mpfr_add(f[1], f[1], force, MPFR_RNDN);
  for (size_t i = 0; i < STATES; i++) finish(f[i], c, x->curve + i * MONOMIALS * POINTS, x->defect[i]);
  mpfr_clear(f[0]), mpfr_clear(f[1]), mpfr_clear(force);
  place_close(&at);
}

static const double *column(const sample *x, size_t i, size_t j) {
  return j < UNKNOWNS ? x->curve + (i * MONOMIALS + 1 + j) * POINTS : x->frame + (i * STATES + j - UNKNOWNS) * POINTS;
}

static void check_columns(const sample *x, const choice *c) {
  place at;
  mpfr_t f[STATES], own[STATES], part;
  place_open(&at, x, c, 1);
  mpfr_init2(part, BITS);
  for (size_t i = 0; i < STATES; i++) mpfr_init2(f[i], BITS), mpfr_init2(own[i], BITS);
  for (size_t j = 0; j < COLUMNS; j++) {
    for (size_t i = 0; i < STATES; i++) polynomial(own[i], column(x, i, j), c->sigma, 0);
    mpfr_mul(f[0], at.x[1], own[0], MPFR_RNDN); /* y dx + x dy + (t - CENTRE) dp */
    mpfr_mul(part, at.x[0], own[1], MPFR_RNDN);
    mpfr_add(f[0], f[0], part, MPFR_RNDN);
    mpfr_mul_d(part, at.since, j < UNKNOWNS ? x->reach[j] : 0, MPFR_RNDN);
    mpfr_add(f[0], f[0], part, MPFR_RNDN);
    mpfr_exp(f[1], at.x[0], MPFR_RNDN); /* e^x dx + p dy + y dp */
    mpfr_mul(f[1], f[1], own[0], MPFR_RNDN);
    mpfr_mul(part, at.p, own[1], MPFR_RNDN);
    mpfr_add(f[1], f[1], part, MPFR_RNDN);
    mpfr_mul_d(part, at.x[1], j < UNKNOWNS ? x->reach[j] : 0, MPFR_RNDN);
    mpfr_add(f[1], f[1], part, MPFR_RNDN);
    for (size_t i = 0; i < STATES; i++) finish(f[i], c, column(x, i, j), x->residual[j * STATES + i]);
  }
  for (size_t i = 0; i < STATES; i++) mpfr_clear(f[i]), mpfr_clear(own[i]);
  mpfr_clear(part);
  place_close(&at);
}

static AMBIT_WORKER int run(sample *x) { return valencia_series(&x->s, x->defect) && valencia_column_series(&x->s); }

static void series_enclose(void **unused) {
  (void)unused;
  static const double scale[] = { 0, 1e-3, 1, 1 };
  sample x;
  sample_open(&x);
  for (int n = 0; n < 2000; n++) {
    draw(&x, scale[n % 4], n % 4 == 3);
    ambit_rounding old = ambit_round_up();
    int known = run(&x);
    ambit_rounding_restore(old);
    assert_true(known);
    for (int k = 0; k < 30; k++) {
      choice c = choose(&x);
      check_defect(&x, &c);
      check_columns(&x, &c);
    }
  }
  sample_close(&x);
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(series_enclose) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
