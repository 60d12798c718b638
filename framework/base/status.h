/* status.h -- an outcome together with the message that explains it. */
#ifndef AMBIT_STATUS_H
#define AMBIT_STATUS_H
#include <ambit/base.h>

#define AMBIT_MESSAGE_MAX 1024

/* The first failure is kept; a later one does not overwrite it. Passed by whoever calls, so there is no global
** errno. */
typedef struct ambit_failure {
  ambit_status status;
  char message[AMBIT_MESSAGE_MAX];
} ambit_failure;

/* f may be NULL */
ambit_status ambit_fail(ambit_failure *f, ambit_status status, const char *format, ...) AMBIT_PRINTF(3, 4);
void ambit_failure_clear(ambit_failure *f);
const char *ambit_status_name(ambit_status status); /* "ok", "domain", "unable", "invalid", ... */
#endif
