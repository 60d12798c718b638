/* loop_solver.c -- small blocks by minors, larger ones by elimination. */
#include "mechanics/loop_solver.h"
#include <string.h>

#define SIMPLIFY_TERMS 64u

static ambit_expr op(const ambit_loop_solver *s, uint32_t code, ambit_expr a, ambit_expr b) {
  return ambit_graph_op(s->g, code, a, b);
}

static ambit_expr product(const ambit_loop_solver *s, ambit_expr a, ambit_expr b) {
  return a == 0 || b == 0 ? 0 : op(s, AMBIT_OP_MUL, a, b);
}

/* a - b c */
static ambit_expr reduce(const ambit_loop_solver *s, ambit_expr a, ambit_expr b, ambit_expr c) {
  return b == 0 || c == 0 ? a : op(s, AMBIT_OP_SUB, a, op(s, AMBIT_OP_MUL, b, c));
}

static ambit_expr entry(const ambit_loop_solver *s, size_t k, size_t l) {
  return s->velocity[s->p->row[k] * s->p->nu + s->p->column[l]];
}

/* -- Cramer: minors by expansion along their emptiest row; equal ones are one node of the graph */

static uint32_t emptiest_row(const ambit_loop_solver *s, const ambit_loop_block *b, uint32_t rows, uint32_t columns) {
  uint32_t best = 0, least = UINT32_MAX;
  for (uint32_t i = 0; i < b->n; i++) {
    uint32_t filled = 0;
    for (uint32_t j = 0; j < b->n; j++) filled += (columns >> j & 1) && entry(s, b->first + i, b->first + j) != 0;
    if ((rows >> i & 1) && filled < least) least = filled, best = i;
  }
  return best;
}

/* Rank of bit i among the set bits: decides the sign of a cofactor. */
static uint32_t place_of(uint32_t set, uint32_t i) {
  uint32_t place = 0;
  for (uint32_t k = 0; k < i; k++) place += set >> k & 1;
  return place;
}

static ambit_expr minor(const ambit_loop_solver *s, const ambit_loop_block *b, uint32_t rows, uint32_t columns) {
  if (rows == 0) return ambit_graph_number(s->g, 1);
  uint32_t i = emptiest_row(s, b, rows, columns);
  ambit_expr sum = 0;
  for (uint32_t j = 0; j < b->n; j++) {
    ambit_expr e = columns >> j & 1 ? entry(s, b->first + i, b->first + j) : 0;
    if (e == 0) continue;
    ambit_expr term = product(s, e, minor(s, b, rows & ~(1u << i), columns & ~(1u << j)));
    bool odd = (place_of(rows, i) + place_of(columns, j)) % 2 != 0;
    sum = op(s, odd ? AMBIT_OP_SUB : AMBIT_OP_ADD, sum, term);
  }
  return ambit_graph_simplify(s->g, sum, SIMPLIFY_TERMS);
}

static void adjugate(const ambit_loop_solver *s, ambit_loop_block *b) {
  uint32_t all = (1u << b->n) - 1;
  b->det = minor(s, b, all, all);
  for (uint32_t i = 0; i < b->n; i++)
    for (uint32_t j = 0; j < b->n; j++) {
      ambit_expr m = minor(s, b, all & ~(1u << j), all & ~(1u << i));
      b->a[i * b->n + j] = (i + j) % 2 ? op(s, AMBIT_OP_NEG, m, m) : m;
    }
}

/* -- elimination in the order of the pivots */

static void eliminate(const ambit_loop_solver *s, ambit_loop_block *b) {
  size_t n = b->n;
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++) b->a[i * n + j] = entry(s, b->first + i, b->first + j);
  for (size_t k = 0; k < n; k++)
    for (size_t i = k + 1; i < n; i++) {
      ambit_expr *row = &b->a[i * n];
      if (row[k] == 0) continue;
      row[k] = op(s, AMBIT_OP_DIV, row[k], b->a[k * n + k]);
      for (size_t j = k + 1; j < n; j++) row[j] = reduce(s, row[j], row[k], b->a[k * n + j]);
    }
}

