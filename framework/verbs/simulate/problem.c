/* problem.c -- which data are parameters, which are unknowns; the tapes over them; the hull of the initial set. */
#include "verbs/simulate/problem.h"
#include "verbs/simulate/implicit.h"
#include "graph/name.h"
#include "graph/series_lowering.h"
#include "graph/tape.h"
#include "graph/hull.h"
#include "num/interval.h"
#include "verbs/run/schedule.h"
#include "verbs/run/unknowns.h"
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define NAMES_MAX 256

typedef struct build {
  const ambit_problem_request *q;
  ambit_graph *graph;
  ambit_arena *arena;
  ambit_failure *f;
  const ambit_expr *rate;          /* [nx] of the system; NULL: not wanted */
  size_t nrate, ninvariant;        /* nx, or 0 where the implicit form does; 0 unless they are wanted */
  const ambit_implicit_form *form; /* NULL: not wanted, or there is none */
  /* everything over states, parameters and time, without point unknowns: rates [nrate], invariants [ninvariant], of the
  ** implicit form F [nx] and R [na] */
  size_t nall;
  ambit_expr *all, *invariant, *implicit, *jump; /* jump [njump x nx] */
  ambit_expr *start;                             /* [nx] without point unknowns */
  ambit_expr *input;                             /* [nx + np + uses_time] of the right-hand side */
  ambit_expr *unknown;                           /* [nu] */
  const ambit_tape *initial;                     /* always sealed, because its hull is needed */
  ambit_problem *p;
} build;

static ambit_status no_memory(const build *b) { return ambit_fail(b->f, AMBIT_NOMEM, "out of memory"); }

static void *room(const build *b, size_t n, size_t size) { return ambit_arena_alloc(b->arena, n * size); }

/* -- times */

static ambit_status check_times(const build *b) {
  const double *t = b->q->time;
  size_t n = b->q->ntime;
  if (n < 2) return ambit_fail(b->f, AMBIT_INVALID, "t needs a start and an end");
  for (size_t i = 0; i < n; i++)
    if (!isfinite(t[i])) return ambit_fail(b->f, AMBIT_INVALID, "t: instant %zu is not a finite number", i + 1);
  if (t[0] == t[n - 1])
    return ambit_fail(b->f, AMBIT_INVALID, "the time span is zero: t starts and ends at %.17g s", t[0]);
  if (!isfinite(t[n - 1] - t[0]))
    return ambit_fail(b->f, AMBIT_INVALID,
        "t: the time span from %.17g s to %.17g s is too long: expected less than %.1e s", t[0], t[n - 1], DBL_MAX);
  bool backwards = t[n - 1] < t[0];
  for (size_t i = 1; i < n; i++)
    if (backwards ? t[i] >= t[i - 1] : t[i] <= t[i - 1])
      return ambit_fail(b->f, AMBIT_INVALID, "t: the instants must %s strictly, but %.17g is followed by %.17g",
          backwards ? "descend" : "ascend", t[i - 1], t[i]);
  return AMBIT_OK;
}

/* -- expressions */

/* SERIES asks for the right-hand side, too, but not beside the implicit form. */
static bool wants_rhs(uint32_t want) {
  return (want & AMBIT_WANT_RHS) || ((want & AMBIT_WANT_SERIES) && !(want & AMBIT_WANT_IMPLICIT));
}

static bool wants_rates(uint32_t want) { return wants_rhs(want) || (want & (AMBIT_WANT_JACOBIAN | AMBIT_WANT_SLOPE)); }

