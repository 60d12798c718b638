/* variation.c -- builds S' = A S + b column by column, for the entries that can differ from zero.
**
** A = df/dx and b = df/dq are symbolic. Column j of S vanishes for all time in the rows that neither start with a
** derivative, nor have a forcing, nor are reached through nonzero entries of A from such a row: there S = 0 solves the
** linear equations, and solutions are unique.
*/
#include "verbs/sensitivity/variation_build.h"
#include "verbs/run/unknowns.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ZERO 0u /* node 0 is the constant 0 */
#define LARGE 5 /* unknowns of the implicit form, from which on formulas for accelerations are far longer than it */

typedef ambit_variation_build_state build;
typedef ambit_variation_column column;

static ambit_status no_memory(const build *b) { return ambit_fail(b->f, AMBIT_NOMEM, "out of memory"); }

static void *room(const build *b, size_t n, size_t size) { return ambit_arena_alloc(b->arena, n * size); }

static ambit_expr multiply(const build *b, ambit_expr x, ambit_expr y) {
  return ambit_graph_op(b->graph, AMBIT_OP_MUL, x, y);
}

/* *d := de/dx; `what` and `whose` for the message */
static ambit_status derive(
    const build *b, ambit_expr e, ambit_expr x, const char *what, const char *whose, ambit_expr *d) {
  ambit_failure why = { 0 };
  *d = ambit_graph_derivative(b->graph, e, x, &why);
  if (*d != AMBIT_NO_EXPR) return AMBIT_OK;
  if (why.status == AMBIT_OK) return no_memory(b);
  return ambit_fail(b->f, why.status, "the %s `%s` has no derivative: %s", what, whose, why.message);
}

/* -- the quantities */

/* The one unknown of the datum, and 1/(dq/du). */
static ambit_status read_datum(const build *b, const ambit_variation_by *by, column *c) {
  size_t n;
  ambit_expr *leaf, slope;
  ambit_status status = ambit_unknowns_leaves(b->graph, b->arena, 1, &by->datum, &n, &leaf, b->f);
  if (status != AMBIT_OK) return status;
  if (n == 0) return ambit_fail(b->f, AMBIT_INVALID, "`%s` is not uncertain: it has one value only", by->name);
  if (n > 1 || ambit_graph_node(b->graph, leaf[0])->op != AMBIT_LEAF_UNKNOWN)
    return ambit_fail(b->f, AMBIT_INVALID, "`%s` is not one uncertain datum: it depends on %s", by->name,
        n > 1 ? "several" : "a state or on time");
  status = derive(b, by->datum, leaf[0], "datum", by->name, &slope);
  if (status != AMBIT_OK) return status;
  const ambit_node *node = ambit_graph_node(b->graph, slope);
  if (!node->constant || ambit_interval_contains(node->range, 0))
    return ambit_fail(b->f, AMBIT_INVALID, "`%s` is not an uncertain datum or a constant times one", by->name);
  c->unknown = leaf[0];
  c->scale = ambit_graph_op(b->graph, AMBIT_OP_DIV, ambit_graph_number(b->graph, 1), slope);
  return c->scale == AMBIT_NO_EXPR ? no_memory(b) : AMBIT_OK;
}

static ambit_status differentiate_datum(const build *b, column *c) {
  for (size_t i = 0; i < b->s->nx; i++) {
    ambit_expr start;
    ambit_status status = derive(b, b->q->initial[i], c->unknown, "initial value of state", b->s->name[i], &start);
    if (status != AMBIT_OK) return status;
    c->start[i] = start == ZERO ? ZERO : multiply(b, start, c->scale);
    if (c->start[i] == AMBIT_NO_EXPR) return no_memory(b);
  }
  return AMBIT_OK;
}

