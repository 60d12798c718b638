/* start.c -- the set at the start: the initial tape over the unknowns.
**
** The tape is run as a step of length 0 of a system without states: the rows of its slots, what its operations fail by,
** and how far that spreads. A state or parameter that is more than rounding away from its row gets a datum of its own.
*/
#include "basis.h"
#include "depend.h"
#include "given.h"
#include "modes.h"
#include "zonotope.h"
#include <ambit/code.h>

#define THIN 0x1p-40 /* relative radius up to which an initial value is a matter of rounding */
#define MINOR 0.02   /* of a state's linear terms: errors of a run are often as large a part of its set */

/* -- the initial tape as a program */

static int open_initial(const zono *z, zono *i) {
  *i = (zono) { .host = z->host, .shape = z->shape };
  memcpy(&i->problem, &z->problem, sizeof i->problem);
  i->program = (program) { .tape = z->problem.initial, .np = z->problem.nu };
  i->np = z->problem.nu, i->m = z->m, i->K = i->K_max = 0;
  return zono_open_rows(i) && zono_open_proof(i);
}

static void put_unknowns(const zono *z, zono *i) {
  const ambit_problem *p = &z->problem;
  for (uint32_t u = 0; u < p->nu; u++)
    row_constant(&z->shape, i->p_row + (size_t)u * z->shape.stride, 0.5 * (p->u_lo[u] + p->u_hi[u]));
  for (uint32_t j = 0; j < z->m; j++) {
    if (z->unknown[j] == AMBIT_NO_SLOT) continue;
    double *row = i->p_row + (size_t)z->unknown[j] * z->shape.stride;
    row[1 + j] = z->scale[j];
    row_norms(&z->shape, row);
  }
}

static uint32_t is_datum(const zono *z, uint32_t u) {
  return z->problem.u_hi[u] > z->problem.u_lo[u] && !(z->minor && z->minor[u]);
}

/* unknowns that are data, those of the largest weight [nu] first */
static uint32_t list_unknowns(zono *z, const double *weight) {
  const ambit_problem *p = &z->problem;
  uint32_t n = 0;
  for (uint32_t u = 0; u < p->nu; u++) {
    if (!is_datum(z, u)) continue;
    uint32_t at = n++;
    for (; weight && at > 0 && weight[z->unknown[at - 1]] < weight[u]; at--) z->unknown[at] = z->unknown[at - 1];
    z->unknown[at] = u;
  }
  return n;
}

/* the middle of an unknown's range and its half width both may be rounded: |u - about - scale xi| is 0 all the same,
** for scale is rounded up and xi is what it must be */
static void choose_data(zono *z, const double *weight) {
  const ambit_problem *p = &z->problem;
  uint32_t known = list_unknowns(z, weight);
  for (uint32_t j = 0; j < known; j++) {
    uint32_t u = z->unknown[j];
    double mid = 0.5 * (p->u_lo[u] + p->u_hi[u]), up = p->u_hi[u] - mid, down = mid - p->u_lo[u];
    z->about[j] = mid, z->scale[j] = nextafter(up > down ? up : down, INFINITY);
  }
  for (uint32_t j = known; j < z->m; j++) z->unknown[j] = AMBIT_NO_SLOT, z->about[j] = 0, z->scale[j] = 1;
}

static uint32_t count_data(const zono *z) {
  uint32_t n = 0;
  for (uint32_t u = 0; u < z->problem.nu; u++) n += is_datum(z, u);
  return n;
}

/* how far the unknown of a problem is from its row: minor ones are constants that are off by their half width */
static double off(const zono *z, uint32_t u) {
  const ambit_problem *p = &z->problem;
  if (!(p->u_hi[u] > p->u_lo[u]) || is_datum(z, u)) return 0;
  double mid = 0.5 * (p->u_lo[u] + p->u_hi[u]);
  return nextafter(fmax(p->u_hi[u] - mid, mid - p->u_lo[u]), INFINITY);
}