static ambit_status check_expressions(const build *b) {
  const ambit_system *s = b->q->system;
  if (s->nx == 0) return ambit_fail(b->f, AMBIT_INVALID, "the system has no states");
  for (size_t i = 0; i < s->nx; i++) {
    if (b->q->initial[i] == AMBIT_NO_EXPR)
      return ambit_fail(b->f, AMBIT_INVALID, "state `%s` has no initial value", s->name[i]);
    if (b->rate && b->rate[i] == AMBIT_NO_EXPR)
      return ambit_fail(b->f, AMBIT_INVALID, "state `%s` has no equation", s->name[i]);
  }
  for (size_t i = 0; i < b->ninvariant; i++)
    if (s->invariant[i] == AMBIT_NO_EXPR)
      return ambit_fail(b->f, AMBIT_INVALID, "invariant `%s` has no formula", s->invariant_name[i]);
  return AMBIT_OK;
}

/* What is wanted of the system, in one list. */
static ambit_status collect_expressions(build *b) {
  const ambit_system *s = b->q->system;
  size_t nform = b->form ? s->nx + b->form->na : 0;
  b->nrate = b->rate ? s->nx : 0;
  size_t njump = s->njump * s->nx;
  b->nall = b->nrate + b->ninvariant + nform + njump;
  b->all = room(b, b->nall + 1, sizeof *b->all);
  if (!b->all) return no_memory(b);
  b->invariant = b->all + b->nrate;
  b->implicit = b->form ? b->invariant + b->ninvariant : b->all;
  if (b->rate) memcpy(b->all, b->rate, b->nrate * sizeof *b->all);
  if (b->ninvariant) memcpy(b->invariant, s->invariant, b->ninvariant * sizeof *b->all);
  b->jump = b->all + b->nall - njump;
  for (size_t i = 0; i < s->njump; i++) memcpy(b->jump + i * s->nx, s->jump[i].to, s->nx * sizeof *b->all);
  if (!b->form) return AMBIT_OK;
  memcpy(b->implicit, b->form->rate, s->nx * sizeof *b->all);
  memcpy(b->implicit + s->nx, b->form->residual, b->form->na * sizeof *b->all);
  return AMBIT_OK;
}

static ambit_status copy_expressions(build *b) {
  const ambit_system *s = b->q->system;
  b->ninvariant = b->q->want & AMBIT_WANT_INVARIANT ? s->ninvariant : 0;
  ambit_status status = AMBIT_OK;
  if (b->q->want & AMBIT_WANT_IMPLICIT) status = ambit_system_implicit(s, &b->form, b->f);
  if (status == AMBIT_OK && (!b->form || wants_rates(b->q->want))) status = ambit_system_rates(s, &b->rate, b->f);
  if (status == AMBIT_OK) status = check_expressions(b);
  if (status == AMBIT_OK) status = collect_expressions(b);
  if (status != AMBIT_OK) return status;
  b->start = room(b, s->nx, sizeof *b->start);
  if (!b->start) return no_memory(b);
  memcpy(b->start, b->q->initial, s->nx * sizeof *b->start);
  status = ambit_unknowns_fold_points(b->graph, b->arena, b->nall, b->all, b->f);
  return status == AMBIT_OK ? ambit_unknowns_fold_points(b->graph, b->arena, s->nx, b->start, b->f) : status;
}

/* How many leaves below e[0..ne) are neither unknowns nor allowed, and their names. */
static ambit_status find_strangers(const build *b, size_t ne, const ambit_expr *e, size_t nallowed,
    const ambit_expr *allowed, size_t *strangers, char name[NAMES_MAX]) {
  size_t n;
  ambit_expr *leaf;
  ambit_status status = ambit_unknowns_leaves(b->graph, b->arena, ne, e, &n, &leaf, b->f);
  if (status == AMBIT_OK)
    *strangers = ambit_unknowns_name_others(b->graph, n, leaf, nallowed, allowed, name, NAMES_MAX);
  return status;
}

