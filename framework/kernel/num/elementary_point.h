/* elementary_point.h -- enclosures of elementary functions at a point.
**
** From h + l with |h + l - f| <= err: f < succ(h) always, and f <= h if l + err <= 0; likewise below. The step is
** taken on integer bits, so that no rounding enters but that of err = E |h|, for which the proof leaves room. Not the
** tightest doubles only if |l| < err.
**
** Tiny arguments, |x| < 2^-27, of a function f(x) = x + O(x^3): |f(x) - x| <= x^3/2 is less than the distance from x
** to its neighbour, which is at least 2^-53 |x|; so the pair is replaced by (x, -+x) with err = 0, which steps on
** the proper side.
*/
#ifndef AMBIT_ELEMENTARY_POINT_H
#define AMBIT_ELEMENTARY_POINT_H
#include "num/elementary_composed.h"

typedef struct enclosure {
  lanes lo, hi;
  bits declined; /* mask: this lane proves nothing */
} enclosure;

INLINE lanes step_up(pair y, lanes err) { return choose(less(-err, y.l), next_above(y.h), y.h); }
INLINE lanes step_down(pair y, lanes err) { return choose(less(y.l, err), next_below(y.h), y.h); }
INLINE enclosure widen(pair y, lanes err) { return (enclosure) { step_down(y, err), step_up(y, err), all_bits(0) }; }
/* the relative error is `small` up to this size of the result, else `error` */
INLINE lanes error_below(lanes h, double size, double small, double error) {
  return magnitude(h) * choose(less_equal(magnitude(h), all(size)), all(small), all(error));
}
/* odd functions: outward is +1 if |f(x)| > |x| near 0 and -1 if less */
INLINE enclosure widen_odd(lanes x, pair y, lanes err, double outward) {
  bits tiny = less(magnitude(x), all(0x1p-27));
  pair near_zero = { x, x * outward };
  y = pair_choose(tiny, near_zero, y);
  return widen(y, choose(tiny, all(0), err));
}
INLINE enclosure rescale(enclosure e, bits k) {
  bits up = shift_left(k, 52);
  return (enclosure) { to_lanes(to_bits(e.lo) + up), to_lanes(to_bits(e.hi) + up), e.declined };
}
INLINE bits outside(lanes x, double lo, double hi) { return ~(less_equal(all(lo), x) & less_equal(x, all(hi))); }

