/* solver_kit.h -- the conformance kit of "ambit.solver/1": any solver plugin can be put through it.
**
** It solves small problems with known solutions through the ABI and checks what a host relies on: records in order,
** without gaps, with bounds that make sense; every listed time hit exactly; a stop by the sink obeyed at once; nothing
** allocated between the first and the last record; failures with a reason; the same answer every time; and, above all,
** that enclosures contain the solutions: bounds, tubes, dense enclosures (which meet the bounds at both ends) and sets
** as functions of the unknowns (which lie within the bounds). It knows no test framework: what it finds goes to a
** callback.
*/
#ifndef AMBIT_SOLVER_KIT_H
#define AMBIT_SOLVER_KIT_H
#include "host/registry.h"
#include "host/services.h"
#include <ambit/solver.h>

typedef struct solver_kit {
  const ambit_solver *plugin;
  const char *name;
  const ambit_arithmetic *arithmetic; /* completed, fit for the plugin */
  void *actx;
  size_t noption;
  const ambit_option *option;
  uint32_t gives;              /* AMBIT_WISH_*: what must be in every step if it is wished for */
  double tolerance;            /* of a solver that proves nothing: how far it may be off, relative to 1 + |x| */
  size_t (*allocations)(void); /* by this thread so far; NULL: not checked */
  const void *(*service)(
      const ambit_host *h, const char *id); /* NULL: the kernel's; a liar shows that the kit would notice */
  /* a broken promise: on which problem, and one sentence with the numbers; at most 5 for each problem */
  void (*finding)(void *user, const char *problem, const char *message);
  void *user;
} solver_kit;

/* Runs every problem; returns the number of broken promises (also those not reported one by one). */
size_t solver_kit_run(const solver_kit *kit);
#endif