/* All e[i] together reach only unknowns and the allowed leaves; otherwise the failure says which one does not. */
static ambit_status check_leaves(const build *b, size_t n, const ambit_expr *e, const char *what,
    const char *const *whose, size_t nallowed, const ambit_expr *allowed, const char *hint) {
  char name[NAMES_MAX];
  size_t strangers;
  ambit_status status = find_strangers(b, n, e, nallowed, allowed, &strangers, name);
  if (status != AMBIT_OK || strangers == 0) return status;
  for (size_t i = 0; i < n; i++) {
    status = find_strangers(b, 1, &e[i], nallowed, allowed, &strangers, name);
    if (status != AMBIT_OK) return status;
    if (strangers) return ambit_fail(b->f, AMBIT_INVALID, "the %s `%s` depends on %s%s", what, whose[i], name, hint);
  }
  return AMBIT_OK;
}

/* The implicit form may depend on its unknowns, too. */
static ambit_status check_form(const build *b, ambit_expr *allowed, const char *hint) {
  const ambit_system *s = b->q->system;
  size_t nx = s->nx, na = b->form->na;
  const char **name = room(b, na, sizeof *name);
  if (!name) return no_memory(b);
  memcpy(allowed + nx + 1, b->form->unknown, na * sizeof *allowed);
  for (size_t k = 0; k < na; k++) name[k] = ambit_graph_node(b->graph, b->form->unknown[k])->text;
  ambit_status status =
      check_leaves(b, nx, b->implicit, "right-hand side of state", s->name, nx + 1 + na, allowed, hint);
  if (status != AMBIT_OK) return status;
  return check_leaves(b, na, b->implicit + nx, "equation for", name, nx + 1 + na, allowed, hint);
}

static ambit_status check_reach(const build *b) {
  const ambit_system *s = b->q->system;
  static const char hint[] = ", which is neither a state nor a parameter";
  ambit_expr *allowed = room(b, s->nx + 1 + (b->form ? b->form->na : 0), sizeof *allowed);
  if (!allowed) return no_memory(b);
  memcpy(allowed, s->state, s->nx * sizeof *allowed);
  allowed[s->nx] = ambit_graph_time(b->graph);
  ambit_status status =
      check_leaves(b, b->nrate, b->all, "right-hand side of state", s->name, s->nx + 1, allowed, hint);
  if (status == AMBIT_OK && b->ninvariant)
    status = check_leaves(b, b->ninvariant, b->invariant, "invariant", s->invariant_name, s->nx + 1, allowed, hint);
  if (status == AMBIT_OK && b->form) status = check_form(b, allowed, hint);
  for (size_t i = 0; i < s->njump && status == AMBIT_OK; i++)
    status = check_leaves(b, s->nx, b->jump + i * s->nx, "sampled value of", s->name, s->nx + 1, allowed, hint);
  if (status != AMBIT_OK) return status;
  return check_leaves(b, s->nx, b->start, "initial value of state", s->name, 0, NULL,
      ", but it may use numbers and uncertain data only");
}

/* -- parameters and unknowns */

static void add_parameters(build *b, size_t n, const ambit_expr *leaf, uint32_t wanted) {
  for (size_t i = 0; i < n; i++) {
    uint32_t op = ambit_graph_node(b->graph, leaf[i])->op;
    if (op == AMBIT_LEAF_TIME) b->p->uses_time = 1;
    if (op == wanted) b->input[b->p->nx + b->p->np++] = leaf[i];
  }
}

/* None of e[i] may depend on what varies in time. */
static ambit_status check_fixed(
    const build *b, size_t n, const ambit_expr *e, const char *what, const char *const *whose, const char *hint) {
  for (size_t i = 0; i < n; i++) {
    size_t count;
    ambit_expr *leaf;
    ambit_status status = ambit_unknowns_leaves(b->graph, b->arena, 1, &e[i], &count, &leaf, b->f);
    if (status != AMBIT_OK) return status;
    for (size_t k = 0; k < count; k++) {
      if (ambit_graph_node(b->graph, leaf[k])->op != AMBIT_LEAF_VARYING) continue;
      char name[AMBIT_DATUM_NAME_MAX];
      ambit_graph_leaf_name(b->graph, leaf[k], name);
      return ambit_fail(b->f, AMBIT_INVALID, "the %s `%s` depends on `%s`%s", what, whose[i], name, hint);
    }
  }
  return AMBIT_OK;
}

