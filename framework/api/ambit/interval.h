/* interval.h -- ranges of doubles, and what a host asks of them. */
#ifndef AMBIT_INTERVAL_H
#define AMBIT_INTERVAL_H
#include <ambit/base.h>
#include <math.h>
#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ambit_interval {
  double lo, hi;
} ambit_interval;

#ifdef __cplusplus
#define AMBIT_RANGE(lo, hi) (ambit_interval { lo, hi })
#else
#define AMBIT_RANGE(lo, hi) ((ambit_interval) { lo, hi })
#endif
#define AMBIT_EMPTY AMBIT_RANGE(INFINITY, -INFINITY)
#define AMBIT_ENTIRE AMBIT_RANGE(-INFINITY, INFINITY)

static inline bool ambit_interval_is_empty(ambit_interval x) { return !(x.lo <= x.hi); }
static inline bool ambit_interval_is_point(ambit_interval x) { return x.lo == x.hi; }
static inline bool ambit_interval_is_bounded(ambit_interval x) { return x.lo > -INFINITY && x.hi < INFINITY; }
static inline bool ambit_interval_contains(ambit_interval x, double v) { return x.lo <= v && v <= x.hi; }

/* Any data made canonical: NaN, reversed or infinite-point bounds become empty. */
AMBIT_EXPORT ambit_interval ambit_interval_of(double lo, double hi);
AMBIT_EXPORT ambit_interval ambit_interval_hull(ambit_interval a, ambit_interval b);
AMBIT_EXPORT ambit_interval ambit_interval_intersect(ambit_interval a, ambit_interval b);
AMBIT_EXPORT double ambit_interval_mid(ambit_interval x); /* a finite double inside; 0 for entire; NaN only for empty */
AMBIT_EXPORT double ambit_interval_rad(ambit_interval x); /* up: x is within mid(x) +- rad(x) */
AMBIT_EXPORT double ambit_interval_width(ambit_interval x); /* up; 0 for empty */
AMBIT_EXPORT double ambit_interval_mag(ambit_interval x);   /* max |v|; 0 for empty */
AMBIT_EXPORT double ambit_interval_mig(ambit_interval x);   /* min |v| */

#ifdef __cplusplus
}
#endif
#endif
