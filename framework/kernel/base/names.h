/* names.h -- the nearest known name, for "did you mean" in messages. */
#ifndef AMBIT_NAMES_H
#define AMBIT_NAMES_H
#include <stddef.h>

/* The candidate with the smallest edit distance to `name` if that is at most one more than a third of its length,
** else NULL. */
const char *ambit_names_nearest(const char *name, const char *const *candidate, size_t count);
#endif
