/* solver_kit_values.c -- polynomials of records, evaluated with intervals. */
#include "kit/solver_kit_values.h"
#include "num/interval.h"
#include <math.h>

static ambit_interval point(double x) { return (ambit_interval) { x, x }; }

static ambit_interval around(double mid, double rad) {
  return ambit_interval_add(point(mid), (ambit_interval) { -rad, rad });
}

ambit_interval kit_dense_value(const ambit_record *r, uint32_t i, ambit_interval s) {
  const double *mid = r->dense_mid + (size_t)i * r->ndense, *rad = r->dense_rad + (size_t)i * r->ndense;
  ambit_interval x = point(0);
  for (uint32_t k = r->ndense; k-- > 0;) x = ambit_interval_add(ambit_interval_mul(x, s), around(mid[k], rad[k]));
  for (uint32_t c = 0; c < r->ncolumn; c++) {
    const double *column = r->dense_column + ((size_t)i * r->ncolumn + c) * r->ncoef_column;
    ambit_interval y = point(0);
    for (uint32_t k = r->ncoef_column; k-- > 0;) y = ambit_interval_add(ambit_interval_mul(y, s), point(column[k]));
    x = ambit_interval_add(x, around(0, ambit_interval_mag(y)));
  }
  return x;
}

ambit_interval kit_set_value(const ambit_set *set, uint32_t i, const double *u) {
  ambit_interval x = around(0, set->rest[i]);
  for (uint32_t k = 0; k < set->nterm; k++) {
    ambit_interval term = point(set->coefficient[(size_t)i * set->nterm + k]);
    for (uint32_t j = 0; j < set->nu; j++) {
      ambit_interval v =
          ambit_interval_div(ambit_interval_sub(point(u[j]), point(set->about[j])), point(set->scale[j]));
      ambit_interval power;
      ambit_interval_pown(&power, v, (int32_t)set->exponent[(size_t)k * set->nu + j]);
      term = ambit_interval_mul(term, power);
    }
    x = ambit_interval_add(x, term);
  }
  return x;
}

const char *kit_dense_fault(const ambit_record *r) {
  if (!r->dense_mid || !r->dense_rad) return r->ndense || r->dense_mid || r->dense_rad ? "half of it is missing" : NULL;
  if (r->ndense == 0) return "it has no coefficients";
  for (size_t k = 0; k < (size_t)r->nx * r->ndense; k++)
    if (!isfinite(r->dense_mid[k]) || !(r->dense_rad[k] >= 0 && r->dense_rad[k] < INFINITY))
      return "a coefficient is not finite, or a radius negative";
  if (r->ncolumn && (!r->dense_column || r->ncoef_column > r->ndense)) return "its columns are missing or too long";
  for (size_t k = 0; k < (size_t)r->nx * r->ncolumn * r->ncoef_column; k++)
    if (!isfinite(r->dense_column[k])) return "a coefficient of a column is not finite";
  return NULL;
}

const char *kit_set_fault(const ambit_record *r, uint32_t nu) {
  const ambit_set *set = r->set;
  if (!set) return NULL;
  if (set->size < sizeof *set || set->nu != nu) return "it is of the wrong size or of other unknowns";
  if (set->nterm && (!set->coefficient || (nu && !set->exponent))) return "its terms are missing";
  for (uint32_t j = 0; j < nu; j++)
    if (!isfinite(set->about[j]) || !(set->scale[j] > 0 && set->scale[j] < INFINITY)) return "an unknown has no scale";
  for (size_t k = 0; k < (size_t)r->nx * set->nterm; k++)
    if (!isfinite(set->coefficient[k])) return "a coefficient is not finite";
  for (uint32_t i = 0; i < r->nx; i++)
    if (!(set->rest[i] >= 0 && set->rest[i] < INFINITY)) return "a rest is negative or not finite";
  return NULL;
}
