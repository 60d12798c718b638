/* tape.c -- sealing: which nodes the outputs reach, in which slots, in which order.
**
** 1. Constant subexpressions become constants: the range of a constant node is the interval evaluation of its
**    operands, a proved enclosure; it is used only where it is bounded and the node is total, so that no flag is
**    lost. Sums, products and quotients in which rounding has piled up stay instructions: an arithmetic that follows
**    dependences, or takes the middle, does better than these bounds. KEEP leaves all as instructions.
** 2. Instructions are ordered by level (1 + the largest level of the operands), then by opcode: nodes of one level do
**    not depend on each other, so equal opcodes of a level make a run.
** 3. Constants share a slot only if they are the same number: equal points, or the same node.
*/
#include "base/clock.h"
#include "base/meter.h"
#include "graph/kink.h"
#include "graph/tape.h"
#include "graph/series_lowering.h"
#include "graph/store.h"
#include "graph/walk.h"
#include <stdlib.h>
#include <string.h>

typedef struct sealing {
  ambit_graph *g;
  ambit_arena *arena;
  ambit_failure *failure;
  ambit_walk walk;
  uint32_t *slot;  /* [walk.count] */
  uint32_t *level; /* [walk.count] 0: constant or input */
  uint32_t *order; /* [walk.count] positions of the instructions, sorted */
  uint32_t *dst, *op, *a, *b, *aux, *out, *degree;
  double *lo, *hi, *range_lo, *range_hi;
  const char **text, **kink;
  ambit_run *run;
  ambit_tape *tape;
} sealing;

static ambit_status no_memory(ambit_failure *f) {
  return ambit_fail(f, AMBIT_NOMEM, "out of memory while sealing a tape");
}

/* A few roundings wide. */
static bool is_narrow(ambit_interval x) { return x.hi - x.lo <= 0x1p-48 * fmax(fabs(x.lo), fabs(x.hi)); }

static bool is_rational(uint32_t op) { return op <= AMBIT_OP_DIV; }

bool ambit_tape_folds(const ambit_graph *g, ambit_expr e) {
  const ambit_node *x = ambit_at(g, e);
  if (x->op == AMBIT_LEAF_CONSTANT) return true;
  return x->constant && x->total && ambit_interval_is_bounded(x->range) && (is_narrow(x->range) || !is_rational(x->op));
}

static bool is_constant_slot(const sealing *s, uint32_t i, bool keep) {
  ambit_expr e = s->walk.node[i];
  return ambit_at(s->g, e)->op == AMBIT_LEAF_CONSTANT || (!keep && ambit_tape_folds(s->g, e));
}

/* -- constants */

typedef struct constant {
  uint64_t bits; /* of the value */
  uint32_t position;
} constant;

static int by_bits(const void *p, const void *q) {
  const constant *a = p, *b = q;
  if (a->bits != b->bits) return a->bits < b->bits ? -1 : 1;
  return a->position < b->position ? -1 : a->position > b->position;
}

static bool put_constant(sealing *s, uint32_t position) {
  const ambit_node *x = ambit_at(s->g, s->walk.node[position]);
  uint32_t k = s->tape->nconst++;
  s->slot[position] = k;
  s->lo[k] = x->range.lo == 0 ? 0 : x->range.lo;
  s->hi[k] = x->range.hi == 0 ? 0 : x->range.hi;
  s->text[k] = NULL;
  if (x->op != AMBIT_LEAF_CONSTANT || !x->text) return true;
  return (s->text[k] = ambit_arena_text(s->arena, x->text)) != NULL;
}

/* Points that are the same double get one slot: sort them, then compare neighbours. */
static bool put_points(sealing *s, constant *point, size_t n) {
  qsort(point, n, sizeof *point, by_bits);
  for (size_t i = 0; i < n; i++) {
    if (i > 0 && point[i].bits == point[i - 1].bits)
      s->slot[point[i].position] = s->slot[point[i - 1].position];
    else if (!put_constant(s, point[i].position))
      return false;
  }
  return true;
}

static ambit_status number_constants(sealing *s, bool keep) {
  constant *point = malloc((s->walk.count + 1) * sizeof *point);
  if (!point) return no_memory(s->failure);
  size_t n = 0;
  bool stored = true;
  for (uint32_t i = 0; i < s->walk.count && stored; i++) {
    if (!is_constant_slot(s, i, keep)) continue;
    ambit_interval range = ambit_at(s->g, s->walk.node[i])->range;
    s->level[i] = 0;
    if (!ambit_interval_is_point(range)) {
      stored = put_constant(s, i);
      continue;
    }
    double value = range.lo == 0 ? 0 : range.lo;
    point[n].position = i;
    memcpy(&point[n++].bits, &value, sizeof value);
  }
  stored = stored && put_points(s, point, n);
  free(point);
  return stored ? AMBIT_OK : no_memory(s->failure);
}

