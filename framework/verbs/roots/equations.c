/* equations.c -- from expressions to tapes over unknowns and uncertain data. */
#include "verbs/roots/equations.h"
#include "graph/contract.h"
#include "graph/hull.h"
#include "graph/name.h"
#include "graph/tape.h"
#include "verbs/run/context.h"
#include "verbs/run/unknowns.h"
#include <stdio.h>
#include <string.h>

#define NAMES_MAX 256

static void *room(ambit_arena *arena, size_t n, size_t size) { return ambit_arena_alloc(arena, (n + 1) * size); }

/* bindings put in; data whose range is one number become that number; 0 = 0 left out */
static ambit_status bind(const ambit_equations *q, ambit_ready *r, ambit_failure *f) {
  r->equation = room(r->arena, q->ne, sizeof *r->equation);
  r->place = room(r->arena, q->ne, sizeof *r->place);
  if (!r->equation || !r->place) return ambit_no_memory(f);
  for (size_t i = 0; i < q->ne; i++)
    if (q->equation[i] == AMBIT_NO_EXPR) return ambit_fail(f, AMBIT_INVALID, "equation %zu is none", i + 1);
  if (q->ne) memcpy(r->equation, q->equation, q->ne * sizeof *r->equation);
  ambit_status status = ambit_graph_substitute(q->graph, q->ne, r->equation, q->nbinding, q->leaf, q->value, f);
  if (status == AMBIT_OK) status = ambit_unknowns_fold_points(q->graph, r->arena, q->ne, r->equation, f);
  ambit_expr zero = ambit_graph_number(q->graph, 0);
  for (size_t i = 0; i < q->ne; i++)
    if (r->equation[i] != zero) {
      r->place[r->ne] = i;
      r->equation[r->ne++] = r->equation[i];
    }
  return status;
}

static ambit_status check_leaves(
    const ambit_equations *q, const ambit_ready *r, size_t n, const ambit_expr *leaf, ambit_failure *f) {
  char name[NAMES_MAX];
  size_t others = ambit_unknowns_name_others(q->graph, n, leaf, q->nx, q->unknown, name, sizeof name);
  if (others == 0) return AMBIT_OK;
  (void)r;
  return ambit_fail(f, AMBIT_INVALID, "%s %s no value: give a range in `box`, to be searched, or a value in `at`", name,
      others == 1 ? "has" : "have");
}

static ambit_status find_inputs(const ambit_equations *q, ambit_ready *r, ambit_failure *f) {
  size_t n;
  ambit_expr *leaf;
  ambit_status status = ambit_unknowns_leaves(q->graph, r->arena, r->ne, r->equation, &n, &leaf, f);
  if (status == AMBIT_OK) status = check_leaves(q, r, n, leaf, f);
  if (status != AMBIT_OK) return status;
  const char **name = room(r->arena, q->nx + n, sizeof *name);
  r->input = room(r->arena, q->nx + n, sizeof *r->input);
  r->p = room(r->arena, n, sizeof *r->p);
  if (!name || !r->input || !r->p) return ambit_no_memory(f);
  for (size_t i = 0; i < q->nx; i++) {
    r->input[i] = q->unknown[i];
    name[i] = ambit_arena_text(r->arena, q->name[i]);
  }
  for (size_t i = 0; i < n; i++) {
    const ambit_node *node = ambit_graph_node(q->graph, leaf[i]);
    if (!ambit_leaf_is_uncertain(node->op)) continue;
    r->input[q->nx + r->np] = leaf[i];
    r->p[r->np] = node->value;
    r->np++;
  }
  for (size_t i = 0; i < q->nx; i++)
    if (!name[i]) return ambit_no_memory(f);
  if (!ambit_graph_leaf_names(r->graph, r->arena, r->np, r->input + q->nx, name + q->nx)) return ambit_no_memory(f);
  r->name = name;
  return AMBIT_OK;
}

ambit_status ambit_equations_prepare(const ambit_equations *q, ambit_arena *arena, ambit_ready *r, ambit_failure *f) {
  *r = (ambit_ready) { .graph = q->graph, .arena = arena, .nx = q->nx };
  ambit_status status = bind(q, r, f);
  if (status == AMBIT_OK) status = find_inputs(q, r, f);
  for (size_t i = 0; i < r->np && status == AMBIT_OK; i++)
    if (ambit_interval_is_empty(r->p[i]) || !ambit_interval_is_bounded(r->p[i]))
      status = ambit_fail(f, AMBIT_INVALID, "the uncertain datum `%s` is empty or not bounded: [%g, %g]",
          r->name[r->nx + i], r->p[i].lo, r->p[i].hi);
  return status;
}

