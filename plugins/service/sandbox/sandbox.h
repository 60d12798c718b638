/* sandbox.h -- what the files of the sandbox service share. Each returns 1, or 0 and why not in text [room]. */
#ifndef SANDBOX_H
#define SANDBOX_H
#include <ambit/sandbox.h>

/* files.c, by Landlock: no file but those of the request, and no TCP. *kept := 0 if the system has no Landlock. */
int sandbox_keep_files(const ambit_sandbox_request *q, int *kept, char *text, size_t room);
/* calls.c, by seccomp: the system calls that a computation needs, and no others. */
int sandbox_keep_calls(const ambit_sandbox_request *q, char *text, size_t room);
#endif
