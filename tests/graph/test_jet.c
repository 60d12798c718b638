/* Taylor coefficients and slopes: closed forms, points of boxes against the judge, solving, refusals. */
#include "graph/series_scene.h"
#include "num/interval.h"
#include <setjmp.h>
#include <stddef.h>
#include <cmocka.h>

static const ambit_jet_service *const service = &ambit_jet_service_v1;

static ambit_jet *open_jet(fixture_host *host, const ambit_tape *t, const ambit_arithmetic *full, uint32_t order,
    uint32_t ndir, const ambit_jet *centre) {
  ambit_jet *jet;
  if (service->open(&host->host, t, full, NULL, order, ndir, centre, &jet) != AMBIT_OK)
    fail_msg("open: %s", host->message);
  return jet;
}

static void expect_near(const ambit_jet *jet, uint32_t slot, uint32_t k, real truth, double width) {
  double mid, rad;
  service->get(jet, slot, k, &mid, &rad, NULL, NULL);
  if (!(fabsl(truth - mid) <= rad * (1 + 1e-15L) + 1e-19L * fabsl(truth)))
    fail_msg("slot %u order %u: %.20Lg is outside %.17g +- %.3g", slot, k, truth, mid, rad);
  if (!(rad <= width * (fabs(mid) + 0x1p-10)))
    fail_msg("slot %u order %u: %.17g +- %.3g is wider than %.3g of it", slot, k, mid, rad, width);
}

/* exp(t) = sum t^k/k!, sin(t^2), 1/(1 - t), log(1 + t), atan t, sqrt(1 + t), cosh t */
static void closed_forms(void **unused) {
  (void)unused;
  fixture_host host;
  fixture_host_open(&host);
  ambit_arithmetic full = fixture_arithmetic();
  fixture_tape *x = fixture_tape_open(&host);
  uint32_t one = fixture_constant(x, 1, 1), t = fixture_input(x, 1);
  uint32_t e = fixture_function(x, AMBIT_OP_EXP, t, t, one), plus = fixture_op(x, AMBIT_OP_ADD, one, t);
  uint32_t square = fixture_op(x, AMBIT_OP_SQR, t, t), s = fixture_function(x, AMBIT_OP_SIN, square, square, one);
  uint32_t geometric = fixture_op(x, AMBIT_OP_DIV, one, fixture_op(x, AMBIT_OP_SUB, one, t));
  uint32_t l = fixture_op(x, AMBIT_OP_LOG, plus, plus), r = fixture_op(x, AMBIT_OP_SQRT, plus, plus);
  uint32_t a = fixture_function(x, AMBIT_OP_ATAN, t, t, one), c = fixture_function(x, AMBIT_OP_COSH, t, t, one);
  uint32_t p = fixture_function(x, AMBIT_OP_ATAN2, t, plus, one); /* atan(t / (1 + t)) = Im log(1 + (1 + i) t) */
  ambit_jet *jet = open_jet(&host, &x->tape, &full, 20, 0, NULL);
  service->put(jet, 0, 0, 0, 0, NULL, NULL);
  service->put(jet, 0, 1, 1, 0, NULL, NULL);
  for (uint32_t k = 0; k <= 20; k++) assert_int_equal(service->advance(jet, k), 0);
  real factorial = 1, root = 1;
  plane power = 1;
  for (uint32_t k = 0; k <= 20; k++) {
    real sign = k % 2 ? 1 : -1, half = 1;
    if (k) factorial *= k, root *= (1.5L - k) / k, power *= 1 + I;
    for (uint32_t j = 2; j <= k / 2; j++) half *= j;
    expect_near(jet, e, k, 1 / factorial, 1e-14);
    expect_near(jet, c, k, k % 2 ? 0 : 1 / factorial, 1e-14);
    expect_near(jet, s, k, k % 4 == 2 ? (k % 8 == 2 ? 1 : -1) / half : 0, 1e-14);
    expect_near(jet, geometric, k, 1, 0);
    expect_near(jet, l, k, k ? sign / k : 0, 1e-13);
    expect_near(jet, a, k, k % 2 ? (k % 4 == 1 ? 1.0L : -1.0L) / k : 0, 1e-13);
    expect_near(jet, r, k, root, 1e-12);
    expect_near(jet, p, k, k ? sign * cimagl(power) / k : 0, 1e-6);
    expect_near(jet, square, k, k == 2, 0);
  }
  fixture_host_close(&host);
}

/* -- boxes */

typedef struct trio {
  ambit_jet *centre, *slopes, *derivatives;
  uint32_t flags;
} trio;

