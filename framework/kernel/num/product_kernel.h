/* product_kernel.h -- products of interval series and matrices for one instruction set (the form: product.h).
**
** A file sets AMBIT_VARIANT (the table to define) and includes this. Sums run over the factor that is one number for
** all lanes, so that no vector is ever added up; results of any size are made in tiles that fit the stack and the first
** cache.
*/
#include "num/product_lanes.h"
#include "num/product_variant.h"
#include "num/rounding.h"
#include <ambit/arithmetic.h>
#include <math.h>

/* Intervals [lo, hi] as mid +- rad, and reach = |mid| + rad; mid may be any double near the middle. */
typedef struct spread {
  lanes mid, rad, reach;
} spread;

INLINE spread spread_of(lanes lo, lanes hi) {
  lanes mid = add_product(all(0.5), hi - lo, lo); /* a point itself, also if its half is no double */
  lanes rad = larger(hi - mid, mid - lo);
  return (spread) { mid, rad, magnitude(mid) + rad };
}

/* lo <= hi, all finite, and 0 * reach is 0 */
INLINE mask is_plain(lanes lo, lanes hi, spread s) { return reaches(hi, lo) & below(s.reach, all(INFINITY)); }

/* n intervals from lo and hi on; whole vectors are written, the last one filled up with zeros. reach may be NULL. */
INLINE mask write_spread(const double *lo, const double *hi, size_t n, double *mid, double *rad, double *reach) {
  mask plain = everywhere();
  for (size_t i = 0; i < n; i += LANES) {
    int whole = i + LANES <= n;
    lanes a = whole ? load(lo + i) : load_some(lo + i, n - i), b = whole ? load(hi + i) : load_some(hi + i, n - i);
    spread s = spread_of(a, b);
    plain &= is_plain(a, b, s);
    store(mid + i, s.mid), store(rad + i, s.rad);
    if (reach) store(reach + i, s.reach);
  }
  return plain;
}

/* The set [-(l + r + q), h + r + q]. */
typedef struct sums {
  lanes h, l, r, q;
} sums;

INLINE sums no_sums(void) { return (sums) { all(0), all(0), all(0), all(0) }; }

INLINE void add_term(sums *s, double mid, double rad, spread b) {
  lanes a = all(mid);
  s->h = add_product(a, b.mid, s->h);
  s->l = subtract_product(a, b.mid, s->l);
  s->r = add_product(magnitude(a), b.rad, s->r);
  s->q = add_product(all(rad), b.reach, s->q);
}

/* The bounds of n <= LANES results; AMBIT_F_UNBOUNDED if they overflow. */
INLINE uint32_t write_bounds(sums s, size_t n, double *lo, double *hi) {
  lanes r = s.r + s.q, up = s.h + r, down = s.l + r, most = larger(up, down);
  if (n < LANES)
    store_some(lo, n, all(0) - down), store_some(hi, n, up), most = first_of(most, n); /* 0 - 0 is 0, not -0 */
  else
    store(lo, all(0) - down), store(hi, up);
  return is_everywhere(below(most, all(INFINITY))) ? 0 : AMBIT_F_UNBOUNDED;
}

#include "num/product_series.h"
#include "num/product_matrix.h"

const ambit_product_variant AMBIT_VARIANT = { convolve, matmul };
