/* Coordinate partitioning: pivots, blocks, symbolic solutions, and what is refused. */
#include "mechanics/constrained.h"
#include "mechanics/loop_motion.h"
#include "mechanics/loop_point.h"
#include "mechanics/machine.h"
#include "num/random.h"
#include "mechanics/rank.h"
#include <math.h>

#define SIZE 12

static double draw(ambit_random *r) { return ambit_random_in(r, (ambit_interval) { -1, 1 }); }

/* -- pivots and blocks */

static void rank_is_that_of_the_factors(void **state) {
  (void)state;
  ambit_random r = { 3 };
  for (size_t rank = 0; rank <= 6; rank++) {
    ambit_arena *arena = ambit_arena_open();
    double a[SIZE * 6], b[6 * SIZE], x[8 * SIZE];
    for (size_t i = 0; i < SIZE * 6; i++) a[i] = draw(&r), b[i] = draw(&r);
    for (size_t i = 0; i < 8; i++)
      for (size_t j = 0; j < SIZE; j++) {
        x[i * SIZE + j] = 0;
        for (size_t k = 0; k < rank; k++) x[i * SIZE + j] += a[i * 6 + k] * b[k * SIZE + j];
      }
    assert_int_equal(ambit_partition_rank(arena, 8, SIZE, x, NULL), rank);
    ambit_arena_close(arena);
  }
}

/* Hidden block triangular matrices: rows and columns shuffled. Blocks are found, and their order solves them. */
static void blocks_are_found(void **state) {
  (void)state;
  ambit_random r = { 5 };
  const size_t start[] = { 0, 1, 3, 6, 7, 9 }, n = 9, nu = 11;
  for (int round = 0; round < 20; round++) {
    ambit_arena *arena = ambit_arena_open();
    double value[9 * 11] = { 0 };
    bool nonzero[9 * 11] = { 0 };
    size_t row[9], column[11];
    for (size_t i = 0; i < nu; i++) {
      size_t j = ambit_random_bits(&r) % (i + 1);
      if (i < n) {
        size_t k = ambit_random_bits(&r) % (i + 1);
        row[i] = row[k];
        row[k] = i;
      }
      column[i] = column[j];
      column[j] = i;
    }
    for (size_t b = 0; b < 5; b++)
      for (size_t i = start[b]; i < start[b + 1]; i++)
        for (size_t j = 0; j < start[b + 1]; j++) {
          bool own = j >= start[b];
          double x = own ? draw(&r) + (i == j ? 4 : 0) : draw(&r) * 0.1;
          value[row[i] * nu + column[j]] = x;
          nonzero[row[i] * nu + column[j]] = true;
        }
    ambit_partition p;
    assert_int_equal(ambit_partition_choose(arena, n, nu, value, nonzero, NULL, &p, NULL), AMBIT_OK);
    assert_int_equal(p.rank, n);
    assert_int_equal(p.nblock, 5);
    for (size_t b = 0; b < p.nblock; b++)
      for (size_t i = p.block[b]; i < p.block[b + 1]; i++)
        for (size_t j = p.block[b + 1]; j < n; j++) assert_false(nonzero[p.row[i] * nu + p.column[j]]);
    ambit_arena_close(arena);
  }
}

static void chosen_speeds_stay_independent(void **state) {
  (void)state;
  ambit_random r = { 7 };
  ambit_arena *arena = ambit_arena_open();
  double value[3 * 5];
  bool nonzero[3 * 5], keep[5] = { false, false, true, false, true };
  for (size_t i = 0; i < 15; i++) value[i] = draw(&r), nonzero[i] = true;
  ambit_partition p;
  assert_int_equal(ambit_partition_choose(arena, 3, 5, value, nonzero, keep, &p, NULL), AMBIT_OK);
  assert_int_equal(p.rank, 3);
  assert_int_equal(p.independent[0], 2);
  assert_int_equal(p.independent[1], 4);
  ambit_arena_close(arena);
}

/* -- solutions */

#define DRAWS 9
#define LARGEST 8 /* blocks */

