/* plugin.c -- the entry of the plugin and its options. */
#include "lohner.h"
#include <string.h>

static const ambit_param param[] = {
  { "order", "1", "integer", "0", "order of the Taylor series of the midpoint, 4 to 60; 0: chosen from the tolerance" },
  { "jacobian_order", "1", "integer", "0",
      "order of the slopes over the set, 3 to `order`; 0: chosen from order and tolerance, and raised where slopes "
      "limit "
      "the step" },
  { "tolerance", "1", "", "1e-18", "truncation error that one step may add to a state, relative to the state's size" },
  { "set", "1", "auto|qr|history", "auto",
      "how the set is kept: qr, one orthogonal frame (Lohner's); history, also the boxes of past steps; auto: history "
      "unless "
      "there are more than 48 states" },
  { "history", "1", "integer", "32",
      "boxes of past steps that are kept before the older half is condensed; 1 to 3 count as 4; 0: as set = qr" },
  { "pieces", "1", "integer", "8",
      "parts, 1 to 16, into which uncertain data are cut to bound how slopes vary; the set stays whole" },
  { "step", "1", "auto|taylor|hermite_obreschkoff", "auto",
      "formula for the slopes over a step: Taylor, explicit; Hermite-Obreschkoff, implicit; auto: Taylor, and "
      "Hermite-Obreschkoff where slopes of the highest order limit the step" },
  { "step_max", "s", "", "inf", "longest step" },
  { "step_min", "s", "", "0",
      "shortest step that is tried before the run gives up; 0: 2^-40 of the time passed, and over wide sets also when "
      "steps shrink so fast that the end is out of reach" },
  { "width_max", "1", "", "0",
      "the run ends when a state is wider than this times its initial magnitude (at least times 1); 0: when all "
      "are wider than 10 times what they are to first order, midpoint and movement with the data" },
  { NULL, NULL, NULL, NULL, NULL },
};

static const ambit_solver solver = {
  .size = sizeof solver,
  .want = AMBIT_WANT_RHS | AMBIT_WANT_SERIES | AMBIT_WANT_INITIAL | AMBIT_WANT_INVARIANT,
  .needs_rigorous = 1,
  .param = param,
  .open = lohner_open,
  .run = lohner_run,
  .close = lohner_close,
  .compared = "order=6,10,15,20,30; tolerance=1e-6,1e-10,1e-14",
  .cheap = "order=8 tolerance=1e-8",
};

static const void *get(const char *interface_id) { return strcmp(interface_id, AMBIT_SOLVER) == 0 ? &solver : NULL; }

const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "solver.lohner", "1.0",
  "Proves where every solution of an initial-value problem is, by interval Taylor series: a high-order series from the "
  "midpoint of the set, "
  "slopes over the whole set, Picard's inclusion for what is beyond both, and sets that keep their correlation to "
  "uncertain data.",
  get };
