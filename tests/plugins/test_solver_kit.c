/* The kit of solvers notices records whose dense enclosure or set is wrong: lohner's records, spoilt on their way. */
#include "solver_case.h"
#include "graph/hull.h"
#include "graph/tape.h"
#include "kit/solver_kit_random.h"
#include <math.h>

enum spoil {
  NOTHING,
  DENSE_MOVED,
  DENSE_SHARP,
  DENSE_NAN,
  DENSE_MISSING,
  SET_MOVED,
  SET_TURNED,
  SET_SHARP,
  SET_WIDE,
  SET_UNKNOWNS,
  SET_MISSING,
  SPOILS
};

#define TERMS 512

typedef struct liar {
  ambit_sink sink; /* first */
  ambit_sink *outer;
} liar;

static enum spoil kind;
static const ambit_solver *honest;

/* a record with some entries changed; copies live until the record is judged */
typedef struct copy {
  ambit_record r;
  ambit_set set;
  double mid[TERMS], rad[TERMS], coefficient[TERMS], rest[TERMS];
} copy;

static void spoil_dense(copy *c) {
  if (!c->r.dense_mid) return;
  size_t n = (size_t)c->r.nx * c->r.ndense;
  assert_true(n <= TERMS);
  memcpy(c->mid, c->r.dense_mid, n * sizeof(double));
  memcpy(c->rad, c->r.dense_rad, n * sizeof(double));
  c->r.dense_mid = c->mid, c->r.dense_rad = c->rad;
  if (kind == DENSE_MOVED) c->mid[0] += 1e-3 + 2 * c->rad[0];
  if (kind == DENSE_SHARP) memset(c->rad, 0, sizeof c->rad);
  if (kind == DENSE_NAN) c->rad[n - 1] = NAN;
  if (kind == DENSE_MISSING) c->r.dense_mid = c->r.dense_rad = NULL, c->r.ndense = 0;
}

static void spoil_set(copy *c) {
  if (!c->r.set) return;
  c->set = *c->r.set;
  uint32_t nx = c->r.nx, nterm = c->set.nterm;
  assert_true(nx * nterm <= TERMS);
  memcpy(c->coefficient, c->set.coefficient, nx * nterm * sizeof(double));
  memcpy(c->rest, c->set.rest, nx * sizeof(double));
  c->r.set = &c->set, c->set.coefficient = c->coefficient, c->set.rest = c->rest;
  if (kind == SET_MOVED) c->coefficient[0] += 1e-3 + 2 * c->rest[0];
  if (kind == SET_TURNED && nterm > 1) c->coefficient[1] = -c->coefficient[1];
  if (kind == SET_SHARP) c->rest[0] = 0;
  if (kind == SET_WIDE) c->rest[0] += 1 + c->r.hi[0] - c->r.lo[0];
  if (kind == SET_UNKNOWNS) c->set.nu++;
  if (kind == SET_MISSING) c->r.set = NULL;
}

static int32_t emit(ambit_sink *s, const ambit_record *r) {
  static copy c;
  liar *l = (liar *)(void *)s;
  c.r = *r;
  spoil_dense(&c);
  spoil_set(&c);
  return l->outer->emit(l->outer, &c.r);
}

static int32_t progress(ambit_sink *s, double done, const char *message) {
  liar *l = (liar *)(void *)s;
  return l->outer->progress(l->outer, done, message);
}

static ambit_status run(void *self, ambit_sink *sink) {
  liar l = { { sizeof l.sink, emit, progress }, sink };
  return honest->run(self, &l.sink);
}

static void what_is_spoilt_is_found(void **unused) {
  (void)unused;
  solver_case c;
  case_open(&c, "lohner", "interval");
  honest = c.kit.plugin;
  ambit_solver spoilt = *honest;
  spoilt.run = run;
  c.kit.plugin = &spoilt;
  c.kit.gives = AMBIT_EXTRA_DENSE | AMBIT_EXTRA_SET;
  for (kind = NOTHING; kind < SPOILS; kind++) {
    c.kit.finding = kind == NOTHING ? case_show : case_hide;
    /* few terms, so that remainders and rests are more than rounding */
    size_t findings = case_findings(&c, "tolerance", "1e-9");
    if ((kind == NOTHING) != (findings == 0)) fail_msg("spoilt in way %d: %zu findings", (int)kind, findings);
  }
  case_close(&c);
}