/* Enclosures of e at random points hold 0 and are narrow at most of them: some come close to singular positions. */
static void expect_zero(machine *s, ambit_random *r, ambit_expr e) {
  ambit_expr leaf[80];
  double value[80];
  int narrow = 0;
  size_t n = ambit_graph_leaves(s->graph, 1, &e, 80, leaf);
  assert_true(n <= 80);
  for (int draws = 0; draws < DRAWS; draws++) {
    for (size_t i = 0; i < n; i++) value[i] = draw(r);
    ambit_interval out;
    machine_values(s, 1, &e, n, leaf, value, &out);
    if (!(out.lo <= 0 && out.hi >= 0)) fail_msg("[%g, %g]", out.lo, out.hi);
    narrow += out.hi - out.lo < 1e-4;
  }
  if (narrow <= DRAWS / 2) fail_msg("narrow at %d of %d points", narrow, DRAWS);
}

/* G_d (G_d^-1 b) = b for symbolic G of every block size around the change from Cramer's rule to elimination, and the
** same for the transpose.
*/
static void solutions_solve(void **state) {
  (void)state;
  ambit_random r = { 9 };
  for (size_t n = 1; n <= LARGEST; n++) {
    machine s = machine_open();
    ambit_arena *arena = ambit_arena_open();
    ambit_expr matrix[LARGEST * LARGEST], b[LARGEST], x[LARGEST], y[LARGEST];
    double value[LARGEST * LARGEST];
    bool nonzero[LARGEST * LARGEST];
    for (size_t i = 0; i < n * n; i++) {
      char name[32];
      bool zero = n > 2 && i % 5 == 3 && i % (n + 1) != 0;
      snprintf(name, sizeof name, "g%zu", i);
      value[i] = zero ? 0 : draw(&r) + (i % (n + 1) == 0 ? 3 : 0);
      nonzero[i] = !zero;
      ambit_expr big = machine_number(&s, i % (n + 1) == 0 ? 5 : 0);
      matrix[i] = zero ? 0 : ambit_graph_op(s.graph, AMBIT_OP_ADD, machine_symbol(&s, name), big);
    }
    for (size_t i = 0; i < n; i++) {
      char name[32];
      snprintf(name, sizeof name, "b%zu", i);
      b[i] = machine_symbol(&s, name);
    }
    ambit_partition p;
    ambit_loop_solver solver;
    assert_int_equal(ambit_partition_choose(arena, n, n, value, nonzero, NULL, &p, NULL), AMBIT_OK);
    assert_int_equal(p.rank, n);
    assert_int_equal(ambit_loop_solver_open(s.graph, arena, &p, matrix, &solver, NULL), AMBIT_OK);
    assert_int_equal(ambit_loop_solve(&solver, b, x, NULL), AMBIT_OK);
    assert_int_equal(ambit_loop_solve_transposed(&solver, b, y, NULL), AMBIT_OK);
    for (size_t i = 0; i < n; i++) {
      ambit_expr ax = ambit_graph_op(s.graph, AMBIT_OP_NEG, b[i], 0), ay = ax;
      for (size_t j = 0; j < n; j++) {
        ax = ambit_graph_op(s.graph, AMBIT_OP_ADD, ax, ambit_graph_op(s.graph, AMBIT_OP_MUL, matrix[i * n + j], x[j]));
        ay = ambit_graph_op(s.graph, AMBIT_OP_ADD, ay, ambit_graph_op(s.graph, AMBIT_OP_MUL, matrix[j * n + i], y[j]));
      }
      expect_zero(&s, &r, ax);
      expect_zero(&s, &r, ay);
    }
    machine_close(&s);
    ambit_arena_close(arena);
  }
}

/* -- a mechanism: a planar four-bar of unequal lengths */

static uint32_t close_point(machine *s, const char *name, ambit_frame a, ambit_frame b) {
  const ambit_element *e = machine_element(s, "close_point");
  ambit_frame connection[3] = { a, b, AMBIT_NOWHERE };
  const ambit_expr *param[1] = { NULL };
  ambit_part_spec spec = { e, "close_point", name, "scene.lua:7", param, connection, NULL };
  uint32_t part = UINT32_MAX;
  if (ambit_mechanism_add(s->mechanism, &spec, &part, &s->failure) != AMBIT_OK) fail_msg("%s", s->failure.message);
  return part;
}

