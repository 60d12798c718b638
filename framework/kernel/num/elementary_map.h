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

/* What is known at a point: the enclosure, and for functions with a period the number of the half period. */
typedef struct sample {
  enclosure e;
  bits half;
} sample;

/* Each function has f_sample(x), and f_join(lo, hi, first, last): f over [lo, hi] from the samples at both ends. */
#define MONOTONE(name, least, most)                                                                                    \
  INLINE sample name##_sample(lanes x) { return (sample) { name##_at(x), all_bits(0) }; }                              \
  INLINE enclosure name##_join(lanes lo, lanes hi, sample first, sample last) {                                        \
    (void)lo, (void)hi;                                                                                                \
    return (enclosure) { least.e.lo, most.e.hi, first.e.declined | last.e.declined };                                  \
  }
MONOTONE(exp, first, last)
MONOTONE(log, first, last)
MONOTONE(asin, first, last)
MONOTONE(acos, last, first)
MONOTONE(atan, first, last)
MONOTONE(sinh, first, last)
MONOTONE(tanh, first, last)

/* even, least at 0 */
INLINE sample cosh_sample(lanes x) { return (sample) { cosh_at(x), all_bits(0) }; }
INLINE enclosure cosh_join(lanes lo, lanes hi, sample first, sample last) {
  bits across = less_equal(lo, all(0)) & less_equal(all(0), hi);
  lanes least = choose(across, all(1), smaller(first.e.lo, last.e.lo));
  return (enclosure) { least, larger(first.e.hi, last.e.hi), first.e.declined | last.e.declined };
}

/* The half period of x, floor((x - pi/2)/pi), up to an even constant: the sine of x + shift pi/128 has a maximum
** where an even one starts */
INLINE bits half_period(angle a, int shift) {
  return shift_right(a.floor + all_bits(((int64_t)1 << 48) - 64 + shift), 7);
}
INLINE enclosure wave_join(lanes lo, lanes hi, sample first, sample last) {
  bits count = last.half - first.half;
  bits one = bits_equal(count, all_bits(1)), many = bits_less(all_bits(1), count);
  bits odd = bits_equal(last.half & all_bits(1), all_bits(1));
  lanes least = choose(many | (one & odd), all(-1), smaller(first.e.lo, last.e.lo));
  lanes most = choose(many | (one & ~odd), all(1), larger(first.e.hi, last.e.hi));
  (void)lo, (void)hi;
  return (enclosure) { least, most, first.e.declined | last.e.declined };
}
#define sin_join wave_join
#define cos_join wave_join
INLINE sample sin_sample(lanes x) {
  angle a = angle_reduce(x);
  return (sample) { sin_of(x, a), half_period(a, 0) };
}
INLINE sample cos_sample(lanes x) {
  angle a = angle_reduce(x);
  return (sample) { cos_of(x, a), half_period(a, 64) };
}
/* increasing between its poles, which are where half periods start */
INLINE sample tan_sample(lanes x) {
  angle a = angle_reduce(x);
  return (sample) { tan_of(x, a), half_period(a, 0) };
}
INLINE enclosure tan_join(lanes lo, lanes hi, sample first, sample last) {
  bits same = bits_equal(first.half, last.half);
  (void)lo, (void)hi;
  return (enclosure) { choose(same, first.e.lo, all(-INFINITY)), choose(same, last.e.hi, all(INFINITY)),
    first.e.declined | last.e.declined };
}

