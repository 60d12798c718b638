/* interval.h -- intervals in upward mode: an upper bound is what is computed, a lower one minus the upward-rounded
** negated value (ambit/rounding.h). Everything below valencia_open() and valencia_run() runs in that mode.
**
** NaN never means "proved": comparisons that decide are written so that a NaN fails them.
*/
#ifndef VALENCIA_INTERVAL_H
#define VALENCIA_INTERVAL_H
#include <ambit/rounding.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>

typedef struct interval {
  double lo, hi;
} interval;

static inline double larger(double a, double b) { return a > b ? a : b; }
static inline double smaller(double a, double b) { return a < b ? a : b; }
/* a NaN on either side is kept */
static inline double larger_or_nan(double a, double b) { return a > b || a != a ? a : b; }
static inline double smaller_or_nan(double a, double b) { return a < b || a != a ? a : b; }

static inline interval point(double x) { return (interval) { x, x }; }
static inline interval within(double r) { return (interval) { -r, r }; }
static inline interval plus(interval a, interval b) { return (interval) { -(-a.lo - b.lo), a.hi + b.hi }; }
static inline interval minus(interval a, interval b) { return (interval) { -(b.hi - a.lo), a.hi - b.lo }; }
static inline interval hull_of(interval a, interval b) {
  return (interval) { smaller_or_nan(a.lo, b.lo), larger_or_nan(a.hi, b.hi) };
}
static inline interval meet(interval a, interval b) { return (interval) { larger(a.lo, b.lo), smaller(a.hi, b.hi) }; }

static inline interval scaled(interval a, double b) {
  return b >= 0 ? (interval) { -(-a.lo * b), a.hi * b } : (interval) { -(a.hi * -b), a.lo * b };
}

static inline interval times(interval a, interval b) {
  double low = larger_or_nan(larger_or_nan(-a.lo * b.lo, -a.lo * b.hi), larger_or_nan(-a.hi * b.lo, -a.hi * b.hi));
  double high = larger_or_nan(larger_or_nan(a.lo * b.lo, a.lo * b.hi), larger_or_nan(a.hi * b.lo, a.hi * b.hi));
  return (interval) { -low, high };
}

static inline double magnitude(interval a) { return larger_or_nan(-a.lo, a.hi); }
static inline double width(interval a) { return a.hi - a.lo; }
/* some number inside, for approximations */
static inline double middle(interval a) { return 0.5 * a.lo + 0.5 * a.hi; }
/* the radius of an interval about mid that holds x */
static inline double radius_about(interval x, double mid) { return larger_or_nan(x.hi - mid, mid - x.lo); }
static inline int is_bounded(interval a) { return a.lo > -INFINITY && a.hi < INFINITY && a.lo <= a.hi; }
#endif
