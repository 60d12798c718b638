/* interval.h -- intervals [-low, high] and nonnegative bounds, in upward mode (ambit/rounding.h): every result of +
** and *
** is rounded up, so that low and high both stay bounds. */
#ifndef STIFF_INTERVAL_H
#define STIFF_INTERVAL_H
#include <ambit/double_double.h>
#include <ambit/rounding.h>
#include <stddef.h>
#include <stdint.h>

typedef struct iv {
  double low, high;
} iv;

/* a NaN on either side is kept: what claims nothing must not be forgotten */
static inline double larger(double a, double b) { return a > b || a != a ? a : b; }
static inline double smaller(double a, double b) { return a < b ? a : b; }
static inline iv iv_of(double x) { return (iv) { -x, x }; }
static inline iv iv_add(iv a, iv b) { return (iv) { a.low + b.low, a.high + b.high }; }
static inline iv iv_sub(iv a, iv b) { return (iv) { a.low + b.high, a.high + b.low }; }
static inline double iv_mag(iv a) { return larger(fabs(a.low), fabs(a.high)); }
static inline double iv_middle(iv a) { return 0.5 * (a.high - a.low); }
static inline iv iv_of_dd(dd x) { return (iv) { -x.hi - x.lo, x.hi + x.lo }; }

/* a x, x a number. (The analyser loses track of how many of n x n entries a loop has set, here and in other places
** that are marked.) */
static inline iv iv_scale(iv a, double x) {
  /* NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult) */
  return x >= 0 ? (iv) { a.low * x, a.high * x } : (iv) { a.high * -x, a.low * -x };
}

/* a + b x */
static inline iv iv_fma(iv a, iv b, double x) { return iv_add(a, iv_scale(b, x)); }

/* r += a x, entry by entry; r is none of a */
static inline void iv_add_scaled(size_t n, iv *restrict r, const iv *restrict a, double x) {
  if (x >= 0)
    for (size_t k = 0; k < n; k++) r[k].low += a[k].low * x, r[k].high += a[k].high * x;
  else
    for (size_t k = 0; k < n; k++) r[k].low += a[k].high * -x, r[k].high += a[k].low * -x;
}

/* a b, b >= 0 or b <= 0 */
static inline iv iv_times(iv a, iv b) {
  if (b.low > 0) { /* -low < 0: turn both */
    b = (iv) { b.high, b.low };
    a = (iv) { a.high, a.low };
  } /* now 0 <= -b.low <= b.high */
  double least = -b.low, most = b.high;
  return (iv) { a.low >= 0 ? a.low * most : a.low * least, a.high >= 0 ? a.high * most : a.high * least };
}
#endif
