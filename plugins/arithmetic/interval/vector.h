/* vector.h -- the few vector operations that the kernels are written in, for the instruction set of the including file.
**
** Eight doubles with AVX-512, four with AVX2 and FMA, otherwise two (SSE2 on x86-64, compiler vectors elsewhere). An
** element of the arithmetic is a pair, so a vector holds WIDTH / 2 of them. `larger` returns its second operand if one
** is NaN, and so may lose NaN: kernels remove NaN before. A mask has a truth value for each double, and & | ~ for all.
*/
#ifndef VECTOR_H
#define VECTOR_H
#include <math.h>
#include <stdint.h>
#include <string.h>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__) && defined(__FMA__)
#define WIDTH 8
#elif defined(__AVX2__) && defined(__FMA__)
#define WIDTH 4
#else
#define WIDTH 2
#endif
#define PAIRS (WIDTH / 2)
#define INLINE static inline __attribute__((always_inline))

typedef double vector __attribute__((vector_size(8 * WIDTH)));
typedef int64_t words __attribute__((vector_size(8 * WIDTH)));

INLINE vector load(const double *p) {
  vector v;
  memcpy(&v, p, sizeof v);
  return v;
}

INLINE void store(double *p, vector v) { memcpy(p, &v, sizeof v); }
INLINE void store_pair(double *p, vector v) { memcpy(p, &v, 2 * sizeof *p); }
INLINE vector magnitude(vector x) { return (vector)((words)x & INT64_MAX); }

/* Intrinsics where there are some: gcc 12 takes compared and combined compiler vectors apart, element by element. */
#if WIDTH == 8
#include "vector_avx512.h"
#elif WIDTH == 4
#include "vector_avx2.h"
#else
#include "vector_two.h"
#endif
#endif
