/* loops.h -- the loops over directions, compiled once per instruction set; all variants are bit-identical.
**
** p x for p = [-pn, ph] and x = [-n, h]: with p >= 0 the bounds are max(ph h, pl h) and max(ph n, pl n); p <= 0 is the
** same for -p and -x, whose halves are exchanged; and with 0 inside p they are max(ph h, pn n) and max(ph n, pn h), as
** the other two products are smaller. So each bound is the larger of two products by a nonnegative number, rounded up.
** Operands are finite, so no NaN arises: products overflow to +inf upward and to -DBL_MAX downward.
*/
#include "gradient.h"
#define VECTOR_MOST 4 /* directions are few */
#include "shared/vector.h"

#define STEP WIDTH

/* four partial sums, whatever the vectors, so that variants agree */
typedef struct total {
  vector part[4 / STEP];
} total;

static inline double sum_of(const total *t) {
  double s[4];
  memcpy(s, t->part, sizeof s);
  return (s[0] + s[1]) + (s[2] + s[3]);
}

typedef struct source { /* the arrays that make -lo and hi of a product */
  vector u, v;
  const double *un, *uh, *vn, *vh;
} source;

static inline source source_of(size_t n, factor p, const double *x) {
  const double *half[2] = { x, x + n };
  return (source) { splat(p.u), splat(p.v), half[p.turn_u], half[!p.turn_u], half[p.turn_v], half[!p.turn_v] };
}
static inline vector product_n(const source *s, size_t j) {
  return larger_each(s->u * load(s->un + j), s->v * load(s->vn + j));
}
static inline vector product_h(const source *s, size_t j) {
  return larger_each(s->u * load(s->uh + j), s->v * load(s->vh + j));
}

static inline void keep(total *t, int which, double *r, size_t n, size_t j, vector rn, vector rh) {
  store(r + j, rn);
  store(r + n + j, rh);
  t->part[which] += larger_each(rn, rh);
}

static AMBIT_WORKER double scale(size_t n, double *r, factor p, const double *x) {
  total t = { 0 };
  source a = source_of(n, p, x);
  for (size_t j = 0; j < n; j += 4)
    for (int k = 0; k < 4 / STEP; k++) {
      size_t at = j + STEP * (size_t)k;
      keep(&t, k, r, n, at, product_n(&a, at), product_h(&a, at));
    }
  return sum_of(&t);
}

static AMBIT_WORKER double combine(size_t n, double *r, factor p, const double *x, factor q, const double *y) {
  total t = { 0 };
  source a = source_of(n, p, x), b = source_of(n, q, y);
  for (size_t j = 0; j < n; j += 4)
    for (int k = 0; k < 4 / STEP; k++) {
      size_t at = j + STEP * (size_t)k;
      keep(&t, k, r, n, at, product_n(&a, at) + product_n(&b, at), product_h(&a, at) + product_h(&b, at));
    }
  return sum_of(&t);
}

static AMBIT_WORKER double hull(size_t n, double *r, const double *x, const double *y) {
  total t = { 0 };
  for (size_t j = 0; j < n; j += 4)
    for (int k = 0; k < 4 / STEP; k++) {
      size_t at = j + STEP * (size_t)k;
      keep(&t, k, r, n, at, larger_each(load(x + at), load(y + at)), larger_each(load(x + n + at), load(y + n + at)));
    }
  return sum_of(&t);
}

const gradient_loops VARIANT = { scale, combine, hull };
