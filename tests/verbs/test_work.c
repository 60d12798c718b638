/* test_work.c -- counted work against counts made by hand; the same work whatever the threads; the profile's frames,
** tables and threads; results that are the same whether they are profiled or not. */
#include "base/meter.h"
#include "graph/jet.h"
#include "graph/tape.h"
#include "host/pool.h"
#include "verbs/run/context.h"
#include <ambit/evaluate.h>
#include "verbs/scene.h"
#include "verbs/run/share.h"
#include <ambit/block.h>
#include <ambit/meter.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>
#include <time.h>
#include <cmocka.h>

static int set_up(void **state) {
  *state = scene_open();
  return 0;
}

static int tear_down(void **state) {
  scene_close(*state);
  return 0;
}

/* -- counts by hand */

/* outputs p^2 x and sin(p^2 x), inputs x (a function of time), p (not): SQR of degree 0, then MUL, SIN, and COS, the
** helper of SIN */
static const ambit_tape *seal(scene *s, ambit_arena *arena, uint32_t flags) {
  ambit_graph *g = s->graph;
  ambit_expr in[] = { ambit_graph_symbol(g, "x", "1"), ambit_graph_unknown(g, "p", (ambit_interval) { 1, 2 }) };
  ambit_expr out[2];
  out[0] = ambit_graph_op(g, AMBIT_OP_MUL, ambit_graph_op(g, AMBIT_OP_SQR, in[1], in[1]), in[0]);
  out[1] = ambit_graph_op(g, AMBIT_OP_SIN, out[0], out[0]);
  const ambit_tape *t;
  assert_int_equal(ambit_tape_seal(g, arena, 2, out, 2, in, 1, flags, &t, NULL), AMBIT_OK);
  assert_int_equal(t->ninstr, flags ? 4 : 3);
  return t;
}

static void put_all(const ambit_jet_service *jets, ambit_jet *jet) {
  const double direction[] = { 1, 0, 0, 1 }, none[] = { 0, 0 };
  jets->put(jet, 0, 0, 1.5, 0.25, direction, none);
  jets->put(jet, 1, 0, 1.5, 0.5, direction + 2, none);
}

/* with the interval arithmetic's own series, and with the kernel's over an arithmetic that has none */
static void counts_series(void **state) {
  scene *s = *state;
  static const char *const name[] = { "interval", "affine" };
  enum { ORDER = 5, NDIR = 2 };
  for (size_t i = 0; i < 2; i++) {
    ambit_arena *arena = ambit_arena_open();
    const ambit_tape *t = seal(s, arena, AMBIT_TAPE_SERIES);
    ambit_context c;
    ambit_jet *jet;
    const ambit_jet_service *jets = &ambit_jet_service_v1;
    assert_int_equal(ambit_context_open(s->registry, name[i], 0, NULL, 0, &c, NULL), AMBIT_OK);
    assert_int_equal(jets->open(&c.scope->host, t, c.arithmetic, c.ctx, ORDER, NDIR, NULL, &jet), AMBIT_OK);
    ambit_work work = ambit_scope_work(c.scope);
    assert_true(work.series == 1 && work.orders == 0 && work.coefficients == 0);
    put_all(jets, jet);
    for (uint32_t k = 0; k <= ORDER; k++) assert_int_equal(jets->advance(jet, k), 0);
    work = ambit_scope_work(c.scope);
    assert_int_equal(work.orders, ORDER + 1);
    assert_int_equal(work.coefficients, (4 + ORDER * 3) * (1 + NDIR)); /* the square has one of order 0 only */
    assert_int_equal(work.skipped, ORDER * (1 + NDIR));
    assert_int_equal(work.operations, work.coefficients);
    double tail[2];
    assert_int_equal(jets->tail(jet, ORDER, 0.1, NULL, NULL, tail, NULL), AMBIT_OK);
    jets->advance(jet, ORDER + 1); /* refused: nothing is computed */
    work = ambit_scope_work(c.scope);
    assert_int_equal(work.tails, 1);
    assert_int_equal(work.orders, ORDER + 1);
    jets->close(jet);
    ambit_context_close(&c);
    ambit_arena_close(arena);
  }
}

