/* dense.c -- Horner's scheme in intervals: coefficients are points but for their radii, which are summed apart. */
#include "model/dense.h"

ambit_interval ambit_dense_value(uint32_t n, const double *mid, const double *rad, ambit_interval s) {
  double far = ambit_interval_mag(s);
  ambit_interval size = { far, far }, value = { 0, 0 }, spread = { 0, 0 };
  for (uint32_t k = n; k-- > 0;) {
    value = ambit_interval_add(ambit_interval_mul(value, s), (ambit_interval) { mid[k], mid[k] });
    spread = ambit_interval_add(ambit_interval_mul(spread, size), (ambit_interval) { rad[k], rad[k] });
  }
  return ambit_interval_add(value, (ambit_interval) { -spread.hi, spread.hi });
}

ambit_interval ambit_dense_state(const ambit_record *r, uint32_t i, ambit_interval when) {
  ambit_interval x = AMBIT_ENTIRE;
  if (r->tube_lo && r->tube_hi) x = (ambit_interval) { r->tube_lo[i], r->tube_hi[i] };
  if (!r->ndense || !r->dense_mid || !r->dense_rad) return x;
  ambit_interval s = ambit_interval_sub(when, (ambit_interval) { r->t_from, r->t_from });
  size_t first = (size_t)i * r->ndense;
  return ambit_interval_intersect(x, ambit_dense_value(r->ndense, r->dense_mid + first, r->dense_rad + first, s));
}
