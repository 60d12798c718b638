/* The root finder: systems whose roots are known exactly, none of which is ever lost; statements of uniqueness that are
** false nowhere; parameters; edges, singular and unbounded cases; what a host relies on. */
#include "roots_case.h"

#define PLANTED 300
#define SAMPLES 200

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

static void assert_counts(const found *r, uint32_t proved, uint32_t undecided) {
  if (r->result.proved != proved || r->result.undecided != undecided)
    fail_msg("%u proved, %u undecided (%s)", r->result.proved, r->result.undecided, r->result.reason);
  assert_int_equal(r->result.status, undecided ? AMBIT_UNABLE : AMBIT_OK);
  assert_true(undecided == 0 || strlen(r->result.reason) > 20);
}

/* -- one unknown: polynomials with integer roots */

static void integer_roots_are_counted(void **state) {
  roots_case *c = *state;
  for (int round = 0; round < PLANTED; round++) {
    bool taken[21] = { false };
    ambit_expr f = number(c, 1);
    int n = 1 + choose(6);
    for (int i = 0; i < n; i++) {
      int r = choose(21);
      if (taken[r]) continue;
      taken[r] = true;
      f = multiply(c, f, less(c, c->x[0], r - 10));
    }
    if (choose(2)) f = ambit_graph_simplify(c->graph, f, 100);
    const ambit_interval box = { -between(0, 20), between(0, 20) };
    found *r = roots_find(c, 1, &f, &box);
    uint32_t inside = 0, edge = 0;
    for (int k = 0; k < 21; k++) {
      double at = k - 10;
      if (!taken[k]) continue;
      uint32_t holding = found_holding(r, AMBIT_ROOT_UNIQUE, &at);
      inside += ambit_interval_contains(box, at);
      edge += !ambit_interval_contains(box, at) && holding;
      if (ambit_interval_contains(box, at) && holding != 1) fail_msg("root %g is in %u boxes", at, holding);
    }
    assert_counts(r, inside + edge, 0);
    free(r);
  }
}

/* -- several: roots planted in sums of terms that vanish exactly there */

/* a term in x_j that is exactly 0 at r */
static ambit_expr vanishing(roots_case *c, ambit_expr x, double r) {
  ambit_expr d = less(c, x, r);
  switch (choose(7)) {
  case 0: return apply(c, AMBIT_OP_SIN, d);
  case 1: return less(c, apply(c, AMBIT_OP_EXP, d), 1);
  case 2: return multiply(c, d, add(c, x, number(c, 3)));
  case 3: return apply(c, AMBIT_OP_ATAN, d);
  case 4: return multiply(c, d, apply(c, AMBIT_OP_COS, x));
  case 5: return multiply(c, d, apply(c, AMBIT_OP_SQR, x));
  default: return d;
  }
}

static void planted_roots_are_never_lost(void **state) {
  roots_case *c = *state;
  uint32_t proved = 0;
  for (int round = 0; round < PLANTED; round++) {
    uint32_t n = 1 + (uint32_t)choose(4);
    double root[ROOTS_UNKNOWNS];
    ambit_expr f[ROOTS_UNKNOWNS];
    ambit_interval box[ROOTS_UNKNOWNS];
    for (uint32_t i = 0; i < n; i++) root[i] = floor(between(-16, 16)) / 8;
    for (uint32_t i = 0; i < n; i++) {
      f[i] = number(c, 0);
      for (uint32_t j = 0; j < n; j++) {
        double factor = floor(between(1, 9)) * (j == i || choose(2) ? 1 : -1); /* terms in x_i never cancel to 0 */
        ambit_expr term = vanishing(c, c->x[j], root[j]);
        if (j == i || choose(2)) f[i] = add(c, f[i], multiply(c, number(c, factor), term));
      }
      f[i] = add(c, f[i], vanishing(c, c->x[i], root[i]));
      double l = choose(4) ? between(0, 2) : 0, r = choose(4) ? between(0, 2) : 0; /* sometimes on the edge */
      box[i] = (ambit_interval) { root[i] - l, root[i] + r };
    }
    const ambit_option few[] = { { "boxes_max", "500" }, { "undecided_max", "50" } };
    found *r = calloc(1, sizeof *r);
    if (roots_run(c, n, f, box, NULL, 2, few, r) != AMBIT_OK) fail_msg("%s", r->failure.message);
    uint32_t unique = found_holding(r, AMBIT_ROOT_UNIQUE, root), other = found_holding(r, AMBIT_ROOT_UNDECIDED, root);
    if (unique + other == 0) fail_msg("round %d: a root of %u equations is lost", round, n);
    if (unique > 1) fail_msg("round %d: a root is in %u proved boxes", round, unique);
    proved += unique;
    free(r);
  }
  assert_true(proved > PLANTED * 9 / 10);
}