/* -- implicit forms */

static ambit_interval at(kit_model *m, ambit_expr e, const double *x) {
  ambit_failure f = { 0 };
  ambit_arena *arena = ambit_arena_open();
  const ambit_tape *tape;
  ambit_expr in[KIT_STATES + KIT_DATA + 1];
  ambit_interval value[KIT_STATES + KIT_DATA + 1], slot[4096], y;
  size_t n = 0;
  for (size_t i = 0; i < m->nx; i++, n++) in[n] = m->state[i], value[n] = (ambit_interval) { x[i], x[i] };
  for (size_t j = 0; j < m->ndatum; j++, n++) in[n] = m->datum[j], value[n] = (ambit_interval) { 0.75, 0.75 };
  in[n] = ambit_graph_time(m->graph), value[n++] = (ambit_interval) { 0.375, 0.375 };
  assert_int_equal(ambit_tape_seal(m->graph, arena, 1, &e, n, in, 0, 0, &tape, &f), AMBIT_OK);
  assert_true(tape->nslot <= 4096);
  ambit_hull(tape, value, slot);
  y = slot[tape->out[0]];
  ambit_arena_close(arena);
  return y;
}

static void expect_form(kit_model *m, const ambit_implicit_form *form) {
  static const double x[KIT_STATES] = { 0.5, -1.25, 0.75, 1.5, -0.5, 0.25, -0.75, 1, 2, -2, 0.125, 0.875 };
  ambit_failure f = { 0 };
  ambit_expr all[2 * KIT_STATES];
  memcpy(all, form->residual, m->nx * sizeof *all);
  memcpy(all + m->nx, form->rate, m->nx * sizeof *all);
  assert_int_equal(ambit_graph_substitute(m->graph, 2 * m->nx, all, m->nx, form->unknown, m->rate, &f), AMBIT_OK);
  for (size_t i = 0; i < m->nx; i++) {
    ambit_interval r = at(m, all[i], x);
    assert_true(r.lo <= 0 && r.hi >= 0 && r.hi - r.lo < 1e-11);
    ambit_interval a = at(m, all[m->nx + i], x), b = at(m, m->rate[i], x);
    assert_true(a.lo <= b.hi && b.lo <= a.hi && a.hi - a.lo < 1e-11);
  }
}

/* Their a is x', and solvers that take it are tried on it like all others. */
static void implicit_forms_are_those_of_the_systems(void **unused) {
  (void)unused;
  size_t seen = 0;
  for (size_t item = 0; item < 36; item++) {
    kit_random_system r;
    kit_model m;
    ambit_failure f = { 0 };
    ambit_arena *arena = ambit_arena_open();
    kit_random_make(&r, 7, item);
    kit_model_open(&m, &r.problem);
    const ambit_implicit_form *form;
    assert_int_equal(ambit_system_implicit(&m.system, &form, &f), AMBIT_OK);
    assert_true((form != NULL) == (r.stages > 0));
    if (form) expect_form(&m, form);
    seen += form != NULL;
    ambit_problem p;
    const ambit_problem_request q = { .system = &m.system,
      .initial = m.initial,
      .ntime = r.problem.ntime,
      .time = r.problem.time,
      .want = AMBIT_WANT_IMPLICIT | AMBIT_WANT_INITIAL };
    if (ambit_problem_build(&q, arena, &p, &f) != AMBIT_OK) fail_msg("%s: %s", r.name, f.message);
    assert_true(p.implicit->na == (form ? m.nx : 0) && p.implicit->nstage == r.stages && !p.rhs);
    kit_model_close(&m);
    ambit_arena_close(arena);
  }
  assert_true(seen >= 18);
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(what_is_spoilt_is_found),
    cmocka_unit_test(implicit_forms_are_those_of_the_systems) };
  return cmocka_run_group_tests_name("solver kit", tests, NULL, NULL);
}
