/* range.c -- the range of a polynomial over [-1, 1]^nvar. Upward mode.
**
** Naive: a monomial with even exponents only is in [0, 1], any other in [-1, 1]. Quadratic: for each variable b x + q
** x^2 has its extremes at -1, 1 or -b / 2q, which is exact where the quadratic part is diagonal. Tighter by
** branch and bound [Hansen & Walster 2004, 12]: a variable in which the polynomial is monotone (the linear coefficient
** exceeds what all other terms add to the derivative) is fixed at the end where the minimum is; otherwise the box with
** the lowest bound is halved along the variable whose nonlinear terms are largest. Halving substitutes x = (y +- 1) / 2
** in the coefficients (substitute.c).
*/
#include "model.h"
#include "substitute.h"

#define GOOD 0x1p-10 /* of the naive width: where to stop */

static uint32_t square_of(const monomials *m, uint32_t v) { return monomials_product(m, 1 + v, 1 + v); }

/* how much less than |b| + max(-q, 0) does -(b x + q x^2) reach: upper bound of the (negative) difference */
static double saved(double b, double q) {
  b = fabs(b);
  if (q <= 0) return 0;
  return b >= 2 * q ? -q : b * b / (4 * q) - b;
}

void model_range_quadratic(const context *c, const model *x, double *down, double *up) {
  *down = x->down, *up = x->up;
  if (c->m.order < 2 || model_norm(c, x)[2] == 0) return;
  for (uint32_t v = 0; v < c->m.nvar; v++) {
    double q = model_coefficient(c, x, square_of(&c->m, v));
    if (q == 0) continue;
    double b = model_coefficient(c, x, 1 + v);
    *down += saved(b, q), *up += saved(b, -q);
  }
}

/* -- branch and bound for the minimum of a polynomial in a plain array */

typedef struct box {
  double *coef;
  double error;   /* of the coefficients, as a bound of the polynomial's */
  double low;     /* a lower bound of the minimum */
  uint32_t split; /* along this variable; UINT32_MAX: nothing left to split */
} box;

typedef struct search {
  const monomials *m;
  double each;   /* error of one substitution */
  double sample; /* a value taken, about: the minimum is not far above it */
  double *weight, *other, *point, *value;
} search;

static void replace(const search *s, box *b, uint32_t v, double mid, double rad) {
  substitute_variable(s->m, b->coef, v, mid, rad);
  b->error += s->each;
}

/* what terms other than the linear one add to each derivative; without x_v^2 in `other` */
static void weigh(search *s, const box *b) {
  const monomials *m = s->m;
  for (uint32_t v = 0; v < m->nvar; v++) s->weight[v] = s->other[v] = 0;
  for (uint32_t i = m->first[1] + m->nvar; i < m->count; i++) {
    double size = fabs(b->coef[i]);
    if (size == 0) continue;
    int diagonal = m->degree[i] == 2 && m->last[i] == m->last[m->parent[i]];
    for (uint32_t j = i; j; j = m->parent[j]) {
      s->weight[m->last[j]] += size;
      if (!diagonal) s->other[m->last[j]] += size;
    }
  }
}

static double lower_bound(const search *s, const box *b) {
  const monomials *m = s->m;
  double down = 0;
  for (uint32_t i = 1; i < m->count; i++)
    if (m->odd[i] || b->coef[i] < 0) down += fabs(b->coef[i]);
  for (uint32_t v = 0; v < m->nvar && m->order >= 2; v++) down += saved(b->coef[1 + v], b->coef[square_of(m, v)]);
  return -(down + b->error - b->coef[0]);
}

/* the polynomial where its quadratic part has its minimum, about */
static double value_there(const search *s, const box *b) {
  const monomials *m = s->m;
  for (uint32_t v = 0; v < m->nvar; v++) {
    double linear = b->coef[1 + v], q = m->order >= 2 ? b->coef[square_of(m, v)] : 0;
    double at = q > 0 ? -linear / (2 * q) : linear > 0 ? -1 : 1;
    s->point[v] = at < -1 ? -1 : at > 1 ? 1 : at;
  }
  double sum = b->coef[0];
  s->value[0] = 1;
  for (uint32_t i = 1; i < m->count; i++) {
    s->value[i] = s->value[m->parent[i]] * s->point[m->last[i]];
    sum += b->coef[i] * s->value[i];
  }
  return sum;
}