static void counts_values(void **state) {
  scene *s = *state;
  ambit_arena *arena = ambit_arena_open();
  const ambit_tape *t = seal(s, arena, 0);
  ambit_context c;
  ambit_lane lane;
  assert_int_equal(ambit_context_open(s->registry, "real", 0, NULL, 0, &c, NULL), AMBIT_OK);
  ambit_work before = ambit_scope_work(c.scope);
  assert_int_equal(ambit_lane_open(&lane, &c.scope->host, t, c.arithmetic, c.ctx), AMBIT_OK);
  ambit_work opened = ambit_scope_work(c.scope);
  assert_int_equal(opened.allocations, before.allocations + 2); /* the block and its record of work */
  assert_true(opened.allocated >= before.allocated + t->nslot * lane.elem);
  for (int i = 0; i < 7; i++) ambit_lane_run(&lane);
  ambit_work work = ambit_scope_work(c.scope);
  assert_int_equal(work.evaluations, 7);
  assert_int_equal(work.operations, 7 * 3);
  assert_int_equal(work.allocations, opened.allocations);
  ambit_lane_close(&lane);
  ambit_context_close(&c);
  ambit_arena_close(arena);
}

/* a host of somebody's own lends the services, but cannot count */
static void *refuse(const ambit_host *h, size_t bytes) { return (void)h, (void)bytes, NULL; }

static void does_not_count_for_others(void **state) {
  (void)state;
  ambit_scope *scope;
  assert_int_equal(ambit_scope_open(&scope, NULL, NULL), AMBIT_OK);
  ambit_host own = scope->host;
  own.alloc = refuse;
  assert_null(ambit_work_open(&own));
  assert_non_null(ambit_work_open(&scope->host));
  ambit_scope_close(scope);
  assert_int_equal(ambit_scope_work(NULL).allocations, 0);
}

static void counts_an_evaluation(void **state) {
  scene *s = *state;
  ambit_graph *g = s->graph;
  ambit_expr u = scene_unknown(s, "u", 1, 2),
             e = ambit_graph_op(g, AMBIT_OP_SIN, ambit_graph_op(g, AMBIT_OP_SQR, u, u), u);
  ambit_evaluate_request q = { .graph = g, .registry = s->registry, .arithmetic = "interval", .nexpr = 1, .expr = &e };
  ambit_interval out;
  ambit_report report;
  assert_int_equal(ambit_evaluate(&q, &out, NULL, &report, NULL), AMBIT_OK);
  assert_int_equal(report.work.evaluations, 1);
  assert_int_equal(report.work.operations, 2);
  assert_int_equal(report.work.gradients, 0);
  q.arithmetic = "gradient";
  assert_int_equal(ambit_evaluate(&q, &out, NULL, &report, NULL), AMBIT_OK);
  assert_true(report.work.gradients > 0);
  assert_int_equal(report.work.evaluations, 1 + report.work.gradients);
  assert_true(report.seconds_graph >= 0 && report.seconds_tape > 0 && report.seconds_context > 0);
  assert_true(report.seconds_graph + report.seconds_tape + report.seconds_context <= report.seconds_build * 1.001);
}

/* -- runs */

/* the pendulum phi'' = -sin phi, phi(0) in [1, 1.01] */
static void make_pendulum(scene *s) {
  ambit_graph *g = s->graph;
  size_t phi = scene_state(s, "phi", scene_unknown(s, "phi0", 1, 1.01));
  size_t omega = scene_state(s, "omega", ambit_graph_number(g, 0));
  s->rate[phi] = s->state[omega];
  ambit_expr sine = ambit_graph_op(g, AMBIT_OP_SIN, s->state[phi], s->state[phi]);
  s->rate[omega] = ambit_graph_op(g, AMBIT_OP_NEG, sine, sine);
}

typedef struct keeper {
  ambit_sink sink; /* first */
  double lo[2], hi[2];
} keeper;

static int32_t keep(ambit_sink *sink, const ambit_record *r) {
  keeper *k = (keeper *)(void *)sink;
  memcpy(k->lo, r->lo, sizeof k->lo);
  memcpy(k->hi, r->hi, sizeof k->hi);
  return 0;
}

static int32_t go_on(ambit_sink *sink, double done, const char *message) {
  return (void)sink, (void)done, (void)message, 0;
}

static ambit_report run(const char *solver, uint32_t pieces, uint32_t threads, keeper *k) {
  static const double time[] = { 0, 1, 2 };
  scene *s = scene_open();
  make_pendulum(s);
  ambit_simulate_request q = scene_request(s, solver, 3, time);
  ambit_simulate_result result;
  ambit_report report;
  *k = (keeper) { .sink = { sizeof(ambit_sink), keep, go_on } };
  q.sink = &k->sink;
  q.pieces = pieces;
  q.threads = threads;
  assert_int_equal(ambit_simulate(&q, &result, &report, NULL), AMBIT_OK);
  assert_int_equal(result.status, AMBIT_OK);
  scene_close(s);
  return report;
}