/* -- inputs */

static ambit_status missing_input(sealing *s, ambit_expr e) {
  const ambit_node *x = ambit_at(s->g, e);
  if (x->op == AMBIT_LEAF_TIME)
    return ambit_fail(s->failure, AMBIT_INVALID, "the expression depends on time, which is not an input");
  if (x->op == AMBIT_LEAF_SYMBOL)
    return ambit_fail(
        s->failure, AMBIT_INVALID, "the expression depends on '%s', which has no value and is not an input", x->text);
  return ambit_fail(s->failure, AMBIT_INVALID, "the expression depends on an unknown named '%s', which is not an input",
      x->text ? x->text : "(no name)");
}

static ambit_status number_inputs(sealing *s, size_t nin, const ambit_expr *in) {
  for (uint32_t i = 0; i < s->walk.count; i++) {
    uint32_t op = ambit_at(s->g, s->walk.node[i])->op;
    if (ambit_op_is_leaf(op) && op != AMBIT_LEAF_CONSTANT) s->slot[i] = AMBIT_NO_SLOT;
  }
  for (size_t k = nin; k-- > 0;) {
    uint32_t i = ambit_walk_find(s->g, in[k]);
    if (i == UINT32_MAX) continue;
    if (s->slot[i] != AMBIT_NO_SLOT)
      return ambit_fail(s->failure, AMBIT_INVALID, "two quantities have the same name, `%s`: call one otherwise",
          ambit_at(s->g, in[k])->text ? ambit_at(s->g, in[k])->text : "(no name)");
    s->slot[i] = s->tape->nconst + (uint32_t)k;
    s->level[i] = 0;
  }
  for (uint32_t i = 0; i < s->walk.count; i++) {
    uint32_t op = ambit_at(s->g, s->walk.node[i])->op;
    if (ambit_op_is_leaf(op) && s->slot[i] == AMBIT_NO_SLOT) return missing_input(s, s->walk.node[i]);
  }
  return AMBIT_OK;
}

/* -- instructions */

/* Sorts positions by a key below `nkey`, keeping the order of equal keys. */
static bool sort_by(uint32_t *item, size_t n, const uint32_t *key, size_t nkey) {
  uint32_t *start = calloc(nkey + 1, sizeof *start), *sorted = malloc((n + 1) * sizeof *sorted);
  if (start && sorted) {
    for (size_t i = 0; i < n; i++) start[key[item[i]] + 1]++;
    for (size_t k = 0; k < nkey; k++) start[k + 1] += start[k];
    for (size_t i = 0; i < n; i++) sorted[start[key[item[i]]]++] = item[i];
    memcpy(item, sorted, n * sizeof *item);
  }
  bool done = start && sorted;
  free(start);
  free(sorted);
  return done;
}

static ambit_status order_instructions(sealing *s, bool keep, size_t *ninstr) {
  const ambit_walk *w = &s->walk;
  uint32_t *op = malloc((w->count + 1) * sizeof *op), deepest = 0;
  if (!op) return no_memory(s->failure);
  size_t n = 0;
  for (uint32_t i = 0; i < w->count; i++) {
    op[i] = ambit_at(s->g, w->node[i])->op;
    if (ambit_op_is_leaf(op[i]) || is_constant_slot(s, i, keep)) continue;
    uint32_t a = s->level[w->a[i]], b = s->level[w->b[i]];
    s->level[i] = 1 + (a > b ? a : b);
    if (s->level[i] > deepest) deepest = s->level[i];
    s->order[n++] = i;
  }
  bool sorted = sort_by(s->order, n, op, AMBIT_OP_END) && sort_by(s->order, n, s->level, (size_t)deepest + 1);
  free(op);
  *ninstr = n;
  return sorted ? AMBIT_OK : no_memory(s->failure);
}

static void write_instructions(sealing *s) {
  const ambit_walk *w = &s->walk;
  uint32_t first = s->tape->nconst + s->tape->nin;
  for (uint32_t k = 0; k < s->tape->ninstr; k++) s->slot[s->order[k]] = first + k;
  for (uint32_t k = 0; k < s->tape->ninstr; k++) {
    uint32_t i = s->order[k];
    const ambit_node *x = ambit_at(s->g, w->node[i]);
    s->op[k] = x->op;
    s->dst[k] = first + k;
    s->a[k] = s->slot[w->a[i]];
    s->b[k] = x->op == AMBIT_OP_POWN ? x->b : s->slot[w->b[i]];
    s->aux[k] = AMBIT_NO_SLOT;
    bool nowhere = ambit_interval_is_empty(x->range); /* defined nowhere: no bounds rather than bounds without sense */
    s->range_lo[first + k] = nowhere ? -INFINITY : x->range.lo;
    s->range_hi[first + k] = nowhere ? INFINITY : x->range.hi;
    ambit_run *last = s->tape->nrun ? &s->run[s->tape->nrun - 1] : NULL;
    bool same = last && last->op == x->op && s->level[s->order[k - 1]] == s->level[i];
    if (same)
      last->count++;
    else
      s->run[s->tape->nrun++] = (ambit_run) { .op = x->op, .first = k, .count = 1 };
  }
}

