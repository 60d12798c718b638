/* spectrum.c -- Gershgorin's discs of X^-1 A X.
**
** X: roughly the eigenvectors, Y: roughly its inverse, in doubles; E = Y X - I and B = Y A X in intervals. If ||E|| = d
** < 1/2 (maximum norm), X and Y are regular, and X^-1 A X = (Y X)^-1 Y A X = B + F B with ||F|| <= d / (1 - d): entry
** (i, j) of F B is at most d / (1 - d) max_k |B_kj|. The columns u, w of a pair (real and imaginary part) turn into u +
** iw, u - iw by T = [1 1; i -i]: the diagonal becomes (a + d)/2 +- i (b - c)/2 for the block [a b; c d], what is beside
** it gets small. Every eigenvalue of a matrix lies in the union of its row discs; a set of m discs that the others do
** not touch holds exactly m (Gershgorin 1931). Boxes around discs, for every matrix of the set, inherit both
** statements. A matrix is real: the one eigenvalue in a disc about the real axis that stands alone is real.
*/
#include "verbs/stability/spectrum.h"
#include "num/regular.h"
#include "num/interval.h"
#include <ambit/arithmetic.h>
#include <math.h>

typedef ambit_interval interval;

static interval point(double x) { return (interval) { x, x }; }
static interval half(interval x) { return ambit_interval_mul(point(0.5), x); }

/* upper bound of |x + iy| */
static double modulus(interval x, interval y) {
  double a = ambit_interval_mag(x), b = ambit_interval_mag(y);
  interval r = ambit_interval_add(ambit_interval_mul(point(a), point(a)), ambit_interval_mul(point(b), point(b)));
  ambit_interval_op(AMBIT_OP_SQRT, &r, r, r);
  return r.hi;
}

static double half_up(double x) { return half(point(x)).hi; }
static double sum_up(double a, double b) { return ambit_interval_add(point(a), point(b)).hi; }

/* r := a b, all n x n */
static void multiply(size_t n, interval *r, const interval *a, const interval *b) {
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++) {
      interval sum = { 0, 0 };
      for (size_t k = 0; k < n; k++) sum = ambit_interval_add(sum, ambit_interval_mul(a[i * n + k], b[k * n + j]));
      r[i * n + j] = sum;
    }
}

static interval *take(ambit_arena *arena, size_t entries) {
  return ambit_arena_alloc(arena, (entries + 1) * sizeof(interval));
}

/* -- X^-1 A X */

/* d / (1 - d) for d = ||Y X - I||; infinite if d is not below 1/2 */
static double bound_correction(size_t n, const interval *product) {
  double d = 0;
  for (size_t i = 0; i < n; i++) {
    double row = 0;
    for (size_t j = 0; j < n; j++)
      row = sum_up(row, ambit_interval_mag(ambit_interval_sub(product[i * n + j], point(i == j))));
    d = fmax(d, row);
  }
  return d < 0.5 ? ambit_interval_div(point(d), ambit_interval_sub(point(1), point(d))).hi : INFINITY;
}

/* b := X^-1 A X; false: X is too nearly singular */
static bool transform(size_t n, const interval *a, const double *vector, interval *b, ambit_arena *arena) {
  interval *x = take(arena, n * n), *y = take(arena, n * n), *work = take(arena, n * n);
  double *inverse = ambit_arena_alloc(arena, 2 * (n * n + 1) * sizeof *inverse);
  if (!x || !y || !work || !inverse) return false;
  for (size_t i = 0; i < n * n; i++) {
    if (!isfinite(vector[i]) || !ambit_interval_is_bounded(a[i])) return false;
    x[i] = point(vector[i]);
  }
  if (!ambit_invert_middle(n, x, inverse)) return false;
  for (size_t i = 0; i < n * n; i++) {
    if (!isfinite(inverse[i])) return false;
    y[i] = point(inverse[i]);
  }
  multiply(n, work, y, x);
  double correction = bound_correction(n, work);
  if (!(correction < INFINITY)) return false;
  multiply(n, work, a, x);
  multiply(n, b, y, work);
  for (size_t j = 0; j < n; j++) {
    double largest = 0;
    for (size_t k = 0; k < n; k++) largest = fmax(largest, ambit_interval_mag(b[k * n + j]));
    double off = ambit_interval_mul(point(correction), point(largest)).hi;
    for (size_t k = 0; k < n; k++) b[k * n + j] = ambit_interval_add(b[k * n + j], (interval) { -off, off });
  }
  return true;
}

