/* Two published arms: mass matrix, bias, gravity torques and accelerations against 17 known digits, in doubles and in
** intervals around decimal data; both forms of the accelerations.
*/
#include "kit/robot_models.h"
#include <ambit/evaluate.h>
#include "mechanics/forward.h"
#include <ambit/dynamics.h>
#include "mechanics/robot_reference.h"
#include "num/decimal.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

enum { N = ROBOT_JOINTS, ROWS = 4 * N };

/* Rows of numbers: M (N rows), bias, gravity, accelerations in both forms. */
typedef struct answers {
  ambit_expr row[N + 4][N];
} answers;

static void check(ambit_status status, const ambit_failure *f) {
  if (status != AMBIT_OK) fail_msg("%s", f->message);
}

static answers write_answers(robot *r, ambit_arena *arena, ambit_forward *forward) {
  answers a;
  ambit_failure f = { 0 };
  ambit_motion motion;
  ambit_list gravity;
  check(ambit_motion_build(r->mechanism, arena, &motion, &f), &f);
  assert_int_equal(motion.n, N);
  check(ambit_gravity_torque(r->mechanism, arena, &gravity, &f), &f);
  for (int i = 0; i < N; i++) {
    memcpy(a.row[i], motion.mass + i * N, sizeof a.row[i]);
    a.row[N][i] = ambit_graph_op(r->graph, AMBIT_OP_NEG, motion.force[i], 0);
    a.row[N + 1][i] = gravity.e[i];
  }
  static const uint32_t form[] = { AMBIT_FORM_MASS_MATRIX, AMBIT_FORM_ARTICULATED };
  for (int k = 0; k < 2; k++) {
    check(ambit_forward_build(r->mechanism, form[k], true, arena, forward, &f), &f);
    assert_int_equal(forward->form, form[k]);
    memcpy(a.row[N + 2 + k], forward->du, sizeof a.row[0]);
  }
  return a;
}

static const char *expected(const robot_case *c, int row, int column) {
  if (row >= N + 2) return c->acceleration[column];
  if (row == N + 1) return c->gravity[column];
  if (row == N) return c->bias[column];
  int i = row < column ? row : column, j = row < column ? column : row;
  return c->mass[i * N - i * (i - 1) / 2 + j - i];
}

/* The decimal with half a unit of its last digit on either side. */
static ambit_interval rounded(const char *text) {
  ambit_interval x;
  char unit[64];
  size_t n = 0;
  assert_int_equal(ambit_decimal_read(text, &x, NULL, NULL), AMBIT_OK);
  for (const char *p = text; *p; p++) {
    if (*p == 'e' || *p == 'E') {
      n += (size_t)snprintf(unit + n, sizeof unit - n, "%s", p);
      break;
    }
    if (*p != '-') unit[n++] = *p == '.' ? '.' : '0';
    unit[n] = '\0';
  }
  char *last = unit + (strchr(unit, 'e') ? (size_t)(strchr(unit, 'e') - unit) : n) - 1;
  *last = *last == '.' ? '.' : '1';
  ambit_interval one;
  assert_int_equal(ambit_decimal_read(unit, &one, NULL, NULL), AMBIT_OK);
  return (ambit_interval) { x.lo - 0.5 * one.hi, x.hi + 0.5 * one.hi };
}

static void evaluate(robot *r, const char *arithmetic, const robot_case *c, const ambit_forward *forward, answers *a,
    ambit_interval *out) {
  ambit_expr leaf[3 * N], value[3 * N];
  ambit_failure f = { 0 };
  for (int i = 0; i < N; i++) {
    leaf[i] = forward->variables.coordinate[i].q, value[i] = ambit_graph_decimal(r->graph, c->q[i], &f);
    leaf[N + i] = forward->variables.u[i], value[N + i] = ambit_graph_decimal(r->graph, c->u[i], &f);
    leaf[2 * N + i] = forward->force[i], value[2 * N + i] = ambit_graph_decimal(r->graph, c->tau[i], &f);
  }
  uint32_t flags;
  ambit_evaluate_request q = { .graph = r->graph,
    .registry = r->registry,
    .arithmetic = arithmetic,
    .nexpr = sizeof *a / sizeof(ambit_expr),
    .expr = a->row[0],
    .nbinding = 3 * N,
    .leaf = leaf,
    .value = value };
  check(ambit_evaluate(&q, out, &flags, NULL, &f), &f);
  assert_int_equal(flags, 0);
}

