/* plugin.c -- options and entry. */
#include "valencia.h"
#include <string.h>

const ambit_param valencia_param[] = {
  { "order", "1", "integer", "0", "degree in time of the approximate solution of a step, 4 to 20; 0: 10" },
  { "degree", "1", "integer", "0",
      "degree of the approximate solution in the uncertain data, to 16, but not above what the arithmetic keeps; 0: "
      "chosen" },
  { "tolerance", "1", "", "0", "error bound that each step may add, relative to the size of a state; 0: 1e-12" },
  { "exponential", "1", "auto|off|on", "auto",
      "exponential enclosure of the error in a basis of eigenvectors: for fast steps only, never (the plain "
      "fixed-point "
      "iteration), or in every step" },
  { "step_max", "s", "", "inf", "longest step" },
  { "step_min", "s", "", "0",
      "give up rather than make a shorter step than this; 0: 2^-40 of the time passed, at least 2^-43 of "
      "the time span" },
  { "width_max", "1", "", "0",
      "give up when a state's enclosure is this many times wider than its initial size, or than 1 if it is smaller; 0: "
      "when all are wider than 10 times what they are to first order, midpoint and movement with the data" },
  { NULL, NULL, NULL, NULL, NULL },
};

static const ambit_solver interface = {
  .size = sizeof interface,
  .want = AMBIT_WANT_RHS | AMBIT_WANT_SERIES | AMBIT_WANT_INITIAL | AMBIT_WANT_TIME,
  .needs_rigorous = 1,
  .param = valencia_param,
  .open = valencia_open,
  .run = valencia_run,
  .close = valencia_close,
  .compared = "order=6,10,15; tolerance=1e-6,1e-9,1e-14",
  .cheap = "order=6 tolerance=1e-6",
};

static const void *get(const char *interface_id) { return strcmp(interface_id, AMBIT_SOLVER) == 0 ? &interface : NULL; }

const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "solver.valencia", "1.0",
  "ValEncIA-IVP (Rauh, Auer & Hofer 2006): an approximate solution that need not be proved, and a proved bound of its "
  "error by fixed-point iteration of r' in f(x_app + r) - x_app', with slopes, exponential enclosures for stiff and "
  "oscillating parts, and polynomials in the uncertain data over Taylor models. Takes right-hand sides with kinks "
  "(abs, min, max), and even such as are only continuous.",
  get };
