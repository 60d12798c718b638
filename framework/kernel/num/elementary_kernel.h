/* elementary_kernel.h -- elementary functions at a point as double-doubles with a proved error.
**
** Each kernel returns h + l with h = RN(h + l) and |h + l - f(x)| <= AMBIT_ERROR_f |h| on its stated range (anything
** elsewhere, but no trap). Table-driven after P. T. P. Tang, ACM TOMS 15(2), 1989 and 16(4), 1990: reduce to a table
** point plus a small rest, Taylor polynomial of the rest, leading terms kept error-free. The bounds are derived in
** docs/numerics/elementary.md and re-checked by tests/num/proof. Round-to-nearest on entry.
*/
#ifndef AMBIT_ELEMENTARY_KERNEL_H
#define AMBIT_ELEMENTARY_KERNEL_H
#include "num/elementary_lanes.h"
#include "num/elementary_tables.h"

/* e^x = (h + l) 2^k, h in [.99, 2), |x| <= 1400. x = n ln2/64 + r, n = 64 k + j, |r| <= 2^-7.5. */
INLINE pair exp_kernel(lanes x, bits *k) {
  bits number;
  lanes n = nearest_integer(x * AMBIT_LN2_64_INVERSE, &number);
  pair a = two_sum(x - n * AMBIT_LN2_64_1, -(n * AMBIT_LN2_64_2)); /* both products exact: 36 + 17 bits */
  pair r = fast_two_sum(a.h, a.l - n * AMBIT_LN2_64_3);
  bits row = number & all_bits(63);
  *k = shift_right(number + all_bits(64 * 4096) - row, 6) - all_bits(4096);
  lanes th, tl;
  gather(ambit_exp_table, row + row, &th, &tl);
  lanes q = AMBIT_FACTORIAL_6 + r.h * AMBIT_FACTORIAL_7;
  q = AMBIT_FACTORIAL_5 + r.h * q;
  q = AMBIT_FACTORIAL_4 + r.h * q;
  q = AMBIT_FACTORIAL_3 + r.h * q;
  q = 0.5 + r.h * q;
  q = r.l + (r.h * r.h) * q; /* e^r - 1 - r.h */
  pair p = two_product(th, r.h), s = fast_two_sum(th, p.h);
  return fast_two_sum(s.h, s.l + (p.l + (th * q + (tl + tl * r.h))));
}

/* ln x, x in (0, +inf). x = 2^k m, r = m c - 1 exact, |r| < 2^-8; ln x = k ln2 - ln c + ln(1 + r). */
INLINE pair log_kernel(lanes x) {
  bits tiny = less(x, all(0x1p-1022));
  bits ix = to_bits(choose(tiny, x * 0x1p54, x));
  bits row = shift_right((shift_right(ix, 43) & all_bits(511)) + all_bits(1), 1);
  bits k = shift_right(ix, 52) - all_bits(1023) - (tiny & all_bits(54)) - bits_less(all_bits(AMBIT_LOG_FIRST - 1), row);
  lanes m = to_lanes((ix & all_bits(0x000fffffffffffff)) | all_bits(0x3ff0000000000000));
  lanes n = to_lanes(k + to_bits(all(INTEGER_SHIFT))) - all(INTEGER_SHIFT);
  lanes c, th, tl, unused;
  gather(ambit_log_table, shift_left(row, 2), &c, &th);
  gather(ambit_log_table + 2, shift_left(row, 2), &tl, &unused);
  pair mc = two_product(m, c);
  lanes r = (mc.h - 1.0) + mc.l;                                 /* exact: the sum is a double */
  lanes a = n * AMBIT_LN2_HIGH + th, b = n * AMBIT_LN2_LOW + tl; /* a exact: multiples of 2^-42, under 2^10 */
  pair sq = two_product(r, r);
  lanes p = r * AMBIT_INVERSE_9 - AMBIT_INVERSE_8;
  p = p * r + AMBIT_INVERSE_7;
  p = p * r - AMBIT_INVERSE_6;
  p = p * r + AMBIT_INVERSE_5;
  p = p * r - AMBIT_INVERSE_4;
  p = p * r + AMBIT_INVERSE_3;
  pair s = fast_two_sum(a, r), t = fast_two_sum(s.h, -0.5 * sq.h);
  return fast_two_sum(t.h, s.l + (t.l + ((b - 0.5 * sq.l) + (r * sq.h) * p)));
}

/* Addition theorem f(a + r) = S (1 + even) + C (r.h + odd): sine, cosine and their hyperbolic sisters. |S| >= |C
** r.h| or S = 0. */
INLINE pair addition(pair s, pair c, lanes r, lanes odd, lanes even) {
  pair q = two_product(c.h, r), t = fast_two_sum(s.h, q.h);
  return fast_two_sum(t.h, t.l + (q.l + (s.l + ((c.h * odd + c.l * r) + s.h * even))));
}

