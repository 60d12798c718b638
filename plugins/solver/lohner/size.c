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
#include "lohner.h"
#include <ambit/matrix.h>

#define FAR_SHARE 0x1p-10 /* of what the set grows to in the end, that counts now */
#define FILLED 2.0        /* times its size, that a state counts as */

static const double *series(const lohner *s, uint32_t i) { return s->series_mid + (size_t)i * (s->options.order + 1u); }

/* df/dx, row i */
static const double *rates(const lohner *s, uint32_t i) {
  return s->slope_mid + ((size_t)i * (s->slope_order + 1u) + 1) * s->ndir + s->nc;
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
static double swing(const lohner *s, uint32_t i) {
  return departure(series(s, i), 1, 3, s->options.order, s->step.length);
}

double lohner_noise(const lohner *s, uint32_t i) {
  const double *rad = s->series_rad + (size_t)i * (s->options.order + 1u);
  double H = s->step.length;
  return H * (rad[1] + H * (rad[2] + H * rad[3]));
}

/* -- near */

/* in which some state changes by its own size; at least the step */
static double natural_time(const lohner *s) {
  double least = INFINITY;
  for (uint32_t i = 0; i < s->nx; i++) {
    const double *mid = series(s, i);
    if (s->size[i] > 0) least = smaller(least, smaller(s->size[i] / fabs(mid[1]), sqrt(s->size[i] / fabs(mid[2]))));
  }
  return least < INFINITY ? larger(least, s->step.length) : s->step.length;
}

static void fill_near(const lohner *s, double *size) {
  double time = natural_time(s);
  int more = 1;
  for (uint32_t sweep = 0; sweep < s->nx && more; sweep++) {
    more = 0;
    for (uint32_t i = 0; i < s->nx; i++) {
      if (size[i] > 0) continue;
      for (uint32_t j = 0; j < s->nx; j++) size[i] = larger(size[i], time * fabs(rates(s, i)[j]) * size[j]);
      more |= size[i] > 0;
    }
  }
}

/* -- far */

static void fill_far(const lohner *s, double share, double *size) {
  uint32_t n = s->nx;
  double *A = s->euler, *x = A + (size_t)n * n, time = fabs(s->problem.time[s->problem.ntime - 1] - s->t);
  uint32_t *row = (uint32_t *)(x + n);
  for (uint32_t i = 0; i < n; i++) {
    for (uint32_t j = 0; j < n; j++) A[(size_t)i * n + j] = (i == j) - time * rates(s, i)[j];
    x[i] = size[i];
  }
  if (!ambit_matrix_factor(n, A, row)) return;
  ambit_matrix_solve(n, A, row, 1, x);
  for (uint32_t i = 0; i < n; i++)
    if (share * fabs(x[i]) > size[i] && share * fabs(x[i]) < INFINITY) size[i] = share * fabs(x[i]);
}

/* States that only second derivatives reach (a product of two that start at zero) count as the smallest of the
** others. */
static void fill_rest(const lohner *s, double *size) {
  double least = INFINITY;
  for (uint32_t i = 0; i < s->nx; i++)
    if (size[i] > 0) least = smaller(least, size[i]);
  for (uint32_t i = 0; i < s->nx && least < INFINITY; i++)
    if (!(size[i] > 0)) size[i] = least;
}

/* -- sizes */

void lohner_choose_units(lohner *s) {
  for (uint32_t i = 0; i < s->nx; i++) s->unit[i] = larger(s->size[i], swing(s, i));
  if (s->lenient == LENIENT_NEAR) fill_near(s, s->unit);
  if (s->lenient == LENIENT_FAR) fill_far(s, 1, s->unit), fill_rest(s, s->unit);
}

void lohner_choose_grown(lohner *s) {
  uint32_t n = s->ndir, q = s->slope_order;
  for (uint32_t i = 0; i < s->nx; i++) {
    s->grown[i] = s->radius[i];
    for (uint32_t j = 0; j < n; j++) {
      const double *slope = s->slope_mid + (size_t)i * (q + 1u) * n + j;
      s->grown[i] += departure(slope, n, 2, s->radius[i] > 0 ? 2 : q, s->step.length) * lohner_reach(s, j);
    }
  }
  if (s->lenient == LENIENT_NEAR) fill_near(s, s->grown);
  if (s->lenient == LENIENT_FAR) fill_far(s, FAR_SHARE, s->grown), fill_rest(s, s->grown);
}

/* 1: what is small by itself counts as more */
int lohner_is_filled(const lohner *s) {
  for (uint32_t i = 0; i < s->nx; i++)
    if (s->unit[i] > FILLED * s->size[i]) return 1;
  return 0;
}
