/* dense.c -- Horner's scheme in intervals: coefficients are points but for their radii, which are summed apart. */
#include "verbs/run/dense.h"
#include "num/interval.h"

static ambit_interval point(double x) { return (ambit_interval) { x, x }; }

static ambit_interval polynomial(uint32_t n, const double *coefficient, ambit_interval s) {
  ambit_interval value = point(0);
  for (uint32_t k = n; k-- > 0;) value = ambit_interval_add(ambit_interval_mul(value, s), point(coefficient[k]));
  return value;
}

/* Encloses what state i is within of its middle. */
static ambit_interval spread(const ambit_record *r, uint32_t i, ambit_interval s) {
  ambit_interval sum = polynomial(r->ndense, r->dense_rad + (size_t)i * r->ndense, point(ambit_interval_mag(s)));
  size_t row = (size_t)r->ncolumn * r->ncoef_column;
  for (uint32_t c = 0; c < r->ncolumn && r->dense_column; c++) {
    const double *column = r->dense_column + i * row + (size_t)c * r->ncoef_column;
    sum = ambit_interval_add(sum, point(ambit_interval_mag(polynomial(r->ncoef_column, column, s))));
  }
  return (ambit_interval) { -sum.hi, sum.hi };
}

ambit_interval ambit_dense_state(const ambit_record *r, uint32_t i, ambit_interval when) {
  ambit_interval x = AMBIT_ENTIRE;
  if (r->tube_lo && r->tube_hi) x = (ambit_interval) { r->tube_lo[i], r->tube_hi[i] };
  if (!r->ndense || !r->dense_mid || !r->dense_rad) return x;
  ambit_interval s = ambit_interval_sub(when, point(r->t_from));
  ambit_interval middle = polynomial(r->ndense, r->dense_mid + (size_t)i * r->ndense, s);
  return ambit_interval_intersect(x, ambit_interval_add(middle, spread(r, i, s)));
}