static ambit_frame bar(machine *s, const char *name, ambit_frame from, const char *offset) {
  ambit_frame tip = machine_link(s, machine_revolute(s, name, from, "0,0,1"), offset);
  machine_mass(s, tip, "2");
  return tip;
}

static void four_bar(machine *s, const char *coupler, const char *height) {
  machine_gravity(s, "0,-9.81,0");
  ambit_frame tip = bar(s, "phi", bar(s, "beta", AMBIT_WORLD, "1,0,0"), coupler);
  ambit_frame far = machine_link(s, AMBIT_WORLD, "3,0,0"), other = bar(s, "psi", far, height);
  close_point(s, "loop", tip, other);
}

static void the_states_are_positions_and_independent_speeds(void **state) {
  (void)state;
  machine s = machine_open();
  ambit_arena *arena = ambit_arena_open();
  ambit_failure f = { 0 };
  four_bar(&s, "2.5,0,0", "2,0,0");
  ambit_system system;
  if (ambit_constrained_system(s.mechanism, AMBIT_FORM_AUTO, arena, &system, &f) != AMBIT_OK) fail_msg("%s", f.message);
  assert_int_equal(system.nx, 4);
  assert_string_equal(system.name[0], "beta");
  assert_string_equal(system.name[3], "beta'");
  assert_int_equal(system.ninvariant, 2);
  assert_string_equal(system.invariant_name[1], "loop.2");
  machine_close(&s);
  ambit_arena_close(arena);
}

#define UNKNOWNS 8

/* Every balance, with u' and lambda as the states say, vanishes: M u' = h + G^T lambda. So does d^2 g/dt^2. */
static void check_equations(machine *s, size_t rows, size_t trivial, size_t largest_block) {
  ambit_arena *arena = ambit_arena_open();
  ambit_failure f = { 0 };
  ambit_constrained c;
  ambit_variables v;
  ambit_expr balance[UNKNOWNS], second[UNKNOWNS], leaf[2 * UNKNOWNS], rate[2 * UNKNOWNS];
  if (ambit_constrained_build(s->mechanism, arena, &c, &f) != AMBIT_OK) fail_msg("%s", f.message);
  const ambit_constraints *k = &c.loops.constraints;
  const ambit_partition *p = &c.loops.partition;
  assert_int_equal(k->n, rows);
  assert_int_equal(k->ntrivial, trivial);
  size_t most = 0;
  for (size_t i = 0; i < p->nblock; i++) {
    size_t n = p->block[i + 1] - p->block[i];
    most = n > most ? n : most;
  }
  assert_int_equal(most, largest_block);
  if (ambit_variables_read(s->mechanism, arena, &v, &f) != AMBIT_OK) fail_msg("%s", f.message);
  assert_true(v.n <= UNKNOWNS && rows <= UNKNOWNS);
  if (ambit_balances_pull(s->mechanism, &v, balance, &f) != AMBIT_OK) fail_msg("%s", f.message);
  if (ambit_constrained_express(&c, arena, v.n, balance, &f) != AMBIT_OK) fail_msg("%s", f.message);
  for (size_t j = 0; j < v.n; j++) {
    leaf[j] = k->coordinate[j].q;
    leaf[v.n + j] = k->speed[j].u;
    rate[j] = k->coordinate[j].rate;
    rate[v.n + j] = k->speed[j].du;
  }
  for (size_t i = 0; i < rows; i++)
    second[i] = ambit_graph_time_derivative(s->graph, k->rate[i], 2 * v.n, leaf, rate, &f);
  if (ambit_constrained_express(&c, arena, rows, second, &f) != AMBIT_OK) fail_msg("%s", f.message);
  ambit_random r = { 4 };
  for (size_t i = 0; i < v.n; i++) expect_zero(s, &r, balance[i]);
  for (size_t i = 0; i < rows; i++) expect_zero(s, &r, second[i]);
  ambit_arena_close(arena);
}

