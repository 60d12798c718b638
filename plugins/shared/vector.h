/* vector.h -- vectors of doubles for the instruction set of the including file: WIDTH is 8 with AVX-512 (F, DQ, VL), 4
** with AVX2, otherwise 2 (SSE2 on x86-64, compiler vectors elsewhere). VECTOR_MOST, if defined, is the most.
**
** Intrinsics where there are some: gcc 12 takes compared and combined compiler vectors apart, element by element.
** `larger_each` and `smaller_each` return their second operand if one is NaN, and so may lose NaN: who calls them has
** removed NaN before. Products with a sum are rounded once where there is FMA, else twice: upper bounds in upward
** mode either way.
*/
#ifndef SHARED_VECTOR_H
#define SHARED_VECTOR_H
#include <stdint.h>
#include <string.h>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#ifndef VECTOR_MOST
#define VECTOR_MOST 8
#endif
#if VECTOR_MOST >= 8 && defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__) && defined(__FMA__)
#define WIDTH 8
#elif VECTOR_MOST >= 4 && defined(__AVX2__)
#define WIDTH 4
#else
#define WIDTH 2
#endif
#define INLINE static inline __attribute__((always_inline))

typedef double vector __attribute__((vector_size(8 * WIDTH)));
typedef int64_t words __attribute__((vector_size(8 * WIDTH)));

INLINE vector load(const double *p) {
  vector v;
  memcpy(&v, p, sizeof v);
  return v;
}
INLINE void store(double *p, vector v) { memcpy(p, &v, sizeof v); }
INLINE vector magnitude(vector x) { return (vector)((words)x & INT64_MAX); }
INLINE vector flip(vector x, words sign) { return (vector)((words)x ^ sign); }

#if WIDTH == 8
INLINE vector splat(double x) { return (vector)_mm512_set1_pd(x); }
INLINE words splat_words(int64_t x) { return (words)_mm512_set1_epi64(x); }
INLINE vector larger_each(vector a, vector b) { return (vector)_mm512_max_pd(a, b); }
INLINE vector smaller_each(vector a, vector b) { return (vector)_mm512_min_pd(a, b); }
INLINE vector multiply_add(vector a, vector b, vector c) { return (vector)_mm512_fmadd_pd(a, b, c); }
INLINE vector subtract_product(vector a, vector b, vector c) { return (vector)_mm512_fnmadd_pd(a, b, c); }
#elif WIDTH == 4
INLINE vector splat(double x) { return (vector)_mm256_set1_pd(x); }
INLINE words splat_words(int64_t x) { return (words)_mm256_set1_epi64x(x); }
INLINE vector larger_each(vector a, vector b) { return (vector)_mm256_max_pd(a, b); }
INLINE vector smaller_each(vector a, vector b) { return (vector)_mm256_min_pd(a, b); }
#else
INLINE vector splat(double x) { return (vector) { x, x }; }
INLINE words splat_words(int64_t x) { return (words) { x, x }; }
#if defined(__SSE2__)
INLINE vector larger_each(vector a, vector b) { return (vector)_mm_max_pd(a, b); }
INLINE vector smaller_each(vector a, vector b) { return (vector)_mm_min_pd(a, b); }
#else
INLINE vector larger_each(vector a, vector b) {
  return (vector) { a[0] > b[0] ? a[0] : b[0], a[1] > b[1] ? a[1] : b[1] };
}
INLINE vector smaller_each(vector a, vector b) {
  return (vector) { a[0] < b[0] ? a[0] : b[0], a[1] < b[1] ? a[1] : b[1] };
}
#endif
#endif

/* c + a b and c - a b */
#if WIDTH == 4 && defined(__FMA__)
INLINE vector multiply_add(vector a, vector b, vector c) { return (vector)_mm256_fmadd_pd(a, b, c); }
INLINE vector subtract_product(vector a, vector b, vector c) { return (vector)_mm256_fnmadd_pd(a, b, c); }
#elif WIDTH < 8
INLINE vector multiply_add(vector a, vector b, vector c) { return a * b + c; }
INLINE vector subtract_product(vector a, vector b, vector c) { return (-a) * b + c; }
#endif
#endif
