/* conformance.h -- what `ambit check` does with one plugin file: loads it as the registry would, and puts it through
** the kit of its kind. */
#ifndef AMBIT_CONFORMANCE_H
#define AMBIT_CONFORMANCE_H
#include <ambit/registry.h>
#include <stdbool.h>

enum { CONFORMS = 0, NOT_LOADED = 1, BROKEN = 3 }; /* verdicts; also the exit codes of the command */

typedef struct conformance {
  const char *file;
  size_t noption; /* options that do not stand at their fallbacks */
  const ambit_option *option;
  uint64_t seed;
  double effort; /* times the usual one */
  bool isotonic; /* of an arithmetic: demanded */
  bool first;    /* apart: end at the first broken promise */
  /* what happens, as it happens:
  **   "plugin"    id, its sentence              "refused"  "", why it cannot be loaded
  **   "begin"     section, ""                   "done"     section, "judged broken"
  **   "finding"   promise, what is broken       "fallback" operation, ""
  **   "note"      "", anything else */
  void (*tell)(void *user, const char *what, const char *name, const char *text);
  void *user;
} conformance;

int conformance_run(const conformance *c);

/* The same in a process of its own, which may crash or hang: then tell("died", section, how). It is ended when it says
** nothing for `patience` seconds. */
int conformance_run_apart(const conformance *c, double patience);
#endif
