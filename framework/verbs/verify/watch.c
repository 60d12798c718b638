/* watch.c -- bounds of g over the steps of a run.
**
** Soundness: the records enclose every solution at every time of a step; a hull of tape(g) over them encloses g. The
** mean value form needs g(x(t)) to be differentiable in t on the part: so it is used only where every operation of g
** and of dg/dt is defined over the whole box (no flag), and off the cut of atan2, where g would jump. Points of
** time are doubles inside the step; the ends of a step take the record's own boxes. Where samples make states leap, the
** box at the end of one step says nothing of the next one, and the start, before the first sample, is looked at by
** itself; solvers leap at doubles, so that where the clock shows t, the time is up to `clock_error` away, but not
** before the start.
*/
#include "verbs/verify/watch_inside.h"
#include "graph/hull.h"
#include "graph/tape.h"
#include "verbs/run/dense.h"
#include "verbs/run/unknowns.h"
#include "num/interval.h"
#include <math.h>
#include <string.h>

/* -- one part of a step */

/* The times that `when` on the clock of the records may be. */
static ambit_interval true_times(const ambit_watch *w, ambit_interval when) {
  double off = w->clock_error;
  if (!(off > 0)) return when;
  ambit_interval wide = ambit_interval_add(when, (ambit_interval) { -off, off });
  return (ambit_interval) { fmax(wide.lo, w->q->start), wide.hi };
}

/* The states that c depends on while t is in `when`, in the inputs. */
void ambit_watch_place(ambit_watch *w, const watched *c, const ambit_record *r, ambit_interval when) {
  bool point = when.lo == when.hi;
  for (uint32_t i = 0; i < w->nx; i++) {
    if (!c->wanted[i]) continue;
    ambit_interval x = ambit_dense_state(r, i, when);
    if (point && when.lo == r->t_to) x = (ambit_interval) { r->lo[i], r->hi[i] };
    if (point && when.lo == r->t_from && w->started && w->reached == r->t_from && !w->q->system->njump)
      x = w->before[i];
    w->in[i] = x;
  }
  w->in[w->nin - 1] = true_times(w, when);
}

ambit_interval ambit_watch_run(ambit_watch *w, const ambit_tape *t) {
  uint32_t flags = ambit_hull(t, w->in, w->slot);
  ambit_interval x = w->slot[t->out[0]];
  return flags & AMBIT_F_PARTIAL ? AMBIT_EMPTY : x;
}

static ambit_interval value_at(ambit_watch *w, const watched *c, const ambit_record *r, double t) {
  ambit_watch_place(w, c, r, (ambit_interval) { t, t });
  return ambit_watch_run(w, c->value);
}

typedef struct part {
  ambit_interval when, g;  /* g over all of it; empty: not known to be defined */
  double time[3];          /* both ends and the middle */
  ambit_interval value[3]; /* g there */
} part;

static void narrow_by_slope(ambit_watch *w, const watched *c, part *p) {
  if (ambit_interval_is_empty(p->g) || !c->slope || ambit_hull_jumps(c->value, w->slot)) return;
  ambit_interval slope = ambit_watch_run(w, c->slope); /* the states are still those of the whole part */
  if (ambit_interval_is_empty(slope)) return;
  for (int k = 0; k < 3; k++) {
    if (ambit_interval_is_empty(p->value[k])) continue;
    ambit_interval t = ambit_interval_sub(p->when, (ambit_interval) { p->time[k], p->time[k] });
    t = ambit_interval_add(
        t, (ambit_interval) { -2 * w->clock_error, 2 * w->clock_error }); /* each of both may be off */
    ambit_interval form = ambit_interval_add(p->value[k], ambit_interval_mul(slope, t));
    ambit_interval both = ambit_interval_intersect(p->g, form);
    if (!ambit_interval_is_empty(both)) p->g = both;
  }
}

static part look(ambit_watch *w, const watched *c, const ambit_record *r, ambit_interval when) {
  part p = { .when = when, .time = { when.lo, ambit_interval_mid(when), when.hi } };
  for (int k = 0; k < 3; k++) p.value[k] = value_at(w, c, r, p.time[k]);
  ambit_watch_place(w, c, r, when);
  p.g = ambit_watch_run(w, c->value);
  narrow_by_slope(w, c, &p);
  return p;
}

