/* provenance.c -- hashes of what was loaded. */
#include "script/provenance.h"
#include "host/load.h"
#include "host/slow.h"
#include "host/trust.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static ambit_status find_digest(ambit_registry *r, const ambit_digest_service **s, ambit_failure *f) {
  const ambit_plugin *plugin;
  ambit_status status = ambit_registry_plugin(r, "service", "digest", &plugin, f);
  if (status != AMBIT_OK) return status;
  *s = plugin->get(AMBIT_DIGEST_SERVICE);
  if (*s && (*s)->size >= sizeof **s) return AMBIT_OK;
  return ambit_fail(f, AMBIT_INVALID, "the plugin service/digest offers no %s", AMBIT_DIGEST_SERVICE);
}

/* about: what the file must still be, or NULL */
static ambit_status hash(
    ambit_registry *r, const char *file, const struct stat *about, char sha256[AMBIT_DIGEST_TEXT], ambit_failure *f) {
  const ambit_digest_service *digest;
  struct stat now;
  ambit_status status = find_digest(r, &digest, f);
  if (status != AMBIT_OK) return status;
  int open_file = open(file, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY); /* a pipe has nothing to read, and ends */
  if (open_file < 0) return ambit_fail(f, AMBIT_INVALID, "cannot say whence this comes: %s: %s", file, strerror(errno));
  status = digest->sha256(open_file, sha256);
  bool same = fstat(open_file, &now) == 0 && (!about || ambit_trust_same(about, &now)); /* after it was read */
  close(open_file);
  if (status != AMBIT_OK) return ambit_fail(f, AMBIT_INVALID, "cannot say whence this comes: %s cannot be read", file);
  return same ? AMBIT_OK
              : ambit_fail(f, AMBIT_INVALID,
                    "cannot say whence this comes: the plugin's file %s was changed after it was loaded", file);
}

ambit_status ambit_provenance_plugin(ambit_registry *r, size_t i, ambit_identity *out, ambit_failure *f) {
  const ambit_loaded *loaded = ambit_registry_loaded(r, i, &out->kind, &out->name);
  out->version = loaded->plugin.version ? loaded->plugin.version : "";
  out->file = loaded->file;
  out->shadows = loaded->shadows;
  return hash(r, out->file, &loaded->about, out->sha256, f);
}

ambit_status ambit_provenance_slow(ambit_registry *r, ambit_identity *out, ambit_failure *f) {
  const ambit_loaded *loaded = ambit_slow_loaded();
  if (!loaded) return AMBIT_UNABLE;
  *out = (ambit_identity) { .kind = "service",
    .name = "elementary",
    .version = loaded->plugin.version ? loaded->plugin.version : "",
    .file = loaded->file,
    .shadows = loaded->shadows };
  return hash(r, out->file, &loaded->about, out->sha256, f);
}

ambit_status ambit_provenance_file(
    ambit_registry *r, const char *file, char sha256[AMBIT_DIGEST_TEXT], ambit_failure *f) {
  return hash(r, file, NULL, sha256, f);
}

ambit_status ambit_provenance_text(
    ambit_registry *r, const void *text, size_t bytes, char sha256[AMBIT_DIGEST_TEXT], ambit_failure *f) {
  const ambit_digest_service *digest;
  ambit_status status = find_digest(r, &digest, f);
  if (status == AMBIT_OK) digest->sha256_bytes(text, bytes, sha256);
  return status;
}
