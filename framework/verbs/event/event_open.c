/* event_open.c -- opening a watch: g and g' of every event and f as tapes over states, unknowns and time. */
#include <ambit/arena.h>
#include "graph/hull.h"
#include "graph/tape.h"
#include "verbs/event/event_inside.h"
#include "verbs/run/unknowns.h"
#include <string.h>

#define NAMES_MAX 256

typedef struct build {
  const ambit_event_watch_request *q;
  ambit_graph *graph;
  ambit_event_watch *w;
  ambit_expr *all;   /* g, g' of each event, then f */
  ambit_expr *input; /* [nin] */
  ambit_failure *f;
} build;

static ambit_status no_memory(const build *b) { return ambit_fail(b->f, AMBIT_NOMEM, "out of memory"); }

static void *room(const build *b, size_t n, size_t size) { return ambit_arena_alloc(b->w->arena, (n + 1) * size); }

/* g may depend on states, unknowns and time. */
static ambit_status check_reach(const build *b, const ambit_event *e) {
  const ambit_system *s = b->q->system;
  size_t n;
  ambit_expr *leaf;
  ambit_status status = ambit_unknowns_leaves(b->graph, b->w->arena, 1, &e->g, &n, &leaf, b->f);
  ambit_expr *allowed = room(b, s->nx, sizeof *allowed);
  if (status != AMBIT_OK) return status;
  if (!allowed) return no_memory(b);
  memcpy(allowed, s->state, s->nx * sizeof *allowed);
  allowed[s->nx] = ambit_graph_time(b->graph);
  char others[NAMES_MAX];
  if (!ambit_unknowns_name_others(b->graph, n, leaf, s->nx + 1, allowed, others, sizeof others)) return AMBIT_OK;
  return ambit_fail(b->f, AMBIT_INVALID,
      "event `%s`: g depends on %s, which is not among the states of the system, its data and time", e->name, others);
}

static ambit_status differentiate(const build *b) {
  const ambit_system *s = b->q->system;
  for (size_t k = 0; k < b->q->n; k++) {
    const ambit_event *e = &b->q->event[k];
    ambit_status status = check_reach(b, e);
    if (status != AMBIT_OK) return status;
    ambit_failure why = { 0 };
    b->all[2 * k] = e->g;
    b->all[2 * k + 1] = ambit_graph_rate_off_kinks(b->graph, e->g, s->nx, s->state, s->rate, &why);
    if (b->all[2 * k + 1] == AMBIT_NO_EXPR)
      return why.status == AMBIT_OK || why.status == AMBIT_NOMEM
                 ? no_memory(b)
                 : ambit_fail(b->f, why.status, "the event `%s`: %s", e->name, why.message);
  }
  memcpy(b->all + 2 * b->q->n, s->rate, s->nx * sizeof *b->all);
  return AMBIT_OK;
}

/* States, the unknowns that anything reaches, time; and the ranges of the unknowns. */
static ambit_status list_inputs(build *b) {
  const ambit_system *s = b->q->system;
  ambit_event_watch *w = b->w;
  size_t n;
  ambit_expr *leaf;
  ambit_status status = ambit_unknowns_leaves(b->graph, w->arena, 2 * b->q->n + s->nx, b->all, &n, &leaf, b->f);
  if (status != AMBIT_OK) return status;
  b->input = room(b, s->nx + n + 1, sizeof *b->input);
  w->in = room(b, s->nx + n + 1, sizeof *w->in);
  if (!b->input || !w->in) return no_memory(b);
  memcpy(b->input, s->state, s->nx * sizeof *b->input);
  size_t used = s->nx;
  for (size_t i = 0; i < n; i++) {
    const ambit_node *node = ambit_graph_node(b->graph, leaf[i]);
    if (!ambit_leaf_is_uncertain(node->op)) continue;
    w->in[used] = node->value;
    b->input[used++] = leaf[i];
  }
  b->input[used++] = ambit_graph_time(b->graph);
  w->nin = (uint32_t)used;
  return AMBIT_OK;
}

static ambit_status seal(build *b) {
  ambit_event_watch *w = b->w;
  const ambit_system *s = b->q->system;
  ambit_status status = AMBIT_OK;
  size_t slots = 0;
  for (size_t k = 0; status == AMBIT_OK && k < w->n; k++) {
    watched *e = &w->one[k];
    *e = (watched) {
      .event = b->q->event[k], .lo = room(b, w->nx, sizeof(double)), .hi = room(b, w->nx, sizeof(double))
    };
    if (!e->lo || !e->hi) return no_memory(b);
    e->event.name = NULL; /* the caller's */
    const ambit_expr *g = b->all + 2 * k;
    status = ambit_tape_seal(b->graph, w->arena, 1, g, w->nin, b->input, w->nx, 0, &e->value, b->f);
    if (status == AMBIT_OK)
      status = ambit_tape_seal(b->graph, w->arena, 2, g, w->nin, b->input, w->nx, 0, &e->both, b->f);
    if (status != AMBIT_OK) return status;
    if (ambit_contract_service_v1.open(&w->scope->host, e->value, &e->contractor) != AMBIT_OK) return no_memory(b);
    slots = e->both->nslot > slots ? e->both->nslot : slots;
    slots = e->value->nslot > slots ? e->value->nslot : slots;
  }
  status = ambit_tape_seal(b->graph, w->arena, s->nx, b->all + 2 * w->n, w->nin, b->input, w->nx, 0, &w->rate, b->f);
  if (status != AMBIT_OK) return status;
  w->slot = room(b, w->rate->nslot > slots ? w->rate->nslot : slots, sizeof *w->slot);
  return w->slot ? AMBIT_OK : no_memory(b);
}