static int allocate(zono *z) {
  const ambit_host *h = z->host;
  size_t row = z->shape.stride * sizeof(double), m = z->m + 1u;
  z->unknown = h->alloc(h, m * sizeof *z->unknown);
  z->about = h->alloc(h, m * sizeof(double)), z->scale = h->alloc(h, m * sizeof(double));
  z->start = h->alloc(h, (z->nx + 1u) * row), z->start_rad = h->alloc(h, (z->nx + 1u) * sizeof(double));
  z->start_p = h->alloc(h, (z->np + 1u) * row), z->start_p_rad = h->alloc(h, (z->np + 1u) * sizeof(double));
  return z->unknown && z->about && z->scale && z->start && z->start_rad && z->start_p && z->start_p_rad;
}

/* -- */

static double *output(const zono *z, uint32_t o, double **rad) {
  int state = o < z->nx;
  *rad = state ? z->start_rad + o : z->start_p_rad + (o - z->nx);
  return (state ? z->start : z->start_p) + (size_t)(state ? o : o - z->nx) * z->shape.stride;
}

/* rows and radii of all outputs, by a row for each slot */
static void keep(zono *z, const zono *i, const double *delta) {
  for (uint32_t o = 0; o < z->nx + z->np; o++) {
    double *rad, *to = output(z, o, &rad);
    row_copy(&z->shape, to, row_at(i, slot_out(i)[o], 0));
    *rad = delta[slot_out(i)[o]];
  }
}

/* *own: how many more data there should be. Functions of time are no data. */
static void give_own_data(zono *z, uint32_t *own) {
  const shape *s = &z->shape;
  uint32_t first = count_data(z), found = 0, fixed = z->nx + z->np - z->problem.nvarying;
  for (uint32_t o = 0; o < z->nx + z->np; o++) {
    int state = o < z->nx;
    double *rad, *to = output(z, o, &rad);
    if (o >= fixed || *rad <= THIN * row_total(s, to) + 0x1p-900) continue;
    if (state && z->minor && z->has_minor[o]) continue;
    if (first + found < z->m) {
      to[1 + first + found] = *rad;
      *rad = 0;
      row_norms(s, to);
    }
    found++;
  }
  *own = found;
}

static ambit_status undefined(const zono *z, const zono *i) {
  if (i->why == WHY_KINK && i->detail)
    return z->host->fail_code(z->host, AMBIT_UNABLE, AMBIT_CODE_UNABLE_KINK,
        "at t = %.9g s the initial values come to the kink of %s; narrow the ranges of the data in `initial`",
        z->problem.time[0], i->detail);
  return z->host->fail_code(z->host, AMBIT_UNABLE, AMBIT_CODE_UNABLE_INITIAL,
      "at t = %.9g s the initial values could not be bounded for all values of their uncertain data; narrow the ranges "
      "of the data in `initial`",
      z->problem.time[0]);
}

static ambit_status evaluate_rows(zono *z, const double *input) {
  const ambit_host *h = z->host;
  const ambit_tape *t = z->problem.initial;
  zono i;
  double *delta = h->alloc(h, (t->nslot + 1u) * sizeof *delta);
  if (!delta || !open_initial(z, &i)) return AMBIT_NOMEM;
  put_unknowns(z, &i);
  if (!zono_series(&i) || !zono_defects(&i) || !zono_spread(&i, input, delta)) return undefined(z, &i);
  for (uint32_t o = 0; o < t->nout; o++)
    if (!(delta[t->out[o]] < 1e200)) return undefined(z, &i);
  keep(z, &i, delta);
  return AMBIT_OK;
}

