/* power_kernel.h -- m^k as a pair of doubles with a proved error.
**
** By squaring from the top bit of k, as an unevaluated sum h + l:
**
**   square   p = h h exactly, (h, l) := (p.h, p.l + 2 h l)          times m   p = h m, (h, l) := (p.h, p.l + l m)
**
** What is left out is l^2 and the rounding of the low words. The sum is normalised at every fourth bit (up to
** PLAIN_MOST only at the end), so that l stays small; the relative error of m^k is below k AMBIT_ERROR_POWER
** (docs/numerics/elementary.md). While no product has a low part the power is exact, and if it is a double none has:
** the powers on the way have no more significant bits. Round-to-nearest on entry.
*/
#ifndef AMBIT_POWER_KERNEL_H
#define AMBIT_POWER_KERNEL_H
#include "num/elementary_kernel.h"

#define PLAIN_MOST 511 /* m^511 < 2^511: nothing overflows on the way */

/* x^n: what does not depend on the lane */
typedef struct exponent {
  int32_t n;
  uint32_t size; /* |n| */
  int top;       /* its highest bit */
  double error;  /* relative */
} exponent;

static inline exponent exponent_of(int32_t n) {
  uint32_t size = n < 0 ? 0u - (uint32_t)n : (uint32_t)n;
  return (exponent) { n, size, 31 - __builtin_clz(size), AMBIT_ERROR_POWER * ((double)size + (n < 0 ? 2 : 0)) };
}

typedef struct power {
  pair y; /* the value is (h + l) 2^k */
  bits k;
  bits inexact; /* not 0 but for the sign: a product had a low part */
} power;

INLINE power power_square(power a) {
  pair p = two_product(a.y.h, a.y.h);
  lanes cross = a.y.h * a.y.l;
  return (power) { { p.h, p.l + (cross + cross) }, a.k + a.k, a.inexact | to_bits(p.l) };
}
INLINE power power_times(power a, lanes m) {
  pair p = two_product(a.y.h, m);
  return (power) { { p.h, p.l + a.y.l * m }, a.k, a.inexact | to_bits(p.l) };
}
/* h back into [1, 2), |l| <= ulp(h)/2 */
INLINE power power_normal(power a) {
  pair y = fast_two_sum(a.y.h, a.y.l);
  bits e = shift_right(to_bits(y.h), 52) - all_bits(1023);
  y.h = to_lanes(to_bits(y.h) - shift_left(e, 52));
  return (power) { { y.h, y.l * power_of_two(-e) }, a.k + e, a.inexact };
}

/* a[i] := m[i]^|n|, m in [1, 2), i < count; several at once, because each step waits for the one before */
INLINE void power_kernel(power *a, const lanes *m, int count, exponent n) {
  for (int i = 0; i < count; i++) a[i] = (power) { { m[i], all(0) }, all_bits(0), all_bits(0) };
  for (int bit = n.top - 1; bit >= 0; bit--) {
    for (int i = 0; i < count; i++) a[i] = power_square(a[i]);
    if (n.size >> bit & 1)
      for (int i = 0; i < count; i++) a[i] = power_times(a[i], m[i]);
    if (n.size > PLAIN_MOST && bit % 4 == 0)
      for (int i = 0; i < count; i++) a[i] = power_normal(a[i]);
  }
  for (int i = 0; i < count; i++) a[i].y = fast_two_sum(a[i].y.h, a[i].y.l);
}
#endif