static void equations_of_a_planar_loop_are_fulfilled(void **state) {
  (void)state;
  machine s = machine_open();
  four_bar(&s, "2.5,0,0", "2,0,0");
  check_equations(&s, 2, 1, 2);
  machine_close(&s);
}

/* Seven hinges in a ring, the general single loop of one freedom: five rows in one block. */
static void equations_of_a_spatial_loop_are_fulfilled(void **state) {
  (void)state;
  static const char *const axis[] = { "0,0,1", "1,0,0.2", "0.1,1,0", "0,0.3,1", "1,0,0", "0.2,1,0.1" };
  static const char *const link[] = { "1,0,0.1", "0,1,0", "0,0.2,1", "-1,0.1,0", "0,-1,0.1", "0.1,0,-1" };
  machine s = machine_open();
  ambit_frame at = AMBIT_WORLD;
  machine_gravity(&s, "0,0,-9.81");
  for (int i = 0; i < 6; i++) {
    char name[8];
    snprintf(name, sizeof name, "q%d", i + 1);
    at = machine_link(&s, machine_revolute(&s, name, at, axis[i]), link[i]);
    machine_mass(&s, at, "1");
  }
  const ambit_element *e = machine_element(&s, "close_revolute");
  ambit_frame connection[3] = { machine_link(&s, AMBIT_WORLD, "0.1,0.3,0.2"), at, AMBIT_NOWHERE };
  const machine_datum axes[2] = { machine_text(&s, "axis", "1,0,0"), machine_text(&s, "axis_b", "0.9,0.1,0.2") };
  const ambit_expr *param[2] = { axes[0].e, axes[1].e };
  ambit_part_spec spec = { e, "close_revolute", "ring", "scene.lua:7", param, connection, NULL };
  uint32_t part;
  if (ambit_mechanism_add(s.mechanism, &spec, &part, &s.failure) != AMBIT_OK) fail_msg("%s", s.failure.message);
  check_equations(&s, 5, 0, 5);
  machine_close(&s);
}

/* -- what is refused */

static void expect_refusal(machine *s, const char *part_of_message, const char *name) {
  ambit_arena *arena = ambit_arena_open();
  ambit_failure f = { 0 };
  ambit_system system;
  assert_int_equal(ambit_constrained_system(s->mechanism, AMBIT_FORM_AUTO, arena, &system, &f), AMBIT_INVALID);
  if (!strstr(f.message, part_of_message) || !strstr(f.message, name)) fail_msg("%s", f.message);
  ambit_arena_close(arena);
}

static void open_loops_are_named(void **state) {
  (void)state;
  machine s = machine_open();
  four_bar(&s, "0.5,0,0", "0.3,0,0"); /* too short to meet */
  expect_refusal(&s, "could not be closed", "`loop`");
  machine_close(&s);
  s = machine_open();
  four_bar(&s, "2.5,0,0", "2,0,0.25"); /* beside the plane */
  expect_refusal(&s, "can never be closed", "`loop.3` is 0.25");
  machine_close(&s);
}

static void fixed_rows_of_uncertain_data_are_named(void **state) {
  (void)state;
  machine s = machine_open();
  ambit_frame tip = bar(&s, "phi", bar(&s, "beta", AMBIT_WORLD, "1,0,0"), "2.5,0,0");
  machine_datum offset = machine_text(&s, "offset", "3,0,0");
  offset.e[2] = ambit_graph_unknown(s.graph, "gap", (ambit_interval) { -0.001, 0.001 });
  ambit_frame far = machine_frame(machine_add(&s, "rigid_link", NULL, AMBIT_WORLD, MACHINE_DATA(offset)));
  close_point(&s, "loop", tip, bar(&s, "psi", far, "2,0,0"));
  expect_refusal(&s, "uncertain data fix its residual", "`loop.3`");
  machine_close(&s);
}