ambit_status ambit_equations_seal(const ambit_ready *r, size_t ne, const ambit_expr *equation, uint32_t flags,
    const ambit_tape **tape, ambit_failure *f) {
  return ambit_tape_seal(r->graph, r->arena, ne, equation, r->nx + r->np, r->input, 0, flags, tape, f);
}

ambit_status ambit_equations_differentiate(const ambit_ready *r, size_t ne, const ambit_expr *equation, size_t first,
    size_t n, uint32_t flags, const ambit_tape **tape, ambit_failure *f) {
  ambit_expr *entry = room(r->arena, ne * n, sizeof *entry);
  if (!entry) return ambit_no_memory(f);
  for (size_t i = 0; i < ne; i++)
    for (size_t j = 0; j < n; j++) {
      ambit_failure why = { 0 };
      entry[i * n + j] = ambit_graph_derivative(r->graph, equation[i], r->input[first + j], &why);
      if (entry[i * n + j] == AMBIT_NO_EXPR)
        return ambit_fail(f, why.status == AMBIT_OK ? AMBIT_NOMEM : why.status, "equation %zu has no derivative: %s",
            i + 1, why.message[0] ? why.message : "out of memory");
    }
  return ambit_tape_seal(r->graph, r->arena, ne * n, entry, r->nx + r->np, r->input, 0, flags, tape, f);
}

bool ambit_equations_at(
    const ambit_ready *r, const ambit_tape *tape, const double *x, ambit_interval *slot, double *out) {
  ambit_interval *in = slot + tape->nconst;
  for (size_t i = 0; i < r->nx; i++) in[i] = (ambit_interval) { x[i], x[i] };
  for (size_t i = 0; i < r->np; i++) {
    double m = ambit_interval_mid(r->p[i]);
    in[r->nx + i] = (ambit_interval) { m, m };
  }
  if (ambit_hull(tape, in, slot) & (AMBIT_F_PARTIAL | AMBIT_F_EMPTY | AMBIT_F_UNBOUNDED)) return false;
  for (uint32_t k = 0; k < tape->nout; k++) out[k] = ambit_interval_mid(slot[tape->out[k]]);
  return true;
}

static ambit_status inspect(const ambit_ready *r, ambit_scope *scope, const ambit_interval *box, bool with_data,
    bool *smooth, ambit_failure *f) {
  const ambit_tape *tape;
  ambit_contractor *contractor;
  double *lo = room(r->arena, r->nx + r->np, sizeof *lo), *hi = room(r->arena, r->nx + r->np, sizeof *hi);
  if (!lo || !hi) return ambit_no_memory(f);
  ambit_status status = ambit_equations_seal(r, r->ne, r->equation, 0, &tape, f);
  if (status != AMBIT_OK) return status;
  if (ambit_contract_service_v1.open(&scope->host, tape, &contractor) != AMBIT_OK) return ambit_no_memory(f);
  for (size_t i = 0; i < r->nx + r->np; i++) {
    ambit_interval x = i < r->nx ? box[i] : r->p[i - r->nx];
    lo[i] = x.lo, hi[i] = x.hi;
  }
  uint32_t n = (uint32_t)(with_data ? r->nx + r->np : r->nx);
  uint32_t flags = ambit_contract_service_v1.inspect_in(contractor, lo, hi, n);
  *smooth = (flags & ~AMBIT_F_KINK_ELSEWHERE) == 0;
  return AMBIT_OK;
}

ambit_status ambit_equations_are_smooth(const ambit_equations *q, ambit_registry *registry, const ambit_interval *box,
    bool with_data, bool *smooth, ambit_failure *f) {
  ambit_arena *arena = ambit_arena_open();
  ambit_scope *scope = NULL;
  ambit_ready ready = { 0 };
  *smooth = false;
  ambit_status status = arena ? ambit_equations_prepare(q, arena, &ready, f) : ambit_no_memory(f);
  if (status == AMBIT_OK) status = ambit_context_scope(registry, &scope, f);
  if (status == AMBIT_OK) status = inspect(&ready, scope, box, with_data, smooth, f);
  ambit_scope_close(scope);
  ambit_arena_close(arena);
  return status;
}
