/* series.c -- the defect of the middle curve, and of the columns about it, by power series in sigma.
**
** The curve p(sigma, 0) is a polynomial, so f along it is a power series with a proved tail (ambit/jet.h): half f - p'
** = sum_k d_k sigma^k + tail, and as p solves the equation well, the d_k are small. About the middle of the step both
** halves are covered by |sigma| <= 1. Derivatives of f along a direction c(sigma) are power series too, so half S c
** - c' is bounded in the same way. Only for right-hand sides that have a series there.
*/
#include "valencia.h"

static void put_time(valencia *s, ambit_jet *z) {
  interval part[2] = { s->time, s->half };
  for (uint32_t m = 0; m < 2 && s->problem.uses_time; m++) {
    double mid = middle(part[m]);
    s->jet->put(z, s->nx + s->np, m, mid, radius_about(part[m], mid), NULL, NULL);
  }
}

static int advance(valencia *s, uint32_t order) {
  ambit_jet *z = s->centre;
  uint32_t nt = s->terms.n, n1 = s->stages.n + 1;
  for (uint32_t i = 0; i < s->nx; i++)
    for (uint32_t m = 0; m <= order; m++)
      s->jet->put(z, i, m, m < n1 ? s->curve[(size_t)i * nt * n1 + m] : 0, 0, NULL, NULL);
  for (uint32_t k = 0; k < s->np; k++) s->jet->put(z, s->nx + k, 0, s->middle[k], s->loose[k], NULL, NULL);
  put_time(s, z);
  for (uint32_t k = 0; k <= order; k++)
    if (s->jet->advance(z, k) & (AMBIT_F_PARTIAL | AMBIT_F_EMPTY | AMBIT_F_UNBOUNDED)) return 0;
  return 1;
}

/* x := hull of what is beyond the series on both halves */
static int tails(valencia *s, ambit_jet *z, uint32_t order, double *tail, double *dtail, uint32_t ndir) {
  double *other = tail + s->nx, *dother = dtail ? dtail + (size_t)s->nx * ndir : NULL;
  if (s->jet->tail(z, order, 1, NULL, NULL, tail, dtail) != AMBIT_OK) return 0;
  if (s->jet->tail(z, order, -1, NULL, NULL, other, dother) != AMBIT_OK) return 0;
  for (uint32_t i = 0; i < s->nx; i++) tail[i] = larger_or_nan(tail[i], other[i]);
  for (uint32_t i = 0; dtail && i < s->nx * ndir; i++) dtail[i] = larger_or_nan(dtail[i], dother[i]);
  return 1;
}

/* (half (mid +- rad) - (k + 1) c) sigma^k over [-1, 1] */
static interval term(const valencia *s, uint32_t k, double mid, double rad, const double *c) {
  interval d = times(s->half, plus(point(mid), within(rad)));
  if (k < s->stages.n) d = minus(d, scaled(point(c[k + 1]), k + 1));
  return times(d, (interval) { k % 2 ? -1 : k ? 0 : 1, 1 });
}

int valencia_series(valencia *s, interval *defect) {
  uint32_t order = s->stages.n + 2, n1 = s->stages.n + 1;
  const ambit_tape *t = s->problem.rhs;
  double *tail = s->tail;
  if (!s->centre || !advance(s, order) || !tails(s, s->centre, order, tail, NULL, 0)) return 0;
  for (uint32_t i = 0; i < s->nx; i++) {
    const double *c = s->curve + (size_t)i * s->terms.n * n1;
    defect[i] = times(s->half, within(tail[i]));
    for (uint32_t k = 0; k <= order; k++) {
      double mid, rad;
      s->jet->get(s->centre, t->out[i], k, &mid, &rad, NULL, NULL);
      defect[i] = plus(defect[i], term(s, k, mid, rad, c));
    }
    if (!is_bounded(defect[i])) return 0;
  }
  return 1;
}

/* -- columns: what the unknowns (while p is linear in them) and the coordinates z of the frame do */

static const double *column_of(const valencia *s, uint32_t i, uint32_t dir) {
  uint32_t n1 = s->stages.n + 1, own = s->ncolumn - s->nx;
  if (dir < own) return s->curve + ((size_t)i * s->terms.n + 1 + dir) * n1;
  return s->frame + ((size_t)i * s->nx + dir - own) * n1;
}

/* the box of p(sigma, xi) + B(sigma) z, coefficient by coefficient */
static int advance_box(valencia *s, uint32_t order) {
  ambit_jet *z = s->box;
  uint32_t nt = s->terms.n, n1 = s->stages.n + 1, own = s->ncolumn - s->nx;
  double *mid = s->tail, *none = mid + s->ncolumn;
  for (uint32_t j = 0; j < s->ncolumn; j++) none[j] = 0;
  for (uint32_t i = 0; i < s->nx; i++)
    for (uint32_t m = 0; m <= order; m++) {
      double rad = 0;
      const double *c = s->curve + (size_t)i * nt * n1;
      for (uint32_t k = 1; k < nt && m < n1; k++) rad += fabs(c[k * n1 + m]);
      for (uint32_t j = 0; j < s->ncolumn; j++) mid[j] = m < n1 ? column_of(s, i, j)[m] : 0;
      for (uint32_t j = 0; j < s->nx; j++) rad += fabs(mid[own + j]) * s->w[j];
      s->jet->put(z, i, m, m < n1 ? c[m] : 0, rad, mid, none);
    }
  for (uint32_t k = 0; k < s->np; k++) {
    double rad = s->loose[k];
    for (uint32_t j = 0; j < s->nu; j++) rad += fabs(s->reach[(size_t)k * s->nu + j]);
    for (uint32_t j = 0; j < s->ncolumn; j++) mid[j] = j < own ? s->reach[(size_t)k * s->nu + j] : 0;
    s->jet->put(z, s->nx + k, 0, s->middle[k], rad, mid, none);
  }
  put_time(s, z);
  for (uint32_t k = 0; k <= order; k++)
    if (s->jet->advance(z, k) & (AMBIT_F_PARTIAL | AMBIT_F_EMPTY | AMBIT_F_UNBOUNDED)) return 0;
  return 1;
}

int valencia_column_series(valencia *s) {
  uint32_t order = s->stages.n, nd = s->ncolumn;
  const ambit_tape *t = s->problem.rhs;
  if (!s->box || !advance_box(s, order)) return 0;
  double *tail = s->tail, *dtail = tail + 2 * s->nx, *mid = dtail + 2u * s->nx * nd, *rad = mid + nd;
  if (!tails(s, s->box, order, tail, dtail, nd)) return 0;
  for (uint32_t i = 0; i < s->nx; i++) {
    for (uint32_t j = 0; j < nd; j++)
      s->residual[(size_t)j * s->nx + i] = times(s->half, within(dtail[(size_t)i * nd + j]));
    for (uint32_t k = 0; k <= order; k++) {
      double value, radius;
      s->jet->get(s->box, t->out[i], k, &value, &radius, mid, rad);
      for (uint32_t j = 0; j < nd; j++) {
        interval *r = s->residual + (size_t)j * s->nx + i;
        *r = plus(*r, term(s, k, mid[j], rad[j], column_of(s, i, j)));
      }
    }
    for (uint32_t j = 0; j < nd; j++)
      if (!is_bounded(s->residual[(size_t)j * s->nx + i])) return 0;
  }
  return 1;
}
