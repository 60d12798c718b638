/* digest.h -- "ambit.digest/1": the SHA-256 of a file or a text. The plugin service/digest.so is loaded when somebody
** asks whence a result comes, and not before.
*/
#ifndef AMBIT_DIGEST_H
#define AMBIT_DIGEST_H
#include "base.h"

#define AMBIT_DIGEST_SERVICE "ambit.digest/1"
#define AMBIT_DIGEST_TEXT 65 /* hexadecimal digits, and the end */

typedef struct ambit_digest_service {
  uint32_t size;
  /* [any] SHA-256 (FIPS 180-4) of the rest of an open file. UNABLE: it could not be read */
  ambit_status (*sha256)(int file, char text[AMBIT_DIGEST_TEXT]);
  /* [any] the same of these bytes */
  void (*sha256_bytes)(const void *bytes, size_t count, char text[AMBIT_DIGEST_TEXT]);
} ambit_digest_service;
#endif
