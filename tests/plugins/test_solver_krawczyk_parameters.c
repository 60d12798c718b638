/* The root finder with wide parameters: for every sampled value of them, the roots by closed form are in the boxes, and
** as many boxes are proved as there are branches; folds, roots that leave the box, tight hulls. */
#include "roots_case.h"

#define SAMPLES 300

static roots_case open_case;

static int set_up(void **state) {
  open_case = roots_open();
  *state = &open_case;
  return 0;
}

static int tear_down(void **state) {
  roots_close(*state);
  return 0;
}

static ambit_expr datum(roots_case *c, const char *name, double lo, double hi) {
  return ambit_graph_unknown(c->graph, name, (ambit_interval) { lo, hi });
}

static found *run_with(roots_case *c, uint32_t n, const ambit_expr *f, const ambit_interval *box, const char *pieces) {
  const ambit_option option[] = { { "parameter_pieces", pieces }, { "boxes_max", "60000" } };
  found *r = calloc(1, sizeof *r);
  if (roots_run(c, n, f, box, NULL, 2, option, r) != AMBIT_OK) fail_msg("%s", r->failure.message);
  return r;
}

/* boxes of the kind that come as near to the point as a closed form is right */
static uint32_t near(const found *r, uint32_t kind, const double *at) {
  uint32_t holding = 0;
  for (uint32_t i = 0; i < r->count; i++) {
    bool inside = r->kind[i] == kind;
    for (uint32_t j = 0; j < r->n; j++)
      inside = inside && r->box[i][j].lo <= at[j] + 1e-11 && r->box[i][j].hi >= at[j] - 1e-11;
    holding += inside;
  }
  return holding;
}

static void branches_are_reported_once(void **state) {
  roots_case *c = *state;
  for (int round = 0; round < 40; round++) {
    double lo = between(0.5, 3), hi = lo * between(1.5, 60);
    ambit_expr f = subtract(c, apply(c, AMBIT_OP_SQR, c->x[0]), datum(c, "p", lo, hi));
    const ambit_interval box = { -1.5 * sqrt(hi), 1.4 * sqrt(hi) };
    found *r = run_with(c, 1, &f, &box, "0");
    if (r->result.proved != 2 || r->result.undecided || r->result.partly)
      fail_msg("p in [%g, %g]: %u proved, %u partly, %u undecided", lo, hi, r->result.proved, r->result.partly,
          r->result.undecided);
    for (uint32_t i = 0; i < 2; i++) { /* the hull of the branch is +-[sqrt lo, sqrt hi], closely */
      double low = fmin(fabs(r->box[i][0].lo), fabs(r->box[i][0].hi)),
             high = fmax(fabs(r->box[i][0].lo), fabs(r->box[i][0].hi)), width = sqrt(hi) - sqrt(lo);
      assert_true(low <= sqrt(lo) * (1 + 1e-15) && low >= sqrt(lo) - 0.05 * width);
      assert_true(high >= sqrt(hi) * (1 - 1e-15) && high <= sqrt(hi) + 0.05 * width);
    }
    free(r);
  }
}

/* x^3 - 3 x = p: three roots for |p| < 2, one for |p| > 2: two folds */
static void folds_are_left_undecided(void **state) {
  roots_case *c = *state;
  ambit_expr x = c->x[0], cube = multiply(c, apply(c, AMBIT_OP_SQR, x), x);
  ambit_expr f = subtract(c, subtract(c, cube, multiply(c, number(c, 3), x)), datum(c, "p", -3, 3));
  const ambit_interval box = { -5, 5 };
  const double fold[2] = { -1, 1 };
  found *r = run_with(c, 1, &f, &box, "0");
  assert_int_equal(r->result.status, AMBIT_UNABLE);
  assert_int_equal(r->result.proved, 0);
  assert_int_equal(r->result.partly, 3);
  assert_int_equal(r->result.undecided, 2);
  for (int k = 0; k < 2; k++) assert_true(found_holding(r, AMBIT_ROOT_UNDECIDED, &fold[k]) == 1);
  for (int s = 0; s < SAMPLES; s++) { /* every root for every p is somewhere */
    double at = between(-2.1, 2.1), p = at * at * at - 3 * at;
    if (fabs(p) > 3) continue;
    assert_true(near(r, AMBIT_ROOT_PARTLY, &at) + near(r, AMBIT_ROOT_UNDECIDED, &at) > 0);
  }
  for (uint32_t i = 0; i < r->count; i++)
    if (r->kind[i] == AMBIT_ROOT_UNDECIDED) assert_true(ambit_interval_width(r->box[i][0]) < 0.3);
  free(r);
}

