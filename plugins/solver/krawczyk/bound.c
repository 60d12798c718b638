/* bound.c -- is every matrix of [A] regular, how large can solutions of A x = -b be, and rows of it. (upward mode)
**
** <A> is Ostrowski's comparison matrix: the least |A_ii| on the diagonal, minus the largest |A_ij| beside it. If u > 0
** and v <= <A> u with v > 0, every A in [A] is an H-matrix, thus regular, and |A^-1 b| <= u max_i |b_i| / v_i (Neumaier
** 1990, 3.6 and 3.7). u comes from a few steps of Jacobi's iteration for <A> u = e, which converges if there is any.
*/
#include "krawczyk.h"
#include <ambit/rounding.h>
#include <math.h>

#define STEPS 40
#define FIRST 2 /* steps before the first test: a better scale bounds solutions more tightly */

static double larger(double a, double b) { return a > b ? a : b; }

static double magnitude(double lo, double hi) { return larger(-lo, hi); }

/* the least |a| in [lo, hi]; 0 if 0 is in it */
static double mignitude(span a) { return a.lo > 0 ? a.lo : a.hi < 0 ? -a.hi : 0; }

/* sum beside the diagonal of |A_ij| u_j, from above */
static double beside(const krawczyk *k, uint32_t i) {
  double sum = 0;
  const double *lo = k->off.lo + (size_t)i * k->n, *hi = k->off.hi + (size_t)i * k->n;
  for (uint32_t j = 0; j < k->n; j++) sum += magnitude(lo[j], hi[j]) * k->scale[j];
  return sum;
}

/* margin <= <A> scale; 1: it is positive */
static int check_margin(const krawczyk *k) {
  for (uint32_t i = 0; i < k->n; i++) {
    double above = beside(k, i) + -(mignitude(k->diagonal[i])) * k->scale[i];
    k->margin[i] = -above;
    if (!(k->margin[i] > 0 && k->scale[i] > 0 && k->scale[i] < INFINITY)) return 0;
  }
  return 1;
}

static int improve_scale(const krawczyk *k) {
  for (uint32_t i = 0; i < k->n; i++) {
    double d = mignitude(k->diagonal[i]);
    k->best[i] = d > 0 ? (1 + beside(k, i)) / d : INFINITY;
  }
  for (uint32_t i = 0; i < k->n; i++) {
    if (!(k->best[i] < 1e100)) return 0;
    k->scale[i] = k->best[i];
  }
  return 1;
}

static AMBIT_WORKER int is_regular(const krawczyk *k) {
  for (uint32_t i = 0; i < k->n; i++) k->scale[i] = 1;
  for (uint32_t step = 0; step < STEPS; step++) {
    if (!improve_scale(k)) return 0;
    if (step >= FIRST && check_margin(k)) return 1;
  }
  return 0;
}

int krawczyk_is_regular(const krawczyk *k) {
  ambit_rounding old = ambit_round_up();
  int regular = is_regular(k);
  ambit_rounding_restore(old);
  return regular;
}

static AMBIT_WORKER void bound_solution(const krawczyk *k, span *z) {
  double most = 0;
  for (uint32_t i = 0; i < k->n; i++) most = larger(most, magnitude(k->b[i].lo, k->b[i].hi) / k->margin[i]);
  for (uint32_t i = 0; i < k->n; i++) {
    double r = k->scale[i] * most;
    z[i] = (span) { -r, r };
  }
}

void krawczyk_bound_solution(const krawczyk *k, span *z) {
  ambit_rounding old = ambit_round_up();
  bound_solution(k, z);
  ambit_rounding_restore(old);
}

/* the product's upper end, and its lower end negated */
static span product(double alo, double ahi, span z) {
  double up = larger(larger(alo * z.lo, alo * z.hi), larger(ahi * z.lo, ahi * z.hi));
  double down = larger(larger(-alo * z.lo, -alo * z.hi), larger(-ahi * z.lo, -ahi * z.hi));
  return (span) { down, up };
}

static AMBIT_WORKER span sum_row(const krawczyk *k, uint32_t i, const span *z) {
  const double *lo = k->off.lo + (size_t)i * k->n, *hi = k->off.hi + (size_t)i * k->n;
  span sum = { -k->b[i].lo, k->b[i].hi }; /* lower end negated */
  for (uint32_t j = 0; j < k->n; j++) {
    span part = product(lo[j], hi[j], z[j]); /* off is 0 at j == i */
    sum.lo += part.lo;
    sum.hi += part.hi;
  }
  return (span) { -sum.lo, sum.hi };
}

span krawczyk_row(const krawczyk *k, uint32_t i, const span *z) {
  ambit_rounding old = ambit_round_up();
  span row = sum_row(k, i, z);
  ambit_rounding_restore(old);
  return row;
}
