/* elementary_map.h -- elementary functions over arrays of intervals, for one width and instruction set.
**
** A file sets AMBIT_LANES, AMBIT_VARIANT (the table to define) and AMBIT_REMAINDER (the table for what is left of a
** last group) and includes this. Lanes that the kernels decline (empty, infinite, at the edge of the domain, huge
** angles) go to ambit_elementary_rare one by one.
*/
#include "num/elementary_point.h"
#include "num/elementary_variant.h"
#include "num/rounding.h"
#include <ambit/tape.h>
#include <math.h>

/* f over [lo, hi]; a group of points (`thin`: lo == hi everywhere) costs one evaluation */
#define MONOTONE(name, least, most)                                                                                    \
  INLINE enclosure name##_over(lanes lo, lanes hi, int thin) {                                                         \
    enclosure first = name##_at(lo), last = thin ? first : name##_at(hi);                                              \
    return (enclosure) { least.lo, most.hi, first.declined | last.declined };                                          \
  }
MONOTONE(exp, first, last)
MONOTONE(log, first, last)
MONOTONE(asin, first, last)
MONOTONE(acos, last, first)
MONOTONE(atan, first, last)
MONOTONE(sinh, first, last)
MONOTONE(tanh, first, last)

/* even, least at 0 */
INLINE enclosure cosh_over(lanes lo, lanes hi, int thin) {
  enclosure first = cosh_at(lo), last = thin ? first : cosh_at(hi);
  bits across = less_equal(lo, all(0)) & less_equal(all(0), hi);
  lanes least = choose(across, all(1), smaller(first.lo, last.lo));
  return (enclosure) { least, larger(first.hi, last.hi), first.declined | last.declined };
}

/* The half period of x, floor((x - pi/2)/pi), up to an even constant: the sine of x + shift pi/128 has a maximum
** where an even one starts */
INLINE bits half_period(angle a, int shift) {
  return shift_right(a.floor + all_bits(((int64_t)1 << 48) - 64 + shift), 7);
}
INLINE enclosure wave(enclosure first, enclosure last, angle a, angle b, int shift) {
  bits end = half_period(b, shift), count = end - half_period(a, shift);
  bits one = bits_equal(count, all_bits(1)), many = bits_less(all_bits(1), count);
  bits odd = bits_equal(end & all_bits(1), all_bits(1));
  lanes least = choose(many | (one & odd), all(-1), smaller(first.lo, last.lo));
  lanes most = choose(many | (one & ~odd), all(1), larger(first.hi, last.hi));
  return (enclosure) { least, most, first.declined | last.declined };
}
INLINE enclosure sin_over(lanes lo, lanes hi, int thin) {
  angle a = angle_reduce(lo);
  enclosure first = sin_of(lo, a);
  if (thin) return first;
  angle b = angle_reduce(hi);
  return wave(first, sin_of(hi, b), a, b, 0);
}
INLINE enclosure cos_over(lanes lo, lanes hi, int thin) {
  angle a = angle_reduce(lo);
  enclosure first = cos_of(lo, a);
  if (thin) return first;
  angle b = angle_reduce(hi);
  return wave(first, cos_of(hi, b), a, b, 64);
}
/* increasing between its poles, which are where half periods start */
INLINE enclosure tan_over(lanes lo, lanes hi, int thin) {
  angle a = angle_reduce(lo);
  enclosure first = tan_of(lo, a);
  if (thin) return first;
  angle b = angle_reduce(hi);
  enclosure last = tan_of(hi, b);
  bits same = bits_equal(half_period(a, 0), half_period(b, 0));
  return (enclosure) { choose(same, first.lo, all(-INFINITY)), choose(same, last.hi, all(INFINITY)),
    first.declined | last.declined };
}

/* Boxes that avoid the cut x <= 0, y = 0. Above the axis the angle falls with x, and rises with y right of 0 and
** falls left of it; below likewise by symmetry; a box on both sides lies at x > 0, where its least and greatest
** angles are at its left corners. */
INLINE enclosure atan2_over(lanes ylo, lanes yhi, lanes xlo, lanes xhi, int thin) {
  bits below = less(yhi, all(0)), above = less(all(0), ylo), right = less(all(0), xlo);
  bits sign = below & all_bits(INT64_MIN);
  lanes near_y = flip(choose(below, yhi, ylo), sign), far_y = flip(choose(below, ylo, yhi), sign);
  lanes least_y = choose(less(all(0), xhi), near_y, far_y), most_y = choose(less(xlo, all(0)), near_y, far_y);
  bits across = ~(below | above);
  enclosure first = atan2_at(choose(across, ylo, least_y), choose(across, xlo, xhi));
  enclosure last = thin ? first : atan2_at(choose(across, yhi, most_y), xlo);
  lanes lo = choose(below, flip(last.hi, sign), first.lo), hi = choose(below, flip(first.lo, sign), last.hi);
  return (enclosure) { lo, hi, first.declined | last.declined | (across & ~right) };
}