static trio run_trio(fixture_host *host, const scene *s, const ambit_arithmetic *full) {
  trio r = { .centre = open_jet(host, &s->x->tape, full, s->K, 0, NULL) };
  r.slopes = open_jet(host, &s->x->tape, full, s->K, SCENE_DIRECTIONS, r.centre);
  r.derivatives = open_jet(host, &s->x->tape, full, s->K, SCENE_DIRECTIONS, NULL);
  r.flags = scene_run(s, r.centre, false);
  r.flags |= scene_run(s, r.slopes, true) | scene_run(s, r.derivatives, true);
  return r;
}

static void close_trio(trio *r) {
  service->close(r->derivatives), service->close(r->slopes), service->close(r->centre);
}

/* u_k(xi) in the box's coefficient, and u_k(xi) - u_k(0) in sum_d s_d xi_d */
static void check_slot(
    const ambit_jet *jet, uint32_t v, uint32_t k, real at, real at_centre, const double *xi, uint32_t op, real scale) {
  double mid, rad, dmid[SCENE_DIRECTIONS], drad[SCENE_DIRECTIONS];
  service->get(jet, v, k, &mid, &rad, dmid, drad);
  real slack = 1e-16L * (fabsl(at) + fabsl(at_centre) + rad) + 1e-18L * scale, change = 0, reach = 0; /* the judge's */
  assert_false(isnan(mid) || isnan(rad));
  if (fabsl(at - mid) > rad + slack)
    fail_msg("op %u slot %u order %u: %.18Lg outside %.17g +- %.3g", op, v, k, at, mid, rad);
  for (int d = 0; d < SCENE_DIRECTIONS; d++) {
    assert_false(isnan(dmid[d]) || isnan(drad[d]));
    change += (real)dmid[d] * xi[d];
    reach += (real)drad[d] * fabs(xi[d]);
  }
  if (fabsl(at - at_centre - change) > reach + slack)
    fail_msg("op %u slot %u order %u: change %.18Lg outside %.17Lg +- %.3Lg", op, v, k, at - at_centre, change, reach);
}

static void check_points(const scene *s, const trio *r, uint64_t *state, uint32_t op) {
  static judge_series here[FIXTURE_MAX], centre[FIXTURE_MAX];
  const double zero[SCENE_DIRECTIONS] = { 0 };
  scene_judge(s, zero, centre);
  for (int point = 0; point < 4; point++) {
    double xi[SCENE_DIRECTIONS];
    scene_point(s, state, xi);
    scene_judge(s, xi, here);
    for (uint32_t v = 0; v < s->x->tape.nslot; v++) {
      real scale = 0;
      for (uint32_t k = 0; k <= s->K; k++) {
        scale = fmaxl(scale, fabsl(here[v].c[k]));
        check_slot(r->slopes, v, k, here[v].c[k], centre[v].c[k], xi, op, scale);
        check_slot(r->derivatives, v, k, here[v].c[k], centre[v].c[k], xi, op, scale);
      }
    }
  }
}

static void every_operation_over_boxes(void **unused) {
  (void)unused;
  uint64_t state = 3;
  ambit_arithmetic full = fixture_arithmetic();
  const double level[] = { 0.3, 1, 2.5, 1e-3, -1 }, width[] = { 0, 1e-9, 1e-3, 0.05, 0.2 };
  for (size_t o = 0; o < SERIES_OPS; o++)
    for (int round = 0; round < 40; round++) {
      fixture_host host;
      fixture_host_open(&host);
      scene s = { .x = scene_single(&host, series_op[o]), .nin = 3, .K = 1 + (uint32_t)(oracle_random(&state) % 10) };
      double wide = width[oracle_random(&state) % 5];
      scene_fill(&s, &state, level[round % 5], wide);
      trio r = run_trio(&host, &s, &full);
      bool proved = (r.flags & (AMBIT_F_PARTIAL | AMBIT_F_UNBOUNDED)) == 0;
      if (proved) check_points(&s, &r, &state, series_op[o]);
      bool whole = round % 5 < 3 && wide < 0.01;
      if (whole && series_op[o] < AMBIT_OP_ABS) assert_true(proved); /* the test must not pass by proving nothing */
      close_trio(&r);
      fixture_host_close(&host);
    }
}

