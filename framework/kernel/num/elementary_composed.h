/* elementary_composed.h -- functions put together from the kernels of elementary_kernel.h, as double-doubles with an
** error bound.
**
** Same promise: |h + l - f(x)| <= AMBIT_ERROR_f |h|. Every step is a double-double one with relative error near
** 2^-100, so that the bounds are those of the parts, multiplied by the condition of the step
** (docs/numerics/elementary.md).
*/
#ifndef AMBIT_ELEMENTARY_COMPOSED_H
#define AMBIT_ELEMENTARY_COMPOSED_H
#include "num/elementary_kernel.h"

/* sqrt(1 - u^2), u in [0, 1]: the other leg of asin and acos; 0 for u = 1 */
INLINE pair other_leg(lanes u) {
  pair q = two_product(u, u), w = fast_two_sum(all(1), -q.h);
  w = fast_two_sum(w.h, w.l - q.l); /* 1 - u^2 */
  bits end = less_equal(all(1), u);
  lanes s = choose(end, all(1), square_root(w.h));
  pair v = two_product(s, s);
  lanes half = 0.5 / s, rest = ((w.h - v.h) - v.l) + w.l;
  return pair_choose(end, (pair) { all(0), all(0) }, (pair) { s, rest * half });
}

/* pi - a where the mask is set, a in [0, pi/2] */
INLINE pair supplement(bits mask, pair a) {
  pair s = fast_two_sum(all(AMBIT_PI_HIGH), -a.h);
  s = fast_two_sum(s.h, s.l + (AMBIT_PI_LOW - a.l));
  return pair_choose(mask, s, a);
}

/* |x| in [2^-28, 1] */
INLINE pair asin_kernel(lanes x) {
  pair u = { magnitude(x), all(0) };
  return pair_flip(atan_kernel(u, other_leg(u.h)), sign_bit(x));
}
/* |x| <= 1 */
INLINE pair acos_kernel(lanes x) {
  pair u = { magnitude(x), all(0) };
  u.h = choose(less(u.h, all(0x1p-400)), all(0), u.h); /* keeps the kernel's range; moves the value by 2^-400 */
  return supplement(less(x, all(0)), atan_kernel(other_leg(u.h), u));
}
/* the angle of (x, y) in [-pi, pi]; |x| and |y| zero or in [2^-400, 2^400], not both zero */
INLINE pair atan2_kernel(lanes y, lanes x) {
  pair b = { magnitude(y), all(0) }, a = { magnitude(x), all(0) };
  return pair_flip(supplement(less(x, all(0)), atan_kernel(b, a)), sign_bit(y));
}

/* |x| <= 3/4: x = c + r, c = j/64, exact; |r| <= 2^-7 */
INLINE void sinh_cosh_near(lanes x, pair *sine, pair *cosine) {
  bits row, sign = sign_bit(x);
  lanes u = magnitude(x), r = u - nearest_integer(u * 64.0, &row) * 0x1p-6;
  pair s, c;
  gather(ambit_sinh_table, shift_left(row, 2), &s.h, &s.l);
  gather(ambit_sinh_table + 2, shift_left(row, 2), &c.h, &c.l);
  lanes z = r * r;
  lanes odd = AMBIT_FACTORIAL_5 + z * AMBIT_FACTORIAL_7;
  odd = (r * z) * (odd * z + AMBIT_FACTORIAL_3);
  lanes even = z * AMBIT_FACTORIAL_8 + AMBIT_FACTORIAL_6;
  even = even * z + AMBIT_FACTORIAL_4;
  even = z * (even * z + 0.5);
  *sine = pair_flip(addition(s, c, r, odd, even), sign);
  *cosine = addition(c, s, r, odd, even);
}

/* (e^u + sign e^-u) / 2 = (h + l) 2^k, u >= 0; sign is the bit of a minus */
INLINE pair exp_halves(lanes u, bits sign, bits *k) {
  pair e = exp_kernel(u, k), i = pair_divide((pair) { all(1), all(0) }, e);
  lanes scale =
      choose(bits_less(*k, all_bits(100)), power_of_two(-(*k & all_bits(127)) - (*k & all_bits(127))), all(0));
  i = pair_flip((pair) { i.h * scale, i.l * scale }, sign);
  pair s = two_sum(e.h, i.h);
  *k = *k - all_bits(1);
  return fast_two_sum(s.h, s.l + (e.l + i.l));
}

#define NEAR 0.75 /* below this sinh and tanh use the table */

/* sinh x = (h + l) 2^k, 2^-28 <= |x| <= 1400 */
INLINE pair sinh_kernel(lanes x, bits *k) {
  bits near = less_equal(magnitude(x), all(NEAR));
  pair r = { x, x };
  *k = all_bits(0);
  if (any(~near)) r = pair_flip(exp_halves(magnitude(x), all_bits(INT64_MIN), k), sign_bit(x));
  if (any(near)) {
    pair s, c;
    sinh_cosh_near(choose(near, x, all(0)), &s, &c);
    r = pair_choose(near, s, r);
    *k = *k & ~near;
  }
  return r;
}
/* cosh x = (h + l) 2^k, |x| <= 1400 */
INLINE pair cosh_kernel(lanes x, bits *k) { return exp_halves(magnitude(x), all_bits(0), k); }

/* e^2u -+ 1, u in (NEAR, 22] */
INLINE void tanh_far(lanes u, pair *less_one, pair *plus_one) {
  bits k;
  pair e = exp_kernel(2.0 * smaller(u, all(22)), &k);
  lanes scale = power_of_two(k), l = e.l * scale;
  *less_one = fast_two_sum(e.h * scale, all(-1)), *plus_one = fast_two_sum(e.h * scale, all(1));
  less_one->l = less_one->l + l, plus_one->l = plus_one->l + l;
}
/* sinh/cosh or (e^2u - 1)/(e^2u + 1), |x| in [2^-28, 22]; any other x has its enclosure rounded to 1 */
INLINE pair tanh_kernel(lanes x) {
  bits near = less_equal(magnitude(x), all(NEAR)), sign = sign_bit(x);
  pair num = { x, x }, den = { all(1), all(0) };
  if (any(~near)) tanh_far(magnitude(x), &num, &den);
  if (any(near)) {
    pair s, c;
    sinh_cosh_near(choose(near, magnitude(x), all(0)), &s, &c);
    num = pair_choose(near, s, num), den = pair_choose(near, c, den);
  }
  return pair_flip(pair_divide(num, den), sign);
}
#endif