/* -- sign changes of one function, by sampling */

static double wave(const double *a, double x) {
  return a[0] * sin(x) + a[1] * cos(2 * x) + a[2] * sin(3 * x + 1) + a[3];
}

static ambit_expr wave_expression(roots_case *c, const double *a) {
  ambit_expr x = c->x[0], two = multiply(c, number(c, 2), x), three = multiply(c, number(c, 3), x);
  ambit_expr sum = multiply(c, number(c, a[0]), apply(c, AMBIT_OP_SIN, x));
  sum = add(c, sum, multiply(c, number(c, a[1]), apply(c, AMBIT_OP_COS, two)));
  sum = add(c, sum, multiply(c, number(c, a[2]), apply(c, AMBIT_OP_SIN, add(c, three, number(c, 1)))));
  return add(c, sum, number(c, a[3]));
}

static void sign_changes_are_roots(void **state) {
  roots_case *c = *state;
  const ambit_interval box = { -5, 5 };
  for (int round = 0; round < 100; round++) {
    double a[4] = { between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1) };
    ambit_expr f = wave_expression(c, a);
    found *r = roots_find(c, 1, &f, &box);
    uint32_t changes = 0;
    double step = 10.0 / 4096;
    for (int i = 0; i < 4096; i++) {
      double from = -5 + i * step, to = from + step;
      if (wave(a, from) * wave(a, to) >= 0) continue;
      changes++;
      bool met = false;
      for (uint32_t k = 0; k < r->count; k++) met = met || (r->box[k][0].lo <= to && r->box[k][0].hi >= from);
      if (!met) fail_msg("no box between %g and %g", from, to);
    }
    for (uint32_t k = 0; k < r->count; k++) { /* a proved root changes the sign */
      ambit_interval x = r->box[k][0];
      if (r->kind[k] == AMBIT_ROOT_UNIQUE && wave(a, x.lo - 1e-6) * wave(a, x.hi + 1e-6) > 0)
        fail_msg("no change of sign at %.17g", x.lo);
    }
    assert_true(r->result.proved + r->result.undecided >= changes);
    if (r->result.status == AMBIT_OK) assert_true(r->result.proved >= changes);
    free(r);
  }
}

/* -- parameters: for each of their values the root is in the box */

static void parametric_roots_hold_for_every_value(void **state) {
  roots_case *c = *state;
  ambit_graph *g = c->graph;
  uint32_t proved = 0;
  for (int round = 0; round < 60; round++) {
    double l1 = between(0.8, 1.2), l2 = between(0.6, 1.4), w = between(1e-6, 0.02), px = between(0.3, 1.2);
    ambit_expr a = c->x[0], b = add(c, c->x[0], c->x[1]);
    ambit_expr p = ambit_graph_unknown(g, "p", (ambit_interval) { l1 - w, l1 + w }),
               q = ambit_graph_unknown(g, "q", (ambit_interval) { l2 - w, l2 + w });
    ambit_expr f[2] = {
      less(c, add(c, multiply(c, p, apply(c, AMBIT_OP_COS, a)), multiply(c, q, apply(c, AMBIT_OP_COS, b))), px),
      less(c, add(c, multiply(c, p, apply(c, AMBIT_OP_SIN, a)), multiply(c, q, apply(c, AMBIT_OP_SIN, b))), 0.5)
    };
    const ambit_interval box[2] = { { -3.15, 3.15 }, { -3.15, 3.15 } };
    const ambit_option few[] = { { "boxes_max", "1000" } };
    found *r = calloc(1, sizeof *r);
    if (roots_run(c, 2, f, box, NULL, 1, few, r) != AMBIT_OK) fail_msg("%s", r->failure.message);
    proved += r->result.proved;
    for (int s = 0; s < SAMPLES; s++) {
      double u = between(l1 - w, l1 + w), v = between(l2 - w, l2 + w);
      double cosine = (px * px + 0.25 - u * u - v * v) / (2 * u * v);
      if (fabs(cosine) > 1) continue;
      for (int sign = -1; sign <= 1; sign += 2) {
        double second = sign * acos(cosine);
        double at[2] = { atan2(0.5, px) - atan2(v * sin(second), u + v * cos(second)), second };
        bool met = false;
        for (uint32_t k = 0; k < r->count; k++) {
          bool near = true; /* as far as the closed form itself is right */
          for (int i = 0; i < 2; i++)
            near = near && r->box[k][i].lo <= at[i] + 1e-12 && at[i] <= r->box[k][i].hi + 1e-12;
          met = met || near;
        }
        if (!met && fabs(at[0]) < 3.1)
          fail_msg("round %d: root (%g, %g) of p = %g, q = %g is lost", round, at[0], at[1], u, v);
      }
    }
    free(r);
  }
  assert_true(proved > 60);
}

