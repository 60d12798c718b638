/* close.c -- the set at the end of the step.
**
** x(h) = Y(xi) + Y_eps eps + sum_j xi_j Y_j eps + z(h). Old generators move with Y_eps / E; what the mixed terms do to
** them is in mixed.c, what z(h) adds in distance.c. Then there are fewer: reduce.c.
*/
#include "basis.h"
#include "depend.h"
#include "modes.h"
#include "proof.h"
#include "quartic.h"
#include "reduce.h"
#include "strip.h"

/* -- the polynomials */

/* end := rows at h; box := what is rounded, and the end of the step itself */
static void find_end(zono *z) {
  proof *p = z->proof;
  const shape *s = &z->shape;
  for (uint32_t i = 0; i < z->nx; i++) {
    uint32_t slot = slot_x(z, i), out = slot_out(z)[i];
    double *to = p->end + (size_t)i * s->stride, power = 1, size = 0, constant = 0;
    dd centre = { 0, 0 };
    memset(to, 0, s->stride * sizeof *to);
    for (uint32_t k = 0; k < orders(z, slot); k++, power *= z->h) {
      const double *row = row_at(z, slot, k);
      row_add(s, to, power, row);
      size += fabs(power) * row_moving(s, row), constant += fabs(power * row[0]);
    }
    for (uint32_t k = orders(z, slot); k-- > 0;)
      centre = dd_add(dd_scale(centre, z->h), row_middle(s, row_at(z, slot, k)));
    row_norms_all(s, to);
    if (!(row_parts(s, 0) & TRIPLES)) *box(z, FROM_DEGREE, i) += row_c(s, to) * ABOVE, to[s->norms + NORM_C] = 0;
    to[0] = centre.hi, to[s->norms + LOW] = centre.lo;
    *box(z, FROM_START, i) += 16 * (z->K + 2) * UNIT * UNIT * constant;
    *box(z, FROM_START, i) += 2 * (z->K + 3) * UNIT * size + z->h_error * (p->high[out] + p->delta[out]);
  }
}

/* -- old generators */

/* what the step makes of errors, of eps until here */
static void resolve_end(zono *z) {
  const shape *s = &z->shape;
  for (uint32_t i = 0; i < z->nx; i++) {
    double *y = z->proof->end + (size_t)i * s->stride;
    *box(z, FROM_START, i) += basis_resolve(z, y + s->eps);
    for (uint32_t j = 0; j < s->mixed && row_x(s, y) > 0; j++)
      *box(z, FROM_START, i) += basis_resolve(z, y + s->mix + (size_t)j * z->nx);
  }
}

static double size_by_errors(const zono *z, const double *y) {
  double sum = 0;
  for (uint32_t k = 0; k < z->nx; k++) sum += fabs(y[k]) * z->E[k];
  return sum;
}

/* columns [ngen] at p->columns, and those of mixed terms; box += what these leave, and rounding. Their number. */
static uint32_t move_generators(zono *z) {
  proof *p = z->proof;
  const shape *s = &z->shape;
  double *moved = p->turned + z->nx * mixed_stride(z);
  mixed_prepare(z);
  memcpy(p->origin, p->from, z->ngen), memcpy(p->source, p->made_by, z->ngen * sizeof *p->source);
  for (uint32_t i = 0; i < z->nx; i++) {
    const double *y = p->end + (size_t)i * s->stride;
    quartic_move(z, i, y + s->eps);
    mixed_through(z, y + s->eps, moved);
    for (uint32_t c = 0; c < z->ngen; c++) p->columns[(size_t)c * z->nx + i] = moved[c];
    double size = size_by_errors(z, y + s->eps); /* E is at least sums of |G|, with those of terms of degree 4 */
    for (uint32_t j = 0; j < s->mixed && row_x(s, y) > 0; j++)
      size += size_by_errors(z, y + s->mix + (size_t)j * z->nx);
    *box(z, FROM_START, i) += 2 * (z->nx + 4) * UNIT * size * ABOVE;
  }
  depend_move(z);
  return mixed_add(z, z->ngen);
}

static void find_sizes(zono *z) {
  for (uint32_t i = 0; i < z->nx; i++) {
    double sum = 0;
    for (uint32_t c = 0; c < z->ngen; c++) sum += fabs(z->G[(size_t)c * z->nx + i]);
    z->E[i] = (sum + depend_size(z, i) + quartic_size(z, i) + discs_width(z, i)) * ABOVE;
  }
}

/* the set from p->end and n columns */
static void settle(zono *z, uint32_t n) {
  const proof *p = z->proof;
  const shape *s = &z->shape;
  quartic_finish(z);
  discs_turn(z);
  quartic_drop(z);
  reduce(z, strip_all(z, n));
  for (uint32_t i = 0; i < z->nx; i++) {
    double *to = z->P + (size_t)i * s->stride;
    row_copy(s, to, p->end + (size_t)i * s->stride);
    memset(to + s->eps, 0, z->nx * sizeof *to);
    memset(to + s->mix, 0, (size_t)s->mixed * z->nx * sizeof *to);
    row_norms_all(s, to);
  }
  find_sizes(z);
  basis_choose(z);
}

void zono_finish(zono *z) {
  memset(z->proof->boxes, 0, ORIGINS * (size_t)z->nx * sizeof(double));
  find_end(z);
  resolve_end(z);
  discs_move(z);
  settle(z, distance_add(z, move_generators(z)));
}

void close_jump(zono *z, uint32_t (*put)(zono *z, const zono *by, uint32_t at), const zono *by) {
  resolve_end(z);
  discs_jump(z);
  settle(z, put(z, by, move_generators(z)));
}
