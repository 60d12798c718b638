/* vector.h -- growing arrays: reserve before each append. */
#ifndef AMBIT_VECTOR_H
#define AMBIT_VECTOR_H
#include <stddef.h>

/* Returns the array with room for `need` elements, its capacity doubled as needed; NULL: out of memory, array
** unchanged. */
void *ambit_vector_reserve(void *array, size_t *capacity, size_t need, size_t element);
#endif
