/* variant.h -- the plugin for one instruction set: kernels and series, compiled with the flags of the including file.
*/
#include "kernels.h"
#include "jets_values.h"
#include "jets_slopes.h"

#define INTERVAL_ENTRY(OP) [AMBIT_OP_##OP] = interval_run_##OP,

const ambit_arithmetic VARIANT = {
  .size = sizeof(ambit_arithmetic),
  .rigorous = 1,
  .open = interval_open,
  .elem = interval_elem,
  .enter = interval_enter,
  .leave = interval_leave,
  .set = interval_set,
  .bounds = interval_bounds,
  .run = { [AMBIT_OP_ADD] = run_add,
      [AMBIT_OP_SUB] = run_sub,
      [AMBIT_OP_NEG] = run_neg,
      [AMBIT_OP_MUL] = run_mul,
      [AMBIT_OP_SQR] = run_sqr,
      [AMBIT_OP_DIV] = run_div,
      [AMBIT_OP_SQRT] = run_sqrt,
      [AMBIT_OP_ABS] = run_abs,
      [AMBIT_OP_MIN] = run_min,
      [AMBIT_OP_MAX] = run_max,
      INTERVAL_SERVED(INTERVAL_ENTRY) INTERVAL_ENTRY(POWN) },
  .dot = dot,
  .jets = &jets_interface,
};