static void random_programs_over_boxes(void **unused) {
  (void)unused;
  uint64_t state = 4;
  ambit_arithmetic full = fixture_arithmetic();
  int proved = 0;
  for (int round = 0; round < 150; round++) {
    fixture_host host;
    fixture_host_open(&host);
    scene s = { .x = scene_random(&host, &state, 12), .nin = 3, .K = 6 };
    scene_fill(&s, &state, round % 2 ? 0.7 : -0.4, round % 3 ? 0.02 : 0);
    trio r = run_trio(&host, &s, &full);
    if (r.flags == 0) check_points(&s, &r, &state, AMBIT_OP_COUNT), proved++;
    close_trio(&r);
    fixture_host_close(&host);
  }
  assert_true(proved > 140);
}

/* The mean of box and centre halves the radius where the rule is bilinear. */
static void slopes_are_tighter_than_derivatives(void **unused) {
  (void)unused;
  uint64_t state = 5;
  ambit_arithmetic full = fixture_arithmetic();
  const uint32_t op[] = { AMBIT_OP_MUL, AMBIT_OP_SQR, AMBIT_OP_DIV, AMBIT_OP_SQRT, AMBIT_OP_EXP, AMBIT_OP_SIN,
    AMBIT_OP_COSH };
  for (size_t o = 0; o < sizeof op / sizeof *op; o++) {
    fixture_host host;
    fixture_host_open(&host);
    scene s = { .x = scene_single(&host, op[o]), .nin = 3, .K = 5 };
    scene_fill(&s, &state, 1, 0.001);
    trio r = run_trio(&host, &s, &full);
    double narrow = 0, wide = 0;
    for (uint32_t v = 4; v < s.x->tape.nslot; v++)
      for (uint32_t k = 0; k <= s.K; k++) {
        double a[SCENE_DIRECTIONS], b[SCENE_DIRECTIONS], mid, rad;
        service->get(r.slopes, v, k, &mid, &rad, NULL, a);
        service->get(r.derivatives, v, k, &mid, &rad, NULL, b);
        for (int d = 0; d < SCENE_DIRECTIONS; d++) narrow += a[d], wide += b[d];
      }
    if (!(narrow <= 0.55 * wide)) fail_msg("op %u: slopes' radius %g, derivatives' %g", op[o], narrow, wide);
    close_trio(&r);
    fixture_host_close(&host);
  }
}

/* -- branches */

static uint32_t flags_of(uint32_t op, uint32_t degree, double mid, double rad, double other) {
  fixture_host host;
  fixture_host_open(&host);
  ambit_arithmetic full = fixture_arithmetic();
  fixture_tape *x = fixture_tape_open(&host);
  uint32_t one = fixture_constant(x, other, other), u = fixture_input(x, degree);
  fixture_output(x, fixture_function(x, op, u, one, one));
  ambit_jet *jet = open_jet(&host, &x->tape, &full, 2, 1, NULL);
  double slope = 1, zero = 0;
  service->put(jet, 0, 0, mid, rad, &slope, &zero);
  uint32_t flags = service->advance(jet, 0);
  double value, radius, dmid, drad;
  service->get(jet, x->out[0], 0, &value, &radius, &dmid, &drad);
  assert_false(isnan(value) || isnan(radius) || isnan(dmid) || isnan(drad));
  if (flags == 0 && degree == 0 && fabs(mid) < rad) assert_true(dmid - drad <= -1 || op != AMBIT_OP_ABS);
  fixture_host_close(&host);
  return flags;
}

static void kinks_and_cuts_prove_nothing(void **unused) {
  (void)unused;
  const uint32_t any = AMBIT_DEGREE_ANY, none = AMBIT_F_UNBOUNDED;
  assert_int_equal(flags_of(AMBIT_OP_ABS, any, 1, 0.5, 1), 0);
  assert_int_equal(flags_of(AMBIT_OP_ABS, any, -1, 0.5, 1), 0);
  assert_int_equal(flags_of(AMBIT_OP_ABS, any, 0.5, 0.5, 1), none);
  assert_int_equal(flags_of(AMBIT_OP_ABS, any, 0, 0, 1), none);
  assert_int_equal(flags_of(AMBIT_OP_ABS, 0, 0, 1, 1), 0); /* constant in time: |u| has slopes in [-1, 1] */
  assert_int_equal(flags_of(AMBIT_OP_MIN, any, 1, 0.5, 2), 0);
  assert_int_equal(flags_of(AMBIT_OP_MIN, any, 1, 1, 2), none);
  assert_int_equal(flags_of(AMBIT_OP_MAX, any, 3, 0.5, 2), 0);
  assert_int_equal(flags_of(AMBIT_OP_MAX, any, 2, 0, 2), none);
  assert_int_equal(flags_of(AMBIT_OP_ATAN2, any, 0, 1, 1), 0);
  assert_int_equal(flags_of(AMBIT_OP_ATAN2, any, 2, 1, -1), 0);
  assert_int_equal(flags_of(AMBIT_OP_ATAN2, any, 0, 1, -1), none);
  assert_int_equal(flags_of(AMBIT_OP_ATAN2, 0, 0, 1, -1), none); /* a jump has no slope */
  assert_true(flags_of(AMBIT_OP_LOG, any, 1, 1, 1) & AMBIT_F_PARTIAL);
  assert_true(flags_of(AMBIT_OP_SQRT, any, 1, 2, 1) & AMBIT_F_PARTIAL);
}

