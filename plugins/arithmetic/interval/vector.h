/* vector.h -- what the kernels need of vectors besides shared/vector.h.
**
** An element of the arithmetic is a pair, so a vector holds WIDTH / 2 of them. A mask has a truth value for each
** double, and & | ~ for all.
*/
#ifndef VECTOR_H
#define VECTOR_H
#include "shared/vector.h"
#include <math.h>

#define PAIRS (WIDTH / 2)

INLINE void store_pair(double *p, vector v) { memcpy(p, &v, 2 * sizeof *p); }

#if WIDTH == 8
#include "vector_avx512.h"
#elif WIDTH == 4
#include "vector_avx2.h"
#else
#include "vector_two.h"
#endif
#endif
