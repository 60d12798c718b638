/* product_lanes.h -- four or two doubles side by side, as the flags of the including file allow.
**
** In upward mode add_product and subtract_product are upper bounds of c + a b and c - a b, rounded once with FMA and
** twice without.
*/
#ifndef AMBIT_PRODUCT_LANES_H
#define AMBIT_PRODUCT_LANES_H
#include <stdint.h>
#include <string.h>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#if defined(__AVX2__) && defined(__FMA__)
#define LANES 4
#else
#define LANES 2
#endif
#define INLINE static inline __attribute__((always_inline))

typedef double lanes __attribute__((vector_size(8 * LANES)));
typedef int64_t words __attribute__((vector_size(8 * LANES)));

INLINE lanes load(const double *p) {
  lanes v;
  memcpy(&v, p, sizeof v);
  return v;
}
INLINE void store(double *p, lanes v) { memcpy(p, &v, sizeof v); }
/* v, loaded once: gcc would load it again for each use, and loads are what the sums wait for */
INLINE lanes held(lanes v) {
#if LANES == 4
  __asm__("" : "+x"(v));
#endif
  return v;
}
INLINE lanes magnitude(lanes x) { return (lanes)((words)x & INT64_MAX); }

#if LANES == 4
INLINE lanes all(double x) { return _mm256_set1_pd(x); }
INLINE lanes larger(lanes a, lanes b) { return _mm256_max_pd(a, b); }
INLINE lanes add_product(lanes a, lanes b, lanes c) { return _mm256_fmadd_pd(a, b, c); }
INLINE lanes subtract_product(lanes a, lanes b, lanes c) { return _mm256_fnmadd_pd(a, b, c); }
typedef words mask; /* all ones or zero for each double */
INLINE mask below(lanes a, lanes b) { return (mask)_mm256_cmp_pd(a, b, _CMP_LT_OQ); }
INLINE mask reaches(lanes a, lanes b) { return (mask)_mm256_cmp_pd(a, b, _CMP_GE_OQ); }
INLINE mask everywhere(void) { return (mask) { -1, -1, -1, -1 }; }
INLINE int is_everywhere(mask m) { return _mm256_movemask_pd((lanes)m) == 15; }
INLINE __m256i first_words(size_t n) {
  static const int64_t mask[7] = { -1, -1, -1, 0, 0, 0, 0 };
  return _mm256_loadu_si256((const __m256i *)(const void *)(mask + 3 - n));
}
INLINE lanes first_of(lanes v, size_t n) { return _mm256_and_pd(v, (lanes)first_words(n)); }
INLINE lanes load_some(const double *p, size_t n) { return _mm256_maskload_pd(p, first_words(n)); }
INLINE void store_some(double *p, size_t n, lanes v) { _mm256_maskstore_pd(p, first_words(n), v); }
#else
INLINE lanes all(double x) { return (lanes) { x, x }; }
typedef words mask; /* all ones or zero for each double; comparisons are false for NaN */
#if defined(__SSE2__)
INLINE lanes larger(lanes a, lanes b) { return _mm_max_pd(a, b); }
INLINE mask below(lanes a, lanes b) { return (mask)_mm_cmplt_pd(a, b); }
INLINE mask reaches(lanes a, lanes b) { return (mask)_mm_cmpge_pd(a, b); }
#else
INLINE lanes larger(lanes a, lanes b) { return (lanes) { a[0] > b[0] ? a[0] : b[0], a[1] > b[1] ? a[1] : b[1] }; }
INLINE mask below(lanes a, lanes b) { return (mask)(a < b); }
INLINE mask reaches(lanes a, lanes b) { return (mask)(a >= b); }
#endif
INLINE mask everywhere(void) { return (mask) { -1, -1 }; }
INLINE int is_everywhere(mask m) { return (m[0] & m[1]) != 0; }
INLINE lanes add_product(lanes a, lanes b, lanes c) { return a * b + c; }
INLINE lanes subtract_product(lanes a, lanes b, lanes c) { return (-a) * b + c; }
/* the first n < LANES; 0 elsewhere */
INLINE lanes first_of(lanes v, size_t n) { return (void)n, (lanes) { v[0], 0 }; }
INLINE lanes load_some(const double *p, size_t n) { return (void)n, (lanes) { p[0], 0 }; }
INLINE void store_some(double *p, size_t n, lanes v) { (void)n, *p = v[0]; }
#endif
#endif
