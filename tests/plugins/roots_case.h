/* roots_case.h -- equations for tests of root finders, and what a run found. */
#ifndef ROOTS_CASE_H
#define ROOTS_CASE_H
#include <ambit/roots.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#ifdef ROOTS_COUNT_ALLOCATIONS
#include "kit/allocations.h"
#else
static inline size_t ambit_allocation_count(void) { return 0; }
#endif

#define ROOTS_UNKNOWNS 6
#define ROOTS_MAX 4096

typedef struct roots_case {
  ambit_registry *registry;
  ambit_graph *graph;
  ambit_expr x[ROOTS_UNKNOWNS];
  const char *name[ROOTS_UNKNOWNS];
} roots_case;

typedef struct found {
  ambit_sink sink; /* first */
  uint32_t n, count, stop_after, progress_after, calls;
  uint32_t kind[ROOTS_MAX];
  ambit_interval box[ROOTS_MAX][ROOTS_UNKNOWNS];
  double done;
  size_t first_count, last_count; /* allocations at the first and the last word of the solver */
  ambit_roots_result result;
  ambit_failure failure;
} found;

static inline roots_case roots_open(void) {
  static const char *const name[ROOTS_UNKNOWNS] = { "x", "y", "z", "u", "v", "w" };
  roots_case c = { .registry = ambit_registry_open(NULL), .graph = ambit_graph_open() };
  for (int i = 0; i < ROOTS_UNKNOWNS; i++) {
    c.name[i] = name[i];
    c.x[i] = ambit_graph_symbol(c.graph, name[i], "1");
  }
  return c;
}

static inline void roots_close(roots_case *c) {
  ambit_graph_close(c->graph);
  ambit_registry_close(c->registry);
}

static inline void found_count(found *to) {
  to->last_count = ambit_allocation_count();
  if (to->calls == 0 && to->count == 0) to->first_count = to->last_count;
}

static inline int32_t found_emit(ambit_sink *s, const ambit_record *r) {
  found *to = (found *)(void *)s;
  found_count(to);
  assert_true(to->count < ROOTS_MAX && r->nx == to->n && r->rigorous == 1);
  to->kind[to->count] = r->event;
  for (uint32_t i = 0; i < r->nx; i++) to->box[to->count][i] = (ambit_interval) { r->lo[i], r->hi[i] };
  return ++to->count == to->stop_after;
}

static inline int32_t found_progress(ambit_sink *s, double done, const char *message) {
  found *to = (found *)(void *)s;
  (void)message;
  found_count(to);
  assert_true(done >= to->done && done <= 1);
  to->done = done;
  return ++to->calls == to->progress_after;
}

/* n equations in n unknowns over box; options by name and text */
static inline ambit_status roots_run(roots_case *c, uint32_t n, const ambit_expr *f, const ambit_interval *box,
    const char *arithmetic, size_t noption, const ambit_option *option, found *to) {
  ambit_equations e = { .graph = c->graph, .ne = n, .equation = f, .nx = n, .unknown = c->x, .name = c->name };
  to->sink = (ambit_sink) { sizeof to->sink, found_emit, found_progress };
  to->n = n;
  ambit_roots_request q = { .equations = &e,
    .box = box,
    .registry = c->registry,
    .solver = "krawczyk",
    .arithmetic = arithmetic,
    .nsolver_option = noption,
    .solver_option = option,
    .sink = &to->sink };
  return ambit_roots(&q, &to->result, NULL, &to->failure);
}

static inline found *roots_find(roots_case *c, uint32_t n, const ambit_expr *f, const ambit_interval *box) {
  found *to = calloc(1, sizeof *to);
  if (roots_run(c, n, f, box, NULL, 0, NULL, to) != AMBIT_OK) fail_msg("%s", to->failure.message);
  return to;
}

/* how many boxes of the kind hold the point */
static inline uint32_t found_holding(const found *r, uint32_t kind, const double *at) {
  uint32_t holding = 0;
  for (uint32_t i = 0; i < r->count; i++) {
    bool inside = r->kind[i] == kind;
    for (uint32_t j = 0; j < r->n; j++) inside = inside && ambit_interval_contains(r->box[i][j], at[j]);
    holding += inside;
  }
  return holding;
}

/* -- expressions */

static inline ambit_expr number(roots_case *c, double x) { return ambit_graph_number(c->graph, x); }
static inline ambit_expr add(roots_case *c, ambit_expr a, ambit_expr b) {
  return ambit_graph_op(c->graph, AMBIT_OP_ADD, a, b);
}
static inline ambit_expr subtract(roots_case *c, ambit_expr a, ambit_expr b) {
  return ambit_graph_op(c->graph, AMBIT_OP_SUB, a, b);
}
static inline ambit_expr multiply(roots_case *c, ambit_expr a, ambit_expr b) {
  return ambit_graph_op(c->graph, AMBIT_OP_MUL, a, b);
}
static inline ambit_expr apply(roots_case *c, uint32_t op, ambit_expr a) { return ambit_graph_op(c->graph, op, a, a); }
static inline ambit_expr less(roots_case *c, ambit_expr a, double b) { return subtract(c, a, number(c, b)); }

/* -- random numbers: xorshift64* */

static inline double uniform(void) {
  static uint64_t state = 0x2545f4914f6cdd1du;
  state ^= state >> 12, state ^= state << 25, state ^= state >> 27;
  return (double)((state * 0x2545f4914f6cdd1du) >> 11) * 0x1p-53;
}
static inline double between(double lo, double hi) { return lo + uniform() * (hi - lo); }
static inline int choose(int n) { return (int)(uniform() * n); }
#endif
