/* provenance.h -- what a result rests on: the kernel, and each plugin that was loaded, with file and SHA-256.
**
** A plugin's file is hashed when that is asked, not when it is loaded. It must then still be the very file that was
** mapped (device, number, size, times of change: a change of the data leaves a later time of change behind, which only
** root can set): else there is a failure, and no hash. All calls: [main].
*/
#ifndef AMBIT_PROVENANCE_H
#define AMBIT_PROVENANCE_H
#include "host/load.h"
#include <ambit/registry.h>
#include <ambit/digest.h>
#include <stdbool.h>

typedef struct ambit_identity {
  const char *kind, *name, *version, *file; /* the registry's, until it is closed */
  char sha256[AMBIT_DIGEST_TEXT];
  bool shadows; /* has the kind and name of one of Ambit's own */
} ambit_identity;

/* The plugins in the order in which they were loaded: i < ambit_registry_count(r). Loads service/digest. */
ambit_status ambit_provenance_plugin(ambit_registry *r, size_t i, ambit_identity *out, ambit_failure *f);
/* The slow path of the elementary functions (slow.h), which is not of a registry; UNABLE: it is not loaded. */
ambit_status ambit_provenance_slow(ambit_registry *r, ambit_identity *out, ambit_failure *f);
/* A file as it lies there now: the kernel (ambit_trust_kernel). */
ambit_status ambit_provenance_file(
    ambit_registry *r, const char *file, char sha256[AMBIT_DIGEST_TEXT], ambit_failure *f);
/* A text that was read: a scene, which may come out of a pipe. */
ambit_status ambit_provenance_text(
    ambit_registry *r, const void *text, size_t bytes, char sha256[AMBIT_DIGEST_TEXT], ambit_failure *f);
#endif