static ambit_status evaluate_over(zono *z, uint32_t m, uint32_t *own, const double *weight) {
  const ambit_host *h = z->host;
  z->m = m;
  if (!shape_open(h, &z->shape, m, z->nx)) return AMBIT_NOMEM;
  if (is_certain(z)) shape_lean(&z->shape);
  if (weight && z->bent && z->bent < z->shape.cubic) z->shape.cubic = z->bent, shape_place(&z->shape);
  double *input = h->alloc(h, (z->problem.nu + 1u) * sizeof *input);
  if (!input || !allocate(z)) return AMBIT_NOMEM;
  choose_data(z, weight);
  for (uint32_t u = 0; u < z->problem.nu; u++) input[u] = off(z, u);
  int is_given = m && given_is_large(z->problem.initial) && given_evaluate(z, input);
  ambit_status status = is_given ? AMBIT_OK : evaluate_rows(z, input);
  if (status == AMBIT_OK) give_own_data(z, own);
  return status;
}

/* -- data that are little more than errors */

static int is_in(const shape *s, const double *row, uint32_t j) {
  if (row[1 + j] != 0) return 1;
  for (uint32_t i = 0; i < s->m; i++) {
    uint32_t least = i < j ? i : j, most = i < j ? j : i;
    if (row_q(s, row) > 0 && most < s->reach[least] && row[s->pair[least] + most - least] != 0) return 1;
  }
  return 0;
}

/* the state that datum j is a small part of, if that is all that it does to first and second order; or nx */
static uint32_t state_of(const zono *z, uint32_t j) {
  const shape *s = &z->shape;
  uint32_t of = z->nx;
  for (uint32_t i = 0; i < z->np; i++)
    if (is_in(s, z->start_p + (size_t)i * s->stride, j)) return z->nx;
  for (uint32_t i = 0; i < z->nx; i++) {
    const double *row = z->start + (size_t)i * s->stride;
    if (!is_in(s, row, j)) continue;
    if (of < z->nx || fabs(row[1 + j]) > MINOR * row_l(s, row)) return z->nx;
    of = i;
  }
  return of;
}

/* which data of the problem are minor; how many */
static uint32_t find_minor(zono *z) {
  uint32_t n = 0;
  for (uint32_t j = 0; j < z->m; j++) {
    uint32_t i = z->unknown[j] == AMBIT_NO_SLOT ? z->nx : state_of(z, j);
    if (i < z->nx) z->minor[z->unknown[j]] = z->has_minor[i] = 1, n++;
  }
  return n;
}

/* In another order of data other monomials have no place in rows, and more states may want data of their own than
** before: for those there is no room, and what they are off by stays an error. */
static ambit_status evaluate_all(zono *z, const double *weight) {
  uint32_t own = 0, m = count_data(z), room = weight ? z->m - m : UINT32_MAX;
  ambit_status status = evaluate_over(z, m, &own, weight);
  if (own > room) own = room;
  return status == AMBIT_OK && own ? evaluate_over(z, m + own, &own, weight) : status;
}

ambit_status zono_start_open(zono *z, const double *weight) {
  ambit_status status = evaluate_all(z, weight);
  if (status != AMBIT_OK || weight || z->m <= FOLLOWED) return status;
  z->minor = z->host->alloc(z->host, z->problem.nu + 1u), z->has_minor = z->host->alloc(z->host, z->nx + 1u);
  if (!z->minor || !z->has_minor) return AMBIT_NOMEM;
  return find_minor(z) ? evaluate_all(z, weight) : AMBIT_OK;
}

void zono_start(zono *z) {
  shape_hold_all(&z->shape);
  if (z->modes) modes_start(z), z->basis->is_turned = 0;
  size_t bytes = z->shape.stride * sizeof(double);
  if (z->proof) depend_start(z);
  z->t = z->problem.time[0], z->next = 1, z->jumped = 0, z->guess = 0, z->ngen = 0, z->why = WHY_NOTHING,
  z->detail = NULL;
  memcpy(z->P, z->start, z->nx * bytes);
  memcpy(z->p_row, z->start_p, z->np * bytes), memcpy(z->p_rad, z->start_p_rad, z->np * sizeof(double));
  for (uint32_t i = 0; i < z->nx; i++) {
    z->E[i] = z->start_rad[i];
    if (z->E[i] == 0) continue;
    double *column = z->G + (size_t)z->ngen++ * z->nx;
    memset(column, 0, z->nx * sizeof *column);
    column[i] = z->E[i];
  }
}