/* |p| and min(p, q) of parameters over their kink: values and slopes between any two points */
static void kinks_of_parameters(void **unused) {
  (void)unused;
  uint64_t state = 6;
  ambit_arithmetic full = fixture_arithmetic();
  const uint32_t op[] = { AMBIT_OP_ABS, AMBIT_OP_MIN, AMBIT_OP_MAX };
  for (size_t o = 0; o < 3; o++)
    for (int round = 0; round < 50; round++) {
      fixture_host host;
      fixture_host_open(&host);
      fixture_tape *x = fixture_tape_open(&host);
      uint32_t p = fixture_input(x, 0), q = fixture_input(x, 0);
      fixture_op(x, op[o], p, q);
      fixture_output_all(x);
      scene s = { .x = x, .nin = 2, .K = 1 };
      scene_fill(&s, &state, 0.1, 2);
      trio r = run_trio(&host, &s, &full);
      assert_int_equal(r.flags, 0);
      check_points(&s, &r, &state, op[o]);
      close_trio(&r);
      fixture_host_close(&host);
    }
}

/* -- differential equations */

typedef void (*field)(uint32_t k, real c[][JUDGE_ORDER + 1]);

/* Lorenz, sigma 10, rho 28, beta 8/3: coefficient k + 1 from the Cauchy products, nothing shared with a tape */
static void lorenz(uint32_t k, real c[][JUDGE_ORDER + 1]) {
  real xz = 0, xy = 0;
  for (uint32_t j = 0; j <= k; j++) xz += c[0][j] * c[2][k - j], xy += c[0][j] * c[1][k - j];
  c[0][k + 1] = 10 * (c[1][k] - c[0][k]) / (k + 1);
  c[1][k + 1] = (28 * c[0][k] - xz - c[1][k]) / (k + 1);
  c[2][k + 1] = (xy - 8 * c[2][k] / 3) / (k + 1);
}

/* pendulum q'' = -sin q, by rows 2, 3 for sin q and cos q */
static void pendulum(uint32_t k, real c[][JUDGE_ORDER + 1]) {
  if (k == 0) c[2][0] = sinl(c[0][0]), c[3][0] = cosl(c[0][0]);
  c[0][k + 1] = c[1][k] / (k + 1);
  c[1][k + 1] = -c[2][k] / (k + 1);
  c[2][k + 1] = c[3][k + 1] = 0;
  for (uint32_t j = 1; j <= k + 1; j++) {
    c[2][k + 1] += j * c[0][j] * c[3][k + 1 - j] / (k + 1);
    c[3][k + 1] -= j * c[0][j] * c[2][k + 1 - j] / (k + 1);
  }
}

static void check_solution(fixture_host *host, fixture_tape *x, const ambit_arithmetic *full, void *actx, uint32_t nx,
    const double *start, field f) {
  real c[4][JUDGE_ORDER + 1] = { { 0 } };
  ambit_jet *jet;
  assert_int_equal(service->open(&host->host, &x->tape, full, actx, 20, 0, NULL, &jet), AMBIT_OK);
  for (uint32_t i = 0; i < nx; i++) {
    c[i][0] = start[i];
    service->put(jet, i, 0, start[i], 0, NULL, NULL);
  }
  assert_int_equal(service->solve(jet, nx, 20), 0);
  for (uint32_t k = 0; k < 20; k++) f(k, c);
  for (uint32_t k = 0; k <= 20; k++)
    for (uint32_t i = 0; i < nx; i++) expect_near(jet, x->tape.nconst + i, k, c[i][k], 1e-9);
  service->close(jet);
}

