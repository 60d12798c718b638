/* calculus.h -- what polynomials can do beyond arithmetic. Upward mode; contracts in <ambit/taylor.h>. */
#ifndef CALCULUS_H
#define CALCULUS_H
#include "model.h"

uint32_t model_build(
    const context *c, model *dst, uint32_t n, const uint32_t *index, const double *value, interval rest);
uint32_t model_widen(const context *c, model *x, interval y);
void model_evaluate(const context *c, const model *x, const double *at_lo, const double *at_hi, double *lo, double *hi);
uint32_t model_compose(const context *c, model *dst, const model *v, const model *w);
uint32_t model_restrict(const context *c, model *dst, const model *v, const double *lo, const double *hi);
uint32_t model_integrate(const context *c, model *dst, const model *v, uint32_t var);
uint32_t model_derive(const context *c, model *dst, const model *v, uint32_t var);
#endif
