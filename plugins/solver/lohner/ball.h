/* ball.h -- numbers known as midpoint +- radius, in upward mode.
**
** Everything in this plugin below lohner_run() and lohner_open() runs in upward mode (ambit/rounding.h): an upper bound
** is what is computed, a lower bound is minus the upward-rounded negated value. A set [-low, high] becomes a ball by
** `ball_of`.
*/
#ifndef LOHNER_BALL_H
#define LOHNER_BALL_H
#include <ambit/rounding.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>

typedef struct ball {
  double mid, rad;
} ball;

static inline double larger(double a, double b) { return a > b ? a : b; }
/* a NaN on either side is kept: what claims nothing must not be forgotten */
static inline double larger_or_nan(double a, double b) { return a > b || a != a ? a : b; }
static inline double smaller(double a, double b) { return a < b ? a : b; }

/* an array of balls, kept as two: loops over one of them are vectors */
typedef struct balls {
  double *mid, *rad;
} balls;

static inline balls balls_at(balls b, size_t at) { return (balls) { b.mid + at, b.rad + at }; }

/* Any midpoint is valid as long as the radius reaches both ends from it. */
static inline ball ball_of(double low, double high) {
  double mid = 0.5 * (high - low);
  return (ball) { mid, larger(high - mid, mid + low) };
}

static inline ball ball_add(ball a, ball b) {
  ball r = ball_of(-a.mid - b.mid, a.mid + b.mid);
  return (ball) { r.mid, r.rad + a.rad + b.rad };
}

/* The time from the start of a step to a point in it or to its end: h +- error, |h| + error <= length. */
typedef struct span {
  double h, error, length;
} span;

/* v h + c */
static inline ball ball_horner(ball v, span t, ball c) {
  ball r = ball_of((-v.mid) * t.h - c.mid, v.mid * t.h + c.mid);
  return (ball) { r.mid, r.rad + (v.rad * t.length + fabs(v.mid) * t.error + c.rad) };
}

/* a + b = sum + error, |error| bounded as a ball: Knuth's idea with both roundings of every difference, so that no
** theorem about exactness in upward mode is needed */
static inline ball ball_two_sum(double a, double b, double *sum) {
  double big = fabs(a) >= fabs(b) ? a : b, small = fabs(a) >= fabs(b) ? b : a;
  *sum = big + small;
  double above = *sum - big, below = -(big - *sum); /* below <= sum - big <= above */
  return ball_of(above - small, small - below);
}
#endif