/* e^x is exact at 0 only, where the kernel gives (1, 0); near 0 the pair is 1 + x up to x^2, which steps on the
** proper side */
INLINE enclosure exp_at(lanes x) {
  bits k;
  pair y = exp_kernel(x, &k);
  lanes err = choose(less(magnitude(x), all(0x1p-60)), all(0), y.h * AMBIT_ERROR_EXP);
  enclosure e = rescale(widen(y, err), k);
  e.declined = outside(x, -708, 0x1.62e42fefa39efp9);
  return e;
}
INLINE enclosure log_at(lanes x) {
  pair y = log_kernel(x);
  enclosure e = widen(y, magnitude(y.h) * AMBIT_ERROR_LOG);
  e.declined = outside(x, 0x1p-1074, 0x1.fffffffffffffp1023);
  return e;
}
INLINE enclosure unit(enclosure e) { return (enclosure) { larger(e.lo, all(-1)), smaller(e.hi, all(1)), e.declined }; }
/* The relative error is largest in the rows of the table next to a zero or a pole: two bounds keep more results
** tightest. */
INLINE lanes sin_error(lanes h) { return error_below(h, AMBIT_SIN_LEAST, AMBIT_ERROR_SIN, AMBIT_ERROR_SIN_FAR); }
INLINE lanes tan_error(lanes h) {
  lanes size = magnitude(h);
  bits near = less(size, all(AMBIT_TAN_LEAST)) | less(all(AMBIT_TAN_MOST), size);
  return size * choose(near, all(AMBIT_ERROR_TAN), all(AMBIT_ERROR_TAN_FAR));
}
INLINE enclosure sin_of(lanes x, angle a) {
  pair y = sin_kernel(a, 0);
  enclosure e = unit(widen_odd(x, y, sin_error(y.h), -1));
  e.declined = a.declined;
  return e;
}
INLINE enclosure cos_of(lanes x, angle a) {
  pair y = sin_kernel(a, 64);
  lanes err = choose(less_equal(magnitude(x), all(0)), all(0), sin_error(y.h)); /* cos 0 = 1 exactly */
  enclosure e = unit(widen(y, err));
  e.declined = a.declined;
  return e;
}
INLINE enclosure tan_of(lanes x, angle a) {
  pair y = tan_kernel(a);
  enclosure e = widen_odd(x, y, tan_error(y.h), 1);
  e.declined = a.declined;
  return e;
}
INLINE enclosure asin_at(lanes x) {
  pair y = asin_kernel(x);
  enclosure e = widen_odd(x, y, magnitude(y.h) * AMBIT_ERROR_ASIN, 1);
  e.declined = outside(x, -1, 1);
  return e;
}
INLINE enclosure acos_at(lanes x) {
  pair y = acos_kernel(x);
  enclosure e = widen(y, magnitude(y.h) * AMBIT_ERROR_ACOS);
  e.declined = outside(x, -1, 1);
  return e;
}
/* infinite x too: past 2^100 the angle changes by less than 2^-100 */
INLINE enclosure atan_at(lanes x) {
  bits tiny = less(magnitude(x), all(0x1p-27));
  pair u = { choose(tiny, all(1), smaller(magnitude(x), all(0x1p100))), all(0) }, one = { all(1), all(0) };
  pair y = pair_flip(atan_kernel(u, one), sign_bit(x));
  return widen_odd(x, y, magnitude(y.h) * AMBIT_ERROR_ATAN, -1);
}
INLINE bits kernel_range(lanes x) {
  return ~(less_equal(all(0x1p-400), magnitude(x)) & less_equal(magnitude(x), all(0x1p400)));
}
INLINE enclosure atan2_at(lanes y, lanes x) {
  pair r = atan2_kernel(y, x);
  enclosure e = widen(r, error_below(r.h, AMBIT_ATAN_SMALL, AMBIT_ERROR_ATAN_NEAR, AMBIT_ERROR_ATAN));
  e.declined = kernel_range(y) | kernel_range(x);
  return e;
}
INLINE enclosure sinh_at(lanes x) {
  bits k, tiny = less(magnitude(x), all(0x1p-27));
  pair y = sinh_kernel(x, &k);
  enclosure e = rescale(widen_odd(x, y, magnitude(y.h) * AMBIT_ERROR_SINH, 1), k & ~tiny);
  e.declined = outside(x, -709, 709);
  return e;
}
INLINE enclosure cosh_at(lanes x) {
  bits k;
  pair y = cosh_kernel(x, &k);
  lanes err = choose(less_equal(magnitude(x), all(0)), all(0), y.h * AMBIT_ERROR_COSH); /* cosh 0 = 1 exactly */
  enclosure e = rescale(widen(y, err), k);
  e.lo = larger(e.lo, all(1));
  e.declined = outside(x, -709, 709);
  return e;
}
INLINE enclosure tanh_at(lanes x) {
  pair y = tanh_kernel(x);
  return unit(widen_odd(x, y, magnitude(y.h) * AMBIT_ERROR_TANH, -1));
}

#if AMBIT_LANES == 1
/* bounds of v 2^k for the positive normal doubles lo <= v <= hi; |k| < 2000 */
INLINE enclosure scale(double lo, double hi, int64_t k) {
  const double most = 0x1.fffffffffffffp1023, tiniest = 0x1p-1074, infinity = __builtin_inf();
  int64_t half = k / 2;
  double first = power_of_two((bits)half), second = power_of_two((bits)(k - half));
  double down = lo * first * second, up = hi * first * second; /* the first product is exact */
  if (down == infinity)
    down = most;
  else if (down > 0 && down / second / first > lo)
    down = next_below(down);
  if (up == 0)
    up = tiniest;
  else if (up < infinity && up / second / first < hi)
    up = next_above(up);
  return (enclosure) { down, up, 0 };
}
#endif
#endif
