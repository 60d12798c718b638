/* pair.h -- one interval as (-lo, hi) in upward mode, for the factors of the rules.
**
** Every bound is computed by operations that round up, so -lo is at least minus the exact lower bound. The empty set
** is (-inf, -inf); only is_empty takes it.
*/
#ifndef GRADIENT_PAIR_H
#define GRADIENT_PAIR_H
#include <float.h>
#include <math.h>

typedef struct pair {
  double n, h; /* -lo, hi */
} pair;

static inline pair pair_of(double lo, double hi) { return (pair) { -lo, hi }; }
static inline pair pair_point(double x) { return (pair) { -x, x }; }
static inline double pair_lo(pair x) { return -x.n; }
static inline int pair_is_empty(pair x) { return x.h == -INFINITY; }
static inline int pair_is_bounded(pair x) { return x.n < INFINITY && x.h < INFINITY; }
static inline int pair_above(pair x) { return x.n < 0; } /* every number is > 0 */
static inline int pair_below(pair x) { return x.h < 0; }
static inline double pair_max(double a, double b) { return a > b ? a : b; }
static inline double pair_min(double a, double b) { return a < b ? a : b; }
static inline double pair_mag(pair x) { return pair_max(x.n, x.h); }
static inline double pair_mig(pair x) { return pair_max(0, pair_max(-x.n, -x.h)); }

static inline pair pair_neg(pair x) { return (pair) { x.h, x.n }; }
static inline pair pair_add(pair x, pair y) { return (pair) { x.n + y.n, x.h + y.h }; }
static inline pair pair_sub(pair x, pair y) { return (pair) { x.n + y.h, x.h + y.n }; }
static inline pair pair_half(pair x) { return (pair) { x.n / 2, x.h / 2 }; }
static inline pair pair_meet(pair x, pair y) { return (pair) { pair_min(x.n, y.n), pair_min(x.h, y.h) }; }
static inline pair pair_hull(pair x, pair y) { return (pair) { pair_max(x.n, y.n), pair_max(x.h, y.h) }; }

static inline double pair_times(double x, double y) { return x == 0 || y == 0 ? 0 : x * y; } /* 0 inf = 0 */

static inline pair pair_mul(pair x, pair y) {
  double n = pair_max(
      pair_max(pair_times(-x.n, y.n), pair_times(x.n, y.h)), pair_max(pair_times(x.h, y.n), pair_times(-x.h, y.h)));
  double h = pair_max(
      pair_max(pair_times(x.n, y.n), pair_times(-x.n, y.h)), pair_max(pair_times(-x.h, y.n), pair_times(x.h, y.h)));
  return (pair) { n, h };
}

/* 1 / y for y without 0 */
static inline pair pair_inverse(pair y) {
  /* lo = 1 / hi(y) rounded down = -((-1) / hi(y) rounded up) */
  return (pair) { -1 / y.h, -1 / y.n };
}

static inline pair pair_div(pair x, pair y) { return pair_mul(x, pair_inverse(y)); } /* y without 0 */

/* {x - y} for numbers */
static inline pair pair_difference(double x, double y) { return (pair) { y - x, x - y }; }
#endif
