/* test_split_solver.c -- `simulate` in pieces with real solvers: closed forms inside, the same bits for any number of
** threads, contexts for solvers that want workers, and requests that make no sense. */
#include <ambit/simulate.h>
#include "num/random.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define NX 2

static const char *const names[] = { "x", "y" }, *const units[] = { "1", "1" };

/* -- x' = a x, y' = -x */

typedef struct growth {
  ambit_graph *graph;
  ambit_registry *registry;
  ambit_expr state[NX], rate[NX], initial[NX], a, x0;
  ambit_system system;
} growth;

static void open_growth(growth *g) {
  *g = (growth) { .graph = ambit_graph_open(), .registry = ambit_registry_open(NULL) };
  for (size_t i = 0; i < NX; i++) g->state[i] = ambit_graph_symbol(g->graph, names[i], units[i]);
  g->a = ambit_graph_unknown(g->graph, NULL, (ambit_interval) { -1, 0.5 });
  g->x0 = ambit_graph_unknown(g->graph, NULL, (ambit_interval) { 1, 1.01 });
  g->rate[0] = ambit_graph_op(g->graph, AMBIT_OP_MUL, g->a, g->state[0]);
  g->rate[1] = ambit_graph_op(g->graph, AMBIT_OP_NEG, g->state[0], g->state[0]);
  g->initial[0] = g->x0;
  g->initial[1] = g->x0; /* shared: x and y start as one */
  g->system =
      (ambit_system) { g->graph, NX, names, units, g->state, g->rate, 0, NULL, NULL, NULL, 0, NULL, NULL, NULL };
}

static void close_growth(growth *g) {
  ambit_registry_close(g->registry);
  ambit_graph_close(g->graph);
}

static ambit_simulate_request growth_request(const growth *g, const double time[2]) {
  return (ambit_simulate_request) {
    .system = &g->system, .registry = g->registry, .solver = "lohner", .initial = g->initial, .ntime = 2, .time = time
  };
}

typedef struct keeper {
  ambit_sink sink; /* first */
  uint32_t n;
  double t[80], value[80][4 * NX];
} keeper;

static int32_t keep(ambit_sink *s, const ambit_record *r) {
  keeper *k = (keeper *)(void *)s;
  const double *part[] = { r->lo, r->hi, r->tube_lo, r->tube_hi };
  assert_true(k->n < 80 && r->tube_lo && r->tube_hi);
  for (int i = 0; i < 4; i++) memcpy(k->value[k->n] + i * NX, part[i], NX * sizeof(double));
  k->t[k->n++] = r->t_to;
  return 0;
}

static keeper run_growth(const ambit_simulate_request *q, ambit_simulate_result *result) {
  keeper k = { .sink = { sizeof(ambit_sink), keep, NULL } };
  ambit_simulate_request own = *q;
  own.sink = &k.sink;
  ambit_failure f = { 0 };
  if (ambit_simulate(&own, result, NULL, &f) != AMBIT_OK) fail_msg("%s", f.message);
  return k;
}

static void check_growth(const keeper *k) {
  ambit_random random = { 3 };
  for (int draw = 0; draw < 400; draw++) {
    double a = ambit_random_in(&random, (ambit_interval) { -1, 0.5 });
    double x0 = ambit_random_in(&random, (ambit_interval) { 1, 1.01 });
    for (uint32_t i = 0; i < k->n; i++)
      for (int part = 0; part < 2; part++) { /* ends; tubes at a time inside */
        double t = part ? k->t[i] - 0.01 : k->t[i], x = x0 * exp(a * t),
               y = x0 - (a == 0 ? x0 * t : x0 * expm1(a * t) / a);
        const double *v = k->value[i] + 2 * NX * part;
        assert_true(v[0] <= x * (1 + 1e-14) && x * (1 - 1e-14) <= v[NX]);
        assert_true(v[1] <= y + 1e-13 && y - 1e-13 <= v[NX + 1]);
      }
  }
}