/* -- what it proves */

static bool is_positive(ambit_interval g) { return g.lo > 0 && g.lo <= g.hi; }
static bool is_not_positive(ambit_interval g) { return g.hi <= 0 && g.lo <= g.hi; }

/* The sign that settles a part: no violation in it (ALWAYS), no success in it (ONCE). */
static bool settles(const watched *c, ambit_interval g) {
  return c->condition->kind == AMBIT_WATCH_ONCE ? is_positive(g) : is_not_positive(g);
}

/* The sign that decides the run, wherever it is seen. */
static bool decides(const watched *c, ambit_interval g) {
  return c->condition->kind == AMBIT_WATCH_ONCE ? is_not_positive(g) : is_positive(g);
}

/* Every solution has g in `g` at all times of `when` on the clock. */
static void witness(const ambit_watch *w, watched *c, ambit_interval when, ambit_interval g) {
  ambit_watch_finding *to = &c->finding;
  if (ambit_interval_is_empty(g) || w->is_ending) return;
  bool once = c->condition->kind == AMBIT_WATCH_ONCE;
  if (once)
    to->bound.hi = g.hi < to->bound.hi ? g.hi : to->bound.hi;
  else
    to->bound.lo = g.lo > to->bound.lo ? g.lo : to->bound.lo;
  if (!decides(c, g)) return;
  bool better = ambit_interval_is_empty(to->value) || (once ? g.hi < to->value.hi : g.lo > to->value.lo);
  if (!better) return;
  to->when = true_times(w, when);
  to->value = g;
}

/* A part that will not be cut any more. */
static void conclude(const ambit_watch *w, watched *c, const part *p) {
  ambit_watch_finding *to = &c->finding;
  bool known = !ambit_interval_is_empty(p->g), once = c->condition->kind == AMBIT_WATCH_ONCE;
  double far = known ? (once ? p->g.lo : p->g.hi) : once ? -INFINITY : INFINITY;
  to->undefined = to->undefined || !known;
  c->open = c->open || !settles(c, p->g);
  bool worse = once ? far < to->bound.lo : far > to->bound.hi;
  if (!worse && !ambit_interval_is_empty(to->worst)) return;
  to->worst = true_times(w, p->when);
  if (once)
    to->bound.lo = far;
  else
    to->bound.hi = far;
}

/* Cutting helps only where the values at single times have a sign. */
static bool is_worth_cutting(const part *p) {
  ambit_interval mid = p->value[1];
  bool straddles = !ambit_interval_is_empty(mid) && mid.lo <= 0 && mid.hi > 0;
  return !straddles && p->time[0] < p->time[1] && p->time[1] < p->time[2];
}

static void scan(ambit_watch *w, watched *c, const ambit_record *r) {
  ambit_interval stack[STACK];
  size_t depth = 0;
  uint32_t left = w->q->cuts;
  bool backwards = r->t_to < r->t_from;
  stack[depth++] = (ambit_interval) { backwards ? r->t_to : r->t_from, backwards ? r->t_from : r->t_to };
  while (depth) {
    part p = look(w, c, r, stack[--depth]);
    witness(w, c, p.when, p.g);
    for (int k = 0; k < 3; k++) witness(w, c, (ambit_interval) { p.time[k], p.time[k] }, p.value[k]);
    if (settles(c, p.g) || !left || depth + 2 > STACK || !is_worth_cutting(&p)) {
      conclude(w, c, &p);
      continue;
    }
    left--;
    stack[depth++] = (ambit_interval) { p.time[1], p.time[2] };
    stack[depth++] = (ambit_interval) { p.time[0], p.time[1] };
  }
}

/* The states at the end of the last step, or at the start. */
static part look_before(ambit_watch *w, const watched *c) {
  for (size_t i = 0; i < w->nx; i++) w->in[i] = w->before[i];
  ambit_interval when = { w->reached, w->reached };
  w->in[w->nin - 1] = when;
  return (part) { .when = when, .g = ambit_watch_run(w, c->value) };
}

