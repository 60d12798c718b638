/* calculus.c -- models from coefficients, on parts of the domain, integrated and derived. Upward mode. */
#include "calculus.h"
#include "substitute.h"

#define ROUNDOFF 0x1p-52 /* of one operation in any mode, relative to its result */
#define UNDERFLOW 0x1p-1074

static const interval everything = { -INFINITY, INFINITY };

static interval hull_with(const context *c, const model *x, interval rest) {
  interval range = model_range_naive(c, x);
  return (interval) { -(-range.lo - rest.lo), range.hi + rest.hi };
}

AMBIT_WORKER uint32_t model_build(
    const context *c, model *dst, uint32_t n, const uint32_t *index, const double *value, interval rest) {
  if (interval_is_empty(rest)) return model_finish_interval(c, dst, (interval) { INFINITY, -INFINITY });
  model_clear(c, dst, 0);
  for (uint32_t k = 0; k < n; k++) {
    if (index[k] >= c->m.count || !(fabs(value[k]) < INFINITY)) return model_finish_interval(c, dst, everything);
    *model_place(c, dst, index[k]) = value[k];
  }
  model_survey(c, dst);
  interval hull = hull_with(c, dst, rest);
  model_add_interval(c, dst, rest);
  return model_finish(c, dst, hull);
}

AMBIT_WORKER uint32_t model_widen(const context *c, model *x, interval y) {
  if (interval_is_empty(y) || interval_is_empty(x->hull))
    return model_finish_interval(c, x, (interval) { INFINITY, -INFINITY });
  interval hull = { -(-x->hull.lo - y.lo), x->hull.hi + y.hi };
  if (!model_is_polynomial(x)) return model_finish_interval(c, x, hull);
  model_add_interval(c, x, y);
  return model_finish(c, x, hull);
}

AMBIT_WORKER uint32_t model_restrict(const context *c, model *dst, const model *v, const double *lo, const double *hi) {
  for (uint32_t j = 0; j < c->m.nvar; j++)
    if (!(lo[j] >= -1 && lo[j] <= hi[j] && hi[j] <= 1)) return model_finish_interval(c, dst, everything);
  if (!model_is_polynomial(v)) return model_finish_interval(c, dst, v->hull);
  double error = 0, size = (v->size + model_norm(c, v)[0]) * 1.001; /* grows by rounding only */
  model_clear(c, dst, 0);
  for (uint32_t i = 0; i < c->m.count; i++) *model_place(c, dst, i) = model_coefficient(c, v, i);
  for (uint32_t j = 0; j < c->m.nvar; j++) {
    if (lo[j] == -1 && hi[j] == 1) continue;
    double mid = (lo[j] + hi[j]) / 2, above = hi[j] - mid, below = mid - lo[j];
    substitute_variable(&c->m, model_coef(c, dst), j, mid, above > below ? above : below);
    error += substitute_error(&c->m, size);
  }
  dst->rad = v->rad + error;
  return model_finish(c, dst, v->hull);
}

/* [-1, 1] times x, and 0 */
static interval spread(interval x) {
  double most = fmax(fabs(x.lo), fabs(x.hi));
  return (interval) { -most, most };
}

static uint32_t exponent_of(const monomials *m, uint32_t i, uint32_t var) {
  uint32_t n = 0;
  for (; i; i = m->parent[i]) n += m->last[i] == var;
  return n;
}

AMBIT_WORKER uint32_t model_integrate(const context *c, model *dst, const model *v, uint32_t var) {
  const monomials *m = &c->m;
  if (var >= m->nvar) return model_finish_interval(c, dst, everything);
  if (interval_is_empty(v->hull)) return model_finish_interval(c, dst, v->hull);
  if (!model_is_polynomial(v)) return model_finish_interval(c, dst, spread(v->hull));
  double error = 0;
  model_clear(c, dst, 0);
  for (uint32_t i = 0; i < m->count; i++) {
    double value = model_coefficient(c, v, i);
    if (value == 0) continue;
    double quotient = value / (exponent_of(m, i, var) + 1.0);
    if (m->degree[i] == m->order)
      error += fabs(value) / (exponent_of(m, i, var) + 1.0);
    else
      *model_place(c, dst, monomials_product(m, 1 + var, i)) = quotient, error += fabs(quotient) * ROUNDOFF + UNDERFLOW;
  }
  dst->rad = v->rad + error;
  return model_finish(c, dst, spread(v->hull));
}

AMBIT_WORKER uint32_t model_derive(const context *c, model *dst, const model *v, uint32_t var) {
  const monomials *m = &c->m;
  if (interval_is_empty(v->hull)) return model_finish_interval(c, dst, v->hull);
  if (var >= m->nvar || !model_is_polynomial(v)) return model_finish_interval(c, dst, everything);
  double error = 0;
  model_clear(c, dst, 0);
  for (uint32_t i = 0; i < m->first[m->order]; i++) { /* monomial i of the derivative comes from i x_var */
    double value = model_coefficient(c, v, monomials_product(m, 1 + var, i));
    if (value == 0) continue;
    double multiple = value * (exponent_of(m, i, var) + 1.0);
    *model_place(c, dst, i) = multiple, error += fabs(multiple) * ROUNDOFF;
  }
  dst->rad = error;
  model_survey(c, dst);
  return model_finish(c, dst, hull_with(c, dst, (interval) { -error, error }));
}
