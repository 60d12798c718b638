/* jump.c -- states that jump: the set after x := g(x, p, t).
**
** The program of g is run as a step of length 0, as that of the initial values is: rows of its slots over the set, what
** its operations fail by, and coefficients of these lumps in x. What x was off by is in eps and moves with the rows;
** each lump is one generator (docs/numerics/zonotope.md, section 7d).
*/
#include "jump.h"
#include "basis.h"
#include "modes.h"
#include "vary.h"

size_t jump_columns(const zono *z) {
  size_t most = 0;
  for (uint32_t n = 0; n < z->problem.njump; n++)
    if (z->problem.jump[n]->nslot > most) most = z->problem.jump[n]->nslot;
  return most;
}

static int open_one(const zono *z, zono *j, const ambit_tape *tape) {
  *j = (zono) { .host = z->host, .shape = z->shape };
  memcpy(&j->problem, &z->problem, sizeof j->problem);
  j->problem.extras = j->problem.njump = 0;
  j->program = (program) { .tape = tape, .nx = z->nx, .np = z->np, .uses_time = z->problem.uses_time };
  j->nvarying = z->problem.nvarying;
  j->nx = z->nx, j->np = z->np, j->m = z->m, j->K = j->K_max = 0;
  return zono_open_rows(j);
}

int jump_open(zono *z) {
  const ambit_problem *p = &z->problem;
  if (!p->njump) return 1;
  z->jump = z->host->alloc(z->host, p->njump * sizeof *z->jump);
  for (uint32_t n = 0; z->jump && n < p->njump; n++)
    if (!open_one(z, &z->jump[n], p->jump[n])) return 0;
  return z->jump != NULL;
}

int jump_open_proofs(zono *z) {
  for (uint32_t n = 0; n < z->problem.njump; n++)
    if (!zono_open_proof(&z->jump[n])) return 0;
  return 1;
}

/* rows, defects, lumps and their coefficients */
static int evaluate(const zono *z, zono *j) {
  j->P = z->P, j->E = z->E, j->basis = z->basis, j->t = z->t, j->h = 0;
  j->p_row = z->p_row, j->p_rad = z->p_rad;
  j->why = WHY_NOTHING, j->proof->prepared = 0;
  j->shape = z->shape;
  shape_hold_all(&j->shape);
  memset(j->proof->input, 0, j->program.tape->nin * sizeof(double));
  return zono_series(j) && zono_defects(j) && zono_spread(j, j->proof->input, j->proof->delta) && sweep_coefficients(j);
}

/* the rows as those at the end of a step */
static void put_rows(zono *z, const zono *j) {
  const shape *s = &z->shape;
  for (uint32_t i = 0; i < z->nx; i++) {
    double *to = z->proof->end + (size_t)i * s->stride;
    row_copy(s, to, row_at(j, slot_out(j)[i], 0));
    if (row_parts(s, 0) & TRIPLES) continue;
    *box(z, FROM_DEGREE, i) += row_c(s, to) * ABOVE, to[s->norms + NORM_C] = 0;
  }
}

/* a column for each lump from number `at` on; returns the number of columns */
static uint32_t put_lumps(zono *z, const zono *j, uint32_t at) {
  proof *p = z->proof;
  const proof *of = j->proof;
  for (uint32_t k = 0; k < j->nslot; k++) {
    double *column = p->columns + (size_t)at * z->nx, any = 0, lump = j->rr[k];
    if (lump == 0) continue;
    for (uint32_t i = 0; i < z->nx; i++) {
      size_t e = (size_t)of->link_to[i] * j->nslot + k;
      int moves = of->link[i] == LINK_TARGET;
      column[i] = moves ? of->C[e] * lump : 0, any += fabs(column[i]);
      if (moves) *box(z, FROM_SLOPE, i) += (of->dC[e] * lump + UNIT * fabs(column[i])) * ABOVE + LEAST;
    }
    if (any == 0) continue;
    double second = lump - j->r[k];
    p->origin[at] = (uint8_t)(is_varying(j, k) ? FROM_VARYING : second > j->r[k] ? FROM_SQUARE : FROM_DEGREE);
    p->source[at++] = 0;
  }
  return at;
}

static int jump(zono *z, zono *j) {
  if (!evaluate(z, j)) {
    z->why = j->why == WHY_NOTHING ? WHY_UNDEFINED : j->why, z->blamed = 0, z->detail = j->detail;
    return 0;
  }
  memset(z->proof->boxes, 0, ORIGINS * (size_t)z->nx * sizeof(double));
  put_rows(z, j);
  close_jump(z, put_lumps, j);
  return 1;
}

int jump_all(zono *z) {
  while (jump_next(z) == z->t)
    if (!jump(z, &z->jump[z->problem.jump_number[z->jumped++]])) return 0;
  return 1;
}
