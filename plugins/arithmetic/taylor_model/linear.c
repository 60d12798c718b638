/* linear.c -- sums, differences, negation. Upward mode; polynomials are added in nearest mode, where the rounding
** error of a sum is a double and is computed exactly [Knuth, TAOCP 2, 4.2.2]. Most sums of scenes have no error at all,
** for they add terms that only one operand has. */
#include "model.h"

#define ERROR_MARGIN 0x1.00001p0 /* the errors are added in nearest mode, fewer than 2^31 of them */

static AMBIT_WORKER double sum_nearest(const context *c, model *dst, const model *a, const model *b, int subtract) {
  ambit_rounding old = ambit_round_nearest();
  double error = c->kernels->sum(&c->m, model_coef(c, dst), model_mask(c, dst), model_coef(c, a), model_mask(c, a),
      model_coef(c, b), model_mask(c, b), subtract);
  ambit_rounding_restore(old);
  return error;
}

double model_sum(const context *c, model *dst, const model *a, const model *b, double sign) {
  return sum_nearest(c, dst, a, b, sign < 0) * ERROR_MARGIN;
}

AMBIT_WORKER uint32_t model_add(const context *c, model *dst, const model *a, const model *b, double sign) {
  interval hull;
  model_hull(c, sign < 0 ? AMBIT_OP_SUB : AMBIT_OP_ADD, &hull, a->hull, b->hull, 0);
  if (a == b && sign < 0 && model_is_polynomial(a)) hull = (interval) { 0, 0 };
  if (!model_is_polynomial(a) || !model_is_polynomial(b)) return model_finish_interval(c, dst, hull);
  double error = model_sum(c, dst, a, b, sign);
  dst->rad = a->rad + b->rad + error;
  return model_finish(c, dst, hull);
}

AMBIT_WORKER uint32_t model_negate(const context *c, model *dst, const model *a) {
  model_copy(c, dst, a);
  double *coef = model_coef(c, dst);
  uint64_t *mask = model_mask(c, dst);
  for (uint32_t w = 0; w < c->m.words; w++)
    for (uint64_t rest = mask[w] | (w == 0); rest; rest &= rest - 1) {
      size_t i = ((size_t)w * 64 + (size_t)__builtin_ctzll(rest)) * MONOMIALS_BLOCK;
      for (int k = 0; k < MONOMIALS_BLOCK; k++) coef[i + (size_t)k] = -coef[i + (size_t)k];
    }
  dst->hull = (interval) { -a->hull.hi, -a->hull.lo };
  dst->down = a->up, dst->up = a->down;
  if (interval_is_empty(a->hull)) return AMBIT_F_EMPTY;
  return a->hull.lo > -INFINITY && a->hull.hi < INFINITY ? 0 : AMBIT_F_UNBOUNDED;
}
