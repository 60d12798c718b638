/* interface.c -- "ambit.taylor/1": every function sets upward mode around a worker that does the arithmetic. */
#include "interface.h"
#include "calculus.h"

static void shape(void *ctx, uint32_t *nvar, uint32_t *order, uint32_t *count) {
  const context *c = ctx;
  *nvar = c->m.nvar, *order = c->m.order, *count = c->m.count;
}

static void exponents(void *ctx, uint32_t index, uint32_t *exponent) {
  monomials_exponents(&((const context *)ctx)->m, index, exponent);
}

static uint32_t index_of(void *ctx, const uint32_t *exponent) {
  return monomials_index(&((const context *)ctx)->m, exponent);
}

static double coefficient(void *ctx, const void *x, uint32_t index) { return model_coefficient(ctx, x, index); }

static uint32_t terms(void *ctx, const void *x, uint32_t *index, double *value) {
  const context *c = ctx;
  uint32_t n = 0;
  for (uint32_t i = 0; i < c->m.count; i++) {
    double v = model_coefficient(c, x, i);
    if (v == 0) continue;
    if (index) index[n] = i;
    if (value) value[n] = v;
    n++;
  }
  return n;
}

static double remainder_of(void *ctx, const void *x) {
  (void)ctx;
  return ((const model *)x)->rad;
}

#define UPWARD(TYPE, CALL)                                                                                             \
  ambit_rounding old = ambit_round_up();                                                                               \
  TYPE result = CALL;                                                                                                  \
  ambit_rounding_restore(old);                                                                                         \
  return result

static uint32_t build(
    void *ctx, void *dst, uint32_t n, const uint32_t *index, const double *value, double lo, double hi) {
  UPWARD(uint32_t, model_build(ctx, dst, n, index, value, (interval) { lo, hi }));
}

static uint32_t widen(void *ctx, void *x, double lo, double hi) {
  UPWARD(uint32_t, model_widen(ctx, x, (interval) { lo, hi }));
}

static AMBIT_WORKER void range_into(const context *c, const model *x, uint32_t boxes, double *lo, double *hi) {
  interval r = model_range(c, x, boxes);
  *lo = r.lo, *hi = r.hi;
}

static void range(void *ctx, const void *x, uint32_t boxes, double *lo, double *hi) {
  ambit_rounding old = ambit_round_up();
  range_into(ctx, x, boxes, lo, hi);
  ambit_rounding_restore(old);
}

static void evaluate(void *ctx, const void *x, const double *at_lo, const double *at_hi, double *lo, double *hi) {
  ambit_rounding old = ambit_round_up();
  model_evaluate(ctx, x, at_lo, at_hi, lo, hi);
  ambit_rounding_restore(old);
}

static uint32_t product(void *ctx, void *dst, const void *a, const void *b) {
  UPWARD(uint32_t, model_multiply(ctx, dst, a, b));
}

static uint32_t compose(void *ctx, void *dst, const void *v, const void *w) {
  UPWARD(uint32_t, model_compose(ctx, dst, v, w));
}

static uint32_t restrict_to(void *ctx, void *dst, const void *v, const double *lo, const double *hi) {
  UPWARD(uint32_t, model_restrict(ctx, dst, v, lo, hi));
}

static uint32_t integrate(void *ctx, void *dst, const void *v, uint32_t var) {
  UPWARD(uint32_t, model_integrate(ctx, dst, v, var));
}

static uint32_t derive(void *ctx, void *dst, const void *v, uint32_t var) {
  UPWARD(uint32_t, model_derive(ctx, dst, v, var));
}

const ambit_taylor taylor_interface = {
  .size = sizeof taylor_interface,
  .shape = shape,
  .exponents = exponents,
  .index = index_of,
  .coefficient = coefficient,
  .terms = terms,
  .remainder = remainder_of,
  .build = build,
  .widen = widen,
  .range = range,
  .evaluate = evaluate,
  .product = product,
  .compose = compose,
  .restrict_to = restrict_to,
  .integrate = integrate,
  .derive = derive,
};