INLINE bits same_bits(lanes a, lanes b) { return bits_equal(to_bits(a), to_bits(b)); }
INLINE bits not_an_interval(lanes lo, lanes hi) {
  return ~(less_equal(lo, hi) & less(lo, all(INFINITY)) & less(all(-INFINITY), hi));
}

/* one interval at a time; a[0..1] and b[0..1] are the bounds of the operands */
static AMBIT_WORKER void rescue(uint32_t op, bits declined, lanes a[2], lanes b[2], enclosure *e) {
  double in[4][AMBIT_LANES], lo[AMBIT_LANES], hi[AMBIT_LANES];
  uint64_t mask[AMBIT_LANES];
  store(in[0], a[0]), store(in[1], a[1]), store(in[2], b[0]), store(in[3], b[1]), store(lo, e->lo), store(hi, e->hi);
  memcpy(mask, &declined, sizeof mask);
  for (int i = 0; i < AMBIT_LANES; i++)
    if (mask[i]) ambit_elementary_rare(op, in[0][i], in[1][i], in[2][i], in[3][i], &lo[i], &hi[i]);
  e->lo = load(lo), e->hi = load(hi);
}

INLINE void finish(uint32_t op, lanes a[2], lanes b[2], enclosure *e) {
  bits declined = e->declined | not_an_interval(a[0], a[1]) | not_an_interval(b[0], b[1]);
  if (__builtin_expect(any(declined), 0)) rescue(op, declined, a, b, e);
}

typedef enclosure (*unary_over)(lanes lo, lanes hi, int thin);
INLINE void unary_group(uint32_t op, unary_over over, const double *alo, const double *ahi, double *rlo, double *rhi) {
  lanes a[2] = { load(alo), load(ahi) };
  int thin = !any(~same_bits(a[0], a[1]));
  enclosure e = thin ? over(a[0], a[0], 1) : over(a[0], a[1], 0);
  finish(op, a, a, &e);
  store(rlo, e.lo), store(rhi, e.hi);
}
INLINE void binary_group(
    uint32_t op, const double *alo, const double *ahi, const double *blo, const double *bhi, double *rlo, double *rhi) {
  lanes a[2] = { load(alo), load(ahi) }, b[2] = { load(blo), load(bhi) };
  int thin = !any(~(same_bits(a[0], a[1]) & same_bits(b[0], b[1])));
  enclosure e = thin ? atan2_over(a[0], a[0], b[0], b[0], 1) : atan2_over(a[0], a[1], b[0], b[1], 0);
  finish(op, a, b, &e);
  store(rlo, e.lo), store(rhi, e.hi);
}

/* The remainder of an array runs one lane at a time: the bits are the same. */
#if AMBIT_LANES > 1
#define FINISH_ARRAY(op)                                                                                               \
  if (i < n) AMBIT_REMAINDER[(op)-AMBIT_OP_EXP](n - i, alo + i, ahi + i, blo + i, bhi + i, rlo + i, rhi + i);
#else
#define FINISH_ARRAY(op)
#endif
#define ARGUMENTS                                                                                                      \
  size_t n, const double *alo, const double *ahi, const double *blo, const double *bhi, double *rlo, double *rhi
#define UNARY(OP, name)                                                                                                \
  static AMBIT_WORKER void name##_map(ARGUMENTS) {                                                                     \
    size_t i = 0;                                                                                                      \
    for (; i + AMBIT_LANES <= n; i += AMBIT_LANES)                                                                     \
      unary_group(AMBIT_OP_##OP, name##_over, alo + i, ahi + i, rlo + i, rhi + i);                                     \
    FINISH_ARRAY(AMBIT_OP_##OP)                                                                                        \
    (void)blo, (void)bhi;                                                                                              \
  }
UNARY(EXP, exp)
UNARY(LOG, log)
UNARY(SIN, sin)
UNARY(COS, cos)
UNARY(TAN, tan)
UNARY(ASIN, asin)
UNARY(ACOS, acos)
UNARY(ATAN, atan)
UNARY(SINH, sinh)
UNARY(COSH, cosh)
UNARY(TANH, tanh)

static AMBIT_WORKER void atan2_map(ARGUMENTS) {
  size_t i = 0;
  for (; i + AMBIT_LANES <= n; i += AMBIT_LANES)
    binary_group(AMBIT_OP_ATAN2, alo + i, ahi + i, blo + i, bhi + i, rlo + i, rhi + i);
  FINISH_ARRAY(AMBIT_OP_ATAN2)
}

const ambit_elementary_map AMBIT_VARIANT[AMBIT_ELEMENTARY_COUNT] = { exp_map, log_map, sin_map, cos_map, tan_map,
  asin_map, acos_map, atan_map, atan2_map, sinh_map, cosh_map, tanh_map };
