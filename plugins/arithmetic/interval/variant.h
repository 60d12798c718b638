/* variant.h -- the plugin for one instruction set: kernels and series, compiled with the flags of the including file,
** which names the tables (VARIANT, JETS) and what it is called (VARIANT_NAME). No set_text: constants arrive as the
** tightest doubles already.
*/
#include "kernels.h"
#include "runs.h"
#include "served.h"
#include "dot.h"
#include "eval.h"
#include "selftest.h"
#if WIDTH == 8
#define JETS interval_avx2_jets /* wider vectors bring nothing to series of a few dozen coefficients */
#else
#include "jets_values.h"
#include "jets_slopes.h"
#endif

#define ENTRY(OP, work, other) [AMBIT_OP_##OP] = run_##OP,

const ambit_arithmetic VARIANT = {
  .size = sizeof(ambit_arithmetic),
  .rigorous = 1,
  .open = open_checked,
  .elem = interval_elem,
  .enter = interval_enter,
  .leave = interval_leave,
  .set = interval_set,
  .bounds = interval_bounds,
  .run = { BASIC_OPERATIONS(ENTRY) ELEMENTARY_OPERATIONS(ENTRY)[AMBIT_OP_POWN] = run_POWN },
  .dot = dot,
  .eval_tape = eval_tape,
  .jets = &JETS,
  .function = run_function,
  .pair = run_function,
};
