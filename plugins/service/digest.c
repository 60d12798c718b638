/* digest.c -- "ambit.digest/1" by Nettle. */
#include <ambit/digest.h>
#include <errno.h>
#include <nettle/sha2.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static ambit_status sha256(int file, char text[AMBIT_DIGEST_TEXT]) {
  struct sha256_ctx state;
  uint8_t chunk[16384], digest[SHA256_DIGEST_SIZE];
  sha256_init(&state);
  for (;;) {
    ssize_t n = read(file, chunk, sizeof chunk);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return AMBIT_UNABLE;
    if (n == 0) break;
    sha256_update(&state, (size_t)n, chunk);
  }
  sha256_digest(&state, sizeof digest, digest);
  for (size_t i = 0; i < sizeof digest; i++) snprintf(text + 2 * i, 3, "%02x", digest[i]);
  return AMBIT_OK;
}

static const ambit_digest_service service = { sizeof service, sha256 };
static const void *get(const char *id) { return strcmp(id, AMBIT_DIGEST_SERVICE) == 0 ? &service : NULL; }
AMBIT_EXPORT const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "service.digest", "1.0",
  "SHA-256 of files, for the provenance of results.", get };
