/* vector.c -- growth by doubling. */
#include "base/vector.h"
#include <stdint.h>
#include <stdlib.h>

void *ambit_vector_reserve(void *array, size_t *capacity, size_t need, size_t element) {
  if (need <= *capacity) return array;
  size_t room = *capacity ? *capacity : 8;
  while (room < need) {
    if (room > SIZE_MAX / 2) return NULL;
    room *= 2;
  }
  if (room > SIZE_MAX / element) return NULL;
  void *grown = realloc(array, room * element);
  if (grown) *capacity = room;
  return grown;
}