static fixture_tape *lorenz_tape(fixture_host *host) {
  fixture_tape *x = fixture_tape_open(host);
  uint32_t ten = fixture_constant(x, 10, 10), rho = fixture_constant(x, 28, 28);
  uint32_t beta = fixture_constant(x, 0x1.5555555555555p1, 0x1.5555555555556p1);
  uint32_t u = fixture_input(x, AMBIT_DEGREE_ANY), v = fixture_input(x, AMBIT_DEGREE_ANY),
           w = fixture_input(x, AMBIT_DEGREE_ANY);
  fixture_output(x, fixture_op(x, AMBIT_OP_MUL, ten, fixture_op(x, AMBIT_OP_SUB, v, u)));
  uint32_t uw = fixture_op(x, AMBIT_OP_MUL, u, fixture_op(x, AMBIT_OP_SUB, rho, w));
  fixture_output(x, fixture_op(x, AMBIT_OP_SUB, uw, v));
  uint32_t uv = fixture_op(x, AMBIT_OP_MUL, u, v);
  fixture_output(x, fixture_op(x, AMBIT_OP_SUB, uv, fixture_op(x, AMBIT_OP_MUL, beta, w)));
  return x;
}

static fixture_tape *pendulum_tape(fixture_host *host) {
  fixture_tape *x = fixture_tape_open(host);
  uint32_t q = fixture_input(x, AMBIT_DEGREE_ANY), p = fixture_input(x, AMBIT_DEGREE_ANY);
  fixture_output(x, p);
  fixture_output(x, fixture_op(x, AMBIT_OP_NEG, fixture_function(x, AMBIT_OP_SIN, q, q, 0), 0));
  return x;
}

static void differential_equations(void **unused) {
  (void)unused;
  const double from[] = { 15, 15, 36 }, swing[] = { 1.5, 0.25 };
  fixture_host host;
  fixture_host_open(&host);
  ambit_arithmetic full = fixture_arithmetic();
  check_solution(&host, lorenz_tape(&host), &full, NULL, 3, from, lorenz);
  check_solution(&host, pendulum_tape(&host), &full, NULL, 2, swing, pendulum);
  /* an arithmetic with jets of its own that leave the integration to the service */
  ambit_arithmetic own = full;
  ambit_jets plain = ambit_jets_general;
  plain.size = offsetof(ambit_jets, integrate);
  own.jets = &plain;
  ambit_jet_source source = { &full, NULL };
  check_solution(&host, lorenz_tape(&host), &own, &source, 3, from, lorenz);
  check_solution(&host, pendulum_tape(&host), &own, &source, 2, swing, pendulum);
  fixture_host_close(&host);
}

/* -- an arithmetic whose series have negative radii */

static int wrong_direction;

static void negative_get(
    const void *self, uint32_t slot, uint32_t k, double *mid, double *rad, double *dmid, double *drad) {
  ambit_jets_general.get(self, slot, k, mid, rad, dmid, drad);
  if (!wrong_direction) *rad = -0.5;
  if (wrong_direction && drad) drad[0] = -0.25;
}

static void notes_negative_radii(void **unused) {
  (void)unused;
  for (wrong_direction = 0; wrong_direction < 2; wrong_direction++) {
    fixture_host host;
    fixture_host_open(&host);
    ambit_arithmetic full = fixture_arithmetic(), own = full;
    ambit_jets wrong = ambit_jets_general;
    ambit_jet_source source = { &full, NULL };
    ambit_fault fault = { 0 };
    double mid, rad, dmid = 1, drad = 0;
    wrong.get = negative_get;
    own.jets = &wrong, own.fault = &fault, own.rigorous = 1;
    fixture_tape *x = fixture_tape_open(&host);
    uint32_t y = fixture_op(x, AMBIT_OP_SQR, fixture_input(x, AMBIT_DEGREE_ANY), 0);
    fixture_output(x, y);
    ambit_jet *jet;
    assert_int_equal(service->open(&host.host, &x->tape, &own, &source, 1, 1, NULL, &jet), AMBIT_OK);
    service->put(jet, 0, 0, 3, 0, &dmid, &drad);
    assert_int_equal(service->advance(jet, 0), 0);
    assert_int_equal(fault.seen, 0);
    service->get(jet, y, 0, &mid, &rad, &dmid, &drad);
    assert_int_equal(fault.seen, 1);
    assert_int_equal(fault.what, AMBIT_FAULT_SERIES);
    assert_true(fault.hi == (wrong_direction ? -0.25 : -0.5));
    service->close(jet);
    fixture_host_close(&host);
  }
}

/* -- an arithmetic with more than tier 1 */

static int dots, cleared;