/* Initial values and invariants may not. */
static ambit_status check_all_fixed(const build *b) {
  const ambit_system *s = b->q->system;
  ambit_status status = check_fixed(b, s->nx, b->start, "initial value of state", s->name,
      ", which varies in time: use ambit.between for one unknown value");
  if (status != AMBIT_OK) return status;
  return check_fixed(
      b, b->ninvariant, b->invariant, "invariant", s->invariant_name, ", which varies in time in any way");
}

/* What takes parameters for constants must not be given functions of time. */
static ambit_status check_varying(const build *b) {
  if (!b->p->nvarying) return AMBIT_OK;
  if (b->q->want & AMBIT_WANT_VARYING) return check_all_fixed(b);
  char name[AMBIT_DATUM_NAME_MAX];
  ambit_graph_leaf_name(b->graph, b->input[b->p->nx + b->p->np - b->p->nvarying], name);
  return ambit_fail_code(b->f, AMBIT_UNABLE, AMBIT_CODE_UNABLE_VARYING,
      "`%s` varies in time, and this solver takes data for constants: leave out `solver`, or name one that takes what "
      "varies",
      name);
}

/* Inputs of all of them: states, then the unknowns they reach, then what varies, then time if it is used. */
static ambit_status find_parameters(build *b) {
  const ambit_system *s = b->q->system;
  size_t n;
  ambit_expr *leaf;
  ambit_status status = ambit_unknowns_leaves(b->graph, b->arena, b->nall, b->all, &n, &leaf, b->f);
  if (status != AMBIT_OK) return status;
  b->input = room(b, s->nx + n + 1, sizeof *b->input);
  const char **name = room(b, s->nx + n, sizeof *name);
  if (!b->input || !name) return no_memory(b);
  for (size_t i = 0; i < s->nx; i++) {
    b->input[i] = s->state[i];
    name[i] = ambit_arena_text(b->arena, s->name[i]);
    if (!name[i]) return no_memory(b);
  }
  add_parameters(b, n, leaf, AMBIT_LEAF_UNKNOWN);
  size_t fixed = b->p->np;
  add_parameters(b, n, leaf, AMBIT_LEAF_VARYING);
  b->p->nvarying = (uint32_t)(b->p->np - fixed);
  status = check_varying(b);
  if (status != AMBIT_OK) return status;
  if (!ambit_graph_leaf_names(b->graph, b->arena, b->p->np, b->input + s->nx, name + s->nx)) return no_memory(b);
  if (b->p->uses_time) b->input[s->nx + b->p->np] = ambit_graph_time(b->graph);
  b->p->name = name;
  return AMBIT_OK;
}

/* The tape from the unknowns to x(t0) and p; an unknown that several of them share is one input. */
static ambit_status seal_initial(build *b) {
  size_t nx = b->q->system->nx, np = b->p->np, nu;
  ambit_expr *out = room(b, nx + np, sizeof *out);
  if (!out) return no_memory(b);
  memcpy(out, b->start, nx * sizeof *out);
  memcpy(out + nx, b->input + nx, np * sizeof *out);
  for (size_t i = nx + np - b->p->nvarying; i < nx + np; i++) {
    out[i] = ambit_graph_interval(b->graph, ambit_graph_node(b->graph, out[i])->value);
    if (out[i] == AMBIT_NO_EXPR) return no_memory(b);
  }
  ambit_status status = ambit_unknowns_leaves(b->graph, b->arena, nx + np, out, &nu, &b->unknown, b->f);
  for (size_t i = 0; i < nu && status == AMBIT_OK; i++)
    if (ambit_graph_node(b->graph, b->unknown[i])->op == AMBIT_LEAF_VARYING) status = check_all_fixed(b);
  if (status != AMBIT_OK) return status;
  const char **name = room(b, nu + 1, sizeof *name);
  if (!name || !ambit_graph_leaf_names(b->graph, b->arena, nu, b->unknown, name)) return no_memory(b);
  b->p->nu = (uint32_t)nu, b->p->unknown_name = name;
  if (b->q->unknown) *b->q->unknown = b->unknown;
  return ambit_tape_seal(
      b->graph, b->arena, nx + np, out, nu, b->unknown, 0, AMBIT_TAPE_SERIES | b->q->seal, &b->initial, b->f);
}

