/* memory.h -- how much memory this process may still take, so that a request beyond it is refused instead of killed. */
#ifndef AMBIT_MEMORY_H
#define AMBIT_MEMORY_H
#include <stdbool.h>
#include <stddef.h>

/* Bytes: the least of what the machine has available, what the control group allows and what RLIMIT_AS leaves;
** SIZE_MAX if the system tells none of them. */
size_t ambit_memory_available(void);

/* Can so many bytes be taken? Sizes that every machine has are granted without asking the system. */
bool ambit_memory_allows(size_t bytes);
#endif