/* An angle x = n pi/128 + r, |r| <= 2^-6.33, and what the addition theorem needs of it. */
typedef struct angle {
  bits floor;         /* floor(128 x/pi), exact: the sign of r is */
  bits row;           /* n */
  bits declined;      /* |x| > 2^39, or r so small that its relative error is not proved */
  lanes r, odd, even; /* sin r = r + odd, cos r = 1 + even */
} angle;
INLINE angle angle_reduce(lanes x) {
  angle a;
  lanes n = nearest_integer(x * AMBIT_PI_128_INVERSE, &a.row);
  pair p = two_product(n, all(AMBIT_PI_128_1)), q = two_product(n, all(AMBIT_PI_128_2));
  pair u = two_sum(x - p.h, -p.l), v = two_sum(u.h, -q.h);
  pair r = fast_two_sum(v.h, ((u.l + v.l) - q.l) - n * AMBIT_PI_128_3);
  a.declined = ~(less_equal(magnitude(x), all(0x1p39)) & less_equal(magnitude(n) * 0x1p-92, magnitude(r.h)));
  a.floor = a.row - shift_right(to_bits(r.h), 63);
  lanes z = r.h * r.h;
  lanes odd = AMBIT_FACTORIAL_5 - z * AMBIT_FACTORIAL_7;
  odd = odd * z - AMBIT_FACTORIAL_3;
  lanes even = z * AMBIT_FACTORIAL_8 - AMBIT_FACTORIAL_6;
  even = even * z + AMBIT_FACTORIAL_4;
  even = even * z - 0.5;
  a.r = r.h, a.odd = r.l + (r.h * z) * odd, a.even = z * even - r.h * r.l;
  return a;
}
/* sin(x + shift pi/128), shift 0 or 64 (the cosine) */
INLINE pair sin_kernel(angle a, int shift) {
  bits row = (a.row + all_bits(shift)) & all_bits(255);
  pair s, c;
  gather(ambit_sin_table, row + row, &s.h, &s.l);
  gather(ambit_sin_table + 128, row + row, &c.h, &c.l);
  return addition(s, c, a.r, a.odd, a.even);
}
INLINE pair tan_kernel(angle a) {
  bits row = a.row & all_bits(255);
  pair s, c;
  gather(ambit_sin_table, row + row, &s.h, &s.l);
  gather(ambit_sin_table + 128, row + row, &c.h, &c.l);
  pair minus = { -s.h, -s.l };
  return pair_divide(addition(s, c, a.r, a.odd, a.even), addition(c, minus, a.r, a.odd, a.even));
}

/* The angle in [0, pi/2] of the point (x, y), x, y >= 0, not both 0, nonzero ones in [2^-400, 2^400], |low word| <=
** 2^-52 |high word|. With a >= b the larger and the smaller one and c = j/32 next to b/a it is atan c + atan t or pi/2
** less that, t = (b - c a)/(a + c b), |t| <= 2^-6; t = q + rest/(a + c b), q the quotient of the high words. */
INLINE pair atan_kernel(pair y, pair x) {
  bits steep = less(x.h, y.h), row;
  pair b = pair_choose(steep, x, y), a = pair_choose(steep, y, x);
  lanes ratio = b.h / a.h;
  /* not NaN: a row of the table */
  lanes c = nearest_integer(choose(less_equal(ratio, all(1)), ratio, all(0)) * 32.0, &row) * 0x1p-5;
  row = row + (steep & all_bits(33));
  pair corner;
  gather(ambit_atan_table, row + row, &corner.h, &corner.l);
  pair ca = two_product(c, a.h), cb = two_product(c, b.h);
  pair den = fast_two_sum(a.h, cb.h);
  lanes num_h = b.h - ca.h, num_l = (b.l - c * a.l) - ca.l; /* the first is exact */
  lanes den_l = den.l + (cb.l + (a.l + c * b.l));
  lanes inverse = 1.0 / den.h, q = num_h * inverse;
  pair v = two_product(q, den.h);
  lanes rest = ((num_h - v.h) - v.l) + (num_l - q * den_l);
  lanes z = q * q, w = z * z;
  lanes p =
      (z * AMBIT_INVERSE_5 - AMBIT_INVERSE_3) + w * ((z * AMBIT_INVERSE_9 - AMBIT_INVERSE_7) - w * AMBIT_INVERSE_11);
  lanes low = rest * (inverse - inverse * z) + (q * z) * p; /* atan(q + d) = atan q + d (1 - q^2) + ... */
  bits sign = steep & all_bits(INT64_MIN);
  pair s = two_sum(corner.h, flip(q, sign));
  return fast_two_sum(s.h, s.l + (corner.l + flip(low, sign)));
}
#endif
