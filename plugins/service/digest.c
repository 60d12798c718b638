/* digest.c -- "ambit.digest/1" by Nettle. */
#include <ambit/digest.h>
#include <errno.h>
#include <nettle/sha2.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static void write_digest(struct sha256_ctx *state, char text[AMBIT_DIGEST_TEXT]) {
  uint8_t digest[SHA256_DIGEST_SIZE];
  sha256_digest(state, sizeof digest, digest);
  for (size_t i = 0; i < sizeof digest; i++) snprintf(text + 2 * i, 3, "%02x", digest[i]);
}

static ambit_status sha256(int file, char text[AMBIT_DIGEST_TEXT]) {
  struct sha256_ctx state;
  uint8_t chunk[16384];
  sha256_init(&state);
  for (;;) {
    ssize_t n = read(file, chunk, sizeof chunk);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return AMBIT_UNABLE;
    if (n == 0) break;
    sha256_update(&state, (size_t)n, chunk);
  }
  write_digest(&state, text);
  return AMBIT_OK;
}

static void sha256_bytes(const void *bytes, size_t count, char text[AMBIT_DIGEST_TEXT]) {
  struct sha256_ctx state;
  sha256_init(&state);
  sha256_update(&state, count, bytes);
  write_digest(&state, text);
}

static const ambit_digest_service service = { sizeof service, sha256, sha256_bytes };
static const void *get(const char *id) { return strcmp(id, AMBIT_DIGEST_SERVICE) == 0 ? &service : NULL; }
AMBIT_EXPORT const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "service.digest", "1.0",
  "SHA-256 of files and texts, for the provenance of results.", get };
