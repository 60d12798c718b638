/* reduction_kit.h -- the conformance kit of strategies of model reduction (AMBIT_STRATEGY).
**
** Random models with candidates, references and a proof that the kit plays: errors of candidates add up with their
** signs, some candidates cost nothing, some cannot be proved.
**
**   decisions  each candidate is decided once; what is accepted was proved just before, within the bounds
**   result     the cut is what was accepted; what costs nothing is cut, what cannot be proved is not
**   stops      a proof or the sink says stop: obeyed at once, and what was accepted stands
**   rankings   known ones, no NaN; the same answer every time
*/
#ifndef AMBIT_REDUCTION_KIT_H
#define AMBIT_REDUCTION_KIT_H
#include <ambit/registry.h>

typedef struct reduction_kit {
  ambit_registry *registry;
  const char *name;
  uint64_t seed;
  size_t noption;
  const ambit_option *option;
  size_t (*allocations)(void);
  void (*finding)(void *user, const char *promise, const char *message);
  void *user;
  size_t runs, proofs, judged, findings; /* counted */
} reduction_kit;

size_t reduction_kit_run(reduction_kit *k, size_t models);
#endif
