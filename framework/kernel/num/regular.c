/* regular.c -- Neumann's test with the midpoint's inverse, and determinants by expansion. */
#include "num/regular.h"
#include "num/interval.h"
#include <ambit/matrix.h>
#include <math.h>
#include <stdint.h>

bool ambit_invert_middle(size_t n, const ambit_interval *b, double *c) {
  double *a = c + n * n;
  for (size_t i = 0; i < n * n; i++) a[i] = ambit_interval_mid(b[i]);
  return ambit_matrix_invert(n, a, c);
}

static ambit_interval point(double x) { return (ambit_interval) { x, x }; }

double ambit_distance_from_one(size_t n, const ambit_interval *b, const double *c) {
  double norm = 0;
  for (size_t i = 0; i < n; i++) {
    ambit_interval sum = { 0, 0 };
    for (size_t j = 0; j < n; j++) {
      ambit_interval x = point(i == j);
      for (size_t k = 0; k < n; k++) {
        if (!(fabs(c[i * n + k]) < INFINITY) || ambit_interval_is_empty(b[k * n + j])) return INFINITY;
        x = ambit_interval_sub(x, ambit_interval_mul(point(c[i * n + k]), b[k * n + j]));
      }
      sum = ambit_interval_add(sum, point(ambit_interval_mag(x)));
    }
    norm = fmax(norm, sum.hi);
  }
  return norm;
}

bool ambit_is_regular(size_t n, const ambit_interval *b, double *scratch) {
  return ambit_invert_middle(n, b, scratch) && ambit_distance_from_one(n, b, scratch) < 1;
}

/* of the rows k.. over the columns in the set */
static ambit_interval determinant(size_t n, const ambit_interval *b, size_t k, uint32_t columns) {
  if (k == n) return point(1);
  ambit_interval sum = { 0, 0 };
  bool odd = false;
  for (size_t j = 0; j < n; j++) {
    if (!(columns >> j & 1)) continue;
    ambit_interval e = b[k * n + j];
    if (e.lo != 0 || e.hi != 0) {
      ambit_interval x = ambit_interval_mul(e, determinant(n, b, k + 1, columns & ~(1u << j)));
      sum = odd ? ambit_interval_sub(sum, x) : ambit_interval_add(sum, x);
    }
    odd = !odd;
  }
  return sum;
}

bool ambit_is_singular(size_t n, const ambit_interval *b) {
  if (n > AMBIT_SINGULAR_MAX) return false;
  ambit_interval d = determinant(n, b, 0, (1u << n) - 1);
  return d.lo == 0 && d.hi == 0;
}