/* -- cases */

static void circle_and_line(void **state) {
  roots_case *c = *state;
  ambit_expr x = c->x[0], y = c->x[1];
  ambit_expr f[2] = { less(c, add(c, apply(c, AMBIT_OP_SQR, x), apply(c, AMBIT_OP_SQR, y)), 1), subtract(c, x, y) };
  const ambit_interval box[2] = { { -INFINITY, INFINITY }, { -INFINITY, INFINITY } };
  found *r = roots_find(c, 2, f, box);
  assert_counts(r, 2, 0);
  for (uint32_t k = 0; k < 2; k++)
    for (int i = 0; i < 2; i++) {
      assert_true(ambit_interval_width(r->box[k][i]) < 1e-15);
      assert_true(fabs(fabs(r->box[k][i].lo) - sqrt(0.5)) < 1e-15);
    }
  free(r);
}

/* every root is on an edge of the searched box, or outside it by less than a rounding */
static void roots_on_the_edge(void **state) {
  roots_case *c = *state;
  ambit_expr x = c->x[0], f = multiply(c, x, less(c, x, 1));
  const ambit_interval whole = { 0, 1 }, left = { -3, 0 }, beside = { 1e-9, 0.999 };
  found *r = roots_find(c, 1, &f, &whole);
  assert_counts(r, 2, 0);
  free(r);
  r = roots_find(c, 1, &f, &left);
  assert_counts(r, 1, 0);
  assert_true(r->box[0][0].lo <= 0 && r->box[0][0].hi >= 0 && r->box[0][0].hi < 1e-15);
  free(r);
  r = roots_find(c, 1, &f, &beside);
  assert_counts(r, 0, 0);
  free(r);
}

static void undecidable_is_said_so(void **state) {
  roots_case *c = *state;
  ambit_expr x = c->x[0], y = c->x[1];
  const ambit_interval box[2] = { { -2, 3 }, { -2, 3 } };
  const double one = 1;
  ambit_expr twice = ambit_graph_simplify(c->graph, apply(c, AMBIT_OP_SQR, less(c, x, 1)), 10);
  found *r = roots_find(c, 1, &twice, box);
  assert_true(r->result.proved == 0 && r->result.status == AMBIT_UNABLE && r->count > 0);
  assert_true(found_holding(r, AMBIT_ROOT_UNDECIDED, &one) > 0);
  free(r);
  ambit_expr same[2] = { add(c, x, y), add(c, multiply(c, number(c, 2), x), multiply(c, number(c, 2), y)) };
  const ambit_option few[] = { { "boxes_max", "500" } };
  r = calloc(1, sizeof *r);
  assert_int_equal(roots_run(c, 2, same, box, NULL, 1, few, r), AMBIT_OK);
  assert_true(r->result.status == AMBIT_UNABLE && r->result.proved == 0 && strstr(r->result.reason, "boxes_max"));
  for (int i = 0; i < 100; i++) { /* the line is covered */
    double at[2] = { between(-2, 2), 0 };
    at[1] = -at[0];
    assert_true(found_holding(r, AMBIT_ROOT_UNDECIDED, at) > 0);
  }
  free(r);
}

static void domains_are_kept(void **state) {
  roots_case *c = *state;
  ambit_expr x = c->x[0];
  const ambit_interval box = { -20, 20 }, everything = AMBIT_ENTIRE;
  ambit_expr f = add(c, apply(c, AMBIT_OP_LOG, x), x);
  found *r = roots_find(c, 1, &f, &box);
  assert_counts(r, 1, 0);
  assert_true(fabs(r->box[0][0].lo - 0.56714329040978387) < 1e-15);
  free(r);
  f = apply(c, AMBIT_OP_EXP, x);
  r = roots_find(c, 1, &f, &everything);
  assert_counts(r, 0, 0);
  free(r);
  /* the angle of (-1, x) jumps from -pi to pi at x = 0, where the formula of its derivative sees nothing */
  ambit_expr angle = ambit_graph_op(c->graph, AMBIT_OP_ATAN2, x, number(c, -1));
  r = roots_find(c, 1, &angle, &box);
  assert_counts(r, 0, 0);
  free(r);
}

/* -- what a host relies on */

