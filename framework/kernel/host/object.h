/* object.h -- is this file a shared object that the loader can map? Asked before dlopen, which may crash on a
** truncated one. */
#ifndef AMBIT_OBJECT_H
#define AMBIT_OBJECT_H
#include <stdbool.h>
#include <stddef.h>

/* false: `reason` (room bytes) says why: no such file, not ELF, truncated, another machine. */
bool ambit_object_check(const char *file, char *reason, size_t room);
#endif