/* Fixes what is monotone, until nothing more is. Fixing one variable leaves the others monotone. Then bounds. */
static void examine(search *s, box *b) {
  for (int changed = 1; changed;) {
    changed = 0;
    weigh(s, b);
    for (uint32_t v = 0; v < s->m->nvar; v++) {
      double linear = b->coef[1 + v];
      int monotone = s->weight[v] > 0 && fabs(linear) >= s->weight[v];
      s->point[v] = !monotone ? 0 : linear > 0 ? -1 : 1;
    }
    for (uint32_t v = 0; v < s->m->nvar; v++)
      if (s->point[v] != 0) replace(s, b, v, s->point[v], 0), changed = 1;
  }
  double most = 0, value = value_there(s, b);
  b->split = UINT32_MAX, b->low = lower_bound(s, b);
  for (uint32_t v = 0; v < s->m->nvar; v++)
    if (s->other[v] > most) most = s->other[v], b->split = v;
  if (value < s->sample) s->sample = value;
}

static uint32_t lowest(const box *b, uint32_t n) {
  uint32_t at = 0;
  for (uint32_t i = 1; i < n; i++)
    if (b[i].low < b[at].low) at = i;
  return at;
}

static double minimum(const context *c, const model *x, double sign, uint32_t boxes) {
  const monomials *m = &c->m;
  box b[RANGE_BOXES_MAX];
  double *room = c->box;
  search s = { .m = m, .sample = INFINITY, .weight = room, .other = room + m->nvar, .point = room + 2 * m->nvar };
  s.value = room + 3 * m->nvar, room = s.value + m->count;
  double size = (x->size + fabs(model_coef(c, x)[0])) * 1.001;
  s.each = substitute_error(m, size);
  for (uint32_t i = 0; i < boxes; i++) b[i].coef = room + (size_t)i * m->count;
  for (uint32_t i = 0; i < m->count; i++) b[0].coef[i] = sign * model_coefficient(c, x, i);
  b[0].error = 0;
  examine(&s, &b[0]);
  uint32_t n = 1, at = 0;
  double good = GOOD * (x->down + x->up);
  while (n < boxes && b[at].split != UINT32_MAX && s.sample - b[at].low > good) {
    memcpy(b[n].coef, b[at].coef, m->count * sizeof *b[n].coef);
    b[n].error = b[at].error;
    uint32_t v = b[at].split;
    double before = b[at].low;
    replace(&s, &b[at], v, -0.5, 0.5), replace(&s, &b[n], v, 0.5, 0.5);
    examine(&s, &b[at]), examine(&s, &b[n]);
    if (b[at].low < before) b[at].low = before; /* a part cannot be lower than the whole */
    if (b[n].low < before) b[n].low = before;
    n++;
    at = lowest(b, n);
  }
  return b[at].low;
}

interval model_range(const context *c, const model *x, uint32_t boxes) {
  double down, up, constant = model_coef(c, x)[0];
  model_range_quadratic(c, x, &down, &up);
  interval r = { -(down - constant), constant + up };
  if (boxes > c->boxes) boxes = c->boxes;
  if (boxes < 1 || !c->box || c->m.order < 2 || x->size == model_norm(c, x)[1]) return r;
  double lo = minimum(c, x, 1, boxes), hi = -minimum(c, x, -1, boxes);
  return (interval) { lo > r.lo ? lo : r.lo, hi < r.hi ? hi : r.hi };
}

interval model_bounds(const context *c, const model *x) {
  if (!model_is_polynomial(x)) return x->hull;
  interval r = model_range(c, x, c->boxes), hull = x->hull;
  double lo = -(x->rad - r.lo), hi = r.hi + x->rad;
  return (interval) { lo > hull.lo ? lo : hull.lo, hi < hull.hi ? hi : hull.hi };
}
