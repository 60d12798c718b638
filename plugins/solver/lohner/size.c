/* size.c -- how large a state counts as, where tolerances are relative: guesses, which no proof rests on.
**
** A state is as large as it is, or as it gets in the step (the error of a model that has forgotten what happens at rest
** begins with t^5). One that starts at zero, and stays there for its first
** derivatives too (the far end of a chain), has no size of its own; with leniency it gets what others could make of it:
**   NEAR: in the time in which some state changes by its own size, by one derivative after the other;
**   FAR: in one implicit Euler step over all the time that is left, |(I - T J)^-1 size|. The far end of a chain counts
**        as what diffuses there in the end, however small it is now: relative to its size in the first steps, it could
**        only be followed by a series of as many orders as it has links to the source.
*/
#include "control.h"
#include <ambit/matrix.h>

#define FAR_SHARE 0x1p-10 /* of what the set grows to in the end, that counts now */
#define FILLED 2.0        /* times its size, that a state counts as */

static const double *series(const flow *phi, uint32_t i) { return phi->centre.mid + (size_t)i * (phi->p + 1u); }

/* df/dx, row i */
static const double *rates(const field *f, const flow *phi, uint32_t i) {
  return phi->slope.mid + ((size_t)i * (phi->q + 1u) + 1) * f->ndir + f->nc;
}

/* sum over k = 1 .. first of |c_k| H^k; if that is zero, the first term beyond that is not. c: `stride` apart */
static double departure(const double *c, size_t stride, uint32_t first, uint32_t last, double H) {
  double sum = 0, power = 1;
  for (uint32_t k = 1; k <= last && (k <= first || sum == 0); k++) {
    power *= H;
    sum += power * fabs(c[k * stride]);
  }
  return sum;
}

/* how far state i gets in the step by its first derivatives: its size where it starts from zero */
static double swing(const flow *phi, uint32_t i) { return departure(series(phi, i), 1, 3, phi->p, phi->step.length); }

double sizes_noise(const flow *phi, uint32_t i) {
  const double *rad = phi->centre.rad + (size_t)i * (phi->p + 1u);
  double H = phi->step.length;
  return H * (rad[1] + H * (rad[2] + H * rad[3]));
}

/* -- near */

/* in which some state changes by its own size; at least the step */
static double natural_time(const field *f, const flow *phi, const double *size) {
  double least = INFINITY;
  for (uint32_t i = 0; i < f->nx; i++) {
    const double *mid = series(phi, i);
    if (size[i] > 0) least = smaller(least, smaller(size[i] / fabs(mid[1]), sqrt(size[i] / fabs(mid[2]))));
  }
  return least < INFINITY ? larger(least, phi->step.length) : phi->step.length;
}

static void fill_near(const field *f, const flow *phi, const sizes *z, double *size) {
  double time = natural_time(f, phi, z->size);
  int more = 1;
  for (uint32_t sweep = 0; sweep < f->nx && more; sweep++) {
    more = 0;
    for (uint32_t i = 0; i < f->nx; i++) {
      if (size[i] > 0) continue;
      for (uint32_t j = 0; j < f->nx; j++) size[i] = larger(size[i], time * fabs(rates(f, phi, i)[j]) * size[j]);
      more |= size[i] > 0;
    }
  }
}

/* -- far */

static void fill_far(const field *f, const flow *phi, const sizes *z, double share, double *size) {
  uint32_t n = f->nx;
  double *A = z->euler, *x = A + (size_t)n * n, time = fabs(field_end(f) - phi->t);
  uint32_t *row = (uint32_t *)(x + n);
  for (uint32_t i = 0; i < n; i++) {
    for (uint32_t j = 0; j < n; j++) A[(size_t)i * n + j] = (i == j) - time * rates(f, phi, i)[j];
    x[i] = size[i];
  }
  if (!ambit_matrix_factor(n, A, row)) return;
  ambit_matrix_solve(n, A, row, 1, x);
  for (uint32_t i = 0; i < n; i++)
    if (share * fabs(x[i]) > size[i] && share * fabs(x[i]) < INFINITY) size[i] = share * fabs(x[i]);
}

/* States that only second derivatives reach (a product of two that start at zero) count as the smallest of the
** others. */
static void fill_rest(const field *f, double *size) {
  double least = INFINITY;
  for (uint32_t i = 0; i < f->nx; i++)
    if (size[i] > 0) least = smaller(least, size[i]);
  for (uint32_t i = 0; i < f->nx && least < INFINITY; i++)
    if (!(size[i] > 0)) size[i] = least;
}

/* -- sizes */

/* what is small by itself counts as more, if need be; `share` of what it is in the end counts now */
static void fill(const field *f, const flow *phi, const sizes *z, double share, double *size) {
  if (z->lenient == LENIENT_NEAR) fill_near(f, phi, z, size);
  if (z->lenient == LENIENT_FAR) fill_far(f, phi, z, share, size), fill_rest(f, size);
}

void sizes_choose_unit(const field *f, const flow *phi, sizes *z) {
  for (uint32_t i = 0; i < f->nx; i++) z->unit[i] = larger(z->size[i], swing(phi, i));
  fill(f, phi, z, 1, z->unit);
}

void sizes_choose_grown(const field *f, const set *x, const flow *phi, sizes *z) {
  uint32_t n = f->ndir, q = phi->q;
  for (uint32_t i = 0; i < f->nx; i++) {
    z->grown[i] = x->radius[i];
    for (uint32_t j = 0; j < n; j++) {
      const double *slope = phi->slope.mid + (size_t)i * (q + 1u) * n + j;
      z->grown[i] += departure(slope, n, 2, x->radius[i] > 0 ? 2 : q, phi->step.length) * set_reach(f, x, j);
    }
  }
  fill(f, phi, z, FAR_SHARE, z->grown);
}

int sizes_are_filled(const field *f, const sizes *z) {
  for (uint32_t i = 0; i < f->nx; i++)
    if (z->unit[i] > FILLED * z->size[i]) return 1;
  return 0;
}