static double norm(const robot_case *c, int row) {
  double sum = 0;
  for (int i = 0; i < N; i++) sum += fabs(strtod(expected(c, row, i), NULL));
  return sum;
}

/* In doubles: 1e-12 of the number; of its row if it is what a right angle of 12 digits leaves of 0. In intervals: the
** digits lie inside, in 1e-11.
*/
static void expect_numbers(const robot_case *c, const ambit_interval *x, bool sets) {
  for (int row = 0; row < N + 4; row++)
    for (int i = 0; i < N; i++) {
      ambit_interval got = x[row * N + i], truth = rounded(expected(c, row, i));
      double size = fabs(truth.hi), all = norm(c, row);
      if (size < 1e-6 * all) size = all;
      bool good = sets ? got.lo <= truth.hi && got.hi >= truth.lo && got.hi - got.lo <= 1e-11 * size
                       : fabs(got.lo - ambit_interval_mid(truth)) <= 1e-12 * size;
      if (!good) fail_msg("row %d, %d: [%.17g, %.17g] instead of %s", row, i, got.lo, got.hi, expected(c, row, i));
    }
}

static void expect_robot(robot r, const robot_case *cases) {
  ambit_arena *arena = ambit_arena_open();
  ambit_forward forward;
  answers a = write_answers(&r, arena, &forward);
  for (int k = 0; k < 3; k++) {
    ambit_interval x[(N + 4) * N];
    evaluate(&r, "real", &cases[k], &forward, &a, x);
    expect_numbers(&cases[k], x, false);
    evaluate(&r, "interval", &cases[k], &forward, &a, x);
    expect_numbers(&cases[k], x, true);
  }
  ambit_arena_close(arena);
  robot_close(&r);
}

static void ur5_has_its_numbers(void **state) {
  (void)state;
  expect_robot(robot_ur5(), ur5_cases);
}

static void puma560_has_its_numbers(void **state) {
  (void)state;
  expect_robot(robot_puma560(), puma560_cases);
}

/* Point data make every expression a constant; its accuracy in doubles must not be that of an interval around it, which
** has no digits left for so many joints.
*/
static void long_chains_keep_their_digits(void **state) {
  (void)state;
  enum { LINKS = 40 };
  robot r = robot_chain(LINKS, 1);
  ambit_arena *arena = ambit_arena_open();
  ambit_failure f = { 0 };
  ambit_forward forward;
  ambit_expr leaf[3 * LINKS], value[3 * LINKS];
  ambit_interval got[LINKS], truth[LINKS];
  check(ambit_forward_build(r.mechanism, AMBIT_FORM_AUTO, true, arena, &forward, &f), &f);
  for (int i = 0; i < LINKS; i++) {
    leaf[i] = forward.variables.coordinate[i].q, value[i] = ambit_graph_number(r.graph, 0.125 * (i % 7));
    leaf[LINKS + i] = forward.variables.u[i], value[LINKS + i] = ambit_graph_number(r.graph, 0.25 * (i % 3) - 0.25);
    leaf[2 * LINKS + i] = forward.force[i], value[2 * LINKS + i] = ambit_graph_number(r.graph, i % 2);
  }
  ambit_option precision = { "precision", "2000" };
  ambit_evaluate_request q = { .graph = r.graph,
    .registry = r.registry,
    .arithmetic = "real",
    .nexpr = LINKS,
    .expr = forward.du,
    .nbinding = 3 * LINKS,
    .leaf = leaf,
    .value = value };
  uint32_t flags;
  check(ambit_evaluate(&q, got, &flags, NULL, &f), &f);
  q.arithmetic = "mpfr", q.noption = 1, q.option = &precision;
  check(ambit_evaluate(&q, truth, &flags, NULL, &f), &f);
  double size = 0;
  for (int i = 0; i < LINKS; i++) size = fmax(size, fabs(truth[i].hi));
  for (int i = 0; i < LINKS; i++) {
    assert_true(truth[i].hi - truth[i].lo <= 1e-15 * size);
    if (!(fabs(got[i].lo - truth[i].lo) <= 1e-12 * size))
      fail_msg("%d: %.17g instead of %.17g", i, got[i].lo, truth[i].lo);
  }
  ambit_arena_close(arena);
  robot_close(&r);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(ur5_has_its_numbers),
    cmocka_unit_test(puma560_has_its_numbers),
    cmocka_unit_test(long_chains_keep_their_digits),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