/* -- hulls */

static double *split(const build *b, size_t n, const ambit_interval *x, double **hi) {
  double *lo = room(b, n, sizeof *lo);
  *hi = room(b, n, sizeof **hi);
  for (size_t i = 0; lo && *hi && i < n; i++) {
    lo[i] = x[i].lo;
    (*hi)[i] = x[i].hi;
  }
  return lo && *hi ? lo : NULL;
}

static ambit_status check_hull(const build *b, uint32_t flags, const ambit_interval *x) {
  const ambit_problem *p = b->p;
  for (size_t i = 0; i < p->nx + p->np; i++) {
    const char *what = i < p->nx ? "the initial value of state" : "the range of parameter";
    if (ambit_interval_is_empty(x[i])) return ambit_fail(b->f, AMBIT_INVALID, "%s `%s` is empty", what, p->name[i]);
    if (!ambit_interval_is_bounded(x[i]))
      return ambit_fail(b->f, AMBIT_INVALID, "%s `%s` is not bounded: [%g, %g]", what, p->name[i], x[i].lo, x[i].hi);
  }
  if (flags & (AMBIT_F_PARTIAL | AMBIT_F_EMPTY))
    return ambit_fail(b->f, AMBIT_INVALID, "the initial values are not defined for all values of their uncertain data");
  return AMBIT_OK;
}

/* The graph's facts hold for the whole range of an unknown, hence for a part of it. */
static ambit_interval range_of(const build *b, ambit_expr unknown) {
  ambit_interval range = ambit_graph_node(b->graph, unknown)->value;
  for (size_t i = 0; i < b->q->nnarrow; i++)
    if (b->q->narrow[i] == unknown) range = ambit_interval_intersect(range, b->q->range[i]);
  return range;
}

static ambit_status find_hulls(build *b) {
  ambit_problem *p = b->p;
  ambit_interval *range = room(b, p->nu, sizeof *range), *slot = room(b, b->initial->nslot, sizeof *slot);
  ambit_interval *x = room(b, (size_t)p->nx + p->np, sizeof *x);
  if (!range || !slot || !x) return no_memory(b);
  for (uint32_t i = 0; i < p->nu; i++) range[i] = range_of(b, b->unknown[i]);
  uint32_t flags = ambit_hull(b->initial, range, slot);
  for (uint32_t i = 0; i < p->nx + p->np; i++) x[i] = slot[b->initial->out[i]];
  ambit_status status = check_hull(b, flags, x);
  if (status != AMBIT_OK) return status;
  double *x_hi, *p_hi, *u_hi;
  p->x0_lo = split(b, p->nx, x, &x_hi);
  p->p_lo = split(b, p->np, x + p->nx, &p_hi);
  p->u_lo = split(b, p->nu, range, &u_hi);
  p->x0_hi = x_hi;
  p->p_hi = p_hi;
  p->u_hi = u_hi;
  return p->x0_lo && p->p_lo && p->u_lo ? AMBIT_OK : no_memory(b);
}

/* -- what the solver wants */

static size_t count_inputs(const build *b) { return (size_t)b->p->nx + b->p->np + b->p->uses_time; }

