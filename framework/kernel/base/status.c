/* status.c -- outcomes and their messages. */
#include <ambit/status.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

AMBIT_PRINTF(4, 0)
static ambit_status set(
    ambit_failure *f, ambit_status status, const char *code, const char *format, va_list arguments) {
  if (!f || f->status != AMBIT_OK) return status;
  f->status = status;
  ambit_code_set(f->code, status, code);
  vsnprintf(f->message, sizeof f->message, format, arguments);
  return status;
}

ambit_status ambit_fail(ambit_failure *f, ambit_status status, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  set(f, status, NULL, format, arguments);
  va_end(arguments);
  return status;
}

ambit_status ambit_fail_code(ambit_failure *f, ambit_status status, const char *code, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  set(f, status, code, format, arguments);
  va_end(arguments);
  return status;
}

void ambit_failure_clear(ambit_failure *f) {
  f->status = AMBIT_OK;
  f->code[0] = '\0';
  f->message[0] = '\0';
}

const char *ambit_status_name(ambit_status status) {
  static const char *const name[] = { "ok", "domain", "unable", "invalid", "out of memory", "stopped", "broken" };
  return status >= 0 && status <= AMBIT_BROKEN ? name[status] : "unknown";
}

/* -- codes */

const char *ambit_code_of(ambit_status status) {
  static const char *const code[] = { AMBIT_CODE_OK, AMBIT_CODE_DOMAIN, AMBIT_CODE_UNABLE, AMBIT_CODE_INVALID,
    AMBIT_CODE_MEMORY, AMBIT_CODE_STOPPED, AMBIT_CODE_BROKEN };
  return status >= 0 && status <= AMBIT_BROKEN ? code[status] : AMBIT_CODE_BROKEN;
}

/* The word, or the word, a dot and lower-case letters, digits, dots and hyphens. */
static int is_code_of(const char *given, const char *word) {
  size_t length = strlen(word);
  if (strncmp(given, word, length) != 0) return 0;
  if (!given[length]) return 1;
  size_t rest = strspn(given + length, "abcdefghijklmnopqrstuvwxyz0123456789.-");
  return given[length] == '.' && rest > 1 && !given[length + rest] && length + rest < AMBIT_CODE_MAX;
}

void ambit_code_set(char code[AMBIT_CODE_MAX], ambit_status status, const char *given) {
  const char *word = ambit_code_of(status);
  snprintf(code, AMBIT_CODE_MAX, "%s", given && is_code_of(given, word) ? given : word);
}

const ambit_code *ambit_code_table(size_t *n) {
#define AMBIT_X(name, code, meaning, advice) { code, meaning, advice },
  static const ambit_code table[] = { AMBIT_CODES(AMBIT_X) };
#undef AMBIT_X
  *n = sizeof table / sizeof *table;
  return table;
}
