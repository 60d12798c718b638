/* plugin.c -- "ambit.sandbox/1": rights first, then files, then system calls, the last step of no return. */
#include "sandbox.h"
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>

/* No core file, which would be written where the process stands. */
static int drop_rights(char *why, size_t room) {
  const struct rlimit none = { 0, 0 };
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && setrlimit(RLIMIT_CORE, &none) == 0) return 1;
  snprintf(why, room, "rights cannot be dropped: %s", strerror(errno));
  return 0;
}

static ambit_status enter(const ambit_sandbox_request *q, int *files, char *why, size_t room) {
  *files = 0;
  if (q->size < sizeof *q) return snprintf(why, room, "the request is of another version"), AMBIT_INVALID;
  if (!drop_rights(why, room) || !sandbox_keep_files(q, files, why, room) || !sandbox_keep_calls(q, why, room))
    return AMBIT_UNABLE;
  return AMBIT_OK;
}

static const ambit_sandbox_service service = { sizeof service, enter };
static const void *get(const char *id) { return strcmp(id, AMBIT_SANDBOX_SERVICE) == 0 ? &service : NULL; }
AMBIT_EXPORT const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "service.sandbox", "1.0",
  "Shuts a process in before it runs what a stranger wrote: files by Landlock, system calls by seccomp.", get };