static ambit_status seal_flow(build *b, size_t n, const ambit_expr *e, const ambit_tape **tape) {
  uint32_t series = b->q->want & AMBIT_WANT_SERIES ? AMBIT_TAPE_SERIES : 0;
  return ambit_tape_seal(
      b->graph, b->arena, n, e, count_inputs(b), b->input, b->p->nx, series | b->q->seal, tape, b->f);
}

static ambit_status seal_jacobian(
    build *b, size_t n, const ambit_expr *e, const char *what, const char *const *whose, const ambit_tape **tape) {
  size_t nx = b->p->nx;
  ambit_expr *entry = room(b, n * nx, sizeof *entry);
  if (!entry) return no_memory(b);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < nx; j++) {
      ambit_failure why = { 0 };
      entry[i * nx + j] = ambit_graph_derivative(b->graph, e[i], b->input[j], &why);
      if (entry[i * nx + j] != AMBIT_NO_EXPR) continue;
      if (why.status == AMBIT_OK || why.status == AMBIT_NOMEM) return no_memory(b);
      char when[80] = "";
      if (b->q->ntime) snprintf(when, sizeof when, "at t = %.9g s, before it begins, ", b->q->time[0]);
      return ambit_fail_code(b->f, AMBIT_UNABLE, AMBIT_CODE_UNABLE_KINK,
          "%sthe solver needs the Jacobian, but the %s `%s` has no derivative: %s; name another `solver`, or put a "
          "smooth "
          "law in its place",
          when, what, whose[i], why.message);
    }
  return ambit_tape_seal(b->graph, b->arena, n * nx, entry, count_inputs(b), b->input, nx, b->q->seal, tape, b->f);
}

/* By the parameters; none where a rate has no derivative (solvers then do without). */
static ambit_status seal_slope(build *b, const ambit_tape **tape) {
  size_t nx = b->p->nx, np = b->p->np;
  ambit_expr *entry = room(b, nx * np + 1, sizeof *entry);
  if (!entry) return no_memory(b);
  for (size_t i = 0; i < nx * np; i++) {
    ambit_failure why = { 0 };
    entry[i] = ambit_graph_derivative(b->graph, b->all[i / np], b->input[nx + i % np], &why);
    if (entry[i] == AMBIT_NO_EXPR) return why.status == AMBIT_OK || why.status == AMBIT_NOMEM ? no_memory(b) : AMBIT_OK;
  }
  return ambit_tape_seal(b->graph, b->arena, nx * np, entry, count_inputs(b), b->input, nx, b->q->seal, tape, b->f);
}

/* The Jacobian only for solvers that want Jacobians: series have slopes, which need no derivative. */
static ambit_status seal_invariants(build *b) {
  ambit_problem *p = b->p;
  const ambit_expr *g = b->invariant;
  const char **name = room(b, b->ninvariant, sizeof *name);
  if (!name) return no_memory(b);
  for (size_t i = 0; i < b->ninvariant; i++)
    if (!(name[i] = ambit_arena_text(b->arena, b->q->system->invariant_name[i]))) return no_memory(b);
  p->ninvariant = (uint32_t)b->ninvariant;
  p->invariant_name = name;
  ambit_status status = seal_flow(b, b->ninvariant, g, &p->invariant);
  if (status != AMBIT_OK || !(b->q->want & AMBIT_WANT_JACOBIAN)) return status;
  return seal_jacobian(b, b->ninvariant, g, "invariant", name, &p->invariant_jacobian);
}

static ambit_status seal_implicit(build *b) {
  ambit_implicit_request q = { b->graph, b->form, b->p->nx, b->p->np, b->p->uses_time, b->q->seal, b->implicit,
    b->input };
  return ambit_implicit_seal(&q, b->arena, &b->p->implicit, b->f);
}

/* -- jumps */

