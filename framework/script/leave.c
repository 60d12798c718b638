/* leave.c -- see leave.h. Handlers of exit() know nothing but static data. */
#include "script/leave.h"
#include "script/limit.h"
#include <ambit/code.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static volatile pid_t guarded; /* the process whose exit() is watched; 0: none */

bool ambit_leave_reserve_files(void) {
  for (int file = STDIN_FILENO; file <= STDERR_FILENO; file++) {
    if (fcntl(file, F_GETFD) != -1) continue;
    if (open("/dev/null", file == STDIN_FILENO ? O_WRONLY : O_RDONLY) != file) return false;
  }
  return true;
}

static void on_exit_by_others(void) {
  if (guarded == 0 || guarded != getpid()) return;
  guarded = 0;
  fflush(stdout);
  fprintf(stderr,
      "ambit: something ended the process by exit() while Ambit was at work, a plugin or a library; nothing is proved "
      "(%s)\n",
      AMBIT_CODE_INVALID_EXIT);
  _exit(EXIT_FAILURE);
}

bool ambit_leave_guard(void) {
  static bool known;
  if (!known) known = atexit(on_exit_by_others) == 0 && at_quick_exit(on_exit_by_others) == 0;
  if (known) guarded = getpid();
  return known;
}

static int later = -1; /* an exit code that replaces what ambit_leave is given; -1: none */

void ambit_leave_with(int code) { later = code; }

static void tell_limit(void) {
  const char *limit, *sentence;
  if (!ambit_limit_reached(&limit, &sentence)) return;
  fprintf(stderr, "ambit: %s: what was done until then holds (%s)\n", sentence, limit);
}

bool ambit_leave_flush(void) { return fflush(stdout) == 0 && !ferror(stdout); }

int ambit_leave(int code) {
  guarded = 0;
  tell_limit();
  if (later >= 0) code = later;
  if (ambit_leave_flush()) return code;
  fprintf(stderr, "ambit: not everything could be written to standard output\n");
  return code == EXIT_SUCCESS ? EXIT_FAILURE : code;
}