static void check_same_work(const ambit_report *a, const ambit_report *b) {
#define AMBIT_X(name, what) assert_int_equal(a->work.name, b->work.name);
  AMBIT_WORKS(AMBIT_X)
#undef AMBIT_X
}

static void counts_runs(void **state) {
  (void)state;
  static const char *const solver[] = { "lohner", "valencia", "taylor_model", "stiff", "gsl" };
  for (size_t i = 0; i < sizeof solver / sizeof *solver; i++) {
    keeper k;
    ambit_report first = run(solver[i], 0, 1, &k), again = run(solver[i], 0, 1, &k);
    check_same_work(&first, &again);
    assert_true(first.work.operations > 0 && first.work.allocations > 0);
    assert_true(first.work.evaluations + first.work.orders > 0);
    assert_true(first.work.tried >= first.steps);
    assert_int_equal(first.work.allocations_run, 0);
    assert_int_equal(first.work.operations >= first.work.coefficients, 1);
  }
}

/* Pieces do the same whichever thread does them; only contexts are one for each thread. */
static void counts_threads_alike(void **state) {
  (void)state;
  keeper k, l;
  ambit_report alone = run("lohner", 4, 1, &k), together = run("lohner", 4, 2, &l);
  assert_memory_equal(k.lo, l.lo, sizeof k.lo);
  assert_int_equal(alone.work.operations, together.work.operations);
  assert_int_equal(alone.work.orders, together.work.orders);
  assert_int_equal(alone.work.tails, together.work.tails);
  assert_int_equal(alone.work.tried, together.work.tried);
  assert_int_equal(alone.work.series, together.work.series);
  keeper m;
  assert_true(alone.work.operations > run("lohner", 0, 1, &m).work.operations);
}

/* -- the meter */

static const ambit_meter_frame *find(const ambit_meter_frame *in, const char *name) {
  for (const ambit_meter_frame *f = in->child; f; f = f->next)
    if (strcmp(f->name, name) == 0) return f;
  return NULL;
}

static void spend(double seconds) {
  struct timespec from, now;
  clock_gettime(CLOCK_MONOTONIC, &from);
  do clock_gettime(CLOCK_MONOTONIC, &now);
  while ((double)(now.tv_sec - from.tv_sec) + 1e-9 * (double)(now.tv_nsec - from.tv_nsec) < seconds);
}

static double sum_of(const ambit_profile *p, const ambit_meter_frame *f) {
  double sum = ambit_profile_self_seconds(p, f) + ambit_profile_cost_seconds(p, f);
  for (const ambit_meter_frame *inner = f->child; inner; inner = inner->next) sum += sum_of(p, inner);
  return sum;
}

static void is_off_by_itself(void **state) {
  (void)state;
  ambit_meter_place nowhere = ambit_meter_here();
  assert_false(ambit_meter_is_on());
  ambit_meter_enter(AMBIT_FRAME_STAGE, "nothing");
  ambit_meter_mark(AMBIT_FRAME_OPERATION, "nothing");
  ambit_meter_leave();
  assert_int_equal(ambit_meter_depth(), 0);
  assert_false(ambit_meter_join(&nowhere, "nothing"));
  assert_null(ambit_meter_tabulate("nothing", 1, 1));
}

static void nests_frames(void **state) {
  (void)state;
  ambit_profile *p = ambit_profile_begin();
  assert_non_null(p);
  assert_null(ambit_profile_begin()); /* one at a time */
  for (int i = 0; i < 3; i++) {
    ambit_meter_enter(AMBIT_FRAME_STAGE, "outer");
    ambit_meter_enter(AMBIT_FRAME_SERVICE, "inner");
    spend(1e-4);
    ambit_meter_leave();
    ambit_meter_mark(AMBIT_FRAME_OPERATION, "ADD");
    ambit_meter_mark(AMBIT_FRAME_OPERATION, "MUL");
    ambit_meter_leave(); /* the mark too */
  }
  uint32_t depth = ambit_meter_depth();
  ambit_meter_enter(AMBIT_FRAME_STAGE, "left open");
  ambit_meter_enter(AMBIT_FRAME_STAGE, "by an error");
  ambit_meter_unwind(depth);
  assert_int_equal(ambit_meter_depth(), depth);
  ambit_meter_leave(); /* one too many does no harm */
  const ambit_meter_frame *root = ambit_profile_end(p), *outer = find(root, "outer"), *inner = find(outer, "inner");
  assert_false(ambit_meter_is_on());
  assert_string_equal(root->name, "script");
  assert_int_equal(outer->count, 3);
  assert_int_equal(inner->count, 3);
  assert_int_equal(find(outer, "ADD")->marks, 3);
  assert_int_equal(find(outer, "MUL")->count, 3);
  assert_int_equal(find(root, "left open")->count, 1);
  assert_true(ambit_profile_self_seconds(p, inner) > 2e-4);
  assert_true(outer->ticks >= inner->ticks);
  double whole = ambit_profile_wall_seconds(p);
  assert_true(fabs(sum_of(p, root) - whole) < 0.01 * whole);
  assert_false(ambit_profile_is_cut(p));
  ambit_profile_close(p);
}

