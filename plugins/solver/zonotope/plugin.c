/* plugin.c -- the entry of the plugin and its options. */
#include "zonotope.h"

static const ambit_param param[] = {
  { "time_order", "1", "integer", "0", "order of the series in time, 3 to 40; 0: by need" },
  { "generators", "1", "integer", "0",
      "generators that are kept, in multiples of the number of states, 2 to 1000; 0: 60" },
  { "tolerance", "1", "", "0",
      "truncation error that one step may add to a state, relative to the state's size; 0: chosen from the width of "
      "the "
      "data" },
  { "step_max", "s", "", "inf", "longest step" },
  { "step_min", "s", "", "0", "shortest step that is tried before the run gives up; 0: 2^-40 of the time passed" },
  { "width_max", "1", "", "0",
      "the run ends when a state is wider than this times its initial magnitude (at least times 1); 0: when all "
      "are wider than 10 times what they are to first order, midpoint and movement with the data" },
  { NULL, NULL, NULL, NULL, NULL },
};

static const ambit_solver solver = {
  .size = sizeof solver,
  .want = AMBIT_WANT_IMPLICIT | AMBIT_WANT_SERIES | AMBIT_WANT_INITIAL | AMBIT_WANT_VARYING | AMBIT_WANT_JUMP,
  .needs_rigorous = 1,
  .arithmetics = "interval", /* its polynomials are its own */
  .param = param,
  .open = zono_open,
  .run = zono_run,
  .close = zono_close,
};

static const void *get(const char *interface_id) { return strcmp(interface_id, AMBIT_SOLVER) == 0 ? &solver : NULL; }

const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "solver.zonotope", "1.0",
  "Proves where every solution of an initial-value problem is, with many uncertain data: polynomials of low degree in "
  "the "
  "data, generators for all that they leave out, and accelerations from the equations that they satisfy instead of "
  "from "
  "formulas that divide.",
  get };
