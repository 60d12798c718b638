/* load.h -- one plugin file: checked, mapped, its entry verified. Keeps no state, so any thread may call it. */
#ifndef AMBIT_LOAD_H
#define AMBIT_LOAD_H
#include "host/path.h"
#include <ambit/registry.h>
#include <stdbool.h>
#include <sys/stat.h>

typedef struct ambit_loaded {
  void *handle; /* dlclose when done */
  const char *file;
  struct stat about;   /* of the file, when it was loaded */
  bool shadows;        /* it has the kind and name of one of Ambit's own */
  ambit_plugin plugin; /* the kernel's copy, as far as both know the struct */
} ambit_loaded;

#define AMBIT_REASON_MAX 512

/* Maps `file`, if it may speak (trust.h), and checks its entry: ABI version, size and, unless `id` is NULL, that it
** calls itself so. INVALID: `reason` says why. */
ambit_status ambit_load_file(const char *file, const char *id, ambit_loaded *loaded, char reason[AMBIT_REASON_MAX]);
/* The first existing <directory>/<kind>/<name>.so. A file that exists but cannot be used ends the search: silently
** taking another plugin of the same name would hide the mistake. One that takes the place of Ambit's own ends it too,
** unless that is allowed (trust.h). The failure lists every file tried and why it was not taken. */
ambit_status ambit_load_named(ambit_arena *arena, const ambit_path *path, const char *kind, const char *name,
    ambit_loaded *loaded, ambit_failure *f);

/* Copies min(own, its size) bytes of a struct that starts with its size into the zeroed `into`; false if it holds
** fewer than `required`. */
bool ambit_load_struct(void *into, size_t own, size_t required, const void *theirs);

/* How many plugins are loaded, and the i-th of them, oldest first. */
size_t ambit_registry_count(const ambit_registry *r);
const ambit_loaded *ambit_registry_loaded(const ambit_registry *r, size_t i, const char **kind, const char **name);
#endif
