/* kernels.h -- the basic operations on vectors of (-lo, hi) pairs; included once per instruction set.
**
** Set-based interval arithmetic (IEEE 1788-2015) in upward mode: hi is the rounded-up bound, -lo the rounded-up bound
** of the negated set, so both are tightest. Notation: x = (-a, A) stands for [a, A], y = (-b, B) for [b, B]; products
** of bounds need 0 * inf = 0, as an infinite bound is no element of the set. Each function below is one operation on
** nonempty operands; `finish` then restores empty ones and collects flags. There is no branch on data, so all inputs
** cost the same, and every variant gives the same bits.
*/
#include "interval.h"
#include "vector.h"

typedef struct findings {
  mask empty, unbounded, partial;
} findings;
typedef vector (*operation)(findings *f, vector x, vector y);

INLINE uint32_t flags_of(const findings *f) {
  return (any(f->partial) ? AMBIT_F_PARTIAL : 0) | (any(f->empty) ? AMBIT_F_EMPTY : 0) |
         (any(f->unbounded) ? AMBIT_F_UNBOUNDED : 0);
}

INLINE mask is_empty(vector x) { return equal(x, splat(-INFINITY)); } /* in both halves or in none */
INLINE vector number(vector x) { return keep(equal(x, x), x); }       /* NaN -> 0 */

INLINE vector finish(findings *f, mask empty, vector r) {
  r = choose(empty, splat(-INFINITY), r);
  f->empty |= is_empty(r);
  f->unbounded |= equal(r, splat(INFINITY));
  return r;
}

INLINE vector add(findings *f, vector x, vector y) { return finish(f, is_empty(x) | is_empty(y), x + y); }
INLINE vector sub(findings *f, vector x, vector y) { return add(f, x, swap(y)); }

INLINE vector neg(findings *f, vector x, vector unused) {
  (void)unused;
  return finish(f, is_empty(x), swap(x));
}

/* -lo = max(-a b, -a B, -A b, -A B) and hi likewise. A NaN is 0 * inf and means 0. Where a = 0 makes one it may be
** dropped, as `larger` does with its first operand: then b or B is infinite, and if a times the other end is no 0
** either, A >= 0 times that infinity or 0 is one. */
INLINE vector product(vector x, vector y) {
  vector a = first(x), b = second(x), z = swap(y);
  vector p = larger_each(a * z, number(b * y));
  vector q = larger_each((-a) * y, number((-b) * z));
  return larger_each(p, q);
}

INLINE vector mul(findings *f, vector x, vector y) { return finish(f, is_empty(x) | is_empty(y), product(x, y)); }

/* For b >= 0 both bounds are v -> v > 0 ? v / b : v / B of their half; b = 0 gives inf where v > 0, which is the hull
** of the quotients by the positive part. B <= 0 is the same for the negatives, b = B = 0 is empty, and 0 inside makes
** everything but 0 / y entire. */
INLINE vector divide(findings *f, vector x, vector y) {
  mask zero_below = reaches(first(y), splat(0)), zero_above = reaches(second(y), splat(0));
  mask strictly_below = above(first(y), splat(0)), strictly_above = above(second(y), splat(0));
  mask contains = zero_below & zero_above, only_zero = contains & ~strictly_below & ~strictly_above;
  mask turn = strictly_below & ~strictly_above;
  mask none = is_empty(x) | is_empty(y);
  mask nonzero = ~equal(x, splat(0));
  nonzero |= swap_mask(nonzero);
  x = choose(turn, swap(x), x), y = choose(turn, swap(y), y);
  vector r = x / choose(above(x, splat(0)), magnitude(first(y)), second(y));
  r = choose(strictly_below & strictly_above, keep(nonzero, splat(INFINITY)), r);
  f->partial |= contains & ~none;
  return finish(f, none | only_zero, r);
}

/* min |v| in both halves: max(0, a, -A) */
INLINE vector least(vector x) { return larger_each(larger_each(-first(x), -second(x)), splat(0)); }
INLINE vector most(vector x) { return larger_each(first(x), second(x)); }

INLINE vector sqr(findings *f, vector x, vector unused) {
  (void)unused;
  vector small = least(x), large = most(x);
  return finish(f, is_empty(x), choose(FIRST_HALVES, (-small) * small, large * large));
}

INLINE vector absolute(findings *f, vector x, vector unused) {
  (void)unused;
  return finish(f, is_empty(x), choose(FIRST_HALVES, -least(x), most(x)));
}

/* s = sqrt(v) rounded up. If s is the root, s * s = v exactly; otherwise s * s > v also when rounded up, and the
** double below s is the root rounded down: s >= 2^-537 is normal, so its bits minus 1 are that double. */
INLINE vector root_down(vector v) {
  vector s = root(v);
  return bits_below(s, above(s * s, v));
}

INLINE vector square_root(findings *f, vector x, vector unused) {
  (void)unused;
  mask none = is_empty(x), negative = above(splat(0), second(x));
  vector lo = root_down(larger_each(-first(x), splat(0))), hi = root(larger_each(second(x), splat(0)));
  f->partial |= above(first(x), splat(0)) & ~none;
  return finish(f, none | negative, choose(FIRST_HALVES, -lo, hi));
}

INLINE vector minimum(findings *f, vector x, vector y) {
  return finish(f, is_empty(x) | is_empty(y), choose(FIRST_HALVES, larger_each(x, y), smaller_each(x, y)));
}

INLINE vector maximum(findings *f, vector x, vector y) {
  return finish(f, is_empty(x) | is_empty(y), choose(FIRST_HALVES, smaller_each(x, y), larger_each(x, y)));
}