/* Boxes that avoid the cut x <= 0, y = 0. Above the axis the angle falls with x, and rises with y right of 0 and
** falls left of it; below likewise by symmetry; a box on both sides lies at x > 0, where its least and greatest
** angles are at its left corners. */
typedef struct corners {
  lanes first_y, first_x, last_y, last_x; /* where the least and the greatest |angle| are */
  bits below, cut;                        /* cut: not such a box */
} corners;
INLINE corners atan2_corners(lanes ylo, lanes yhi, lanes xlo, lanes xhi) {
  bits below = less(yhi, all(0)), above = less(all(0), ylo), right = less(all(0), xlo), across = ~(below | above);
  bits sign = below & all_bits(INT64_MIN);
  lanes near_y = flip(choose(below, yhi, ylo), sign), far_y = flip(choose(below, ylo, yhi), sign);
  lanes least_y = choose(less(all(0), xhi), near_y, far_y), most_y = choose(less(xlo, all(0)), near_y, far_y);
  return (corners) { choose(across, ylo, least_y), choose(across, xlo, xhi), choose(across, yhi, most_y), xlo, below,
    across & ~right };
}
INLINE enclosure atan2_join(corners c, enclosure first, enclosure last) {
  bits sign = c.below & all_bits(INT64_MIN);
  lanes lo = choose(c.below, flip(last.hi, sign), first.lo), hi = choose(c.below, flip(first.lo, sign), last.hi);
  return (enclosure) { lo, hi, first.declined | last.declined | c.cut };
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

typedef sample (*sample_at)(lanes x);
typedef enclosure (*join_ends)(lanes lo, lanes hi, sample first, sample last);
/* a group of points, lo == hi everywhere, costs one evaluation */
INLINE void unary_group(
    uint32_t op, sample_at at, join_ends join, const double *alo, const double *ahi, double *rlo, double *rhi) {
  lanes a[2] = { load(alo), load(ahi) };
  sample first = at(a[0]), last = any(~same_bits(a[0], a[1])) ? at(a[1]) : first;
  enclosure e = join(a[0], a[1], first, last);
  finish(op, a, a, &e);
  store(rlo, e.lo), store(rhi, e.hi);
}
INLINE void binary_group(
    uint32_t op, const double *alo, const double *ahi, const double *blo, const double *bhi, double *rlo, double *rhi) {
  lanes a[2] = { load(alo), load(ahi) }, b[2] = { load(blo), load(bhi) };
  corners c = atan2_corners(a[0], a[1], b[0], b[1]);
  bits wide = ~(same_bits(a[0], a[1]) & same_bits(b[0], b[1]));
  enclosure first = atan2_at(c.first_y, c.first_x), last = any(wide) ? atan2_at(c.last_y, c.last_x) : first;
  enclosure e = atan2_join(c, first, last);
  finish(op, a, b, &e);
  store(rlo, e.lo), store(rhi, e.hi);
}

#if AMBIT_LANES == 2
/* One interval alone: its two ends side by side, which costs one evaluation too. */
INLINE lanes both(lanes a, int i) { return all(a[i]); }
INLINE enclosure enclosure_of(enclosure e, int i) {
  return (enclosure) { both(e.lo, i), both(e.hi, i), (bits) { e.declined[i], e.declined[i] } };
}
INLINE sample sample_of(sample s, int i) { return (sample) { enclosure_of(s.e, i), (bits) { s.half[i], s.half[i] } }; }
INLINE void finish_one(uint32_t op, lanes a, lanes b, enclosure e, double *rlo, double *rhi) {
  bits declined = e.declined | not_an_interval(both(a, 0), both(a, 1)) | not_an_interval(both(b, 0), both(b, 1));
  *rlo = e.lo[0], *rhi = e.hi[0];
  if (__builtin_expect(declined[0] != 0, 0)) ambit_elementary_rare(op, a[0], a[1], b[0], b[1], rlo, rhi);
}
INLINE void unary_one(uint32_t op, sample_at at, join_ends join, double alo, double ahi, double *rlo, double *rhi) {
  lanes a = { alo, ahi };
  sample s = at(a);
  enclosure e = join(both(a, 0), both(a, 1), sample_of(s, 0), sample_of(s, 1));
  finish_one(op, a, a, e, rlo, rhi);
}
INLINE void binary_one(uint32_t op, double alo, double ahi, double blo, double bhi, double *rlo, double *rhi) {
  lanes a = { alo, ahi }, b = { blo, bhi };
  corners c = atan2_corners(both(a, 0), both(a, 1), both(b, 0), both(b, 1));
  enclosure s = atan2_at((lanes) { c.first_y[0], c.last_y[0] }, (lanes) { c.first_x[0], c.last_x[0] });
  finish_one(op, a, b, atan2_join(c, enclosure_of(s, 0), enclosure_of(s, 1)), rlo, rhi);
}
#endif

/* What is left of an array goes to a narrower variant: the bits are the same. */
#if AMBIT_LANES > 2
#define FINISH_UNARY(OP, name)                                                                                         \
  if (i < n) AMBIT_REMAINDER[OP - AMBIT_OP_EXP](n - i, alo + i, ahi + i, blo + i, bhi + i, rlo + i, rhi + i);
#define FINISH_BINARY(OP) FINISH_UNARY(OP, )
#else
#define FINISH_UNARY(OP, name)                                                                                         \
  if (i < n) unary_one(OP, name##_sample, name##_join, alo[i], ahi[i], rlo + i, rhi + i);
#define FINISH_BINARY(OP)                                                                                              \
  if (i < n) binary_one(OP, alo[i], ahi[i], blo[i], bhi[i], rlo + i, rhi + i);
#endif
#define ARGUMENTS                                                                                                      \
  size_t n, const double *alo, const double *ahi, const double *blo, const double *bhi, double *rlo, double *rhi
#define UNARY(OP, name)                                                                                                \
  static AMBIT_WORKER void name##_map(ARGUMENTS) {                                                                     \
    size_t i = 0;                                                                                                      \
    for (; i + AMBIT_LANES <= n; i += AMBIT_LANES)                                                                     \
      unary_group(AMBIT_OP_##OP, name##_sample, name##_join, alo + i, ahi + i, rlo + i, rhi + i);                      \
    FINISH_UNARY(AMBIT_OP_##OP, name)                                                                                  \
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
  FINISH_BINARY(AMBIT_OP_ATAN2)
}

const ambit_elementary_map AMBIT_VARIANT[AMBIT_ELEMENTARY_COUNT] = { exp_map, log_map, sin_map, cos_map, tan_map,
  asin_map, acos_map, atan_map, atan2_map, sinh_map, cosh_map, tanh_map };