static bool name_kinks(sealing *s) {
  for (uint32_t k = 0; k < s->tape->ninstr; k++) {
    if (!ambit_op_has_kink(s->op[k])) continue;
    s->kink[k] = ambit_kink_text(s->g, s->walk.node[s->order[k]], s->arena);
    if (!s->kink[k]) return false;
  }
  return true;
}

static void write_aux(sealing *s) {
  if (!(s->tape->flags & AMBIT_TAPE_SERIES)) return;
  for (uint32_t k = 0; k < s->tape->ninstr; k++) {
    ambit_expr helper = ambit_series_helper(s->g, s->walk.node[s->order[k]]);
    uint32_t at = helper == AMBIT_NO_EXPR ? UINT32_MAX : ambit_walk_find(s->g, helper);
    if (at != UINT32_MAX) s->aux[k] = s->slot[at];
  }
}

/* -- what is known of each slot */

static uint32_t sum_degree(uint64_t a, uint64_t b) {
  return a + b < AMBIT_DEGREE_ANY ? (uint32_t)(a + b) : AMBIT_DEGREE_ANY;
}

static uint32_t degree_of(uint32_t op, uint32_t a, uint32_t b, uint32_t exponent) {
  switch (op) {
  case AMBIT_OP_ADD:
  case AMBIT_OP_SUB: return a > b ? a : b;
  case AMBIT_OP_NEG: return a;
  case AMBIT_OP_MUL: return sum_degree(a, b);
  case AMBIT_OP_SQR: return sum_degree(a, a);
  case AMBIT_OP_POWN:
    if (a == 0 || exponent == 0) return 0;
    if ((int32_t)exponent < 0 || a == AMBIT_DEGREE_ANY) return AMBIT_DEGREE_ANY;
    return sum_degree((uint64_t)a * exponent, 0);
  case AMBIT_OP_DIV: return b == 0 ? a : AMBIT_DEGREE_ANY;
  default: return a == 0 && b == 0 ? 0 : AMBIT_DEGREE_ANY;
  }
}

static void describe_slots(sealing *s, const ambit_expr *in, size_t nvarying) {
  const ambit_tape *t = s->tape;
  for (uint32_t k = 0; k < t->nconst; k++) s->range_lo[k] = s->lo[k], s->range_hi[k] = s->hi[k];
  for (uint32_t k = 0; k < t->nin; k++) {
    const ambit_node *x = ambit_at(s->g, in[k]);
    s->range_lo[t->nconst + k] = x->range.lo;
    s->range_hi[t->nconst + k] = x->range.hi;
    s->degree[t->nconst + k] = x->op == AMBIT_LEAF_TIME ? 1 : k < nvarying ? AMBIT_DEGREE_ANY : 0;
  }
  for (uint32_t k = 0; k < t->ninstr; k++) {
    uint32_t b = s->op[k] == AMBIT_OP_POWN ? s->a[k] : s->b[k];
    s->degree[s->dst[k]] = degree_of(s->op[k], s->degree[s->a[k]], s->degree[b], s->b[k]);
  }
}

/* -- all together */

static void *take(sealing *s, size_t n, size_t size) { return ambit_arena_alloc(s->arena, (n + 1) * size); }

static bool allocate(sealing *s, size_t ninstr, size_t nout) {
  size_t nslot = s->tape->nconst + s->tape->nin + ninstr;
  s->op = take(s, ninstr, sizeof *s->op);
  s->dst = take(s, ninstr, sizeof *s->dst);
  s->a = take(s, ninstr, sizeof *s->a);
  s->b = take(s, ninstr, sizeof *s->b);
  s->aux = take(s, ninstr, sizeof *s->aux);
  s->run = take(s, ninstr, sizeof *s->run);
  s->out = take(s, nout, sizeof *s->out);
  s->degree = take(s, nslot, sizeof *s->degree);
  s->kink = take(s, ninstr, sizeof *s->kink);
  s->range_lo = take(s, nslot, sizeof *s->range_lo);
  s->range_hi = take(s, nslot, sizeof *s->range_hi);
  return s->kink && s->op && s->dst && s->a && s->b && s->aux && s->run && s->out && s->degree && s->range_lo &&
         s->range_hi;
}