static uint32_t box_dot(
    void *ctx, void *dst, const void *a, ptrdiff_t sa, const void *b, ptrdiff_t sb, size_t m, size_t lanes) {
  (void)ctx;
  const ambit_interval *x = a, *y = b;
  for (size_t l = 0; l < lanes; l++) {
    ambit_interval sum = { 0, 0 };
    for (ptrdiff_t j = 0; j < (ptrdiff_t)m; j++)
      sum = ambit_interval_add(sum, ambit_interval_mul(x[j * sa + (ptrdiff_t)l], y[j * sb + (ptrdiff_t)l]));
    ((ambit_interval *)dst)[l] = sum;
  }
  dots++;
  return 0;
}

static void box_clear(void *ctx, void *base, size_t n) {
  (void)ctx, (void)base;
  cleared += (int)n;
}

static int32_t exact_text(void *ctx, void *dst, const char *text) {
  (void)ctx;
  if (strcmp(text, "28") != 0) return 0;
  *(ambit_interval *)dst = (ambit_interval) { 28, 28 };
  return 1;
}

static void products_by_dot(void **unused) {
  (void)unused;
  const double from[] = { 15, 15, 36 };
  fixture_host host;
  fixture_host_open(&host);
  ambit_arithmetic full = fixture_arithmetic();
  full.dot = box_dot, full.clear = box_clear, full.set_text = exact_text;
  fixture_tape *x = lorenz_tape(&host);
  x->lo[1] = 27, x->hi[1] = 29, x->text[1] = "28", x->text[0] = "10"; /* the text is sharper than the bounds */
  dots = cleared = 0;
  check_solution(&host, x, &full, NULL, 3, from, lorenz);
  assert_true(dots > 30 && cleared > 100);
  fixture_host_close(&host);
}

/* -- refusals */

static void refusals(void **unused) {
  (void)unused;
  fixture_host host;
  fixture_host_open(&host);
  ambit_arithmetic full = fixture_arithmetic();
  ambit_jet *jet, *other;
  fixture_tape *x = pendulum_tape(&host), *y = pendulum_tape(&host);
  x->tape.flags = 0;
  assert_int_equal(service->open(&host.host, &x->tape, &full, NULL, 4, 0, NULL, &jet), AMBIT_INVALID);
  assert_null(jet);
  x->tape.flags = AMBIT_TAPE_SERIES;
  x->op[0] = AMBIT_OP_TAN;
  assert_int_equal(service->open(&host.host, &x->tape, &full, NULL, 4, 0, NULL, &jet), AMBIT_INVALID);
  x->op[0] = AMBIT_OP_SIN;
  x->aux[0] = AMBIT_NO_SLOT;
  assert_int_equal(service->open(&host.host, &x->tape, &full, NULL, 4, 0, NULL, &jet), AMBIT_INVALID);
  other = open_jet(&host, &y->tape, &full, 3, 0, NULL);
  assert_int_equal(
      service->open(&host.host, &y->tape, &full, NULL, 4, 1, other, &jet), AMBIT_INVALID); /* order too low */
  assert_non_null(strstr(host.message, "to order 4"));
  full.jets = &(const ambit_jets) { .size = sizeof(ambit_jets), .open = ambit_jets_general.open };
  assert_int_equal(service->open(&host.host, &y->tape, &full, NULL, 4, 0, NULL, &jet), AMBIT_INVALID);
  fixture_host_close(&host);
}

/* An input that the tape takes for constant must not move; what is no number claims nothing. */
static void bad_coefficients_prove_nothing(void **unused) {
  (void)unused;
  fixture_host host;
  fixture_host_open(&host);
  ambit_arithmetic full = fixture_arithmetic();
  fixture_tape *x = fixture_tape_open(&host);
  uint32_t u = fixture_input(x, AMBIT_DEGREE_ANY), p = fixture_input(x, 0);
  uint32_t y = fixture_op(x, AMBIT_OP_MUL, u, p);
  fixture_output(x, y);
  ambit_jet *jet = open_jet(&host, &x->tape, &full, 3, 0, NULL);
  service->put(jet, 0, 0, 1, 0, NULL, NULL), service->put(jet, 1, 0, 2, 0, NULL, NULL);
  service->put(jet, 1, 1, 0, 0, NULL, NULL);
  assert_int_equal(service->advance(jet, 0), 0);
  service->put(jet, 1, 1, 0.5, 0, NULL, NULL);
  assert_true(service->advance(jet, 1) & AMBIT_F_UNBOUNDED);
  jet = open_jet(&host, &x->tape, &full, 3, 0, NULL);
  service->put(jet, 0, 0, NAN, 0, NULL, NULL), service->put(jet, 1, 0, 2, 0, NULL, NULL);
  assert_true(service->advance(jet, 0) & AMBIT_F_UNBOUNDED);
  double mid, rad;
  service->get(jet, y, 0, &mid, &rad, NULL, NULL);
  assert_true(!isnan(mid) && rad == INFINITY);
  fixture_host_close(&host);
}

