/* power_map.h -- integer powers over arrays of intervals, for one width and instruction set.
**
** |x| = m 2^e, m in [1, 2): m^|n| from power_kernel.h; for n < 0 the quotient 1/(h + l), which adds less than
** 2 AMBIT_ERROR_POWER. A lane is declined if this does not decide between two doubles, or if x or the result is not a
** normal double: ambit_power_rare takes it.
**
** A file sets AMBIT_LANES, AMBIT_POWER (the function to define) and, above two lanes, AMBIT_POWER_REMAINDER.
*/
#ifndef AMBIT_POWER_MAP_H
#define AMBIT_POWER_MAP_H
#include "num/elementary_point.h"
#include "num/power_kernel.h"
#include "num/power_variant.h"
#include "num/rounding.h"
#include <math.h>

/* k n for |k| < 2^20 */
INLINE bits multiply_small(bits k, double n) {
  lanes number = to_lanes(k + to_bits(all(INTEGER_SHIFT))) - all(INTEGER_SHIFT);
  bits product;
  (void)nearest_integer(number * n, &product);
  return product;
}

INLINE lanes mantissa(lanes x) { /* in [1, 2) */
  return to_lanes((to_bits(x) & all_bits(0x000fffffffffffff)) | all_bits(0x3ff0000000000000));
}

/* x^n from a = mantissa(x)^|n| */
INLINE enclosure power_widen(lanes x, power a, exponent n) {
  bits u = to_bits(x) & all_bits(INT64_MAX), e = shift_right(u, 52);
  bits inexact = shift_left(a.inexact, 1), k = a.k;
  if (n.n < 0) {
    a.y = pair_divide((pair) { all(1), all(0) }, a.y);
    inexact = shift_left(u, 12); /* only powers of two have an inverse */
    k = -k;
  }
  bits exact = bits_equal(inexact, all_bits(0));
  lanes err = choose(exact, all(0), a.y.h * n.error);
  bits undecided = ~exact & less_equal(magnitude(a.y.l), err);
  k = k + multiply_small(e - all_bits(1023), (double)n.n);
  bits scaled = shift_right(to_bits(a.y.h), 52) + k; /* the biased exponent of the result */
  bits unusual = bits_less(scaled, all_bits(2)) | bits_less(all_bits(2045), scaled) | bits_equal(e, all_bits(0)) |
                 bits_equal(e, all_bits(2047));
  enclosure r = rescale((enclosure) { step_down(a.y, err), step_up(a.y, err), undecided | unusual }, k);
  if (n.n > 0) {
    bits zero = bits_equal(u, all_bits(0));
    r = (enclosure) { choose(zero, all(0), r.lo), choose(zero, all(0), r.hi), r.declined & ~zero };
  }
  if (n.n % 2 == 0) return r;
  bits sign = sign_bit(x), negative = less(x, all(0));
  return (enclosure) { flip(choose(negative, r.hi, r.lo), sign), flip(choose(negative, r.lo, r.hi), sign), r.declined };
}

/* Where the power is least and greatest; outside: 0 is in the interval and n < 0. */
typedef struct power_ends {
  lanes least, most;
  bits outside;
} power_ends;
INLINE power_ends power_points(lanes lo, lanes hi, exponent n) {
  lanes least = lo, most = hi;
  bits across = less_equal(lo, all(0)) & less_equal(all(0), hi);
  if (n.n % 2 == 0) {
    least = choose(across, all(0), smaller(magnitude(lo), magnitude(hi)));
    most = larger(magnitude(lo), magnitude(hi));
  }
  if (n.n > 0) return (power_ends) { least, most, all_bits(0) };
  return (power_ends) { most, least, across };
}

static AMBIT_WORKER void power_rescue(
    int32_t n, bits declined, const double *alo, const double *ahi, double *rlo, double *rhi) {
  uint64_t mask[AMBIT_LANES];
  memcpy(mask, &declined, sizeof mask);
  for (int i = 0; i < AMBIT_LANES; i++)
    if (mask[i]) ambit_power_rare(n, alo[i], ahi[i], rlo + i, rhi + i);
}

INLINE void power_group(exponent n, const double *alo, const double *ahi, double *rlo, double *rhi) {
  lanes lo = load(alo), hi = load(ahi);
  power_ends p = power_points(lo, hi, n);
  enclosure first, last;
  if (any(~bits_equal(to_bits(p.least), to_bits(p.most)))) {
    power a[2];
    const lanes m[2] = { mantissa(p.least), mantissa(p.most) };
    power_kernel(a, m, 2, n);
    first = power_widen(p.least, a[0], n), last = power_widen(p.most, a[1], n);
  } else {
    power a;
    const lanes m = mantissa(p.least);
    power_kernel(&a, &m, 1, n);
    first = last = power_widen(p.least, a, n);
  }
  bits real = less_equal(lo, hi) & less(lo, all(INFINITY)) & less(all(-INFINITY), hi);
  bits declined = first.declined | last.declined | p.outside | ~real;
  store(rlo, first.lo), store(rhi, last.hi);
  if (__builtin_expect(any(declined), 0)) {
    double bound[2][AMBIT_LANES]; /* r may be a */
    store(bound[0], lo), store(bound[1], hi);
    power_rescue(n.n, declined, bound[0], bound[1], rlo, rhi);
  }
}

#if AMBIT_LANES == 2
INLINE void power_one(exponent n, double alo, double ahi, double *rlo, double *rhi) {
  power_ends p = power_points(all(alo), all(ahi), n);
  lanes x = { p.least[0], p.most[0] }, m = mantissa(x);
  power a;
  power_kernel(&a, &m, 1, n);
  enclosure e = power_widen(x, a, n);
  *rlo = e.lo[0], *rhi = e.hi[1];
  if (any(e.declined | p.outside) || !(alo <= ahi && alo < INFINITY && ahi > -INFINITY))
    ambit_power_rare(n.n, alo, ahi, rlo, rhi);
}
#endif

AMBIT_WORKER void AMBIT_POWER(int32_t n, size_t count, const double *alo, const double *ahi, double *rlo, double *rhi) {
  exponent e = exponent_of(n);
  size_t i = 0;
  for (; i + AMBIT_LANES <= count; i += AMBIT_LANES) power_group(e, alo + i, ahi + i, rlo + i, rhi + i);
#if AMBIT_LANES > 2
  if (i < count) AMBIT_POWER_REMAINDER(n, count - i, alo + i, ahi + i, rlo + i, rhi + i);
#else
  if (i < count) power_one(e, alo[i], ahi[i], rlo + i, rhi + i);
#endif
}
#endif
