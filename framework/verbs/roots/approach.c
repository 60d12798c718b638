/* approach.c -- Levenberg (1944), Marquardt (1963): (J^T J + lambda diag(J^T J)) step = -J^T f, lambda smaller after a
** step that helps, larger after one that does not. Ordinary floating point; finds a centre, proves nothing. */
#include "verbs/roots/equations.h"
#include <ambit/matrix.h>
#include <math.h>
#include <string.h>

#define ITERATIONS 200
#define FIRST_DAMPING 1e-3
#define LEAST_DAMPING 1e-14
#define MOST_DAMPING 1e12
#define NEGLIGIBLE 1e-13 /* of a step, relative to 1 + |x| */

typedef struct iteration {
  const ambit_ready *r;
  const ambit_tape *f, *J;
  ambit_interval *slot;
  double *x, *trial, *step; /* [nx] */
  double *value, *next;     /* [ne] */
  double *slope;            /* [ne * nx] */
  double *normal, *right;   /* [nx * nx] [nx] */
  double damping;
} iteration;

static ambit_status make_room(iteration *it, ambit_failure *f) {
  const ambit_ready *r = it->r;
  size_t slots = it->f->nslot > it->J->nslot ? it->f->nslot : it->J->nslot;
  it->slot = ambit_arena_alloc(r->arena, (slots + 1) * sizeof *it->slot);
  double **const vector[] = { &it->trial, &it->step, &it->right };
  bool good = it->slot != NULL;
  for (size_t i = 0; i < 3; i++)
    good = good && (*vector[i] = ambit_arena_alloc(r->arena, (r->nx + 1) * sizeof(double)));
  double **const values[] = { &it->value, &it->next };
  for (size_t i = 0; i < 2; i++)
    good = good && (*values[i] = ambit_arena_alloc(r->arena, (r->ne + 1) * sizeof(double)));
  good = good && (it->slope = ambit_arena_alloc(r->arena, (r->ne * r->nx + 1) * sizeof(double)));
  good = good && (it->normal = ambit_arena_alloc(r->arena, (r->nx * r->nx + 1) * sizeof(double)));
  return good ? AMBIT_OK : ambit_no_memory(f);
}

static double squares(size_t n, const double *v) {
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += v[i] * v[i];
  return sum;
}

static bool find_step(iteration *it) {
  size_t n = it->r->nx, ne = it->r->ne;
  for (size_t a = 0; a < n; a++) {
    double g = 0;
    for (size_t i = 0; i < ne; i++) g -= it->slope[i * n + a] * it->value[i];
    it->step[a] = g;
    for (size_t b = 0; b <= a; b++) {
      double s = 0;
      for (size_t i = 0; i < ne; i++) s += it->slope[i * n + a] * it->slope[i * n + b];
      it->normal[a * n + b] = a == b ? s * (1 + it->damping) + it->damping * 1e-12 + 1e-290 : s;
    }
  }
  return ambit_matrix_solve_definite(n, it->normal, it->step);
}

/* one accepted step; false: none helps any more */
static bool advance(iteration *it) {
  const ambit_ready *r = it->r;
  if (!ambit_equations_at(r, it->J, it->x, it->slot, it->slope)) return false;
  for (; it->damping < MOST_DAMPING; it->damping *= 10) {
    if (!find_step(it)) continue;
    for (size_t j = 0; j < r->nx; j++) it->trial[j] = it->x[j] + it->step[j];
    if (!ambit_equations_at(r, it->f, it->trial, it->slot, it->next)) continue;
    if (!(squares(r->ne, it->next) < squares(r->ne, it->value))) continue;
    memcpy(it->x, it->trial, r->nx * sizeof *it->x);
    memcpy(it->value, it->next, r->ne * sizeof *it->value);
    it->damping = fmax(it->damping / 10, LEAST_DAMPING);
    return true;
  }
  return false;
}

/* the undamped step from here is negligible, and what is left is rounding: no minimum beside a root */
static bool has_converged(iteration *it) {
  const ambit_ready *r = it->r;
  it->damping = LEAST_DAMPING;
  if (!ambit_equations_at(r, it->J, it->x, it->slot, it->slope) || !find_step(it)) return false;
  for (size_t j = 0; j < r->nx; j++)
    if (!(fabs(it->step[j]) <= 1e3 * NEGLIGIBLE * (1 + fabs(it->x[j])))) return false;
  for (size_t i = 0; i < r->ne; i++) {
    double size = 1e-3;
    for (size_t j = 0; j < r->nx; j++) size += fabs(it->slope[i * r->nx + j]) * (1 + fabs(it->x[j]));
    if (!(fabs(it->value[i]) <= 1e-9 * size)) return false;
  }
  return true;
}

static bool is_negligible(const iteration *it) {
  for (size_t j = 0; j < it->r->nx; j++)
    if (fabs(it->step[j]) > NEGLIGIBLE * (1 + fabs(it->x[j]))) return false;
  return true;
}

ambit_status ambit_roots_approach(
    const ambit_equations *q, double *x, double *residual, bool *converged, ambit_failure *f) {
  ambit_ready r;
  iteration it = { .r = &r, .x = x, .damping = FIRST_DAMPING };
  ambit_arena *arena = ambit_arena_open();
  if (!arena) return ambit_no_memory(f);
  ambit_status status = ambit_equations_prepare(q, arena, &r, f);
  if (status == AMBIT_OK) status = ambit_equations_seal(&r, r.ne, r.equation, 0, &it.f, f);
  if (status == AMBIT_OK) status = ambit_equations_differentiate(&r, r.ne, r.equation, 0, r.nx, 0, &it.J, f);
  if (status == AMBIT_OK) status = make_room(&it, f);
  if (status == AMBIT_OK && !ambit_equations_at(&r, it.f, x, it.slot, it.value))
    status = ambit_fail(f, AMBIT_UNABLE, "the equations are not defined at the guess");
  if (status == AMBIT_OK) {
    for (int i = 0; i < ITERATIONS && advance(&it) && !is_negligible(&it); i++) {}
    *converged = has_converged(&it);
    memset(residual, 0, q->ne * sizeof *residual);
    for (size_t i = 0; i < r.ne; i++) residual[r.place[i]] = it.value[i];
  }
  ambit_arena_close(arena);
  return status;
}
