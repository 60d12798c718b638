/* plugin.c -- the entry of the plugin and its options. */
#include "krawczyk.h"
#include <string.h>

static const ambit_param param[] = {
  { "tolerance", "1", "", "1e-8",
      "boxes narrower than this, relative to the unknowns' size or absolutely below 1, are cut no further" },
  { "boxes_max", "1", "integer", "100000", "boxes that are looked at before the search gives up" },
  { "undecided_max", "1", "integer", "1000", "undecided boxes before the search gives up" },
  { "roots_max", "1", "integer", "10000", "roots before the search gives up" },
  { "operator", "1", "auto|newton|krawczyk|hansen_sengupta", "auto",
      "what narrows and proves boxes; auto: Newton's where the Jacobian is regular, Hansen and Sengupta's elsewhere" },
  { "parameter_pieces", "1", "integer", "0",
      "parts into which the ranges of uncertain data are cut for a proof and a tight enclosure; 0: automatic, 1: "
      "never" },
  { NULL, NULL, NULL, NULL, NULL },
};

static const ambit_root_finder root_finder = {
  .size = sizeof root_finder,
  .want = AMBIT_ROOT_WANT_JACOBIAN | AMBIT_ROOT_WANT_SLOPE | AMBIT_ROOT_WANT_FURTHER,
  .needs_rigorous = 1,
  .param = param,
  .open = krawczyk_open,
  .run = krawczyk_run,
  .close = krawczyk_close,
};

static const void *get(const char *interface_id) {
  return strcmp(interface_id, AMBIT_ROOT_FINDER) == 0 ? &root_finder : NULL;
}

const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "solver.krawczyk", "1.0",
  "Finds and proves all roots of n equations in n unknowns in a box, for every value of uncertain data: interval "
  "operators of Newton, Krawczyk, Hansen and Sengupta, narrowing by the formulas run backwards, monotonicity, epsilon "
  "inflation, cuts of the box and of the data's ranges.",
  get };