static void look_at_the_start(ambit_watch *w, watched *c) {
  part p = look_before(w, c);
  witness(w, c, p.when, p.g);
  conclude(w, c, &p);
}

/* The end is somewhere in this step. */
static void look_at_an_end(ambit_watch *w, watched *c, const ambit_record *r) {
  bool backwards = r->t_to < r->t_from;
  ambit_interval when = { backwards ? r->t_to : r->t_from, backwards ? r->t_from : r->t_to };
  part p = look(w, c, r, when);
  c->end_undefined = c->end_undefined || ambit_interval_is_empty(p.g);
  c->end = ambit_interval_hull(c->end, p.g);
}

static bool is_ending(const ambit_watch *w, const ambit_record *r) {
  if (!w->q->last) return false;
  return r->t_to < r->t_from ? r->t_from <= *w->q->last : r->t_from >= *w->q->last;
}

/* -- the sink */

static bool is_over(const watched *c) { return c->condition->limit > 0 && c->finding.bound.hi > c->condition->limit; }

/* A condition and all its rivals are over their limits. */
static bool is_hopeless(const ambit_watch *w, size_t k) {
  size_t last = k + w->watched[k].condition->rivals;
  bool all = last < w->n;
  for (size_t i = k; i <= last && all; i++) all = is_over(&w->watched[i]);
  return all;
}

bool ambit_watch_gave_up(const ambit_watch *w) { return w->gave_up; }

static int32_t emit(ambit_sink *s, const ambit_record *r) {
  ambit_watch *w = (ambit_watch *)(void *)s;
  if (r->kind != AMBIT_REC_STEP) return 0;
  w->is_ending = is_ending(w, r);
  w->clock_error = r->clock_error;
  bool leaps_first = w->q->system->njump && w->started && w->reached == w->q->start;
  for (size_t k = 0; k < w->n; k++) {
    uint32_t kind = w->watched[k].condition->kind;
    if (leaps_first && kind != AMBIT_WATCH_END) look_at_the_start(w, &w->watched[k]);
    if (kind == AMBIT_WATCH_MOST)
      ambit_watch_scan_most(w, &w->watched[k], r);
    else if (kind != AMBIT_WATCH_END)
      scan(w, &w->watched[k], r);
    else if (w->is_ending)
      look_at_an_end(w, &w->watched[k], r);
  }
  for (size_t i = 0; i < w->nx; i++) w->before[i] = (ambit_interval) { r->lo[i], r->hi[i] };
  w->reached = r->t_to;
  w->started = true;
  for (size_t k = 0; k < w->n && !w->gave_up; k++) w->gave_up = is_hopeless(w, k);
  return w->gave_up;
}

static int32_t progress(ambit_sink *s, double done, const char *message) {
  const ambit_watch *w = (const ambit_watch *)(const void *)s;
  ambit_sink *outer = w->q->outer;
  return outer && outer->progress ? outer->progress(outer, done, message) : 0;
}

ambit_sink *ambit_watch_sink(ambit_watch *w) { return &w->sink; }

/* -- the outcome */

static void look_at_the_end(ambit_watch *w, watched *c) {
  part p = look_before(w, c);
  if (w->q->last) {
    double a = *w->q->last, b = w->reached;
    p.when = a < b ? (ambit_interval) { a, b } : (ambit_interval) { b, a };
    p.g = c->end_undefined ? AMBIT_EMPTY : c->end;
  }
  w->is_ending = false;
  witness(w, c, p.when, p.g);
  conclude(w, c, &p);
}

void ambit_watch_end(ambit_watch *w, bool complete, ambit_watch_finding *finding) {
  for (size_t k = 0; k < w->n; k++) {
    watched *c = &w->watched[k];
    ambit_watch_finding *to = &c->finding;
    bool once = c->condition->kind == AMBIT_WATCH_ONCE, seen = !ambit_interval_is_empty(to->value);
    if (c->condition->kind == AMBIT_WATCH_END && complete) {
      look_at_the_end(w, c);
      seen = !ambit_interval_is_empty(to->value);
    }
    bool settled = complete && !c->open;
    to->holds = once ? seen : settled;
    to->fails = once ? settled : seen;
    if (!complete && once) to->bound.lo = -INFINITY;
    if (!complete && !once) to->bound.hi = INFINITY;
    finding[k] = *to;
  }
}