static void encloses_with_a_real_solver(void **state) {
  (void)state;
  static const double time[] = { 0, 2 };
  growth g;
  open_growth(&g);
  ambit_simulate_request q = growth_request(&g, time);
  ambit_cut cut[] = { { g.a, "a", 12 }, { g.x0, "x", 2 } };
  q.ncut = 2;
  q.cut = cut;
  keeper first = { 0 };
  for (uint32_t threads = 1; threads <= 5; threads += 2) {
    ambit_simulate_result result;
    q.threads = threads;
    keeper k = run_growth(&q, &result);
    assert_int_equal(result.status, AMBIT_OK);
    assert_int_equal(result.pieces, 24);
    assert_int_equal(result.threads, threads);
    assert_int_equal(result.rigorous, 1);
    assert_int_equal(k.n, 64); /* between a start and an end: the common grid */
    assert_int_equal(result.steps, 64);
    assert_true(result.t_reached == 2 && result.cpu_seconds > 0 && result.wall_seconds > 0);
    check_growth(&k);
    if (threads == 1)
      first = k;
    else
      assert_memory_equal(k.value, first.value, sizeof k.value); /* bit for bit */
  }
  double true_width = 1.01 * exp(1) - exp(-2);
  assert_true(first.value[63][NX] - first.value[63][0] < 1.1 * true_width);
  close_growth(&g);
}

static void cuts_by_itself_what_matters(void **state) {
  (void)state;
  static const double time[] = { 2, 0 }; /* backwards */
  growth g;
  open_growth(&g);
  ambit_simulate_request q = growth_request(&g, time);
  q.pieces = 10;
  ambit_simulate_result result;
  keeper k = run_growth(&q, &result);
  assert_int_equal(result.status, AMBIT_OK);
  assert_int_equal(result.pieces, 10); /* all for a */
  assert_true(k.t[k.n - 1] == 0);
  close_growth(&g);
}

/* Workers: contexts for solvers that ask for them, as many as threads; in pieces, one. */
static void lends_contexts_to_solvers_that_want_them(void **state) {
  (void)state;
  static const double time[] = { 0, 1 };
  growth g;
  open_growth(&g);
  ambit_registry_close(g.registry);
  g.registry = ambit_registry_open(AMBIT_BROKEN_DIR);
  g.rate[0] = g.rate[1] = ambit_graph_number(g.graph, 0);
  for (uint32_t threads = 1; threads <= 8; threads++)
    for (uint32_t pieces = 0; pieces <= 6; pieces += 6) {
      ambit_simulate_request q = growth_request(&g, time);
      ambit_simulate_result result;
      ambit_failure f = { 0 };
      q.solver = "crew";
      q.threads = threads;
      q.pieces = pieces;
      if (ambit_simulate(&q, &result, NULL, &f) != AMBIT_OK) fail_msg("%s", f.message);
      if (result.status != AMBIT_OK) fail_msg("%s", result.reason);
      assert_int_equal(result.threads, pieces && threads > pieces ? pieces : threads);
    }
  close_growth(&g);
}

static void refuses_cuts_that_make_no_sense(void **state) {
  (void)state;
  static const double time[] = { 0, 1 };
  growth g;
  open_growth(&g);
  ambit_simulate_request q = growth_request(&g, time);
  ambit_expr other = ambit_graph_unknown(g.graph, NULL, (ambit_interval) { 0, 1 });
  const struct {
    ambit_cut cut[2];
    const char *part;
  } wrong[] = {
    { { { other, "z", 2 }, { g.a, "a", 2 } }, "does not depend on `z`" },
    { { { g.x0, "x", 2 }, { g.x0, "y", 3 } }, "`x` and `y` are the same uncertain datum" },
    { { { g.a, "a", 60000 }, { g.x0, "y", 60000 } }, "more than 65536 pieces" },
  };
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    ambit_simulate_result result;
    ambit_failure f = { 0 };
    q.ncut = 2;
    q.cut = wrong[i].cut;
    assert_int_equal(ambit_simulate(&q, &result, NULL, &f), AMBIT_INVALID);
    if (!strstr(f.message, wrong[i].part)) fail_msg("%s", f.message);
  }
  setenv("AMBIT_THREADS", "some", 1);
  ambit_simulate_result result;
  ambit_failure f = { 0 };
  q.ncut = 0;
  assert_int_equal(ambit_simulate(&q, &result, NULL, &f), AMBIT_INVALID);
  assert_non_null(strstr(f.message, "AMBIT_THREADS is `some`"));
  unsetenv("AMBIT_THREADS");
  close_growth(&g);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(encloses_with_a_real_solver),
    cmocka_unit_test(cuts_by_itself_what_matters),
    cmocka_unit_test(lends_contexts_to_solvers_that_want_them),
    cmocka_unit_test(refuses_cuts_that_make_no_sense),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