static ambit_status read_column(const build *b, size_t j) {
  const ambit_variation_by *by = &b->q->by[j];
  column *c = &b->column[j];
  size_t nx = b->s->nx;
  c->start = room(b, nx, sizeof *c->start); /* zeroed: the constant 0 */
  c->forcing = room(b, nx, sizeof *c->forcing);
  c->reached = room(b, nx, sizeof *c->reached);
  c->unknown = AMBIT_NO_EXPR;
  if (!c->start || !c->forcing || !c->reached) return no_memory(b);
  if (by->initial_of != AMBIT_VARIATION_ZERO) {
    c->start[by->initial_of] = ambit_graph_number(b->graph, 1);
    return c->start[by->initial_of] == AMBIT_NO_EXPR ? no_memory(b) : AMBIT_OK;
  }
  ambit_status status = read_datum(b, by, c);
  return status == AMBIT_OK ? differentiate_datum(b, c) : status;
}

/* Along a solution g stays zero, so its start must stay on g = 0 while the quantity varies: here, because g knows
** nothing of what varies. */
static ambit_status check_invariants(const build *b, size_t j) {
  const column *c = &b->column[j];
  for (size_t k = 0; k < b->s->ninvariant; k++) {
    ambit_expr d = ZERO;
    ambit_status status = AMBIT_OK;
    if (c->unknown != AMBIT_NO_EXPR)
      status = derive(b, b->s->invariant[k], c->unknown, "constraint", b->s->invariant_name[k], &d);
    for (size_t i = 0; i < b->s->nx && d == ZERO && status == AMBIT_OK; i++)
      if (c->start[i] != ZERO)
        status = derive(b, b->s->invariant[k], b->s->state[i], "constraint", b->s->invariant_name[k], &d);
    if (status != AMBIT_OK) return status;
    if (d != ZERO)
      return ambit_fail(b->f, AMBIT_INVALID,
          "the derivative by `%s` is not defined by the initial values: `%s` moves the start off the constraint `%s`, "
          "and how the other states follow is not known; differentiate by data that neither the initial values nor "
          "the constraints depend on (masses, forces)",
          b->q->by[j].name, b->q->by[j].name, b->s->invariant_name[k]);
  }
  return AMBIT_OK;
}

static ambit_status read_columns(const build *b) {
  ambit_status status = AMBIT_OK;
  for (size_t j = 0; j < b->q->nby && status == AMBIT_OK; j++) {
    status = read_column(b, j);
    if (status == AMBIT_OK) status = check_invariants(b, j);
  }
  return status;
}

/* df/dq of a datum */
static ambit_status force(const build *b, column *c) {
  for (size_t i = 0; i < b->s->nx && c->unknown != AMBIT_NO_EXPR; i++) {
    ambit_expr forcing;
    ambit_status status = derive(b, b->rate[i], c->unknown, "right-hand side of state", b->s->name[i], &forcing);
    if (status != AMBIT_OK) return status;
    c->forcing[i] = forcing == ZERO ? ZERO : multiply(b, forcing, c->scale);
    if (c->forcing[i] == AMBIT_NO_EXPR) return no_memory(b);
  }
  return AMBIT_OK;
}

/* A and b by formulas for the right-hand sides */
static ambit_status differentiate(build *b) {
  size_t nx = b->s->nx;
  ambit_status status = ambit_system_rates(b->s, &b->rate, b->f);
  b->slope = room(b, nx * nx, sizeof *b->slope);
  if (status == AMBIT_OK && !b->slope) status = no_memory(b);
  for (size_t i = 0; i < nx; i++)
    for (size_t k = 0; k < nx && status == AMBIT_OK; k++)
      status = derive(b, b->rate[i], b->s->state[k], "right-hand side of state", b->s->name[i], &b->slope[i * nx + k]);
  for (size_t j = 0; j < b->q->nby && status == AMBIT_OK; j++) status = force(b, &b->column[j]);
  return status;
}

/* -- structure */

