/* partition.c -- pivots by value, blocks by structure. */
#include "mechanics/partition.h"
#include <math.h>
#include <string.h>

#define THRESHOLD 0.1
#define NOTHING 1e-14 /* an entry that counts as 0 where fill-in is counted */

static uint32_t *numbers(ambit_arena *arena, size_t n) { return ambit_arena_alloc(arena, (n + 1) * sizeof(uint32_t)); }

/* -- pivots */

typedef struct elimination {
  size_t n, nu;
  double *a;                   /* [n*nu] what is left */
  bool *row_done, *column_out; /* column_out: a pivot, or kept independent */
} elimination;

static bool active(const elimination *e, size_t i, size_t j) { return !e->row_done[i] && !e->column_out[j]; }

/* (other entries in the row) * (other entries in the column): how much the pivot may fill in */
static size_t fill_in(const elimination *e, size_t i, size_t j) {
  size_t in_row = 0, in_column = 0;
  for (size_t l = 0; l < e->nu; l++) in_row += l != j && !e->column_out[l] && fabs(e->a[i * e->nu + l]) > NOTHING;
  for (size_t k = 0; k < e->n; k++) in_column += k != i && !e->row_done[k] && fabs(e->a[k * e->nu + j]) > NOTHING;
  return in_row * in_column;
}

/* false: what is left counts as 0. The last column that has a good entry, so that joints near the base stay
** independent; in it the row that fills in least.
*/
static bool find_pivot(const elimination *e, size_t *row, size_t *column) {
  double most = 0;
  for (size_t i = 0; i < e->n; i++)
    for (size_t j = 0; j < e->nu; j++)
      if (active(e, i, j)) most = fmax(most, fabs(e->a[i * e->nu + j]));
  if (!(most > AMBIT_RANK_TOLERANCE)) return false;
  size_t least = SIZE_MAX;
  for (size_t j = e->nu; j-- > 0 && least == SIZE_MAX;)
    for (size_t i = 0; i < e->n; i++) {
      if (!active(e, i, j) || fabs(e->a[i * e->nu + j]) < THRESHOLD * most) continue;
      size_t fill = fill_in(e, i, j);
      if (fill >= least) continue;
      least = fill;
      *row = i;
      *column = j;
    }
  return true;
}

static void eliminate(elimination *e, size_t row, size_t column) {
  const double *pivot = &e->a[row * e->nu];
  e->row_done[row] = e->column_out[column] = true;
  for (size_t i = 0; i < e->n; i++) {
    double factor = e->row_done[i] ? 0 : e->a[i * e->nu + column] / pivot[column];
    if (factor == 0) continue;
    /* columns kept independent, too: whether they could have been pivots does not matter here */
    for (size_t j = 0; j < e->nu; j++) e->a[i * e->nu + j] -= factor * pivot[j];
    e->a[i * e->nu + column] = 0;
  }
}

static bool open_elimination(ambit_arena *arena, size_t n, size_t nu, const double *value, elimination *e) {
  *e = (elimination) { n, nu, ambit_arena_alloc(arena, (n * nu + 1) * sizeof(double)),
    ambit_arena_alloc(arena, (n + 1) * sizeof(bool)), ambit_arena_alloc(arena, (nu + 1) * sizeof(bool)) };
  if (!e->a || !e->row_done || !e->column_out) return false;
  for (size_t i = 0; i < n; i++) {
    double size = 0;
    for (size_t j = 0; j < nu; j++) size = fmax(size, fabs(value[i * nu + j]));
    for (size_t j = 0; j < nu; j++) e->a[i * nu + j] = size > 0 ? value[i * nu + j] / size : 0;
  }
  return true;
}

size_t ambit_partition_rank(ambit_arena *arena, size_t n, size_t nu, const double *value, ambit_failure *f) {
  elimination e;
  size_t rank = 0, i, j;
  if (!open_elimination(arena, n, nu, value, &e)) {
    ambit_no_memory(f);
    return 0;
  }
  for (; find_pivot(&e, &i, &j); rank++) eliminate(&e, i, j);
  return rank;
}

/* -- blocks: strongly connected components, where pivot k leads to pivot l if row k has an entry in column l */

typedef struct tarjan {
  const ambit_partition *p;
  const bool *nonzero;
  uint32_t *index, *low, *stack, *frame, *next; /* [rank] each; index 0: not seen */
  bool *stacked;
  uint32_t *order, *start; /* [rank], [rank + 1]: components one after the other */
  uint32_t seen, depth, placed, ncomponent;
} tarjan;

