/* signature.h -- "d(Ddd)" of ambit/export.h as a libffi call interface. */
#ifndef AMBIT_LUA_SIGNATURE_H
#define AMBIT_LUA_SIGNATURE_H
#include <ambit/arena.h>
#include <ambit/status.h>
#include <ffi.h>

#define AMBIT_SIGNATURE_MAX 16 /* arguments as Lua counts them */

/* Kinds: v i l d s D as in export.h; ( is a callback whose own signature is in `callback`. In C an array is two
** arguments (pointer, count), a callback too (function, user word); a callback itself receives that user word as its
** last argument. */
typedef struct ambit_signature {
  char result;
  size_t count, c_count;
  char kind[AMBIT_SIGNATURE_MAX];
  struct ambit_signature *callback[AMBIT_SIGNATURE_MAX];
  ffi_type *type[2 * AMBIT_SIGNATURE_MAX + 1];
  ffi_cif cif;
} ambit_signature;

/* In the arena; NULL: the failure quotes the text and says what is wrong with it. */
ambit_signature *ambit_signature_read(ambit_arena *arena, const char *text, ambit_failure *f);
#endif
