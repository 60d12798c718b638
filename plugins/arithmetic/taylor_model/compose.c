/* compose.c -- a Taylor model at intervals and at Taylor models. Upward mode.
**
** At intervals: each monomial is the one without its last variable times a power of that variable, so that even powers
** stay positive. At models: Horner's rule along the tree of words, S(i) = c_i + sum over v <= last(i) of w_v S(i x_v),
** where branches without a coefficient are cut off. Both enclose p on the operands; the remainder of v is added.
*/
#include "calculus.h"

/* -- at a box */

/* powers 1 .. order of each variable */
static void write_powers(const context *c, const double *at_lo, const double *at_hi, interval *power) {
  for (uint32_t v = 0; v < c->m.nvar; v++)
    for (uint32_t k = 1; k <= c->m.order; k++) {
      interval *p = &power[(size_t)v * c->m.order + k - 1];
      c->num->pown(&p->lo, &p->hi, at_lo[v], at_hi[v], (int32_t)k);
    }
}

static interval value_of(const context *c, const interval *value, const interval *power, uint32_t i) {
  uint32_t v = c->m.last[i], n = 0, rest = i;
  for (; rest && c->m.last[rest] == v; rest = c->m.parent[rest]) n++;
  interval p = power[(size_t)v * c->m.order + n - 1];
  return rest ? interval_times(value[rest], p) : p;
}

AMBIT_WORKER void model_evaluate(
    const context *c, const model *x, const double *at_lo, const double *at_hi, double *lo, double *hi) {
  interval *value = c->at[0], *power = c->at[1];
  interval sum = { 0, 0 };
  *lo = x->hull.lo, *hi = x->hull.hi;
  if (!model_is_polynomial(x)) return;
  write_powers(c, at_lo, at_hi, power);
  for (uint32_t i = 0; i < c->m.count; i++) {
    double coef = model_coefficient(c, x, i);
    value[i] = i ? value_of(c, value, power, i) : (interval) { 1, 1 };
    interval term = interval_times((interval) { coef, coef }, value[i]);
    if (coef != 0) sum = (interval) { -(-sum.lo - term.lo), sum.hi + term.hi };
  }
  double down = -(x->rad - sum.lo), up = sum.hi + x->rad;
  if (down > *lo) *lo = down;
  if (up < *hi) *hi = up;
}

/* -- at models */

static void mark_alive(const context *c, const model *v) {
  for (uint32_t i = 0; i < c->m.count; i++) c->alive[i] = model_coefficient(c, v, i) != 0;
  for (uint32_t i = c->m.count; i-- > 1;) c->alive[c->m.parent[i]] |= c->alive[i];
}

static const model *argument(const context *c, const model *w, uint32_t v) {
  return (const model *)(const void *)((const char *)w + v * c->elem);
}

/* S(i) into the element of this level */
static void branch(const context *c, const model *v, const model *w, uint32_t i, uint32_t level) {
  model *sum = model_scratch(c, MODEL_SCRATCH + level), *inner = model_scratch(c, MODEL_SCRATCH + level + 1);
  model *product = model_scratch(c, 0), *next = model_scratch(c, 1);
  double constant = model_coefficient(c, v, i);
  model_set_interval(c, sum, (interval) { constant, constant });
  if (c->m.degree[i] == c->m.order) return;
  for (uint32_t j = 0; j < c->m.nvar && (i == 0 || j <= c->m.last[i]); j++) {
    uint32_t child = c->m.child[i] + j;
    if (!c->alive[child]) continue;
    branch(c, v, w, child, level + 1);
    model_multiply(c, product, argument(c, w, j), inner);
    model_add(c, next, sum, product, 1);
    model_copy(c, sum, next);
  }
}

AMBIT_WORKER uint32_t model_compose(const context *c, model *dst, const model *v, const model *w) {
  uint32_t flags = 0;
  int empty = interval_is_empty(v->hull);
  for (uint32_t j = 0; j < c->m.nvar; j++) {
    interval hull = argument(c, w, j)->hull;
    empty |= interval_is_empty(hull) || hull.hi < -1 || hull.lo > 1;
    if (hull.lo < -1 || hull.hi > 1) flags |= AMBIT_F_PARTIAL;
  }
  if (empty) return flags | model_finish_interval(c, dst, (interval) { INFINITY, -INFINITY });
  if (!model_is_polynomial(v)) return flags | model_finish_interval(c, dst, v->hull);
  mark_alive(c, v);
  branch(c, v, w, 0, 0);
  const model *result = model_scratch(c, MODEL_SCRATCH);
  if (!model_is_polynomial(result)) return flags | model_finish_interval(c, dst, v->hull);
  model_copy(c, dst, result);
  dst->rad += v->rad;
  return flags | model_finish(c, dst, v->hull);
}