ambit_status ambit_loop_solver_open(ambit_graph *g, ambit_arena *arena, const ambit_partition *p,
    const ambit_expr *velocity, ambit_loop_solver *s, ambit_failure *f) {
  *s = (ambit_loop_solver) { g, p, velocity, ambit_arena_alloc(arena, (p->nblock + 1) * sizeof *s->block),
    ambit_arena_alloc(arena, (p->rank + 1) * sizeof *s->work) };
  if (!s->block || !s->work) return ambit_no_memory(f);
  for (size_t i = 0; i < p->nblock; i++) {
    ambit_loop_block *b = &s->block[i];
    b->first = p->block[i];
    b->n = p->block[i + 1] - b->first;
    b->a = ambit_arena_alloc(arena, b->n * b->n * sizeof *b->a);
    if (!b->a) return ambit_no_memory(f);
    if (b->n <= AMBIT_CRAMER)
      adjugate(s, b);
    else
      eliminate(s, b);
  }
  return AMBIT_OK;
}

/* -- solutions */

/* x := B^-1 x, or with `transposed` B^-T x */
static void solve_cramer(const ambit_loop_solver *s, const ambit_loop_block *b, bool transposed, ambit_expr *x) {
  ambit_expr y[AMBIT_CRAMER];
  for (size_t i = 0; i < b->n; i++) {
    y[i] = 0;
    for (size_t j = 0; j < b->n; j++) {
      ambit_expr a = transposed ? b->a[j * b->n + i] : b->a[i * b->n + j];
      y[i] = op(s, AMBIT_OP_ADD, y[i], product(s, a, x[j]));
    }
  }
  for (size_t i = 0; i < b->n; i++) x[i] = y[i] == 0 ? 0 : op(s, AMBIT_OP_DIV, y[i], b->det);
}

static void solve_eliminated(const ambit_loop_solver *s, const ambit_loop_block *b, bool transposed, ambit_expr *x) {
  size_t n = b->n;
  const ambit_expr *a = b->a;
  for (size_t k = 0; k < n; k++) { /* L x = x, or U^T x = x */
    for (size_t i = 0; i < k; i++) x[k] = reduce(s, x[k], transposed ? a[i * n + k] : a[k * n + i], x[i]);
    if (transposed && x[k]) x[k] = op(s, AMBIT_OP_DIV, x[k], a[k * n + k]);
  }
  for (size_t k = n; k-- > 0;) { /* U x = x, or L^T x = x */
    for (size_t i = k + 1; i < n; i++) x[k] = reduce(s, x[k], transposed ? a[i * n + k] : a[k * n + i], x[i]);
    if (!transposed && x[k]) x[k] = op(s, AMBIT_OP_DIV, x[k], a[k * n + k]);
  }
}

static void solve_block(const ambit_loop_solver *s, const ambit_loop_block *b, bool transposed, ambit_expr *x) {
  if (b->n <= AMBIT_CRAMER)
    solve_cramer(s, b, transposed, x);
  else
    solve_eliminated(s, b, transposed, x);
}

static ambit_status check(const ambit_loop_solver *s, ambit_failure *f) {
  for (size_t k = 0; k < s->p->rank; k++)
    if (s->work[k] == AMBIT_NO_EXPR) return ambit_no_memory(f);
  return AMBIT_OK;
}

ambit_status ambit_loop_solve(const ambit_loop_solver *s, const ambit_expr *b, ambit_expr *x, ambit_failure *f) {
  const ambit_partition *p = s->p;
  for (size_t i = 0; i < p->nblock; i++) {
    const ambit_loop_block *block = &s->block[i];
    for (size_t k = block->first; k < block->first + block->n; k++) {
      s->work[k] = b[p->row[k]];
      for (size_t l = 0; l < block->first; l++) s->work[k] = reduce(s, s->work[k], entry(s, k, l), s->work[l]);
    }
    solve_block(s, block, false, s->work + block->first);
  }
  for (size_t k = 0; k < p->rank; k++) x[p->column[k]] = s->work[k];
  return check(s, f);
}

ambit_status ambit_loop_solve_transposed(
    const ambit_loop_solver *s, const ambit_expr *b, ambit_expr *y, ambit_failure *f) {
  const ambit_partition *p = s->p;
  for (size_t i = p->nblock; i-- > 0;) {
    const ambit_loop_block *block = &s->block[i];
    size_t end = block->first + block->n;
    for (size_t k = block->first; k < end; k++) {
      s->work[k] = b[p->column[k]];
      for (size_t l = end; l < p->rank; l++) s->work[k] = reduce(s, s->work[k], entry(s, l, k), s->work[l]);
    }
    solve_block(s, block, true, s->work + block->first);
  }
  for (size_t k = 0; k < p->rank; k++) y[p->row[k]] = s->work[k];
  return check(s, f);
}