static void loops_without_freedom_are_named(void **state) {
  (void)state;
  machine s = machine_open();
  ambit_frame tip = bar(&s, "beta", AMBIT_WORLD, "1,0,0");
  ambit_frame far = machine_link(&s, AMBIT_WORLD, "1,1,0");
  close_point(&s, "truss", tip, bar(&s, "psi", far, "0.8,0,0"));
  expect_refusal(&s, "no degree of freedom", "`truss`");
  machine_close(&s);
}

static void singular_references_are_named(void **state) {
  (void)state;
  machine s = machine_open();
  ambit_failure f = { 0 };
  ambit_frame tip = bar(&s, "over", bar(&s, "one", AMBIT_WORLD, "1,0,0"), "1,0,0");
  close_point(&s, "square", tip, bar(&s, "two", machine_link(&s, AMBIT_WORLD, "1,0,0"), "1,0,0"));
  const char *const flat[] = { "one", "over", "two" };
  const double angle[] = { 0, 0, 0 };
  assert_int_equal(ambit_loops_refer(s.mechanism, 3, flat, angle, &f), AMBIT_OK);
  expect_refusal(&s, "singular at the reference", "`square`");
  const double upright[] = { 1.5, -1.5, 1.5 };
  assert_int_equal(ambit_loops_refer(s.mechanism, 3, flat, upright, &f), AMBIT_OK);
  ambit_arena *arena = ambit_arena_open();
  ambit_system system;
  assert_int_equal(ambit_constrained_system(s.mechanism, AMBIT_FORM_AUTO, arena, &system, &f), AMBIT_OK);
  ambit_arena_close(arena);
  machine_close(&s);
}

static void bad_choices_are_named(void **state) {
  (void)state;
  machine s = machine_open();
  ambit_failure f = { 0 };
  four_bar(&s, "2.5,0,0", "2,0,0");
  const char *const both[] = { "beta", "psi" }, *const wrong[] = { "bet" };
  assert_int_equal(ambit_loops_choose(s.mechanism, 2, both, &f), AMBIT_OK);
  expect_refusal(&s, "2 coordinates were named, but the loops leave 1 degree of freedom", "independent");
  assert_int_equal(ambit_loops_choose(s.mechanism, 1, wrong, &f), AMBIT_OK);
  expect_refusal(&s, "there is no coordinate", "`bet`");
  assert_int_equal(ambit_loops_choose(s.mechanism, 0, NULL, &f), AMBIT_OK);
  const double x = 1;
  assert_int_equal(ambit_loops_refer(s.mechanism, 1, wrong, &x, &f), AMBIT_OK);
  expect_refusal(&s, "there is no coordinate", "`bet`");
  machine_close(&s);
}

/* -- rank */

static ambit_rank certify(machine *s, ambit_arena *arena, const double *lo, const double *hi, size_t budget) {
  static const char *const name[] = { "beta", "phi", "psi" };
  ambit_rank rank;
  ambit_failure f = { 0 };
  ambit_rank_request q = { .mechanism = s->mechanism, .n = 3, .name = name, .lo = lo, .hi = hi, .budget = budget };
  if (ambit_rank_certify(&q, arena, &rank, &f) != AMBIT_OK) fail_msg("%s", f.message);
  return rank;
}

/* The crank of a Grashof four-bar (1, 2.5, 2, 3) turns all the way round: at every assembled position beta determines
** the others, because coupler and rocker are never aligned: the distance of their ends, between 2 and 4, is never 0.5
** or 4.5.
*/
static void rank_is_certified_over_a_turn(void **state) {
  (void)state;
  ambit_arena *arena = ambit_arena_open();
  machine s = machine_open();
  ambit_failure f = { 0 };
  const char *const crank[] = { "beta" };
  four_bar(&s, "2.5,0,0", "2,0,0");
  ambit_loops_choose(s.mechanism, 1, crank, &f);
  const double lo[] = { 0, -7, 0 }, hi[] = { 6.3, 3.2, 6.3 };
  ambit_rank r = certify(&s, arena, lo, hi, 20000);
  assert_int_equal(r.outcome, AMBIT_RANK_PROVED);
  assert_true(r.boxes > 1);
  assert_int_equal(r.partition.independent[0], 0);
  /* a few boxes do not do */
  r = certify(&s, arena, lo, hi, 3);
  assert_int_equal(r.outcome, AMBIT_RANK_UNDECIDED);
  assert_true(r.nrow == 2);
  /* the loop cannot be closed with the rocker below the ground and the coupler above it */
  const double nowhere_lo[] = { 1, -0.1, 4 }, nowhere_hi[] = { 1.1, 0.1, 4.1 };
  assert_int_equal(certify(&s, arena, nowhere_lo, nowhere_hi, 100).outcome, AMBIT_RANK_EMPTY);
  machine_close(&s);
  ambit_arena_close(arena);
}