/* Hull of expressions of unknowns; entire if they are not only of those (ambit_simulate says so). */
static ambit_status hull(const build *b, size_t n, const ambit_expr *e, ambit_interval *x) {
  size_t nleaf;
  ambit_expr *leaf;
  const ambit_tape *tape;
  ambit_failure unused = { 0 };
  for (size_t i = 0; i < n; i++) x[i] = AMBIT_ENTIRE;
  ambit_status status = ambit_unknowns_leaves(b->graph, b->w->arena, n, e, &nleaf, &leaf, b->f);
  if (status != AMBIT_OK) return status;
  for (size_t i = 0; i < nleaf; i++)
    if (ambit_graph_node(b->graph, leaf[i])->op != AMBIT_LEAF_UNKNOWN) return AMBIT_OK;
  if (ambit_tape_seal(b->graph, b->w->arena, n, e, nleaf, leaf, 0, 0, &tape, &unused) != AMBIT_OK) return AMBIT_OK;
  ambit_interval *range = room(b, nleaf, sizeof *range), *slot = room(b, tape->nslot, sizeof *slot);
  if (!range || !slot) return no_memory(b);
  for (size_t i = 0; i < nleaf; i++) range[i] = ambit_graph_node(b->graph, leaf[i])->value;
  if (ambit_hull(tape, range, slot) & (AMBIT_F_PARTIAL | AMBIT_F_EMPTY)) return AMBIT_OK;
  for (size_t i = 0; i < n; i++) x[i] = slot[tape->out[i]];
  return AMBIT_OK;
}

/* The initial set, and which events it starts on: where g of the initial expressions is exactly 0. */
static ambit_status look_at_start(const build *b) {
  const ambit_system *s = b->q->system;
  ambit_event_watch *w = b->w;
  ambit_expr *from = room(b, s->nx + 1, sizeof *from), *to = room(b, s->nx + 1, sizeof *to);
  if (!from || !to) return no_memory(b);
  for (size_t i = 0; i < s->nx; i++)
    if (b->q->initial[i] == AMBIT_NO_EXPR) return AMBIT_OK; /* ambit_simulate says so */
  memcpy(from, s->state, s->nx * sizeof *from);
  memcpy(to, b->q->initial, s->nx * sizeof *to);
  from[s->nx] = ambit_graph_time(b->graph);
  to[s->nx] = ambit_graph_number(b->graph, b->q->t_start);
  ambit_status status = hull(b, s->nx, b->q->initial, w->before);
  for (size_t k = 0; status == AMBIT_OK && k < w->n; k++) {
    ambit_expr g = w->one[k].event.g;
    ambit_interval x;
    status = ambit_graph_substitute(b->graph, 1, &g, s->nx + 1, from, to, b->f);
    if (status == AMBIT_OK) status = hull(b, 1, &g, &x);
    if (status == AMBIT_OK && x.lo == 0 && x.hi == 0) w->one[k].event.starts_on = 1;
  }
  return status;
}

static ambit_status reserve(const build *b) {
  ambit_event_watch *w = b->w;
  w->one = room(b, w->n, sizeof *w->one);
  w->before = room(b, w->nx, sizeof *w->before);
  w->speed = room(b, w->nx, sizeof *w->speed);
  w->lo = room(b, w->nin, sizeof *w->lo);
  w->hi = room(b, w->nin, sizeof *w->hi);
  w->found = room(b, w->room, sizeof *w->found);
  double *box = room(b, 2 * w->nx * w->room, sizeof *box);
  if (!w->one || !w->before || !w->speed || !w->lo || !w->hi || !w->found || !box) return no_memory(b);
  for (size_t i = 0; i < w->room; i++) {
    w->found[i].lo = box + 2 * i * w->nx;
    w->found[i].hi = w->found[i].lo + w->nx;
  }
  return AMBIT_OK;
}

static ambit_event_watch *make(const ambit_event_watch_request *q) {
  ambit_arena *arena = ambit_arena_open();
  ambit_event_watch *w = arena ? ambit_arena_alloc(arena, sizeof *w) : NULL;
  if (!w) {
    ambit_arena_close(arena);
    return NULL;
  }
  w->arena = arena;
  w->nx = (uint32_t)q->system->nx;
  w->n = q->n;
  w->room = q->room;
  w->t_first = w->t_before = q->t_start;
  w->leaps = q->system->njump > 0;
  w->stopped_by = SIZE_MAX;
  return w;
}

ambit_status ambit_event_watch_open(const ambit_event_watch_request *q, ambit_event_watch **out, ambit_failure *f) {
  *out = NULL;
  build b = { .q = q, .graph = q->system->graph, .w = make(q), .f = f };
  if (!b.w) return ambit_no_memory(f);
  ambit_status status = ambit_scope_open(&b.w->scope, NULL, NULL);
  if (status != AMBIT_OK) no_memory(&b);
  if (status == AMBIT_OK && !(b.all = room(&b, 2 * q->n + q->system->nx, sizeof *b.all))) status = no_memory(&b);
  if (status == AMBIT_OK) status = differentiate(&b);
  if (status == AMBIT_OK) status = list_inputs(&b);
  if (status == AMBIT_OK) status = reserve(&b);
  if (status == AMBIT_OK) status = seal(&b);
  if (status == AMBIT_OK) status = look_at_start(&b);
  if (status == AMBIT_OK)
    *out = b.w;
  else
    ambit_event_watch_close(b.w);
  return status;
}

void ambit_event_watch_close(ambit_event_watch *w) {
  if (!w) return;
  ambit_scope_close(w->scope);
  ambit_arena_close(w->arena);
}