/* more paths than there is room for: told, and nothing lost but their names */
static void survives_too_many_frames(void **state) {
  (void)state;
  char name[32];
  ambit_profile *p = ambit_profile_begin();
  for (int i = 0; i < 10000; i++) {
    snprintf(name, sizeof name, "%d", i);
    ambit_meter_enter(AMBIT_FRAME_CORE, name);
    ambit_meter_enter(AMBIT_FRAME_CORE, "inside");
    ambit_meter_leave();
    ambit_meter_leave();
  }
  ambit_meter_enter(AMBIT_FRAME_CORE, "1"); /* a frame that has its place, a mark that has none */
  ambit_meter_mark(AMBIT_FRAME_OPERATION, "new");
  ambit_meter_leave();
  assert_int_equal(ambit_meter_depth(), 1);
  for (int i = 0; i < 10000; i++) ambit_meter_enter(AMBIT_FRAME_ELEMENT, "deep");
  ambit_meter_unwind(1);
  assert_int_equal(ambit_meter_depth(), 1);
  const ambit_meter_frame *root = ambit_profile_end(p);
  assert_true(ambit_profile_is_cut(p));
  double whole = ambit_profile_wall_seconds(p);
  assert_true(fabs(sum_of(p, root) - whole) < 0.01 * whole);
  ambit_profile_close(p);
}

static ambit_status item(void *user, uint32_t number, uint32_t worker) {
  (void)user, (void)number, (void)worker;
  ambit_meter_enter(AMBIT_FRAME_SERVICE, "work");
  spend(1e-4);
  ambit_meter_leave();
  return AMBIT_OK;
}

static void joins_threads(void **state) {
  (void)state;
  for (uint32_t threads = 1; threads <= 3; threads++) {
    ambit_pool *pool;
    ambit_profile *p = ambit_profile_begin();
    assert_int_equal(ambit_pool_open(NULL, threads, &pool), AMBIT_OK);
    ambit_meter_enter(AMBIT_FRAME_STAGE, "run");
    assert_int_equal(ambit_pool_run(pool, 20, item, NULL, NULL), AMBIT_OK);
    ambit_meter_leave();
    ambit_pool_close(pool);
    const ambit_meter_frame *at = find(ambit_profile_end(p), "run");
    const ambit_meter_frame *waits = find(at, "waiting for threads");
    if (threads > 1) assert_non_null(waits);
    const ambit_meter_frame *items = find(at, "item of a pool");
    assert_non_null(items);
    assert_int_equal(items->count, 20);
    assert_int_equal(find(items, "work")->count, 20);
    assert_true(ambit_profile_self_seconds(p, find(items, "work")) > 15e-4);
    ambit_profile_close(p);
  }
}

static ambit_status inner(void *user, uint32_t number, uint32_t worker) {
  ambit_pool *pool;
  (void)number, (void)worker;
  assert_int_equal(ambit_pool_open(NULL, 2, &pool), AMBIT_OK);
  ambit_meter_enter(AMBIT_FRAME_STAGE, "inner");
  ambit_status status = ambit_pool_run(pool, 5, item, user, NULL);
  ambit_meter_leave();
  ambit_pool_close(pool);
  return status;
}

static uint64_t count_of(const ambit_meter_frame *f, const char *name) {
  uint64_t n = strcmp(f->name, name) == 0 ? f->count : 0;
  for (const ambit_meter_frame *child = f->child; child; child = child->next) n += count_of(child, name);
  return n;
}

/* what a pool does that an item of another pool opens is not lost */
static void joins_threads_of_threads(void **state) {
  (void)state;
  ambit_pool *pool;
  ambit_profile *p = ambit_profile_begin();
  assert_int_equal(ambit_pool_open(NULL, 2, &pool), AMBIT_OK);
  assert_int_equal(ambit_pool_run(pool, 4, inner, NULL, NULL), AMBIT_OK);
  ambit_pool_close(pool);
  const ambit_meter_frame *root = ambit_profile_end(p);
  assert_int_equal(count_of(root, "inner"), 4);
  assert_int_equal(count_of(root, "work"), 20);
  ambit_profile_close(p);
}

