/* registry.h -- plugins by name: found on AMBIT_PATH, dlopened on first use, never scanned-and-loaded. */
#ifndef AMBIT_REGISTRY_H
#define AMBIT_REGISTRY_H
#include <ambit/status.h>
#include <ambit/arithmetic.h>
#include <ambit/element.h>
#include <ambit/export.h>
#include <ambit/reduction.h>
#include <ambit/root_finder.h>
#include <ambit/solver.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ambit_registry ambit_registry;

/* path: colon-separated directories, each with arithmetic/ element/ solver/ service/ below; NULL: $AMBIT_PATH. Behind
** it Ambit's own directory is searched, `ambit` beside libambit. All calls: [main]. NULL: out of memory. */
AMBIT_EXPORT ambit_registry *ambit_registry_open(const char *path);
AMBIT_EXPORT void ambit_registry_close(ambit_registry *r);

/* kind "arithmetic" | "element" | "solver" | "service". Loads on first use. A failure lists every path tried, the
** reason, and the nearest known name (from a directory listing, without loading). Checks id, ABI version, sizes. */
AMBIT_EXPORT ambit_status ambit_registry_plugin(
    ambit_registry *r, const char *kind, const char *name, const ambit_plugin **p, ambit_failure *f);
/* completed; valid until close; the three of kind "solver" are what it offers, one or several */
AMBIT_EXPORT ambit_status ambit_registry_arithmetic(
    ambit_registry *r, const char *name, const ambit_arithmetic **a, ambit_failure *f);
AMBIT_EXPORT ambit_status ambit_registry_element(
    ambit_registry *r, const char *name, const ambit_element **e, ambit_failure *f);
AMBIT_EXPORT ambit_status ambit_registry_solver(
    ambit_registry *r, const char *name, const ambit_solver **s, ambit_failure *f);
AMBIT_EXPORT ambit_status ambit_registry_root_finder(
    ambit_registry *r, const char *name, const ambit_root_finder **s, ambit_failure *f);
AMBIT_EXPORT ambit_status ambit_registry_strategy(
    ambit_registry *r, const char *name, const ambit_strategy **s, ambit_failure *f);
/* any .so, for `ambit check`; from then on the kind and name in its id mean this file */
AMBIT_EXPORT ambit_status ambit_registry_load_file(
    ambit_registry *r, const char *file, const ambit_plugin **p, ambit_failure *f);

/* The functions that a plugin offers to Lua; *e is NULL if it offers none. */
AMBIT_EXPORT ambit_status ambit_registry_exports(
    ambit_registry *r, const ambit_plugin *p, const ambit_exports **e, ambit_failure *f);
/* Where plugins' notes go, [any] thread (NULL: nowhere). */
AMBIT_EXPORT void ambit_registry_set_note(ambit_registry *r, void (*note)(void *user, const char *line), void *user);
AMBIT_EXPORT void ambit_registry_note(ambit_registry *r, const char *line);

typedef struct ambit_listing {
  const char *kind, *name, *file;
  int loaded;
} ambit_listing;
/* By file names, loads nothing; the texts are valid until the next call with room. */
AMBIT_EXPORT size_t ambit_registry_list(ambit_registry *r, size_t room, ambit_listing *out);
/* An option of an arithmetic or a solver. */
typedef struct ambit_option {
  const char *name;
  const char *text; /* a word for choices, a literal for numbers (point) */
} ambit_option;

/* Files may speak that nobody but their user can have changed. Two exceptions, for the whole process, as what is loaded
** is; [any]. What lies below this folder (its real name) is trusted, whoever may write there. INVALID: there is no such
** folder. */
AMBIT_EXPORT ambit_status ambit_trust_folder(const char *folder, ambit_failure *f);
/* A plugin on AMBIT_PATH may have the kind and name of one of Ambit's own. */
AMBIT_EXPORT void ambit_trust_shadows(void);

#ifdef __cplusplus
}
#endif
#endif
