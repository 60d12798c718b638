/* plugin.c -- the entry of the plugin and its options. */
#include "flow.h"
#include <string.h>

static const ambit_param param[] = {
  { "order", "1", "integer", "0",
      "degree of the polynomials in the uncertain data, 1 to 31; 0: chosen from their number and the set's width" },
  { "time_order", "1", "integer", "0", "order of the series in time, 4 to 40; 0: chosen from the tolerance" },
  { "jacobian_order", "1", "integer", "0", "order in time of the slopes that move the remainder, 3 to 20; 0: 5" },
  { "tolerance", "1", "", "0",
      "truncation error in time that one step may add to a state, relative to its size; 0: 1e-11, and more for a wide "
      "set in four uncertain data or more, up to 1e-7" },
  { "split_tolerance", "1", "", "0",
      "truncation error in the uncertain data, in one step and relative, above which a piece of them is split; 0: "
      "1e-11 for one datum, 1e-8 for two, 1e-6 for three, 1e-5 for more" },
  { "pieces_max", "1", "integer", "0",
      "most pieces that the uncertain data are split into; 0: what fits in 96 MB, at most 256" },
  { "outputs", "1", "integer", "100", "most records over the whole time span once there is more than one piece" },
  { "step_max", "s", "", "inf", "longest step" },
  { "step_min", "s", "", "0", "shortest step that is tried before the run gives up; 0: 2^-40 of the time passed" },
  { "width_max", "1", "", "0",
      "the run ends when a state is wider than this times its initial magnitude (at least times 1); 0: when all "
      "are wider than 10 times what their polynomials are" },
  { NULL, NULL, NULL, NULL, NULL },
};

static const ambit_solver solver = {
  .size = sizeof solver,
  .want = AMBIT_WANT_RHS | AMBIT_WANT_SERIES | AMBIT_WANT_INITIAL | AMBIT_WANT_WORKERS,
  .needs_rigorous = 1,
  .param = param,
  .open = flow_open,
  .run = flow_run,
  .close = flow_close,
  .compared = "order=4,6,8,12; tolerance=1e-7,1e-9,1e-13",
  .cheap = "order=2 time_order=8 tolerance=1e-6",
};

static const void *get(const char *interface_id) { return strcmp(interface_id, AMBIT_SOLVER) == 0 ? &solver : NULL; }

const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "solver.taylor_model", "1.0",
  "Proves where every solution of an initial-value problem is, with wide uncertain data: the flow as polynomials in "
  "the "
  "data, by Taylor series in time whose coefficients are polynomials, remainders that are moved linearly with slopes "
  "of "
  "their own for each part of the data, and data split where polynomials of the given degree no longer hold.",
  get };