/* -- opening */

/* Marks the states that a tape reads. */
static void want(const ambit_watch *w, const ambit_tape *t, bool *wanted) {
  for (uint32_t i = 0; i < t->ninstr; i++) {
    uint32_t a = t->a[i] - t->nconst, b = t->op[i] == AMBIT_OP_POWN ? a : t->b[i] - t->nconst;
    if (a < w->nx) wanted[a] = true;
    if (b < w->nx) wanted[b] = true;
  }
  if (t->out[0] - t->nconst < w->nx) wanted[t->out[0] - t->nconst] = true;
}

static ambit_status seal(ambit_watch *w, ambit_arena *arena, ambit_expr e, const ambit_expr *input,
    const ambit_tape **tape, ambit_failure *f) {
  return ambit_tape_seal(w->q->system->graph, arena, 1, &e, w->nin, input, 0, 0, tape, f);
}

/* Without a derivative by time (abs, min, max) there is no mean value form. */
static ambit_status seal_slope(
    ambit_watch *w, ambit_arena *arena, watched *c, const ambit_expr *input, ambit_failure *f) {
  const ambit_system *s = w->q->system;
  ambit_failure why = { 0 };
  ambit_expr d = ambit_graph_time_derivative(s->graph, c->condition->g, s->nx, s->state, s->rate, &why);
  if (d == AMBIT_NO_EXPR) return why.status == AMBIT_NOMEM ? ambit_no_memory(f) : AMBIT_OK;
  return seal(w, arena, d, input, &c->slope, f);
}

static ambit_status check(const ambit_watch *w, const watched *c, ambit_arena *arena, ambit_failure *f) {
  const ambit_system *s = w->q->system;
  char name[256];
  size_t n;
  ambit_expr *leaf, *allowed = ambit_arena_alloc(arena, (s->nx + 1) * sizeof *allowed);
  if (!allowed) return ambit_no_memory(f);
  memcpy(allowed, s->state, s->nx * sizeof *allowed);
  allowed[s->nx] = ambit_graph_time(s->graph);
  ambit_status status = ambit_unknowns_leaves(s->graph, arena, 1, &c->condition->g, &n, &leaf, f);
  if (status != AMBIT_OK) return status;
  if (!ambit_unknowns_name_others(s->graph, n, leaf, s->nx + 1, allowed, name, sizeof name)) return AMBIT_OK;
  return ambit_fail(f, AMBIT_INVALID, "the condition `%s` depends on %s, which is neither a state nor a datum",
      c->condition->name, name);
}

/* Inputs: states, every unknown of the conditions, right-hand sides and initial values, time. */
static ambit_status collect_inputs(ambit_watch *w, ambit_arena *arena, ambit_expr **input, ambit_failure *f) {
  const ambit_system *s = w->q->system;
  size_t n, count = w->n + s->nx;
  ambit_expr *all = ambit_arena_alloc(arena, (count + s->nx) * sizeof *all), *leaf;
  if (!all) return ambit_no_memory(f);
  for (size_t k = 0; k < w->n; k++) all[k] = w->watched[k].condition->g;
  memcpy(all + w->n, s->rate, s->nx * sizeof *all);
  if (w->q->initial) {
    memcpy(all + count, w->q->initial, s->nx * sizeof *all);
    count += s->nx;
  }
  ambit_status status = ambit_unknowns_leaves(s->graph, arena, count, all, &n, &leaf, f);
  if (status != AMBIT_OK) return status;
  *input = ambit_arena_alloc(arena, (s->nx + n + 1) * sizeof **input);
  w->in = ambit_arena_alloc(arena, (s->nx + n + 1) * sizeof *w->in);
  if (!*input || !w->in) return ambit_no_memory(f);
  memcpy(*input, s->state, s->nx * sizeof **input);
  w->nin = s->nx;
  for (size_t i = 0; i < n; i++) {
    const ambit_node *node = ambit_graph_node(s->graph, leaf[i]);
    if (!ambit_leaf_is_uncertain(node->op)) continue;
    (*input)[w->nin] = leaf[i];
    w->in[w->nin] = node->value;
    for (size_t k = 0; k < w->q->nnarrow; k++)
      if (w->q->narrow[k] == leaf[i]) w->in[w->nin] = ambit_interval_intersect(node->value, w->q->range[k]);
    w->nin++;
  }
  (*input)[w->nin++] = ambit_graph_time(s->graph);
  return AMBIT_OK;
}

