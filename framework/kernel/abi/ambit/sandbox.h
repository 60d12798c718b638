/* sandbox.h -- "ambit.sandbox/1": shuts the calling process in, for good, before it runs what a stranger wrote. The
** plugin service/sandbox.so is loaded by `ambit ... --sandbox` and by nothing else.
*/
#ifndef AMBIT_SANDBOX_H
#define AMBIT_SANDBOX_H
#include "base.h"
#include <stddef.h>

#define AMBIT_SANDBOX_SERVICE "ambit.sandbox/1"

typedef struct ambit_sandbox_request {
  uint32_t size;
  uint32_t children; /* 1: processes may be forked; no program may be started in any case */
  size_t nread, nwrite;
  const char *const *read; /* files, and folders with all in them, that may be read; those that do not exist: nothing */
  const char *const *write; /* folders in which files may be made, written and replaced */
} ambit_sandbox_request;

typedef struct ambit_sandbox_service {
  uint32_t size;
  /* [main thread, before others are made] From now on, for this process and all that come of it: no file beyond those
  ** of the request, no network, no program, no look into other processes, no new rights.
  ** OK: all of that; *files := 0 if the system cannot keep files from a process (Linux before 5.13, without Landlock).
  ** UNABLE, and why: the process is not shut in. */
  ambit_status (*enter)(const ambit_sandbox_request *q, int *files, char *why, size_t room);
} ambit_sandbox_service;
#endif
