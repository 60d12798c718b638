/* quasi_random.h -- "ambit.quasi_random/1": sequences of points that fill the unit cube more evenly than random ones
** do. The plugin service/quasi_random.so is loaded when something is drawn; without it the kernel's own pseudo-random
** generator draws.
*/
#ifndef AMBIT_QUASI_RANDOM_SERVICE_H
#define AMBIT_QUASI_RANDOM_SERVICE_H
#include "base.h"

#define AMBIT_QUASI_RANDOM_SERVICE "ambit.quasi_random/1"

typedef struct ambit_quasi_random_service {
  uint32_t size;
  /* [any] the most dimensions and points of "sobol", "niederreiter", "halton", "reverse_halton"; of others 0, 0 */
  void (*most)(const char *sequence, uint32_t *dimensions, uint64_t *points);
  /* [any] a sequence of n dimensions before its first point. INVALID: none of that name and size; NOMEM */
  ambit_status (*open)(const char *sequence, uint32_t n, void **self);
  /* [ctx] its next `count` points: coordinate i of point k, in [0, 1), is point[i * stride + k]. No allocation.
  ** UNABLE: there are no more points */
  ambit_status (*next)(void *self, size_t count, double *point, size_t stride);
  void (*close)(void *self);
} ambit_quasi_random_service;
#endif