static ambit_status find_schedule(build *b) {
  const ambit_problem_request *q = b->q;
  ambit_problem *p = b->p;
  if (!(q->want & AMBIT_WANT_JUMP))
    return ambit_fail_code(b->f, AMBIT_UNABLE, AMBIT_CODE_UNABLE_SAMPLED,
        "the system is sampled, and this solver takes states that never jump: leave out `solver`, or name one that "
        "takes sampled systems");
  ambit_schedule s;
  ambit_status status =
      ambit_schedule_build(q->system, q->registry, q->time[0], q->time[q->ntime - 1], q->final, b->arena, &s, b->f);
  p->njump_time = s.n, p->jump_time = s.time, p->jump_number = s.number, p->jump_error = s.error;
  return status;
}

static ambit_status seal_jumps(build *b) {
  size_t n = b->q->system->njump, nx = b->p->nx;
  const ambit_tape **tape = room(b, n, sizeof *tape);
  if (!tape) return no_memory(b);
  ambit_status status = find_schedule(b);
  for (size_t i = 0; i < n && status == AMBIT_OK; i++) status = seal_flow(b, nx, b->jump + i * nx, &tape[i]);
  b->p->njump = (uint32_t)n, b->p->jump = tape;
  return status;
}

static ambit_status seal_wanted(build *b) {
  uint32_t want = b->q->want;
  ambit_problem *p = b->p;
  ambit_status status = AMBIT_OK;
  if ((want & (AMBIT_WANT_JACOBIAN | AMBIT_WANT_SLOPE)) && !ambit_series_bound(b->graph, p->nx, b->all))
    return no_memory(b);
  if (wants_rhs(want)) status = seal_flow(b, p->nx, b->all, &p->rhs);
  if (status == AMBIT_OK && (want & AMBIT_WANT_IMPLICIT)) status = seal_implicit(b);
  if (status == AMBIT_OK && (want & AMBIT_WANT_JACOBIAN))
    status = seal_jacobian(b, p->nx, b->all, "right-hand side of state", p->name, &p->jacobian);
  if (status == AMBIT_OK && (want & AMBIT_WANT_SLOPE) && p->np) status = seal_slope(b, &p->slope);
  if (status == AMBIT_OK && b->ninvariant) status = seal_invariants(b);
  if (status == AMBIT_OK && b->q->system->njump) status = seal_jumps(b);
  if (want & AMBIT_WANT_INITIAL) p->initial = b->initial;
  return status;
}

static bool copy_bounds(build *b) {
  const ambit_system *s = b->q->system;
  if (!s->least) return true;
  size_t size = s->nx * sizeof(double);
  double *least = ambit_arena_alloc(b->arena, size), *most = ambit_arena_alloc(b->arena, size);
  if (!least || !most) return false;
  memcpy(least, s->least, size), memcpy(most, s->most, size);
  b->p->x_least = least, b->p->x_most = most;
  return true;
}

ambit_status ambit_problem_build(
    const ambit_problem_request *q, ambit_arena *arena, ambit_problem *p, ambit_failure *f) {
  *p = (ambit_problem) { .size = sizeof *p, .nx = (uint32_t)q->system->nx, .ntime = (uint32_t)q->ntime };
  build b = { .q = q, .graph = q->system->graph, .arena = arena, .f = f, .p = p };
  ambit_status status = check_times(&b);
  if (status == AMBIT_OK) status = copy_expressions(&b);
  if (status == AMBIT_OK) status = check_reach(&b);
  if (status == AMBIT_OK) status = find_parameters(&b);
  if (status == AMBIT_OK) status = seal_initial(&b);
  if (status == AMBIT_OK) status = find_hulls(&b);
  if (status == AMBIT_OK) status = seal_wanted(&b);
  if (status != AMBIT_OK) return status;
  double *time = ambit_arena_alloc(arena, q->ntime * sizeof *time);
  if (!time) return ambit_no_memory(f);
  memcpy(time, q->time, q->ntime * sizeof *time);
  p->time = time;
  return copy_bounds(&b) ? AMBIT_OK : ambit_no_memory(f);
}
