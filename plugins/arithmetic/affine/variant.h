/* variant.h -- the plugin for one instruction set: kernels compiled with the flags of the including file. */
#include "multiply.h"

static const affine_kernels kernels = { multiply, add, apply, combine, scale, size, pairs };

static ambit_status open(const ambit_host *h, const double *option, uint32_t nvar, void **ctx) {
  return affine_open(h, option, nvar, &kernels, VARIANT.run, ctx);
}

#define AFFINE_ENTRY(OP) [AMBIT_OP_##OP] = affine_run_##OP,

const ambit_arithmetic VARIANT = {
  .size = sizeof(ambit_arithmetic),
  .rigorous = 1,
  .param = affine_params,
  .open = open,
  .close = affine_close,
  .elem = affine_elem,
  .enter = affine_enter,
  .leave = affine_leave,
  .set = affine_set,
  .bounds = affine_bounds,
  .run = { [AMBIT_OP_ADD] = run_add, [AMBIT_OP_SUB] = run_sub, [AMBIT_OP_MUL] = run_mul, AFFINE_RUNS(AFFINE_ENTRY) },
  .eval_tape = affine_eval_tape,
  .function = affine_run_function,
};
