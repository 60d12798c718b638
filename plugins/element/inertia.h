/* inertia.h -- the inertia of a body: a symmetric matrix, and one that some body can have.
**
** The second moments of a mass distribution about its centre, S = tr(I)/2 1 - I, form a positive semidefinite matrix
** [Traversaro, Brossette, Escande & Nori 2016], which contains the triangle inequality of the principal moments.
** Entries may be uncertain: what is refused is certainly wrong, for every value in their ranges. Of S the entries, the
** 2x2 minors and the determinant are bounded from above; for exact numbers that decides. SLACK (times the trace) leaves
** room for rounded data and for the rounding of this check, which is one of input: no proof rests on it.
*/
#ifndef AMBIT_INERTIA_H
#define AMBIT_INERTIA_H
#include <ambit/spatial.h>

#define INERTIA_SLACK 1e-9

typedef struct inertia_range {
  double lo, hi;
} inertia_range;

/* I from the upper triangle: symmetric, also when both halves were given apart. */
static inline ambit_rotation inertia_matrix(const ambit_expr *e) {
  ambit_rotation m;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) m.m[i][j] = i <= j ? e[3 * i + j] : e[3 * j + i];
  return m;
}

static inline inertia_range inertia_product(inertia_range x, inertia_range y) {
  double p[4] = { x.lo * y.lo, x.lo * y.hi, x.hi * y.lo, x.hi * y.hi };
  inertia_range r = { p[0], p[0] };
  for (int i = 1; i < 4; i++) {
    if (!(p[i] >= r.lo)) r.lo = p[i]; /* a NaN (0 times infinity) stays: nothing is certain then */
    if (!(p[i] <= r.hi)) r.hi = p[i];
  }
  return r;
}

/* x y - z w */
static inline inertia_range inertia_minor(inertia_range x, inertia_range y, inertia_range z, inertia_range w) {
  inertia_range p = inertia_product(x, y), q = inertia_product(z, w);
  return (inertia_range) { p.lo - q.hi, p.hi - q.lo };
}

/* smallest square in the range */
static inline double inertia_least_square(inertia_range x) {
  return x.lo > 0 ? x.lo * x.lo : x.hi < 0 ? x.hi * x.hi : 0;
}

static inline ambit_status inertia_check_symmetry(ambit_build *b, const inertia_range *x, double slack) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < i; j++) {
      inertia_range p = x[3 * i + j], q = x[3 * j + i];
      if (p.lo - q.hi > slack || q.lo - p.hi > slack)
        return b->fail(b, AMBIT_INVALID,
            "the inertia is not symmetric: row %d, column %d is %g, row %d, column %d is %g", j + 1, i + 1, q.lo, i + 1,
            j + 1, p.lo);
    }
  return AMBIT_OK;
}

/* Is S certainly not positive semidefinite? */
static inline int inertia_is_impossible(const inertia_range *x, double trace) {
  inertia_range s[9];
  double slack = INERTIA_SLACK * trace;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      inertia_range one = x[i <= j ? 3 * i + j : 3 * j + i]; /* the same triangle as inertia_matrix() */
      s[3 * i + j] = (inertia_range) { -one.hi, -one.lo };
    }
  for (int i = 0; i < 3; i++) {
    inertia_range own = x[4 * i], y = x[4 * ((i + 1) % 3)], z = x[4 * ((i + 2) % 3)];
    s[4 * i] = (inertia_range) { (y.lo + z.lo - own.hi) / 2, (y.hi + z.hi - own.lo) / 2 };
    if (own.hi < -slack || s[4 * i].hi < -slack) return 1;
  }
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3;
    double most = s[4 * i].hi * s[4 * j].hi;
    if (most - inertia_least_square(s[3 * i + j]) < -slack * trace) return 1;
  }
  inertia_range a = inertia_product(s[0], inertia_minor(s[4], s[8], s[5], s[7]));
  inertia_range c = inertia_product(s[1], inertia_minor(s[3], s[8], s[5], s[6]));
  inertia_range d = inertia_product(s[2], inertia_minor(s[3], s[7], s[4], s[6]));
  return a.hi - c.lo + d.hi < -slack * trace * trace;
}

/* Nine entries by rows; NULL: a point. Not symmetric is always a slip: half of the entries would not count. */
static inline ambit_status inertia_check(ambit_build *b, const ambit_expr *e, int physical) {
  inertia_range x[9];
  double trace = 0;
  if (!e) return AMBIT_OK;
  for (int i = 0; i < 9; i++) b->range(b, e[i], &x[i].lo, &x[i].hi);
  for (int i = 0; i < 3; i++) {
    double low = x[4 * i].lo < 0 ? -x[4 * i].lo : x[4 * i].lo, high = x[4 * i].hi < 0 ? -x[4 * i].hi : x[4 * i].hi;
    trace += low > high ? low : high;
  }
  ambit_status status = inertia_check_symmetry(b, x, INERTIA_SLACK * trace);
  if (status != AMBIT_OK || !physical || !inertia_is_impossible(x, trace)) return status;
  return b->fail(b, AMBIT_INVALID,
      "no body has this inertia: of its principal moments one is negative, or larger than the sum of the other two; "
      "`physical = false` takes it as it is");
}
#endif
