/* solver_kit.h -- the conformance kit of "ambit.solver/1": any solver plugin can be put through it.
**
** It solves small problems with known solutions through the ABI and checks what a host relies on: records in order,
** without gaps, with bounds that make sense; every listed time hit exactly; a stop by the sink obeyed at once; nothing
** allocated between the first and the last record; failures with a reason; the same answer every time; and, above all,
** that enclosures contain the solutions: bounds, tubes, dense enclosures (which meet the bounds at both ends) and sets
** as functions of the unknowns (which lie within the bounds). It knows no test framework: what it finds goes to a
** callback.
**
** Problems are of two kinds: some by hand, each for one thing that a solver may get wrong, and random systems of 1 to
** 12 states with closed solutions (solver_kit_random.h). The solution is judged at every corner of the data.
*/
#ifndef AMBIT_SOLVER_KIT_H
#define AMBIT_SOLVER_KIT_H
#include <ambit/registry.h>
#include "host/services.h"
#include <ambit/solver.h>

/* what was tried: runs, those that came to the end, records with bounds, tubes, dense enclosures and sets, stops, and
** single comparisons */
typedef struct solver_kit_counts {
  size_t runs, complete, enclosures, tubes, dense, sets, stops, compared;
} solver_kit_counts;

typedef struct solver_kit {
  const ambit_solver *plugin;
  const char *name;
  const ambit_arithmetic *arithmetic; /* completed, fit for the plugin */
  void *actx;
  size_t noption;
  const ambit_option *option;
  uint32_t gives;              /* AMBIT_EXTRA_*: what must be in every step if it is asked for */
  double tolerance;            /* of a solver that proves nothing: how far it may be off, relative to 1 + |x| */
  size_t (*allocations)(void); /* by this thread so far; NULL: not checked */
  const void *(*service)(
      const ambit_host *h, const char *id); /* NULL: the kernel's; a liar shows that the kit would notice */
  /* a broken promise: on which problem, and one sentence with the numbers; at most 5 for each problem */
  void (*finding)(void *user, const char *problem, const char *message);
  void *user;
  uint64_t seed; /* of the random systems */
} solver_kit;

/* Runs every problem; returns the number of broken promises (also those not reported one by one). counts: added to; may
** be NULL */
size_t solver_kit_run(const solver_kit *kit, solver_kit_counts *counts);
/* The same with so many random systems; ends at the first that breaks a promise. */
size_t solver_kit_run_random(const solver_kit *kit, size_t systems, solver_kit_counts *counts);
#endif