/* The box at the start. What is wrong with initial values, the run itself will say. */
static ambit_status find_start(ambit_watch *w, ambit_arena *arena, const ambit_expr *input, ambit_failure *f) {
  const ambit_tape *t;
  ambit_failure own = { 0 };
  if (!w->q->initial) return AMBIT_OK;
  ambit_status status =
      ambit_tape_seal(w->q->system->graph, arena, w->nx, w->q->initial, w->nin, input, 0, 0, &t, &own);
  if (status != AMBIT_OK) return status == AMBIT_NOMEM ? ambit_fail(f, status, "%s", own.message) : AMBIT_OK;
  ambit_interval *slot = ambit_arena_alloc(arena, t->nslot * sizeof *slot);
  if (!slot) return ambit_no_memory(f);
  w->started = !(ambit_hull(t, w->in, slot) & AMBIT_F_PARTIAL);
  w->reached = w->q->start;
  for (size_t i = 0; i < w->nx; i++) w->before[i] = slot[t->out[i]];
  return AMBIT_OK;
}

static ambit_status open_conditions(ambit_watch *w, ambit_arena *arena, ambit_failure *f) {
  ambit_expr *input = NULL;
  uint32_t slots = 0;
  ambit_status status = AMBIT_OK;
  for (size_t k = 0; k < w->n && status == AMBIT_OK; k++) {
    watched *c = &w->watched[k];
    c->condition = &w->q->condition[k];
    c->finding.bound = c->condition->kind == AMBIT_WATCH_ONCE ? (ambit_interval) { INFINITY, INFINITY }
                                                              : (ambit_interval) { -INFINITY, -INFINITY };
    c->finding.when = c->finding.value = c->finding.worst = c->end = AMBIT_EMPTY;
    if (c->condition->kind == AMBIT_WATCH_MOST) c->finding.bound = (ambit_interval) { 0, 0 };
    status = check(w, c, arena, f);
  }
  if (status == AMBIT_OK) status = collect_inputs(w, arena, &input, f);
  for (size_t k = 0; k < w->n && status == AMBIT_OK; k++) {
    watched *c = &w->watched[k];
    status = seal(w, arena, c->condition->g, input, &c->value, f);
    if (status == AMBIT_OK) status = seal_slope(w, arena, c, input, f);
    if (status != AMBIT_OK) return status;
    c->wanted = ambit_arena_alloc(arena, w->nx * sizeof *c->wanted);
    if (!c->wanted) return ambit_no_memory(f);
    want(w, c->value, c->wanted);
    if (c->slope) want(w, c->slope, c->wanted);
    if (c->value->nslot > slots) slots = c->value->nslot;
    if (c->slope && c->slope->nslot > slots) slots = c->slope->nslot;
  }
  if (status != AMBIT_OK) return status;
  w->slot = ambit_arena_alloc(arena, slots * sizeof *w->slot);
  w->before = ambit_arena_alloc(arena, w->nx * sizeof *w->before);
  if (!w->slot || !w->before) return ambit_no_memory(f);
  return find_start(w, arena, input, f);
}

ambit_status ambit_watch_open(const ambit_watch_request *q, ambit_arena *arena, ambit_watch **watch, ambit_failure *f) {
  ambit_watch *w = ambit_arena_alloc(arena, sizeof *w);
  *watch = w;
  if (!w) return ambit_no_memory(f);
  w->sink = (ambit_sink) { sizeof(ambit_sink), emit, progress };
  w->q = q;
  w->n = q->ncondition;
  w->nx = q->system->nx;
  w->watched = ambit_arena_alloc(arena, w->n * sizeof *w->watched);
  if (!w->watched) return ambit_no_memory(f);
  return open_conditions(w, arena, f);
}
