/* plugin.c -- the entry of the plugin and its options. */
#include "stiff.h"
#include <string.h>

static const ambit_param param[] = {
  { "nodes", "1", "integer", "0",
      "collocation nodes of a step, 4 to 20, which is the degree of its polynomial; 0: chosen from the tolerance" },
  { "degree", "1", "integer", "0",
      "highest power of the unknowns that enclosures keep, less if there are many; 0: chosen from their number" },
  { "tolerance", "1", "", "1e-16", "size of the last coefficients of a step's polynomial, relative to the state's" },
  { "step_max", "s", "", "inf", "longest step" },
  { "step_min", "s", "", "0", "shortest step that is tried before the run gives up; 0: 2^-48 of the time reached" },
  { "width_max", "1", "", "0",
      "the run ends when a state is wider than this times its largest magnitude so far (at least times 1); 0: when all "
      "are wider than 10 times what they are to first order, midpoint and movement with the data" },
  { NULL, NULL, NULL, NULL, NULL },
};

static const ambit_solver solver = {
  .size = sizeof solver,
  .want = AMBIT_WANT_RHS | AMBIT_WANT_SERIES | AMBIT_WANT_JACOBIAN | AMBIT_WANT_INITIAL | AMBIT_WANT_SLOPE,
  .needs_rigorous = 1,
  .arithmetics = "interval", /* its polynomials are its own */
  .param = param,
  .open = stiff_open,
  .run = stiff_run,
  .close = stiff_close,
  .compared = "tolerance=1e-8,1e-12,1e-16",
  .cheap = "nodes=6 tolerance=1e-8",
};

static const void *get(const char *interface_id) { return strcmp(interface_id, AMBIT_SOLVER) == 0 ? &solver : NULL; }

const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "solver.stiff", "1.0",
  "Proves where the solutions of a stiff initial-value problem are, with steps as long as the solution is smooth: "
  "collocation without proof, then a rigorous defect, and errors bounded by a comparison system in frames that "
  "separate "
  "fast from slow directions.",
  get };
