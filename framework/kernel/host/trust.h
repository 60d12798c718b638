/* trust.h -- which files may speak in this process: those that nobody but their user can have changed.
**
** A file is trusted if it and every folder above it, by their real names, belong to root, to the user, or to the owner
** of the file that the kernel is in (the command, the Lua module, or libambit in other programs), and nobody else may
** write there (a sticky folder such as /tmp is good: what lies in it cannot be replaced by others). Folders that hold
** that file too are not looked at: whoever can write there can replace Ambit itself. What was allowed holds for the
** whole process, as what is loaded does; it only grows. [any]
*/
#ifndef AMBIT_TRUST_H
#define AMBIT_TRUST_H
#include <ambit/registry.h>
#include <stdbool.h>
#include <sys/stat.h>

bool ambit_trust_has_shadows(void);
/* Calls back for each folder that is trusted. */
void ambit_trust_each(void (*tell)(void *user, const char *folder), void *user);

/* false: `reason` says who may write where, and what to do. */
bool ambit_trust_file(const char *file, char *reason, size_t room);

/* The real name of the file that the kernel is in; NULL: not known. free() it. */
char *ambit_trust_kernel(void);

/* Is it the same file, unchanged? By device, number, size, and when data and status changed. */
bool ambit_trust_same(const struct stat *a, const struct stat *b);
#endif