static bool leads(const tarjan *t, uint32_t k, uint32_t l) {
  return k != l && t->nonzero[t->p->row[k] * t->p->nu + t->p->column[l]];
}

static void enter(tarjan *t, uint32_t k) {
  t->index[k] = t->low[k] = ++t->seen;
  t->next[k] = 0;
  t->stack[t->depth++] = k;
  t->stacked[k] = true;
}

/* Takes the component of k off the stack. Within it pivots keep the order of elimination. */
static void place_component(tarjan *t, uint32_t k) {
  uint32_t first = t->placed, l;
  t->start[t->ncomponent++] = first;
  do {
    l = t->stack[--t->depth];
    t->stacked[l] = false;
    uint32_t at = t->placed++;
    for (; at > first && t->order[at - 1] > l; at--) t->order[at] = t->order[at - 1];
    t->order[at] = l;
  } while (l != k);
}

/* Without recursion: `frame` holds the path from the root. What a component leads to has been placed before it. */
static void visit(tarjan *t, uint32_t root) {
  uint32_t depth = 0, rank = (uint32_t)t->p->rank;
  t->frame[depth++] = root;
  enter(t, root);
  while (depth) {
    uint32_t k = t->frame[depth - 1], l = t->next[k]++;
    if (l < rank) {
      if (!leads(t, k, l)) continue;
      if (!t->index[l]) {
        enter(t, l);
        t->frame[depth++] = l;
      } else if (t->stacked[l] && t->index[l] < t->low[k])
        t->low[k] = t->index[l];
      continue;
    }
    if (t->low[k] == t->index[k]) place_component(t, k);
    if (--depth && t->low[k] < t->low[t->frame[depth - 1]]) t->low[t->frame[depth - 1]] = t->low[k];
  }
}

static ambit_status order_blocks(ambit_arena *arena, const bool *nonzero, ambit_partition *p, ambit_failure *f) {
  size_t n = p->rank;
  tarjan t = { .p = p,
    .nonzero = nonzero,
    .index = numbers(arena, n),
    .low = numbers(arena, n),
    .stack = numbers(arena, n),
    .frame = numbers(arena, n),
    .next = numbers(arena, n),
    .stacked = ambit_arena_alloc(arena, (n + 1) * sizeof(bool)),
    .order = numbers(arena, n),
    .start = numbers(arena, n + 1) };
  uint32_t *row = numbers(arena, n), *column = numbers(arena, n);
  if (!t.index || !t.low || !t.stack || !t.frame || !t.next || !t.stacked || !t.order || !t.start || !row || !column)
    return ambit_no_memory(f);
  for (uint32_t k = 0; k < n; k++)
    if (!t.index[k]) visit(&t, k);
  for (size_t k = 0; k < n; k++) {
    row[k] = p->row[t.order[k]];
    column[k] = p->column[t.order[k]];
  }
  t.start[t.ncomponent] = (uint32_t)n;
  p->row = row;
  p->column = column;
  p->nblock = t.ncomponent;
  p->block = t.start;
  return AMBIT_OK;
}

ambit_status ambit_partition_choose(ambit_arena *arena, size_t n, size_t nu, const double *value, const bool *nonzero,
    const bool *keep, ambit_partition *p, ambit_failure *f) {
  elimination e;
  size_t i = 0, j = 0, independent = 0, redundant = 0;
  *p = (ambit_partition) { .n = n,
    .nu = nu,
    .row = numbers(arena, n),
    .column = numbers(arena, n),
    .independent = numbers(arena, nu),
    .redundant = numbers(arena, n) };
  if (!p->row || !p->column || !p->independent || !p->redundant || !open_elimination(arena, n, nu, value, &e))
    return ambit_no_memory(f);
  if (keep) memcpy(e.column_out, keep, nu * sizeof *keep);
  for (; find_pivot(&e, &i, &j); p->rank++) {
    eliminate(&e, i, j);
    p->row[p->rank] = (uint32_t)i;
    p->column[p->rank] = (uint32_t)j;
  }
  for (i = 0; i < n; i++)
    if (!e.row_done[i]) p->redundant[redundant++] = (uint32_t)i;
  for (j = 0; j < nu; j++)
    if (!e.column_out[j] || (keep && keep[j])) p->independent[independent++] = (uint32_t)j;
  return order_blocks(arena, nonzero, p, f);
}