/* -- shares */

static void shares_instructions(void **state) {
  scene *s = *state;
  static const char *const name[] = { "first", "second" };
  ambit_arena *arena = ambit_arena_open();
  const ambit_tape *t = seal(s, arena, 0);
  ambit_share_note(t, "off", 2, name); /* nobody looks */
  ambit_profile *p = ambit_profile_begin();
  ambit_share_note(t, "rates", 2, name);
  const ambit_meter_frame *root = ambit_profile_end(p);
  const ambit_meter_table *table = ambit_profile_tables(p);
  assert_non_null(table);
  assert_null(table->next);
  assert_ptr_equal(table->frame, root);
  assert_int_equal(table->columns, 2 * AMBIT_OP_END + 2);
  const double *first = table->value, *second = table->value + table->columns;
  assert_string_equal(table->name[1], "second");
  /* p^2 and the product are for both, the sine for the second alone */
  assert_true(first[AMBIT_OP_SQR] == 0 && first[AMBIT_OP_MUL] == 0 && second[AMBIT_OP_SIN] == 1);
  assert_true(first[AMBIT_OP_END + AMBIT_OP_SQR] == 0.5 && second[AMBIT_OP_END + AMBIT_OP_MUL] == 0.5);
  assert_true(first[AMBIT_OP_END + AMBIT_OP_SIN] == 0 && second[AMBIT_OP_END + AMBIT_OP_SIN] == 1);
  assert_true(first[2 * AMBIT_OP_END + 1] == 2 && second[2 * AMBIT_OP_END + 1] == 3);
  double all = 0;
  for (uint32_t k = 0; k < 2 * AMBIT_OP_END; k++) all += k < AMBIT_OP_END ? 0 : first[k] + second[k];
  assert_true(all == t->ninstr); /* the parts are the whole */
  ambit_profile_close(p);
  ambit_arena_close(arena);
}

/* -- profiled runs */

static void profiles_without_changing(void **state) {
  (void)state;
  static const char *const solver[] = { "lohner", "valencia", "taylor_model", "stiff", "gsl" };
  for (size_t i = 0; i < sizeof solver / sizeof *solver; i++) {
    keeper plain, profiled;
    ambit_report before = run(solver[i], 0, 1, &plain);
    ambit_profile *p = ambit_profile_begin();
    ambit_report after = run(solver[i], 0, 1, &profiled);
    const ambit_meter_frame *root = ambit_profile_end(p), *stage = find(root, "run");
    assert_memory_equal(plain.lo, profiled.lo, sizeof plain.lo);
    assert_memory_equal(plain.hi, profiled.hi, sizeof plain.hi);
    check_same_work(&before, &after);
    assert_non_null(stage);
    assert_non_null(find(stage, solver[i]));
    assert_non_null(find(root, "open"));
    assert_non_null(find(find(root, "graph"), "tape"));
    ambit_profile_close(p);
  }
}

static void lends_the_meter_only_then(void **state) {
  (void)state;
  ambit_scope *scope;
  assert_int_equal(ambit_scope_open(&scope, NULL, NULL), AMBIT_OK);
  const ambit_host *h = &scope->host;
  assert_null(h->service(h, AMBIT_METER_SERVICE));
  ambit_profile *p = ambit_profile_begin();
  const ambit_meter_service *meter = h->service(h, AMBIT_METER_SERVICE);
  assert_non_null(meter);
  meter->enter("my part");
  meter->operation(AMBIT_OP_SIN);
  meter->operation(AMBIT_OP_COUNT);
  meter->leave();
  const ambit_meter_frame *mine = find(ambit_profile_end(p), "my part");
  assert_non_null(find(mine, "SIN"));
  assert_non_null(find(mine, "other"));
  ambit_profile_close(p);
  ambit_scope_close(scope);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(counts_series, set_up, tear_down),
    cmocka_unit_test_setup_teardown(counts_values, set_up, tear_down),
    cmocka_unit_test(does_not_count_for_others),
    cmocka_unit_test_setup_teardown(counts_an_evaluation, set_up, tear_down),
    cmocka_unit_test(counts_runs),
    cmocka_unit_test(counts_threads_alike),
    cmocka_unit_test(is_off_by_itself),
    cmocka_unit_test(nests_frames),
    cmocka_unit_test(survives_too_many_frames),
    cmocka_unit_test(joins_threads),
    cmocka_unit_test(joins_threads_of_threads),
    cmocka_unit_test_setup_teardown(shares_instructions, set_up, tear_down),
    cmocka_unit_test(profiles_without_changing),
    cmocka_unit_test(lends_the_meter_only_then),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
