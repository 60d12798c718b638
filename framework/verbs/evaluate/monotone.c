/* monotone.c -- the monotonicity test: a bound of f over a box by its bound over a face.
**
** Let gradient() enclose the generalised partial derivatives of f over a box B in bounded intervals D_j. It says so
** only where every operation is defined and continuous on all of B (arithmetic.h), so f is Lipschitz there, and by
** Lebourg's mean value theorem (Clarke, Optimization and Nonsmooth Analysis, 1983, theorem 2.3.7), for x and y in B
** that differ in the unknown j alone, f(y) - f(x) = d (y_j - x_j) for some d of D_j. With D_j >= 0, moving x_j to its
** lower end therefore never increases f: min over B = min over the face x_j = lo_j, and max over B = max over
** x_j = hi_j; with D_j <= 0 the other way round. Faces of several such unknowns are taken one after the other, as D
** encloses the derivatives on each face of B too. What is left is again a box, smaller, where derivatives are narrower
** and more of them may have one sign: so repeat until no unknown is fixed (Hansen, Global Optimization Using Interval
** Analysis, 1992, chapter 11). A lower bound of f over the last box is one over B. If every unknown gets fixed, the
** bound is the value at a corner: exact up to rounding.
**
** Each output has a tape of its own, so that it pays for nothing but itself. Cost: at most nunknown runs a side, and
** in practice two or three.
*/
#include "verbs/evaluate/monotone.h"
#include "graph/interpreter.h"
#include "graph/tape.h"
#include <string.h>

typedef struct search {
  const ambit_monotone *m;
  ambit_block *block;
  const ambit_tape *tape;
  ambit_interval *box, *whole; /* [nunknown] */
  double *lo, *hi;             /* [nunknown] derivatives over the last box that was run */
} search;

/* *x := bounds over s->box; false: derivatives are not known */
static bool run(search *s, ambit_interval *x) {
  const ambit_arithmetic *full = s->m->context->arithmetic;
  size_t pitch, elem = full->elem(s->m->context->ctx);
  for (size_t j = 0; j < s->m->nunknown; j++) ambit_block_set(s->block, (uint32_t)j, 0, s->box[j], (int32_t)j);
  ambit_block_run(s->block);
  ambit_work_evaluate(s->m->work, s->tape->ninstr, 1);
  s->m->work->gradients++;
  *x = ambit_block_get(s->block, 0, 0);
  const char *out = (const char *)ambit_block_base(s->block, &pitch) + s->tape->out[0] * elem;
  if (full->gradient(s->m->context->ctx, out, s->lo, s->hi) == 0) return false;
  for (size_t j = 0; j < s->m->nunknown; j++)
    if (!(s->lo[j] <= s->hi[j])) {
      ambit_fault_note(full, AMBIT_FAULT_DERIVATIVE, s->lo[j], s->hi[j]);
      return false;
    }
  return true;
}

/* Unknowns with a derivative of one sign go to the end where f is least (or greatest); is there a new one? */
static bool fix(search *s, bool greatest) {
  bool moved = false;
  for (size_t j = 0; j < s->m->nunknown; j++) {
    ambit_interval x = s->box[j];
    bool rises = s->lo[j] >= 0, falls = s->hi[j] <= 0;
    if (ambit_interval_is_point(x) || !(rises || falls)) continue;
    double end = rises == greatest ? x.hi : x.lo;
    if (isinf(end)) continue;
    s->box[j] = (ambit_interval) { end, end };
    moved = moved || s->lo[j] < 0 || s->hi[j] > 0; /* [0, 0]: f does not depend on it */
  }
  return moved;
}

static void narrow_side(search *s, bool greatest, ambit_interval *x) {
  size_t n = s->m->nunknown;
  ambit_interval found;
  memcpy(s->box, s->whole, n * sizeof *s->box);
  bool known = run(s, &found);
  while (known && fix(s, greatest)) {
    known = run(s, &found);
    ambit_interval half = greatest ? (ambit_interval) { -INFINITY, found.hi } : (ambit_interval) { found.lo, INFINITY };
    ambit_interval better = ambit_interval_intersect(*x, half);
    if (!ambit_interval_is_empty(found) && !ambit_interval_is_empty(better)) *x = better;
  }
}

static ambit_status prepare(search *s, ambit_arena *arena, ambit_expr e, ambit_failure *f) {
  const ambit_monotone *m = s->m;
  size_t n = m->nunknown;
  s->box = ambit_arena_alloc(arena, n * sizeof *s->box);
  s->whole = ambit_arena_alloc(arena, n * sizeof *s->whole);
  s->lo = ambit_arena_alloc(arena, n * sizeof *s->lo);
  s->hi = ambit_arena_alloc(arena, n * sizeof *s->hi);
  if (!s->box || !s->whole || !s->lo || !s->hi) return ambit_no_memory(f);
  for (size_t j = 0; j < n; j++) s->whole[j] = ambit_graph_node(m->graph, m->unknown[j])->value;
  ambit_status status = ambit_tape_seal(m->graph, arena, 1, &e, n, m->unknown, 0, m->seal, &s->tape, f);
  if (status != AMBIT_OK) return status;
  return ambit_block_open(s->tape, m->context->arithmetic, m->context->ctx, 1, &s->block, f);
}

ambit_status ambit_monotone_narrow(const ambit_monotone *m, ambit_expr e, ambit_interval *x, ambit_failure *f) {
  if (!m->context->arithmetic->gradient || m->nunknown == 0 || ambit_interval_is_empty(*x)) return AMBIT_OK;
  search s = { .m = m };
  ambit_arena *arena = ambit_arena_open();
  if (!arena) return ambit_no_memory(f);
  ambit_status status = prepare(&s, arena, e, f);
  if (status == AMBIT_OK) {
    narrow_side(&s, false, x);
    narrow_side(&s, true, x);
  }
  ambit_block_close(s.block);
  ambit_arena_close(arena);
  return status;
}
