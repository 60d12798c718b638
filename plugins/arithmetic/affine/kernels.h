/* kernels.h -- passes over coefficient blocks; included once per instruction set, which VARIANT names.
**
** Upward mode. Each result u is the exact value rounded upward (two roundings, both upward, without FMA), and d the
** negated value rounded upward, so -d <= exact <= u and the error of keeping u is at most u + d. `gap` collects these,
** `size` the |u|; all sums are rounded upward, in any order, so they are upper bounds. `dot` is only near sum x_i y_i;
** product.c bounds by how much it may be wrong.
*/
#include "affine.h"
#include "vector.h"

#define SIGN INT64_MIN

/* one vector of results and its share of the sums */
#define KEEP(r, u, d)                                                                                                  \
  do {                                                                                                                 \
    store(r, u);                                                                                                       \
    gap += (u) + (d);                                                                                                  \
    size += magnitude(u);                                                                                              \
  } while (0)

INLINE void copied(double *r, const double *x, size_t n, words sign, vector *size) {
  for (size_t i = 0; i < n; i += WIDTH) {
    vector u = flip(load(x + i), sign);
    store(r + i, u);
    *size += magnitude(u);
  }
}

INLINE void sum(double *r, const double *x, size_t nx, const double *y, size_t ny, int negate, affine_sums *s) {
  size_t both = AFFINE_BLOCK * (nx < ny ? nx : ny);
  words sign = splat_words(negate ? SIGN : 0);
  vector gap = splat(0), size = splat(0);
  for (size_t i = 0; i < both; i += WIDTH) {
    vector a = load(x + i), b = flip(load(y + i), sign);
    vector u = a + b, d = flip(a, splat_words(SIGN)) - b;
    KEEP(r + i, u, d);
  }
  if (nx > ny) copied(r + both, x + both, AFFINE_BLOCK * (nx - ny), splat_words(0), &size);
  if (ny > nx) copied(r + both, y + both, AFFINE_BLOCK * (ny - nx), sign, &size);
  s->gap = total(gap), s->size = total(size);
}

/* the rest of the longer operand */
INLINE void scaled(double *r, double p, const double *x, size_t n, vector *gaps, vector *sizes) {
  vector up = splat(p), down = splat(-p), gap = *gaps, size = *sizes;
  for (size_t i = 0; i < n; i += WIDTH) {
    vector a = load(x + i), u = up * a, d = down * a;
    KEEP(r + i, u, d);
  }
  *gaps = gap, *sizes = size;
}

static void scale(double *r, double p, const double *x, size_t nx, affine_sums *s) {
  vector gap = splat(0), size = splat(0);
  scaled(r, p, x, AFFINE_BLOCK * nx, &gap, &size);
  s->gap = total(gap), s->size = total(size);
}

INLINE void tail(double *r, double p, const double *x, size_t nx, double q, const double *y, size_t ny, size_t both,
    vector *gap, vector *size) {
  if (nx > ny) scaled(r + both, p, x + both, AFFINE_BLOCK * (nx - ny), gap, size);
  if (ny > nx) scaled(r + both, q, y + both, AFFINE_BLOCK * (ny - nx), gap, size);
}

static void combine(
    double *r, double p, const double *x, size_t nx, double q, const double *y, size_t ny, affine_sums *s) {
  size_t both = AFFINE_BLOCK * (nx < ny ? nx : ny);
  vector gap = splat(0), size = splat(0), p_up = splat(p), p_down = splat(-p), q_up = splat(q), q_down = splat(-q);
  for (size_t i = 0; i < both; i += WIDTH) {
    vector a = load(x + i), b = load(y + i);
    vector u = multiply_add(p_up, a, q_up * b), d = multiply_add(p_down, a, q_down * b);
    KEEP(r + i, u, d);
  }
  tail(r, p, x, nx, q, y, ny, both, &gap, &size);
  s->gap = total(gap), s->size = total(size);
}

/* r := p x + q y, and sums for the quadratic part; gap is of the places that one operand only has (multiply.h) */
INLINE totals product(double *r, double p, const double *x, size_t nx, double q, const double *y, size_t ny) {
  size_t both = AFFINE_BLOCK * (nx < ny ? nx : ny);
  vector gap = splat(0), size = splat(0), dot = splat(0), absdot = splat(0);
  vector p_up = splat(p), q_up = splat(q);
  for (size_t i = 0; i < both; i += WIDTH) {
    vector a = load(x + i), b = load(y + i);
    vector u = multiply_add(p_up, a, q_up * b);
    store(r + i, u);
    size += magnitude(u);
    dot = multiply_add(a, b, dot);
    absdot = multiply_add(magnitude(a), magnitude(b), absdot);
  }
  tail(r, p, x, nx, q, y, ny, both, &gap, &size);
  return total_each(gap, size, dot, absdot);
}

