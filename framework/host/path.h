/* path.h -- where plugins are looked for: an ordered list of directories, and names without surprises. */
#ifndef AMBIT_PATH_H
#define AMBIT_PATH_H
#include "base/arena.h"
#include "base/status.h"

typedef struct ambit_path {
  size_t count;
  const char **directory; /* [count] */
} ambit_path;

/* given (NULL: $AMBIT_PATH), then the build tree's directory if it exists, the directory `ambit` beside libambit, and the one fixed at
** configuration. The texts live in the arena. */
ambit_status ambit_path_open(ambit_arena *arena, const char *given, ambit_path *path);
/* "<directory>/<kind>/<name>.so" in the arena; NULL: out of memory */
char *ambit_path_file(ambit_arena *arena, const char *directory, const char *kind, const char *name);

#define AMBIT_KINDS 4
extern const char *const ambit_plugin_kind[AMBIT_KINDS]; /* "arithmetic", "element", "solver", "service" */
/* INVALID if the kind is unknown, or the name is not made of letters, digits, '_', '-', '.' (not first). */
ambit_status ambit_path_check(const char *kind, const char *name, ambit_failure *f);
#endif