/* Equal bars: flat is singular, proved at the point and undecided around it. */
static void singular_points_are_certified(void **state) {
  (void)state;
  ambit_arena *arena = ambit_arena_open();
  machine s = machine_open();
  ambit_frame tip = bar(&s, "phi", bar(&s, "beta", AMBIT_WORLD, "1,0,0"), "1,0,0");
  close_point(&s, "square", tip, bar(&s, "psi", machine_link(&s, AMBIT_WORLD, "1,0,0"), "1,0,0"));
  const double flat[] = { 0, 0, 0 }, lo[] = { -0.1, -0.1, -0.1 }, hi[] = { 0.1, 0.1, 0.1 };
  const double right_lo[] = { 1, -1.6, 1 }, right_hi[] = { 1.5, -0.9, 1.5 };
  ambit_rank r = certify(&s, arena, flat, flat, 100);
  assert_int_equal(r.outcome, AMBIT_RANK_SINGULAR);
  assert_string_equal(r.loops.constraints.row[r.row[0]].loop, "square");
  assert_int_equal(certify(&s, arena, lo, hi, 2000).outcome, AMBIT_RANK_UNDECIDED);
  assert_int_equal(certify(&s, arena, right_lo, right_hi, 2000).outcome, AMBIT_RANK_PROVED);
  machine_close(&s);
  ambit_arena_close(arena);
}

static void boxes_are_checked(void **state) {
  (void)state;
  ambit_arena *arena = ambit_arena_open();
  machine s = machine_open();
  four_bar(&s, "2.5,0,0", "2,0,0");
  const char *const two[] = { "beta", "phi" }, *const all[] = { "beta", "phi", "psi" };
  const double lo[] = { 0, 0, 0 }, hi[] = { 1, 1, INFINITY };
  ambit_rank r;
  ambit_failure f = { 0 };
  ambit_rank_request q = { .mechanism = s.mechanism, .n = 2, .name = two, .lo = lo, .hi = hi, .budget = 10 };
  assert_int_equal(ambit_rank_certify(&q, arena, &r, &f), AMBIT_INVALID);
  assert_non_null(strstr(f.message, "says nothing about the coordinate `psi`"));
  ambit_failure_clear(&f);
  q = (ambit_rank_request) { .mechanism = s.mechanism, .n = 3, .name = all, .lo = lo, .hi = hi, .budget = 10 };
  assert_int_equal(ambit_rank_certify(&q, arena, &r, &f), AMBIT_INVALID);
  assert_non_null(strstr(f.message, "the range of `psi` must be finite"));
  machine_close(&s);
  ambit_arena_close(arena);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(rank_is_that_of_the_factors),
    cmocka_unit_test(blocks_are_found),
    cmocka_unit_test(chosen_speeds_stay_independent),
    cmocka_unit_test(solutions_solve),
    cmocka_unit_test(the_states_are_positions_and_independent_speeds),
    cmocka_unit_test(equations_of_a_planar_loop_are_fulfilled),
    cmocka_unit_test(equations_of_a_spatial_loop_are_fulfilled),
    cmocka_unit_test(open_loops_are_named),
    cmocka_unit_test(fixed_rows_of_uncertain_data_are_named),
    cmocka_unit_test(loops_without_freedom_are_named),
    cmocka_unit_test(singular_references_are_named),
    cmocka_unit_test(bad_choices_are_named),
    cmocka_unit_test(rank_is_certified_over_a_turn),
    cmocka_unit_test(singular_points_are_certified),
    cmocka_unit_test(boxes_are_checked),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