/* two parameters, two unknowns: x^2 + y^2 = p, y = q x: x = +-sqrt(p / (1 + q^2)) */
static void two_wide_parameters(void **state) {
  roots_case *c = *state;
  ambit_expr p = datum(c, "p", 1, 2), q = datum(c, "q", 1, 3), x = c->x[0], y = c->x[1];
  ambit_expr f[2] = { subtract(c, add(c, apply(c, AMBIT_OP_SQR, x), apply(c, AMBIT_OP_SQR, y)), p),
    subtract(c, multiply(c, q, x), y) };
  const ambit_interval box[2] = { { -5, 5 }, { -5, 5 } };
  static const char *const pieces[] = { "0", "1024" };
  for (int k = 0; k < 2; k++) {
    found *r = run_with(c, 2, f, box, pieces[k]);
    if (r->result.proved != 2 || r->result.undecided) fail_msg("%u proved: %s", r->result.proved, r->result.reason);
    for (int s = 0; s < SAMPLES; s++) {
      double u = between(1, 2), v = between(1, 3), at[2] = { sqrt(u / (1 + v * v)), v * sqrt(u / (1 + v * v)) };
      assert_true(near(r, AMBIT_ROOT_UNIQUE, at) == 1);
      at[0] = -at[0], at[1] = -at[1];
      assert_true(near(r, AMBIT_ROOT_UNIQUE, at) == 1);
      at[0] -= 1; /* the comparison sees what is none */
      assert_true(near(r, AMBIT_ROOT_UNIQUE, at) == 0);
    }
    free(r);
  }
}

/* two branches whose hulls overlap, though they never meet: x = p -+ 1/8 */
static void overlapping_hulls_stay_apart(void **state) {
  roots_case *c = *state;
  ambit_expr d = subtract(c, c->x[0], datum(c, "p", -1, 1));
  ambit_expr f = less(c, apply(c, AMBIT_OP_SQR, d), 0.015625);
  const ambit_interval box = { -3, 3 };
  found *r = run_with(c, 1, &f, &box, "0");
  if (r->result.proved != 2 || r->result.undecided) fail_msg("%u proved: %s", r->result.proved, r->result.reason);
  for (uint32_t i = 0; i < 2; i++) {
    double middle = ambit_interval_mid(r->box[i][0]);
    assert_true(fabs(fabs(middle) - 0.125) < 1e-3 && ambit_interval_width(r->box[i][0]) < 2.05);
  }
  free(r);
}

/* the root x = p leaves the box as p grows: a root for a part of the parameters, all decided */
static void roots_that_leave_are_partly_there(void **state) {
  roots_case *c = *state;
  ambit_expr x = c->x[0], p = datum(c, "p", 0, 8);
  ambit_expr f = subtract(c, add(c, x, multiply(c, number(c, 0.01), apply(c, AMBIT_OP_EXP, x))), p);
  const ambit_interval box = { 0.5, 2 };
  found *r = run_with(c, 1, &f, &box, "0");
  assert_true(r->result.proved + r->result.partly == 1 && r->result.undecided == 0);
  assert_int_equal(r->result.status, AMBIT_OK);
  assert_true(r->box[0][0].lo <= 0.5 && r->box[0][0].hi >= 2);
  free(r);
}

/* pieces = 1: nothing is cut, as before there was this option */
static void pieces_can_be_forbidden(void **state) {
  roots_case *c = *state;
  ambit_expr f = subtract(c, apply(c, AMBIT_OP_SQR, c->x[0]), datum(c, "p", 4, 100));
  const ambit_interval box = { -20, 20 };
  found *r = run_with(c, 1, &f, &box, "1");
  assert_true(r->result.proved == 0 && r->result.status == AMBIT_UNABLE && r->result.boxes < 5000);
  const double at[2] = { 3, -7 };
  for (int i = 0; i < 2; i++) assert_true(found_holding(r, AMBIT_ROOT_UNDECIDED, &at[i]) > 0);
  assert_non_null(strstr(r->result.reason, "parameter_pieces"));
  free(r);
}

/* g(x) = g(r(p)) with g random and r(p) = a + b p + c p^2 known: r(p) is a root for each p, whatever else is */
static ambit_expr mixed(roots_case *c, const double *g, const ambit_expr *x, uint32_t n, uint32_t i) {
  ambit_expr sum = multiply(c, number(c, g[0]), apply(c, AMBIT_OP_SQR, x[i]));
  sum = add(c, sum, multiply(c, number(c, g[1]), x[i]));
  sum = add(c, sum, multiply(c, number(c, g[2]), apply(c, AMBIT_OP_SIN, x[(i + 1) % n])));
  return add(c, sum, multiply(c, number(c, g[3]), multiply(c, x[i], x[(i + 1) % n])));
}

