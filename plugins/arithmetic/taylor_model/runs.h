/* runs.h -- run functions of the Taylor-model plugin (contract: ambit_run_fn). */
#ifndef RUNS_H
#define RUNS_H
#include "model.h"

#define TAYLOR_FUNCTIONS(X) X(SQRT) X(EXP) X(LOG) X(SIN) X(COS) X(TAN) X(ASIN) X(ACOS) X(ATAN) X(SINH) X(COSH) X(TANH)
#define TAYLOR_OTHERS(X) X(ADD) X(SUB) X(NEG) X(MUL) X(SQR) X(POWN) X(DIV) X(ATAN2) X(ABS) X(MIN) X(MAX)
#define TAYLOR_DECLARE(OP)                                                                                             \
  uint32_t taylor_run_##OP(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,            \
      size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b);
TAYLOR_FUNCTIONS(TAYLOR_DECLARE)
TAYLOR_OTHERS(TAYLOR_DECLARE)
#undef TAYLOR_DECLARE
uint32_t taylor_run_function(const ambit_arithmetic *self, void *ctx, uint32_t op, void *base, size_t pitch,
    size_t lanes, size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b);
#endif
