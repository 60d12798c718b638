/* solve.c -- the approximate inverse's solution and its distance from the true ones. */
#include "verbs/roots/solve.h"
#include "num/regular.h"
#include "num/interval.h"
#include <math.h>

typedef ambit_interval interval;

static interval point(double x) { return (interval) { x, x }; }

#define SWEEPS 20
#define WORTH 0.99

/* entry (i, j) of 1 - C A */
static interval residual(size_t n, const double *c, const interval *a, size_t i, size_t j) {
  interval x = point(i == j);
  for (size_t k = 0; k < n; k++) x = ambit_interval_sub(x, ambit_interval_mul(point(c[i * n + k]), a[k * n + j]));
  return x;
}

static interval product(size_t n, const double *c, const interval *b, size_t i) {
  interval x = point(0);
  for (size_t k = 0; k < n; k++) x = ambit_interval_add(x, ambit_interval_mul(point(c[i * n + k]), b[k]));
  return x;
}

/* x := x and C b + (1 - C A) x; did that pay? */
static bool narrow(size_t n, const double *c, const interval *a, const interval *b, interval *x) {
  bool paid = false;
  for (size_t i = 0; i < n; i++) {
    interval row = product(n, c, b, i);
    for (size_t j = 0; j < n; j++) row = ambit_interval_add(row, ambit_interval_mul(residual(n, c, a, i, j), x[j]));
    row = ambit_interval_intersect(row, x[i]);
    paid = paid || ambit_interval_width(row) < WORTH * ambit_interval_width(x[i]);
    x[i] = row;
  }
  return paid;
}

bool ambit_solve_enclose(
    size_t n, const ambit_interval *a, const ambit_interval *b, ambit_interval *x, double *scratch) {
  for (size_t i = 0; i < n * n; i++)
    if (ambit_interval_is_empty(a[i]) || !ambit_interval_is_bounded(a[i])) return false;
  if (!ambit_invert_middle(n, a, scratch)) return false;
  double d = ambit_distance_from_one(n, a, scratch), most = 0;
  if (!(d < 1)) return false;
  for (size_t i = 0; i < n; i++) {
    x[i] = product(n, scratch, b, i);
    if (ambit_interval_is_empty(x[i]) || !ambit_interval_is_bounded(x[i])) return false;
    most = fmax(most, ambit_interval_mag(x[i]));
  }
  interval ratio = ambit_interval_div(point(d), ambit_interval_sub(point(1), point(d)));
  double off = ambit_interval_mul(ratio, point(most)).hi;
  for (size_t i = 0; i < n; i++) x[i] = ambit_interval_add(x[i], (interval) { -off, off });
  if (!(off < INFINITY)) return false;
  for (int s = 0; s < SWEEPS; s++)
    if (!narrow(n, scratch, a, b, x)) break;
  return true;
}
