/* value.h -- functions at doubles, from the kernel's enclosures: proofs rest on no mathematical library. */
#ifndef ZONOTOPE_VALUE_H
#define ZONOTOPE_VALUE_H
#include "zonotope.h"

/* The upper end of an enclosure of op(x, other), which is at most 3 units in the last place above; other: of ATAN2. */
static inline double value_of(const zono *z, uint32_t op, double x, double other) {
  const double a[2] = { x, x }, b[2] = { other, other };
  double r[2];
  z->num->map(op, 1, r, a, op == AMBIT_OP_ATAN2 ? b : NULL, 0);
  return r[1];
}

/* sqrt(x^2 + y^2) within 4 units in the last place, where the squares alone would underflow, too */
static inline double length_of(double x, double y) {
  double most = fmax(fabs(x), fabs(y)), ratio = fmin(fabs(x), fabs(y)) / most;
  return most > 0 ? most * sqrt(1 + ratio * ratio) : most;
}
#endif
