/* registry.h -- plugins by name: found on AMBIT_PATH, dlopened on first use, never scanned-and-loaded. */
#ifndef AMBIT_REGISTRY_H
#define AMBIT_REGISTRY_H
#include "base/status.h"
#include <ambit/arithmetic.h>
#include <ambit/element.h>
#include <ambit/export.h>
#include <ambit/solver.h>

typedef struct ambit_registry ambit_registry;

/* path: colon-separated directories, each with arithmetic/ element/ solver/ service/ below; NULL: $AMBIT_PATH. Behind
** it the directory `ambit` beside libambit is searched. All calls: [main]. NULL: out of memory. */
ambit_registry *ambit_registry_open(const char *path);
void ambit_registry_close(ambit_registry *r);

/* kind "arithmetic" | "element" | "solver" | "service". Loads on first use. A failure lists every path tried, the
** reason, and the nearest known name (from a directory listing, without loading). Checks id, ABI version, sizes. */
ambit_status ambit_registry_plugin(
    ambit_registry *r, const char *kind, const char *name, const ambit_plugin **p, ambit_failure *f);
/* completed; valid until close */
ambit_status ambit_registry_arithmetic(
    ambit_registry *r, const char *name, const ambit_arithmetic **a, ambit_failure *f);
ambit_status ambit_registry_element(ambit_registry *r, const char *name, const ambit_element **e, ambit_failure *f);
ambit_status ambit_registry_solver(ambit_registry *r, const char *name, const ambit_solver **s, ambit_failure *f);
/* any .so, for `ambit check`; from then on the kind and name in its id mean this file */
ambit_status ambit_registry_load_file(ambit_registry *r, const char *file, const ambit_plugin **p, ambit_failure *f);

/* The functions that a plugin offers to Lua; *e is NULL if it offers none. */
ambit_status ambit_registry_exports(
    ambit_registry *r, const ambit_plugin *p, const ambit_exports **e, ambit_failure *f);
/* Where plugins' notes go, [any] thread (NULL: nowhere). */
void ambit_registry_set_note(ambit_registry *r, void (*note)(void *user, const char *line), void *user);
void ambit_registry_note(ambit_registry *r, const char *line);

/* How many plugins are loaded, and the i-th of them, oldest first. */
size_t ambit_registry_count(const ambit_registry *r);
const struct ambit_loaded *ambit_registry_loaded(
    const ambit_registry *r, size_t i, const char **kind, const char **name);

typedef struct ambit_listing {
  const char *kind, *name, *file;
  int loaded;
} ambit_listing;
/* By file names, loads nothing; the texts are valid until the next call with room. */
size_t ambit_registry_list(ambit_registry *r, size_t room, ambit_listing *out);
/* options by name -> the flat array that open() takes: declaration order, shapes flattened; NaN where an option that
** may be absent (fallback "") is. Numbers are the nearest double. Unknown name: error with the nearest. `owner`:
** "solver `lohner`", for messages. */
typedef struct ambit_option {
  const char *name;
  const char *text; /* a word for choices, a literal for numbers (point) */
} ambit_option;
size_t ambit_params_count(const ambit_param *param);
size_t ambit_params_doubles(const ambit_param *param);
ambit_status ambit_params_resolve(
    const ambit_param *param, const char *owner, size_t n, const ambit_option *given, double *out, ambit_failure *f);
#endif
