/* status.c -- outcomes and their messages. */
#include "base/status.h"
#include <stdarg.h>
#include <stdio.h>

ambit_status ambit_fail(ambit_failure *f, ambit_status status, const char *format, ...) {
  if (!f || f->status != AMBIT_OK) return status;
  f->status = status;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(f->message, sizeof f->message, format, arguments);
  va_end(arguments);
  return status;
}

void ambit_failure_clear(ambit_failure *f) {
  f->status = AMBIT_OK;
  f->message[0] = '\0';
}

const char *ambit_status_name(ambit_status status) {
  static const char *const name[] = { "ok", "domain", "unable", "invalid", "out of memory", "stopped", "broken" };
  return status >= 0 && status <= AMBIT_BROKEN ? name[status] : "unknown";
}