static void reach(const build *b, column *c) {
  size_t nx = b->s->nx;
  for (size_t i = 0; i < nx; i++) c->reached[i] = c->start[i] != ZERO || c->forcing[i] != ZERO;
  for (bool grows = true; grows;) {
    grows = false;
    for (size_t i = 0; i < nx; i++)
      for (size_t k = 0; k < nx && !c->reached[i]; k++)
        if (c->reached[k] && b->slope[i * nx + k] != ZERO) grows = c->reached[i] = true;
  }
}

/* Which entries are states; returns how many states there are in all. */
static size_t number_states(const build *b, uint32_t *place) {
  size_t n = b->s->nx, nby = b->q->nby;
  for (size_t j = 0; j < nby; j++) {
    if (!b->form) reach(b, &b->column[j]);
    for (size_t i = 0; i < b->s->nx; i++)
      place[i * nby + j] = b->column[j].reached[i] ? (uint32_t)n++ : AMBIT_VARIATION_ZERO;
  }
  return n;
}

/* -- the new system */

static const char *join(const build *b, const char *format, const char *first, const char *second) {
  size_t n = strlen(format) + strlen(first) + strlen(second);
  char *text = room(b, n, 1);
  if (text) snprintf(text, n, format, first, second);
  return text;
}

static bool is_one(const char *unit) { return !unit || !*unit || strcmp(unit, "1") == 0 || strcmp(unit, "rad") == 0; }

static const char *ratio_unit(const build *b, const char *above, const char *below) {
  if (above && below && strcmp(above, below) == 0) return "1";
  if (is_one(below)) return is_one(above) ? "1" : above;
  return join(b, "%s/(%s)", is_one(above) ? "1" : above, below);
}

/* sum_k A_ik S_kj + b_ij */
static ambit_expr variation_rate(const build *b, size_t i, size_t j) {
  size_t nx = b->s->nx, nby = b->q->nby;
  ambit_expr sum = b->column[j].forcing[i];
  for (size_t k = 0; k < nx; k++) {
    uint32_t at = b->v->place[k * nby + j];
    if (at == AMBIT_VARIATION_ZERO || b->slope[i * nx + k] == ZERO) continue;
    ambit_expr term = multiply(b, b->slope[i * nx + k], b->v->system.state[at]);
    if (term == AMBIT_NO_EXPR) return term;
    sum = ambit_graph_op(b->graph, AMBIT_OP_ADD, sum, term);
    if (sum == AMBIT_NO_EXPR) return sum;
  }
  return sum;
}

typedef struct parts {
  const char **name, **unit;
  ambit_expr *state, *rate, *start;
} parts;

static ambit_status name_states(const build *b, const parts *p) {
  size_t nby = b->q->nby;
  for (size_t i = 0; i < b->s->nx; i++)
    for (size_t j = 0; j < nby; j++) {
      uint32_t at = b->v->place[i * nby + j];
      if (at == AMBIT_VARIATION_ZERO) continue;
      p->name[at] = join(b, "d %s/d %s", b->s->name[i], b->q->by[j].name);
      p->unit[at] = ratio_unit(b, b->s->unit[i], b->q->by[j].unit);
      if (!p->name[at] || !p->unit[at]) return no_memory(b);
      p->state[at] = ambit_graph_symbol(b->graph, p->name[at], p->unit[at]);
      p->start[at] = b->column[j].start[i];
      if (p->state[at] == AMBIT_NO_EXPR) return no_memory(b);
    }
  return AMBIT_OK;
}

static ambit_status check_names(const build *b) {
  const ambit_system *s = &b->v->system;
  for (size_t i = b->s->nx; i < s->nx; i++)
    for (size_t k = 0; k < i; k++)
      if (strcmp(s->name[i], s->name[k]) == 0)
        return ambit_fail(
            b->f, AMBIT_INVALID, "there would be two states `%s`: give the quantities other names", s->name[i]);
  return AMBIT_OK;
}