static bool allocate_scratch(sealing *s) {
  size_t n = s->walk.count + 1;
  s->slot = calloc(n, sizeof *s->slot);
  s->level = calloc(n, sizeof *s->level);
  s->order = malloc(n * sizeof *s->order);
  s->lo = take(s, n, sizeof *s->lo);
  s->hi = take(s, n, sizeof *s->hi);
  s->text = take(s, n, sizeof *s->text);
  return s->slot && s->level && s->order && s->lo && s->hi && s->text;
}

static void finish(sealing *s) {
  ambit_tape *t = s->tape;
  t->nslot = t->nconst + t->nin + t->ninstr;
  t->op = s->op, t->dst = s->dst, t->a = s->a, t->b = s->b, t->aux = s->aux, t->run = s->run;
  t->lo = s->lo, t->hi = s->hi, t->text = s->text, t->kink = s->kink;
  t->out = s->out, t->degree = s->degree, t->range_lo = s->range_lo, t->range_hi = s->range_hi;
}

/* root [nroot]: what the walk started from, the outputs first */
static ambit_status write_tape(
    sealing *s, size_t nout, const ambit_expr *root, size_t nin, const ambit_expr *in, size_t nvarying, bool keep) {
  size_t ninstr = 0;
  if (!allocate_scratch(s)) return no_memory(s->failure);
  ambit_status status = number_constants(s, keep);
  if (status == AMBIT_OK) status = number_inputs(s, nin, in);
  if (status == AMBIT_OK) status = order_instructions(s, keep, &ninstr);
  if (status != AMBIT_OK) return status;
  if (!allocate(s, ninstr, nout)) return no_memory(s->failure);
  s->tape->ninstr = (uint32_t)ninstr;
  write_instructions(s);
  write_aux(s);
  for (size_t i = 0; i < nout; i++) s->out[i] = s->slot[ambit_walk_find(s->g, root[i])];
  describe_slots(s, in, nvarying);
  finish(s);
  return name_kinks(s) ? AMBIT_OK : no_memory(s->failure); /* last: texts are walks of their own */
}

static ambit_status check_arguments(
    const ambit_graph *g, size_t nout, const ambit_expr *out, size_t nin, const ambit_expr *in, ambit_failure *f) {
  for (size_t i = 0; i < nout; i++)
    if (out[i] >= g->count) return ambit_fail(f, AMBIT_INVALID, "output %zu of the tape is no expression", i + 1);
  for (size_t i = 0; i < nin; i++) {
    bool leaf =
        in[i] < g->count && ambit_op_is_leaf(ambit_at(g, in[i])->op) && ambit_at(g, in[i])->op != AMBIT_LEAF_CONSTANT;
    if (!leaf) return ambit_fail(f, AMBIT_INVALID, "input %zu of the tape is no unknown, symbol or time", i + 1);
  }
  return AMBIT_OK;
}

static ambit_status seal(ambit_graph *g, ambit_arena *arena, size_t nout, const ambit_expr *out, size_t nin,
    const ambit_expr *in, size_t nvarying, uint32_t flags, const ambit_tape **tape, ambit_failure *f) {
  bool keep = flags & AMBIT_SEAL_KEEP;
  sealing s = { .g = g, .arena = arena, .failure = f };
  ambit_status status = check_arguments(g, nout, out, nin, in, f);
  if (status != AMBIT_OK) return status;
  ambit_expr *root;
  size_t nroot;
  status = ambit_series_lower(g, nout, out, flags, &root, &nroot, f);
  if (status != AMBIT_OK) return status;
  s.tape = ambit_arena_alloc(arena, sizeof *s.tape);
  bool ready = s.tape && ambit_walk_open(g, nroot, root, keep ? NULL : ambit_tape_folds, &s.walk);
  if (ready) {
    s.tape->size = sizeof *s.tape;
    s.tape->flags = flags & AMBIT_TAPE_SERIES;
    s.tape->nin = (uint32_t)nin;
    s.tape->nout = (uint32_t)nout;
    status = write_tape(&s, nout, root, nin, in, nvarying, keep);
  } else
    status = no_memory(f);
  if (status == AMBIT_OK) *tape = s.tape;
  ambit_walk_close(&s.walk);
  free(s.slot);
  free(s.level);
  free(s.order);
  free(root);
  return status;
}

ambit_status ambit_tape_seal(ambit_graph *g, ambit_arena *arena, size_t nout, const ambit_expr *out, size_t nin,
    const ambit_expr *in, size_t nvarying, uint32_t flags, const ambit_tape **tape, ambit_failure *f) {
  double begun = ambit_clock_cpu();
  ambit_meter_enter(AMBIT_FRAME_STAGE, "tape");
  ambit_status status = seal(g, arena, nout, out, nin, in, nvarying, flags, tape, f);
  ambit_meter_leave();
  g->sealing += ambit_clock_cpu() - begun;
  return status;
}