/* 1/u at an infinite u is not 0. */
static void infinite_coefficients_prove_nothing(void **unused) {
  (void)unused;
  fixture_host host;
  fixture_host_open(&host);
  ambit_arithmetic full = fixture_arithmetic();
  fixture_tape *x = fixture_tape_open(&host);
  uint32_t one = fixture_constant(x, 1, 1), u = fixture_input(x, AMBIT_DEGREE_ANY);
  uint32_t y = fixture_op(x, AMBIT_OP_DIV, one, u);
  fixture_output(x, y);
  const double far[] = { INFINITY, -INFINITY }, radius[] = { 0, 1 };
  for (size_t i = 0; i < 4; i++) {
    ambit_jet *jet = open_jet(&host, &x->tape, &full, 3, 0, NULL);
    double mid, rad;
    service->put(jet, 0, 0, far[i % 2], radius[i / 2], NULL, NULL);
    assert_true(service->advance(jet, 0) & AMBIT_F_UNBOUNDED);
    service->get(jet, y, 0, &mid, &rad, NULL, NULL);
    assert_true(isfinite(mid) && rad == INFINITY);
  }
  fixture_host_close(&host);
}

static bool is_known(ambit_jet *jet, uint32_t K) {
  double tail[8]; /* more than any tape here has outputs */
  return service->tail(jet, K, 0.5, NULL, NULL, tail, NULL) == AMBIT_OK;
}

/* An order needs those below it, and of slopes the centre's. */
/* mid +- rad as it is put, though neither end is a double (all sums here are exact in long double) */
static void coefficients_are_held_as_they_are_put(void **unused) {
  (void)unused;
  fixture_host host;
  fixture_host_open(&host);
  ambit_arithmetic full = fixture_arithmetic();
  fixture_tape *x = fixture_tape_open(&host);
  uint32_t one = fixture_constant(x, 1, 1), in = fixture_input(x, AMBIT_DEGREE_ANY);
  fixture_op(x, AMBIT_OP_ADD, in, one);
  ambit_jet *jet = open_jet(&host, &x->tape, &full, 0, 1, NULL);
  for (int k = 1; k < 200; k++) {
    double mid = (k % 2 ? 1 : -1) * (1 + k * 0x1p-52), rad = k * 0x1p-60, found, width, slope, margin;
    service->put(jet, 0, 0, mid, rad, &mid, &rad);
    assert_int_equal(service->advance(jet, 0), 0);
    service->get(jet, in, 0, &found, &width, &slope, &margin);
    assert_true((long double)mid + rad <= (long double)found + width);
    assert_true((long double)mid - rad >= (long double)found - width);
    assert_true((long double)mid + rad <= (long double)slope + margin);
    assert_true((long double)mid - rad >= (long double)slope - margin);
  }
  fixture_host_close(&host);
}

static void orders_ascend(void **unused) {
  (void)unused;
  fixture_host host;
  fixture_host_open(&host);
  ambit_arithmetic full = fixture_arithmetic();
  fixture_tape *x = pendulum_tape(&host);
  ambit_jet *jet = open_jet(&host, &x->tape, &full, 3, 0, NULL), *box = open_jet(&host, &x->tape, &full, 3, 1, jet);
  for (uint32_t i = 0; i < 2; i++) service->put(jet, i, 0, 1, 0, NULL, NULL), service->put(box, i, 0, 1, 0, NULL, NULL);
  assert_int_equal(service->advance(jet, 1), AMBIT_F_UNBOUNDED);
  assert_false(is_known(jet, 1) || is_known(jet, 0));
  assert_int_equal(service->advance(box, 0), AMBIT_F_UNBOUNDED); /* the centre has nothing yet */
  assert_false(is_known(box, 0));
  for (uint32_t k = 0; k <= 3; k++) assert_int_equal(service->advance(jet, k), 0);
  assert_int_equal(service->advance(jet, 4), AMBIT_F_UNBOUNDED); /* beyond the order */
  service->put(jet, 0, 4, 1, 0, NULL, NULL);
  assert_true(is_known(jet, 3));
  for (uint32_t k = 0; k < 2; k++) assert_int_equal(service->advance(box, k), 0);
  service->put(jet, 0, 1, 0.5, 0, NULL, NULL); /* orders from 1 on are void */
  assert_int_equal(service->advance(jet, 2), AMBIT_F_UNBOUNDED);
  assert_int_equal(service->advance(box, 2), AMBIT_F_UNBOUNDED);
  assert_true(is_known(box, 1) && !is_known(box, 2) && is_known(jet, 0) && !is_known(jet, 1));
  for (uint32_t k = 1; k <= 3; k++) assert_int_equal(service->advance(jet, k) | service->advance(box, k - 1), 0);
  fixture_host_close(&host);
}