static void planted_branches_are_never_lost(void **state) {
  roots_case *c = *state;
  uint32_t proved = 0;
  for (int round = 0; round < 40; round++) {
    uint32_t n = 1 + (uint32_t)choose(3);
    double a[3], b[3], e[3], width = between(0.05, 1);
    ambit_expr p = datum(c, "p", -width, width), r[3], f[3];
    ambit_interval box[3];
    for (uint32_t i = 0; i < n; i++) {
      a[i] = floor(between(-16, 16)) / 8, b[i] = floor(between(-8, 8)) / 8, e[i] = floor(between(-4, 4)) / 8;
      r[i] = add(c, number(c, a[i]),
          add(c, multiply(c, number(c, b[i]), p), multiply(c, number(c, e[i]), apply(c, AMBIT_OP_SQR, p))));
      box[i] = (ambit_interval) { a[i] - 2, a[i] + 1.7 };
    }
    for (uint32_t i = 0; i < n; i++) {
      const double g[4] = { choose(5) / 4.0, 1 + choose(5) / 4.0, choose(3) / 4.0, choose(3) / 8.0 };
      f[i] = subtract(c, mixed(c, g, c->x, n, i), mixed(c, g, r, n, i));
    }
    const ambit_option option[] = { { "boxes_max", "1500" } };
    found *got = calloc(1, sizeof *got);
    if (roots_run(c, n, f, box, NULL, 1, option, got) != AMBIT_OK) fail_msg("%s", got->failure.message);
    proved += got->result.proved + got->result.partly;
    for (int s = 0; s < SAMPLES; s++) {
      double at[3], u = between(-width, width);
      bool inside = true;
      for (uint32_t i = 0; i < n; i++) {
        at[i] = a[i] + b[i] * u + e[i] * u * u;
        inside = inside && ambit_interval_contains(box[i], at[i]);
      }
      if (!inside) continue;
      uint32_t met = 0;
      for (uint32_t kind = 0; kind <= AMBIT_ROOT_PARTLY; kind++) met += near(got, kind, at);
      if (!met) fail_msg("round %d: a root of %u equations is lost at p = %g", round, n, u);
    }
    free(got);
  }
  assert_true(proved > 30);
}

/* a kink or a jump in a parameter does not keep f from being smooth in x */
static void kinks_in_parameters_do_no_harm(void **state) {
  roots_case *c = *state;
  ambit_expr x = c->x[0], p = datum(c, "p", -0.3, 1), size = apply(c, AMBIT_OP_ABS, p);
  ambit_expr f = subtract(c, apply(c, AMBIT_OP_SQR, x), add(c, number(c, 1), size)); /* x^2 = 1 + |p| */
  const ambit_interval box = { -3, 3 };
  found *r = run_with(c, 1, &f, &box, "0");
  if (r->result.proved != 2 || r->result.undecided) fail_msg("%u proved: %s", r->result.proved, r->result.reason);
  for (int s = 0; s < SAMPLES; s++) {
    double at = sqrt(1 + fabs(between(-0.3, 1)));
    assert_true(near(r, AMBIT_ROOT_UNIQUE, &at) == 1);
  }
  assert_true(ambit_interval_width(r->box[0][0]) < 0.5);
  free(r);
  /* the angle of (-1, q) jumps by 2 pi at q = 0: x = angle has two branches then, both of which are in the boxes */
  ambit_expr angle = ambit_graph_op(c->graph, AMBIT_OP_ATAN2, datum(c, "q", -0.5, 0.25), number(c, -1));
  f = subtract(c, x, multiply(c, number(c, 0.25), angle));
  r = run_with(c, 1, &f, &box, "0");
  for (int s = 0; s < SAMPLES; s++) {
    double at = 0.25 * atan2(between(-0.5, 0.25), -1);
    assert_true(
        near(r, AMBIT_ROOT_UNIQUE, &at) + near(r, AMBIT_ROOT_PARTLY, &at) + near(r, AMBIT_ROOT_UNDECIDED, &at) > 0);
  }
  free(r);
}

static void runs_repeat(void **state) {
  roots_case *c = *state;
  ambit_expr f = subtract(c, apply(c, AMBIT_OP_SQR, c->x[0]), datum(c, "p", 1, 30));
  const ambit_interval box = { -9, 8 };
  found *r[2];
  for (int i = 0; i < 2; i++) r[i] = run_with(c, 1, &f, &box, "0");
  assert_memory_equal(r[0]->box, r[1]->box, sizeof r[0]->box);
  assert_int_equal(r[0]->first_count, r[0]->last_count);
  for (int i = 0; i < 2; i++) free(r[i]);
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(branches_are_reported_once),
    cmocka_unit_test(folds_are_left_undecided), cmocka_unit_test(two_wide_parameters),
    cmocka_unit_test(overlapping_hulls_stay_apart), cmocka_unit_test(roots_that_leave_are_partly_there),
    cmocka_unit_test(pieces_can_be_forbidden), cmocka_unit_test(planted_branches_are_never_lost),
    cmocka_unit_test(kinks_in_parameters_do_no_harm), cmocka_unit_test(runs_repeat) };
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
