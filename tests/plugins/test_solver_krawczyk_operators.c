/* Each operator of the root finder: random systems with planted roots, standard test systems with known numbers of
** roots, and that a gap of a quotient is used. */
#include "roots_case.h"

#define PLANTED 120

static const char *const operators[] = { "auto", "newton", "krawczyk", "hansen_sengupta" };
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

static found *run_with(roots_case *c, uint32_t n, const ambit_expr *f, const ambit_interval *box, const char *which) {
  const ambit_option option[] = { { "operator", which }, { "boxes_max", "20000" } };
  found *r = calloc(1, sizeof *r);
  if (roots_run(c, n, f, box, NULL, 2, option, r) != AMBIT_OK) fail_msg("%s", r->failure.message);
  return r;
}

/* n coupled products of two factors, each with known roots: (x_i - a_i)(x_i - b_i) + sum_j c_ij (x_j - a_j) prod_k ...
** vanish at a; whatever else they have as roots, a is one of them */
static void planted_roots_are_found_by_each(void **state) {
  roots_case *c = *state;
  uint32_t proved[4] = { 0 };
  for (int round = 0; round < PLANTED; round++) {
    uint32_t n = 1 + (uint32_t)choose(3);
    double a[3], b[3];
    ambit_expr f[3];
    ambit_interval box[3];
    for (uint32_t i = 0; i < n; i++) {
      a[i] = floor(between(-16, 16)) / 8, b[i] = a[i] + 1 + floor(between(0, 8)) / 4;
      box[i] = (ambit_interval) { a[i] - between(0.1, 3), a[i] + between(0.1, 3) };
    }
    for (uint32_t i = 0; i < n; i++) {
      f[i] = multiply(c, less(c, c->x[i], a[i]), less(c, c->x[i], b[i]));
      for (uint32_t j = 0; j < n; j++)
        if (j != i)
          f[i] = add(c, f[i], multiply(c, number(c, choose(7) / 8.0), multiply(c, less(c, c->x[j], a[j]), c->x[i])));
    }
    uint32_t count[4];
    for (size_t o = 0; o < 4; o++) {
      found *r = run_with(c, n, f, box, operators[o]);
      uint32_t unique = found_holding(r, AMBIT_ROOT_UNIQUE, a), other = found_holding(r, AMBIT_ROOT_UNDECIDED, a);
      if (unique + other == 0) fail_msg("round %d: %s lost a root of %u equations", round, operators[o], n);
      if (unique > 1) fail_msg("round %d: %s proved a root %u times", round, operators[o], unique);
      proved[o] += unique;
      count[o] = r->result.undecided ? 0 : r->result.proved;
      if (o > 0 && count[0] && count[o] && count[0] != count[o])
        fail_msg("round %d: %u roots by auto, %u by %s", round, count[0], count[o], operators[o]);
      free(r);
    }
  }
  for (size_t o = 0; o < 4; o++) assert_true(proved[o] > PLANTED * 9 / 10);
}

/* Brown's almost linear system of 3: all ones, and the real roots of 3 s^3 - 13 s^2 ... counted by its polynomial: with
** x1 = x2 = s, x3 = 4 - 3 s: s^2 (4 - 3 s) = 1: s = 1, (1 +- sqrt 13) / 6 */
static void brown_has_three_roots(void **state) {
  roots_case *c = *state;
  ambit_expr all = add(c, add(c, c->x[0], c->x[1]), c->x[2]);
  ambit_expr f[3] = { less(c, add(c, c->x[0], all), 4), less(c, add(c, c->x[1], all), 4),
    less(c, multiply(c, multiply(c, c->x[0], c->x[1]), c->x[2]), 1) };
  const ambit_interval box[3] = { { -10, 10 }, { -10, 10 }, { -10, 10 } };
  const double s[3] = { 1, (1 + sqrt(13)) / 6, (1 - sqrt(13)) / 6 };
  for (size_t o = 0; o < 4; o++) {
    found *r = run_with(c, 3, f, box, operators[o]);
    if (r->result.proved != 3 || r->result.undecided) fail_msg("%s: %u roots", operators[o], r->result.proved);
    for (int k = 0; k < 3; k++) {
      bool met = false;
      for (uint32_t i = 0; i < r->count; i++)
        met = met || (fabs(r->box[i][0].lo - s[k]) < 1e-12 && fabs(r->box[i][2].hi - (4 - 3 * s[k])) < 1e-12);
      if (!met) fail_msg("%s: %g is missing", operators[o], s[k]);
      assert_true(ambit_interval_width(r->box[k][0]) < 1e-14);
    }
    free(r);
  }
}

/* 1/x-like slopes: an extended quotient splits the box at once */
static void gaps_split_boxes(void **state) {
  roots_case *c = *state;
  ambit_expr f = less(c, apply(c, AMBIT_OP_SQR, c->x[0]), 4);
  f = add(c, f, multiply(c, number(c, 1e-3), apply(c, AMBIT_OP_SIN, multiply(c, number(c, 3), c->x[0]))));
  const ambit_interval box = { -3, 3.25 };
  found *rows = run_with(c, 1, &f, &box, "hansen_sengupta");
  assert_int_equal(rows->result.proved, 2);
  assert_true(rows->result.boxes <= 5);
  free(rows);
}

/* a double root, and one of a higher order: small undecided boxes around it, in bounded work */
static void multiple_roots_stay_undecided(void **state) {
  roots_case *c = *state;
  ambit_expr d = less(c, c->x[0], 1), e = less(c, c->x[1], 0.5);
  ambit_expr f[2] = { add(c, apply(c, AMBIT_OP_SQR, d), multiply(c, d, e)), add(c, e, apply(c, AMBIT_OP_SQR, e)) };
  const ambit_interval box[2] = { { -3, 4 }, { -0.4, 5 } };
  const double at[2] = { 1, 0.5 };
  for (size_t o = 0; o < 4; o++) {
    found *r = run_with(c, 2, f, box, operators[o]);
    assert_int_equal(r->result.status, AMBIT_UNABLE);
    assert_true(found_holding(r, AMBIT_ROOT_UNDECIDED, at) > 0 && found_holding(r, AMBIT_ROOT_UNIQUE, at) == 0);
    if (o == 0) assert_true(r->result.boxes < 2000);
    for (uint32_t i = 0; i < r->count && o == 0; i++) assert_true(ambit_interval_width(r->box[i][0]) < 1e-5);
    free(r);
  }
}

static void unknown_operators_are_refused(void **state) {
  roots_case *c = *state;
  const ambit_interval box = { -1, 1 };
  const ambit_option wrong[][1] = { { { "operator", "newtn" } }, { { "parameter_pieces", "-1" } },
    { { "parameter_pieces", "1e9" } } };
  static const char *const part[] = { "newton", "`parameter_pieces`", "`parameter_pieces`" };
  for (int i = 0; i < 3; i++) {
    found *r = calloc(1, sizeof *r);
    assert_int_equal(roots_run(c, 1, c->x, &box, NULL, 1, wrong[i], r), AMBIT_INVALID);
    if (!strstr(r->failure.message, part[i])) fail_msg("%s", r->failure.message);
    free(r);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(planted_roots_are_found_by_each),
    cmocka_unit_test(brown_has_three_roots), cmocka_unit_test(gaps_split_boxes),
    cmocka_unit_test(multiple_roots_stay_undecided), cmocka_unit_test(unknown_operators_are_refused) };
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
