/* mutant.h -- a plugin with one fault: what the conformance kit must find.
**
** One shared object for each kind wraps correct plugins and has a table of faults. Which fault it has says the
** environment variable AMBIT_MUTANT when it is loaded (empty: none, it must conform); where the correct plugins are
** says AMBIT_MUTANT_OF, the folder of one kind. The program run_mutants tries all of them.
**
** All that changes lives behind pointers, so that the watch over global data sees nothing but the fault.
*/
#ifndef AMBIT_MUTANT_H
#define AMBIT_MUTANT_H
#include <ambit/base.h>
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* exported by each: fault i, or NULL behind the last one */
typedef const char *(*mutant_name_fn)(size_t i);
#define MUTANT_NAME "ambit_mutant_name"

static inline const char *mutant_wanted(void) {
  const char *name = getenv("AMBIT_MUTANT");
  return name ? name : "";
}

/* an interface of a correct plugin */
static inline const void *mutant_base(const char *name, const char *interface_id) {
  char file[4096];
  const char *folder = getenv("AMBIT_MUTANT_OF");
  snprintf(file, sizeof file, "%s/%s.so", folder ? folder : ".", name);
  void *library = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  const ambit_plugin *entry = library ? dlsym(library, "ambit_entry") : NULL;
  if (!entry) fprintf(stderr, "%s: %s\n", file, dlerror());
  return entry ? entry->get(interface_id) : NULL;
}
#endif