/* sqrt u is not defined at the centre -1: there are no slopes about it. */
static void a_centre_outside_the_domain_proves_nothing(void **unused) {
  (void)unused;
  fixture_host host;
  fixture_host_open(&host);
  ambit_arithmetic full = fixture_arithmetic();
  fixture_tape *x = fixture_tape_open(&host);
  uint32_t u = fixture_input(x, AMBIT_DEGREE_ANY);
  fixture_output(x, fixture_op(x, AMBIT_OP_SQRT, u, u));
  ambit_jet *centre = open_jet(&host, &x->tape, &full, 1, 0, NULL),
            *box = open_jet(&host, &x->tape, &full, 1, 1, centre);
  const double one = 1, none = 0;
  service->put(centre, 0, 0, 0, 1, NULL, NULL), service->put(box, 0, 0, 2, 0.5, &one, &none);
  assert_true(service->advance(centre, 0) & AMBIT_F_PARTIAL);
  assert_true(service->advance(box, 0) & AMBIT_F_UNBOUNDED);
  fixture_host_close(&host);
}

/* -- an arithmetic without rigour, whose bounds cross by rounding */

static uint32_t crossed_log(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,
    size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  (void)self, (void)ctx, (void)b, (void)lanes;
  ambit_interval *x = base;
  for (size_t i = 0; i < count; i++) {
    double y = log(x[a[i] * pitch].lo);
    x[dst[i] * pitch] = (ambit_interval) { nextafter(y, INFINITY), y };
  }
  return 0;
}

static void crossed_bounds_leave_slopes(void **unused) {
  (void)unused;
  fixture_host host;
  fixture_host_open(&host);
  ambit_arithmetic full = fixture_arithmetic();
  full.rigorous = 0, full.run[AMBIT_OP_LOG] = crossed_log;
  fixture_tape *x = fixture_tape_open(&host);
  uint32_t u = fixture_input(x, AMBIT_DEGREE_ANY), l = fixture_op(x, AMBIT_OP_LOG, u, u);
  uint32_t y = fixture_function(x, AMBIT_OP_EXP, l, l, 0);
  fixture_output(x, y);
  ambit_jet *centre = open_jet(&host, &x->tape, &full, 1, 0, NULL),
            *jet = open_jet(&host, &x->tape, &full, 1, 1, centre);
  const double one = 1, none = 0;
  double mid, rad, dmid, drad;
  full.run[AMBIT_OP_LOG] = fixture_arithmetic().run[AMBIT_OP_LOG];
  service->put(centre, 0, 0, 3, 0, NULL, NULL), service->put(jet, 0, 0, 3, 0, &one, &none);
  service->advance(centre, 0);
  full.run[AMBIT_OP_LOG] = crossed_log;
  service->advance(jet, 0);
  service->get(jet, y, 0, &mid, &rad, &dmid, &drad);
  assert_true(fabs(dmid - 1) < 1e-14 && drad < 1e-14); /* exp log u = u */
  fixture_host_close(&host);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(closed_forms),
    cmocka_unit_test(every_operation_over_boxes),
    cmocka_unit_test(random_programs_over_boxes),
    cmocka_unit_test(slopes_are_tighter_than_derivatives),
    cmocka_unit_test(kinks_and_cuts_prove_nothing),
    cmocka_unit_test(kinks_of_parameters),
    cmocka_unit_test(notes_negative_radii),
    cmocka_unit_test(differential_equations),
    cmocka_unit_test(products_by_dot),
    cmocka_unit_test(refusals),
    cmocka_unit_test(bad_coefficients_prove_nothing),
    cmocka_unit_test(infinite_coefficients_prove_nothing),
    cmocka_unit_test(coefficients_are_held_as_they_are_put),
    cmocka_unit_test(orders_ascend),
    cmocka_unit_test(a_centre_outside_the_domain_proves_nothing),
    cmocka_unit_test(crossed_bounds_leave_slopes),
  };
  return cmocka_run_group_tests_name("jet", tests, NULL, NULL);
}