/* -- discs */

typedef struct discs {
  size_t n;
  const interval *b;
  const bool *is_first;
} discs;

static interval entry(const discs *d, size_t i, size_t j) { return d->b[i * d->n + j]; }

/* sum of |entries| of the transformed row of i in the columns of block j (one or two); i is real */
static double beside_real(const discs *d, size_t i, size_t j) {
  if (!d->is_first[j]) return ambit_interval_mag(entry(d, i, j));
  return 2 * modulus(entry(d, i, j), entry(d, i, j + 1));
}

/* the same for i the first of a pair */
static double beside_pair(const discs *d, size_t i, size_t j) {
  interval p = entry(d, i, j), r = entry(d, i + 1, j);
  if (!d->is_first[j]) return half_up(modulus(p, r));
  interval q = entry(d, i, j + 1), s = entry(d, i + 1, j + 1);
  double other = half_up(modulus(ambit_interval_sub(p, s), ambit_interval_add(q, r)));
  if (i == j) return other; /* the first is the diagonal */
  return sum_up(other, half_up(modulus(ambit_interval_add(p, s), ambit_interval_sub(q, r))));
}

static void set_disc(const discs *d, size_t i, ambit_eigenvalue *value) {
  bool pair = d->is_first[i];
  double radius = 0;
  for (size_t j = 0; j < d->n; j += d->is_first[j] ? 2 : 1)
    if (pair || j != i) radius = sum_up(radius, pair ? beside_pair(d, i, j) : beside_real(d, i, j));
  interval around = { -radius, radius }, re = entry(d, i, i), im = { 0, 0 };
  if (pair) {
    re = half(ambit_interval_add(re, entry(d, i + 1, i + 1)));
    im = half(ambit_interval_sub(entry(d, i, i + 1), entry(d, i + 1, i)));
  }
  value[i].re = ambit_interval_add(re, around);
  value[i].im = ambit_interval_add(im, around);
  if (!pair) return;
  value[i + 1].re = value[i].re;
  value[i + 1].im = (interval) { -value[i].im.hi, -value[i].im.lo };
}

static bool touch(const ambit_eigenvalue *a, const ambit_eigenvalue *b) {
  return a->re.lo <= b->re.hi && b->re.lo <= a->re.hi && a->im.lo <= b->im.hi && b->im.lo <= a->im.hi;
}

/* boxes that touch become one: until none do */
static void join(size_t n, ambit_eigenvalue *value) {
  for (size_t i = 0; i < n; i++) value[i].group = (uint32_t)i;
  bool again = true;
  while (again) {
    again = false;
    for (size_t i = 0; i < n; i++)
      for (size_t j = 0; j < i; j++) {
        ambit_eigenvalue *x = &value[i], *y = &value[j];
        if (x->group == y->group || !touch(x, y)) continue;
        interval re = ambit_interval_hull(x->re, y->re), im = ambit_interval_hull(x->im, y->im);
        uint32_t from = x->group, to = y->group;
        for (size_t k = 0; k < n; k++)
          if (value[k].group == from || value[k].group == to) value[k].group = to, value[k].re = re, value[k].im = im;
        again = true;
      }
  }
}

static void count(size_t n, ambit_eigenvalue *value) {
  for (size_t i = 0; i < n; i++) {
    value[i].count = 0;
    for (size_t j = 0; j < n; j++) value[i].count += value[j].group == value[i].group;
  }
}

bool ambit_spectrum_enclose(size_t n, const ambit_interval *a, const double *vector, const bool *is_first,
    ambit_eigenvalue *value, double *spread, ambit_arena *arena) {
  interval *b = take(arena, n * n);
  if (!b || !transform(n, a, vector, b, arena)) return false;
  const discs d = { n, b, is_first };
  for (size_t i = 0; i < n; i += is_first[i] ? 2 : 1) set_disc(&d, i, value);
  join(n, value);
  count(n, value);
  *spread = 0;
  for (size_t i = 0; i < n; i++) {
    if (!ambit_interval_is_bounded(value[i].re) || !ambit_interval_is_bounded(value[i].im)) return false;
    if (value[i].count == 1 && !is_first[i] && ambit_interval_contains(value[i].im, 0)) value[i].im = point(0);
    *spread += ambit_interval_width(value[i].re) + ambit_interval_width(value[i].im);
  }
  return true;
}
