/* status.h -- an outcome together with the message that explains it. */
#ifndef AMBIT_STATUS_H
#define AMBIT_STATUS_H
#include <ambit/code.h>

#ifdef __cplusplus
extern "C" {
#endif

#define AMBIT_MESSAGE_MAX 1024

/* The first failure is kept; a later one does not overwrite it. Passed by whoever calls, so there is no global
** errno. */
typedef struct ambit_failure {
  ambit_status status;
  char code[AMBIT_CODE_MAX]; /* of <ambit/code.h>, or a plugin's own; "" if OK */
  char message[AMBIT_MESSAGE_MAX];
} ambit_failure;

/* f may be NULL. The code is that of the status alone. */
AMBIT_EXPORT ambit_status ambit_fail(ambit_failure *f, ambit_status status, const char *format, ...) AMBIT_PRINTF(3, 4);
/* The same with a code, which begins with the word of the status; any other is replaced by that word. */
AMBIT_EXPORT ambit_status ambit_fail_code(
    ambit_failure *f, ambit_status status, const char *code, const char *format, ...) AMBIT_PRINTF(4, 5);
static inline ambit_status ambit_no_memory(ambit_failure *f) { return ambit_fail(f, AMBIT_NOMEM, "out of memory"); }
AMBIT_EXPORT void ambit_failure_clear(ambit_failure *f);
AMBIT_EXPORT const char *ambit_status_name(ambit_status status); /* "ok", "domain", "unable", "invalid", ... */

AMBIT_EXPORT const char *ambit_code_of(
    ambit_status status); /* "ok", "domain", "unable", "invalid", "memory", "stopped", "broken" */
/* Into code: the given one if it is a code of this status, else ambit_code_of(status). given may be NULL. */
AMBIT_EXPORT void ambit_code_set(char code[AMBIT_CODE_MAX], ambit_status status, const char *given);

typedef struct ambit_code {
  const char *code, *meaning, *advice;
} ambit_code;
AMBIT_EXPORT const ambit_code *ambit_code_table(size_t *n); /* all of <ambit/code.h>, in its order */

#ifdef __cplusplus
}
#endif
#endif
