/* loop_point.c -- evaluation at a point, and assembly by the Levenberg-Marquardt step
**   dq = -J^T (J J^T + mu 1)^-1 g,   J = dg/dq,
** with a small fixed mu relative to J: directions of redundant rows, whose singular values are small, are left alone,
** all others converge by a factor of about mu a step.
*/
#include "mechanics/loop_point.h"
#include "graph/tape.h"
#include "graph/hull.h"
#include <ambit/matrix.h>
#include <string.h>

#define STEPS 200
#define DAMPING 1e-9
#define CLOSED 1e-11 /* residual relative to the size of the rows */
#define STRIDE 1.0   /* no coordinate moves further in a step; rad, m */

static ambit_status seal(
    ambit_loop_point *p, ambit_arena *arena, size_t nout, const ambit_expr *out, ambit_failure *f) {
  ambit_graph *g = ambit_mechanism_graph(p->c->mechanism);
  size_t n = ambit_graph_leaves(g, nout, out, 0, NULL);
  ambit_expr *leaf = ambit_arena_alloc(arena, (n + 1) * sizeof *leaf);
  p->in = ambit_arena_alloc(arena, (n + 1) * sizeof *p->in);
  p->place = ambit_arena_alloc(arena, (p->c->nq + 1) * sizeof *p->place);
  if (!leaf || !p->in || !p->place) return ambit_no_memory(f);
  ambit_graph_leaves(g, nout, out, n, leaf);
  for (size_t j = 0; j < p->c->nq; j++) p->place[j] = SIZE_MAX;
  p->time = SIZE_MAX;
  for (size_t i = 0; i < n; i++) {
    double x = ambit_interval_mid(ambit_graph_node(g, leaf[i])->range);
    p->in[i] = (ambit_interval) { x, x };
    if (ambit_graph_node(g, leaf[i])->op == AMBIT_LEAF_TIME) p->time = i;
    for (size_t j = 0; j < p->c->nq; j++)
      if (leaf[i] == p->c->coordinate[j].q) p->place[j] = i;
  }
  ambit_status status = ambit_tape_seal(g, arena, nout, out, n, leaf, 0, 0, &p->tape, f);
  if (status != AMBIT_OK) return status;
  p->slot = ambit_arena_alloc(arena, (p->tape->nslot + 1) * sizeof *p->slot);
  return p->slot ? AMBIT_OK : ambit_no_memory(f);
}

ambit_status ambit_loop_point_open(
    const ambit_constraints *c, ambit_arena *arena, ambit_loop_point *p, ambit_failure *f) {
  size_t rows = c->n + c->npure, ng = rows, ns = rows * c->nq, nv = c->n * c->nu;
  *p = (ambit_loop_point) { .c = c };
  ambit_expr *out = ambit_arena_alloc(arena, (ng + ns + nv + c->n + 1) * sizeof *out);
  p->g = ambit_arena_alloc(arena, (ng + ns + nv + c->n + 1) * sizeof *p->g);
  p->scratch = ambit_arena_alloc(arena, (rows * rows + 2 * rows + c->nq + 1) * sizeof *p->scratch);
  if (!out || !p->g || !p->scratch) return ambit_no_memory(f);
  p->slope = p->g + ng;
  p->velocity = p->slope + ns;
  p->drive = p->velocity + nv;
  for (size_t k = 0; k < ng; k++) out[k] = c->row[k].g;
  memcpy(out + ng, c->slope, ns * sizeof *out);
  memcpy(out + ng + ns, c->velocity, nv * sizeof *out);
  memcpy(out + ng + ns + nv, c->drive, c->n * sizeof *out);
  return seal(p, arena, ng + ns + nv + c->n, out, f);
}

bool ambit_loop_point_evaluate(ambit_loop_point *p, const double *q, double t) {
  for (size_t j = 0; j < p->c->nq; j++)
    if (p->place[j] != SIZE_MAX) p->in[p->place[j]] = (ambit_interval) { q[j], q[j] };
  if (p->time != SIZE_MAX) p->in[p->time] = (ambit_interval) { t, t };
  ambit_hull(p->tape, p->in, p->slot);
  for (uint32_t i = 0; i < p->tape->nout; i++) {
    ambit_interval x = p->slot[p->tape->out[i]];
    if (ambit_interval_is_empty(x) || !ambit_interval_is_bounded(x)) return false;
    p->g[i] = ambit_interval_mid(x);
  }
  return true;
}

/* -- assembly */

/* Rows divided by their size at this point, so that metres and cosines weigh alike. */
static double row_size(const ambit_loop_point *p, size_t k) {
  double size = 0;
  for (size_t j = 0; j < p->c->nq; j++) size = fmax(size, fabs(p->slope[k * p->c->nq + j]));
  return size > 0 ? size : 1;
}

static double residual(const ambit_loop_point *p) {
  double most = 0;
  for (size_t k = 0; k < p->c->n + p->c->npure; k++) most = fmax(most, fabs(p->g[k]) / row_size(p, k));
  return most;
}

static bool step(ambit_loop_point *p, double *q) {
  size_t n = p->c->n + p->c->npure, nq = p->c->nq;
  double *a = p->scratch, *x = a + n * n, *size = x + n, *dq = size + n, longest = 0;
  for (size_t k = 0; k < n; k++) size[k] = row_size(p, k);
  double most = 0;
  for (size_t k = 0; k < n; k++) {
    x[k] = p->g[k] / size[k];
    for (size_t l = 0; l < n; l++) {
      double sum = 0;
      for (size_t j = 0; j < nq; j++) sum += p->slope[k * nq + j] * p->slope[l * nq + j];
      a[k * n + l] = sum / (size[k] * size[l]);
    }
    most = fmax(most, a[k * n + k]);
  }
  for (size_t k = 0; k < n; k++) a[k * n + k] += DAMPING * most + 1e-300;
  if (!ambit_matrix_solve_definite(n, a, x)) return false;
  for (size_t j = 0; j < nq; j++) {
    dq[j] = 0;
    for (size_t k = 0; k < n; k++) dq[j] -= p->slope[k * nq + j] * x[k] / size[k];
    longest = fmax(longest, fabs(dq[j]));
  }
  if (!(longest < INFINITY)) return false;
  double share = longest > STRIDE ? STRIDE / longest : 1;
  for (size_t j = 0; j < nq; j++) q[j] += share * dq[j];
  return true;
}

bool ambit_loop_point_close(ambit_loop_point *p, double *q, double t) {
  for (int i = 0; i < STEPS; i++) {
    if (!ambit_loop_point_evaluate(p, q, t)) return false;
    if (residual(p) <= CLOSED)
      return !step(p, q) || ambit_loop_point_evaluate(p, q, t); /* one more, to the last bits */
    if (!step(p, q)) return false;
  }
  return false;
}

size_t ambit_loop_point_worst(const ambit_loop_point *p) {
  size_t worst = 0;
  for (size_t k = 1; k < p->c->n + p->c->npure; k++)
    if (fabs(p->g[k]) / row_size(p, k) > fabs(p->g[worst]) / row_size(p, worst)) worst = k;
  return worst;
}