static double size(const double *x, size_t nx) {
  vector size = splat(0);
  for (size_t i = 0; i < AFFINE_BLOCK * nx; i += WIDTH) size += magnitude(load(x + i));
  return total(size);
}

/* from 7 - k on: ones for the lanes behind lane k */
static const int64_t behind[16] = { 0, 0, 0, 0, 0, 0, 0, 0, -1, -1, -1, -1, -1, -1, -1, -1 };

static double pairs(const double *x, const double *y, size_t n) {
  vector sum = splat(0);
  for (size_t i = 0; i < AFFINE_BLOCK * n; i++) {
    size_t own = i - i % WIDTH;
    vector a = splat(x[i]), b = splat(y[i]);
    words later;
    memcpy(&later, behind + 7 - i % WIDTH, sizeof later);
    vector v = magnitude(multiply_add(a, load(y + own), b * load(x + own)));
    sum += (vector)((words)v & later);
    for (size_t j = own + WIDTH; j < AFFINE_BLOCK * n; j += WIDTH)
      sum += magnitude(multiply_add(a, load(y + j), b * load(x + j)));
  }
  return total(sum);
}

/* -- whole operations */

/* affine_finish, the usual case inline */
INLINE uint32_t finish(const affine_context *c, affine_element *r, pair hull, double size, double err, int64_t symbol) {
  double rad = size + err;
  pair reach = both(rad) + (pair) { -r->centre, r->centre }, least = smaller_pair(hull, reach);
  double half = 0.5 * (least[0] + least[1]);
  int usual = err < half && half + rad < INFINITY && /* false for NaN */
              (symbol == AFFINE_NO_SYMBOL || err <= AFFINE_MATTERS * rad);
  if (!usual) {
    store_pair(&r->nlo, hull);
    return affine_finish(c, r, size, err, symbol);
  }
  store_pair(&r->nlo, least);
  r->err = err, r->rad = rad, r->epoch = c->epoch;
  return 0;
}

INLINE uint32_t add_inline(const affine_context *c, affine_element *r, const affine_element *x, const affine_element *y,
    int negate, int64_t symbol) {
  affine_sums s;
  pair hull = load_pair(&x->nlo) + (negate ? (pair) { y->hi, y->nlo } : load_pair(&y->nlo));
  double x0 = x->centre, y0 = negate ? -y->centre : y->centre, own = x->err + y->err;
  r->blocks = x->blocks > y->blocks ? x->blocks : y->blocks;
  sum(r->coef, x->coef, x->blocks, y->coef, y->blocks, negate, &s);
  r->centre = x0 + y0;
  double below = -x0 - y0;
  return finish(c, r, hull, s.size, own + (s.gap + (r->centre + below)), symbol);
}

static uint32_t add(const affine_context *c, affine_element *r, const affine_element *x, const affine_element *y,
    int negate, int64_t symbol) {
  return add_inline(c, r, x, y, negate, symbol);
}

static uint32_t apply(const affine_context *c, affine_element *r, const affine_element *x, double slope, double glo,
    double ghi, int64_t symbol) {
  affine_sums s;
  double middle = 0.5 * glo + 0.5 * ghi, radius = ghi - middle > middle - glo ? ghi - middle : middle - glo;
  r->blocks = slope == 0 ? 0 : x->blocks;
  scale(r->coef, slope, x->coef, r->blocks, &s);
  r->centre = slope * x->centre + middle;
  double below = (-slope) * x->centre - middle;
  return finish(
      c, r, load_pair(&r->nlo), s.size, (radius + fabs(slope) * x->err) + (s.gap + (r->centre + below)), symbol);
}

INLINE uint32_t add_up(
    const affine_context *c, affine_element *r, const affine_element *x, const affine_element *y, int64_t symbol) {
  return add_inline(c, r, x, y, 0, symbol);
}
INLINE uint32_t subtract(
    const affine_context *c, affine_element *r, const affine_element *x, const affine_element *y, int64_t symbol) {
  return add_inline(c, r, x, y, 1, symbol);
}

static AFFINE_RUN(run_add, ADD, add_up, b) static AFFINE_RUN(run_sub, SUB, subtract, b)