static void stops_are_obeyed_and_runs_repeat(void **state) {
  roots_case *c = *state;
  ambit_expr f = apply(c, AMBIT_OP_SIN, c->x[0]);
  const ambit_interval box = { -50, 50 };
  found *first = roots_find(c, 1, &f, &box), *again = roots_find(c, 1, &f, &box);
  assert_counts(first, 31, 0);
  assert_true(first->result.boxes > 0 && first->calls > 0);
  assert_memory_equal(first->box, again->box, sizeof first->box);
  assert_int_equal(first->first_count, first->last_count);
  for (uint32_t after = 1; after <= 3; after++) {
    found *r = calloc(1, sizeof *r);
    r->stop_after = after;
    assert_int_equal(roots_run(c, 1, &f, &box, NULL, 0, NULL, r), AMBIT_OK);
    assert_true(r->result.status == AMBIT_STOPPED && r->count == after);
    *r = (found) { .progress_after = after };
    assert_int_equal(roots_run(c, 1, &f, &box, NULL, 0, NULL, r), AMBIT_OK);
    assert_true(r->result.status == AMBIT_STOPPED && r->calls == after);
    free(r);
  }
  free(first);
  free(again);
}

static void every_rigorous_arithmetic_serves(void **state) {
  roots_case *c = *state;
  static const char *const name[] = { "interval", "affine", "taylor_model", "gradient",
#ifndef AMBIT_COUNT_ALLOCATIONS /* which ends every run that allocates; MPFR fills caches of its own while it runs */
    "mpfr"
#endif
  };
  ambit_expr x = c->x[0], y = c->x[1];
  ambit_expr f[2] = { less(c, add(c, apply(c, AMBIT_OP_SQR, x), apply(c, AMBIT_OP_SQR, y)), 4),
    subtract(c, apply(c, AMBIT_OP_EXP, x), add(c, y, number(c, 2))) };
  const ambit_interval box[2] = { { -3, 3 }, { -3, 3 } };
  for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
    found *r = calloc(1, sizeof *r);
    if (roots_run(c, 2, f, box, name[i], 0, NULL, r) != AMBIT_OK) fail_msg("%s: %s", name[i], r->failure.message);
    if (r->result.proved != 2 || r->result.undecided) fail_msg("%s: %u proved", name[i], r->result.proved);
    if (r->first_count != r->last_count && strcmp(name[i], "mpfr") != 0) /* which fills caches of its own */
      fail_msg("%s: allocations while running", name[i]);
    free(r);
  }
  found *r = calloc(1, sizeof *r);
  assert_int_equal(roots_run(c, 2, f, box, "real", 0, NULL, r), AMBIT_INVALID);
  assert_non_null(strstr(r->failure.message, "does not work with arithmetic `real`"));
  free(r);
}

static void refuse(roots_case *c, uint32_t n, const ambit_expr *f, ambit_interval box, const char *option,
    const char *value, const char *part) {
  const ambit_interval boxes[2] = { box, box };
  const ambit_option o[] = { { option, value } };
  found *r = calloc(1, sizeof *r);
  assert_int_equal(roots_run(c, n, f, boxes, NULL, option != NULL, o, r), AMBIT_INVALID);
  if (!strstr(r->failure.message, part)) fail_msg("\"%s\" expected, got: %s", part, r->failure.message);
  free(r);
}

static void bad_requests_are_refused(void **state) {
  roots_case *c = *state;
  ambit_expr f[2] = { c->x[0], number(c, 0) }, kink = apply(c, AMBIT_OP_ABS, less(c, c->x[0], 1)),
             stranger = add(c, c->x[0], c->x[4]);
  const ambit_interval box = { -1, 1 };
  refuse(c, 1, f, (ambit_interval) { 2, 1 }, NULL, NULL, "the box is empty: `x` in [2, 1]");
  refuse(c, 1, f, (ambit_interval) { NAN, 1 }, NULL, NULL, "the box is empty");
  refuse(c, 2, f, box, NULL, NULL, "1 equation cannot fix 2 unknowns (`x`, `y`)");
  refuse(c, 0, f, box, NULL, NULL, "there are no unknowns");
  refuse(c, 1, &kink, box, NULL, NULL, "has no derivative");
  refuse(c, 1, &stranger, box, NULL, NULL, "`v` has no value");
  refuse(c, 1, f, box, "tolerance", "-1", "`tolerance`");
  refuse(c, 1, f, box, "boxes_max", "0", "`boxes_max`");
  refuse(c, 1, f, box, "roots_max", "1e9", "`roots_max`");
  refuse(c, 1, f, box, "tolerence", "1", "tolerance");
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(integer_roots_are_counted),
    cmocka_unit_test(planted_roots_are_never_lost), cmocka_unit_test(sign_changes_are_roots),
    cmocka_unit_test(parametric_roots_hold_for_every_value), cmocka_unit_test(circle_and_line),
    cmocka_unit_test(roots_on_the_edge), cmocka_unit_test(undecidable_is_said_so), cmocka_unit_test(domains_are_kept),
    cmocka_unit_test(stops_are_obeyed_and_runs_repeat), cmocka_unit_test(every_rigorous_arithmetic_serves),
    cmocka_unit_test(bad_requests_are_refused) };
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
