/* path.h -- where plugins are looked for: an ordered list of directories, and names without surprises. */
#ifndef AMBIT_PATH_H
#define AMBIT_PATH_H
#include <ambit/arena.h>
#include <ambit/status.h>

typedef struct ambit_path {
  size_t count;
  const char **directory; /* [count] */
  const char *own;        /* Ambit's own, the last of them; NULL: there is none */
} ambit_path;

/* given (NULL: $AMBIT_PATH), from where the process is now if not absolute, then Ambit's own: the directory at
** `ambit_place`, seen from the file that the kernel is in, wherever that was moved. No other place is compiled in. The
** texts live in the arena. */
ambit_status ambit_path_open(ambit_arena *arena, const char *given, ambit_path *path);
/* What lies there by file name, without loading: one entry a name (the first directory wins), sorted. Returns how
** many; the list lives in the arena (NULL if there are none or memory is out). */
typedef struct ambit_found {
  const char *name, *file;
} ambit_found;
size_t ambit_path_list(ambit_arena *arena, const ambit_path *path, const char *kind, ambit_found **found);
/* The nearest known name of that kind, or NULL. */
const char *ambit_path_nearest(ambit_arena *arena, const ambit_path *path, const char *kind, const char *name);
/* "<directory>/<kind>/<name>.so" in the arena; NULL: out of memory */
char *ambit_path_file(ambit_arena *arena, const char *directory, const char *kind, const char *name);

#define AMBIT_KINDS 4
extern const char ambit_place[];                         /* "../lib/ambit": place.c */
extern const char *const ambit_plugin_kind[AMBIT_KINDS]; /* "arithmetic", "element", "solver", "service" */
/* INVALID if the kind is unknown, or the name is not made of letters, digits, '_', '-', '.' (not first). */
ambit_status ambit_path_check(const char *kind, const char *name, ambit_failure *f);
#endif
