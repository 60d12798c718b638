/* roots_kit.h -- the conformance kit of root finders (AMBIT_ROOT_FINDER).
**
** Random equations of 1 to 6 unknowns whose roots are planted: products of linear factors in y, x = y + phi(x) with a
** triangular phi, some roots outside of the searched box, some dependent on data. All of them are known for every value
** of the data; besides there are double roots, no roots, and equations that are no polynomials.
**
**   lost      a root of the box is in no reported box although the search is over
**   unique    a box that says so has not exactly one root
**   records   bounds, kinds, the searched box; stop and progress; the same answer every time
*/
#ifndef AMBIT_ROOTS_KIT_H
#define AMBIT_ROOTS_KIT_H
#include <ambit/registry.h>

typedef struct roots_kit {
  ambit_registry *registry;
  const char *name;
  uint64_t seed;
  size_t noption;
  const ambit_option *option;
  size_t (*allocations)(void);
  void (*finding)(void *user, const char *promise, const char *message);
  void *user;
  size_t searches, complete, boxes, roots, judged, findings; /* counted */
} roots_kit;

/* So many random systems, and the special ones; returns the number of broken promises. */
size_t roots_kit_run(roots_kit *k, size_t systems);
#endif