/* p.rate of all further states */
static ambit_status write_rates(const build *b, ambit_expr *rate) {
  size_t nby = b->q->nby;
  for (size_t i = 0; i < b->s->nx; i++)
    for (size_t j = 0; j < nby; j++) {
      uint32_t at = b->v->place[i * nby + j];
      if (at == AMBIT_VARIATION_ZERO) continue;
      rate[at] = variation_rate(b, i, j);
      if (rate[at] == AMBIT_NO_EXPR) return no_memory(b);
    }
  return AMBIT_OK;
}

/* Formulas for the right-hand sides, for a solver that cannot do without. */
static ambit_status write_later(ambit_system_source *self, ambit_failure *f) {
  build *b = ((ambit_variation_source *)(void *)self)->build;
  ambit_failure *before = b->f;
  ambit_expr *rate = room(b, b->v->system.nx, sizeof *rate);
  b->f = f;
  ambit_status status = rate ? differentiate(b) : no_memory(b);
  if (status == AMBIT_OK) memcpy(rate, b->rate, b->s->nx * sizeof *rate);
  if (status == AMBIT_OK) status = write_rates(b, rate);
  if (status == AMBIT_OK) self->rate = rate;
  b->f = before;
  return status;
}

static ambit_status assemble(build *b, size_t n) {
  size_t nx = b->s->nx;
  parts p = { room(b, n, sizeof *p.name), room(b, n, sizeof *p.unit), room(b, n, sizeof *p.state),
    room(b, n, sizeof *p.rate), room(b, n, sizeof *p.start) };
  if (!p.name || !p.unit || !p.state || !p.rate || !p.start) return no_memory(b);
  memcpy(p.name, b->s->name, nx * sizeof *p.name);
  memcpy(p.unit, b->s->unit, nx * sizeof *p.unit);
  memcpy(p.state, b->s->state, nx * sizeof *p.state);
  memcpy(p.start, b->q->initial, nx * sizeof *p.start);
  b->v->system = *b->s;
  b->v->system.source = NULL; /* it knows nothing of the further states */
  b->v->system.nx = n;
  b->v->system.name = p.name;
  b->v->system.unit = p.unit;
  b->v->system.state = p.state;
  b->v->initial = p.start;
  ambit_status status = name_states(b, &p);
  if (status == AMBIT_OK) status = check_names(b);
  if (status != AMBIT_OK) return status;
  if (b->form) {
    b->v->system.rate = NULL;
    return ambit_variation_implicit(b, write_later);
  }
  memcpy(p.rate, b->rate, nx * sizeof *p.rate);
  b->v->system.rate = p.rate;
  return write_rates(b, p.rate);
}

/* Outlives the request, as long as the arena does. */
static build *open_build(const ambit_variation_request *q, ambit_arena *arena, ambit_variation *v, ambit_failure *f) {
  build *b = ambit_arena_alloc(arena, sizeof *b);
  ambit_variation_request *own = ambit_arena_alloc(arena, sizeof *own);
  if (!b || !own) return NULL;
  *own = *q;
  *b = (build) { .q = own, .s = q->system, .graph = q->system->graph, .arena = arena, .f = f, .v = v };
  b->column = room(b, q->nby, sizeof *b->column);
  return b->column ? b : NULL;
}

ambit_status ambit_variation_build(
    const ambit_variation_request *q, ambit_arena *arena, ambit_variation *v, ambit_failure *f) {
  *v = (ambit_variation) { 0 };
  build *b = open_build(q, arena, v, f);
  uint32_t *place = b ? room(b, q->system->nx * q->nby, sizeof *place) : NULL;
  if (!place) return ambit_fail(f, AMBIT_NOMEM, "out of memory");
  ambit_status status = read_columns(b);
  if (status == AMBIT_OK && !q->system->rate) status = ambit_system_implicit(q->system, &b->form, f);
  if (b->form && b->form->na < LARGE) b->form = NULL;
  if (status == AMBIT_OK) status = b->form ? ambit_variation_reach(b) : differentiate(b);
  if (status != AMBIT_OK) return status;
  v->place = place;
  return assemble(b, number_states(b, place));
}
