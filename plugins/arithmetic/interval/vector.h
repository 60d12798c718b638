/* vector.h -- the few vector operations that the kernels are written in, for the instruction set of the including file.
**
** Four doubles with AVX2 and FMA, otherwise two (SSE2 on x86-64, compiler vectors elsewhere). `larger` returns its
** second operand if the first is NaN, and so loses NaN: kernels remove NaN before.
*/
#ifndef VECTOR_H
#define VECTOR_H
#include <math.h>
#include <stdint.h>
#include <string.h>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#if defined(__AVX2__) && defined(__FMA__)
#define WIDTH 4
#else
#define WIDTH 2
#endif

typedef double vector __attribute__((vector_size(8 * WIDTH)));
typedef int64_t mask __attribute__((vector_size(8 * WIDTH))); /* all ones or zero in each element */

static inline vector load(const double *p) {
  vector v;
  memcpy(&v, p, sizeof v);
  return v;
}

static inline void store(double *p, vector v) { memcpy(p, &v, sizeof v); }

/* Intrinsics where there are some: gcc 12 takes compared and combined compiler vectors apart, element by element. */
#if WIDTH == 4
static inline mask equal(vector a, vector b) { return (mask)_mm256_cmp_pd(a, b, _CMP_EQ_OQ); }
static inline mask above(vector a, vector b) { return (mask)_mm256_cmp_pd(a, b, _CMP_GT_OQ); } /* false for NaN */
static inline mask reaches(vector a, vector b) { return (mask)_mm256_cmp_pd(a, b, _CMP_GE_OQ); }
static inline vector choose(mask m, vector yes, vector no) { return _mm256_blendv_pd(no, yes, (vector)m); }
#elif defined(__SSE2__)
static inline mask equal(vector a, vector b) { return (mask)_mm_cmpeq_pd(a, b); }
static inline mask above(vector a, vector b) { return (mask)_mm_cmpgt_pd(a, b); } /* false for NaN */
static inline mask reaches(vector a, vector b) { return (mask)_mm_cmpge_pd(a, b); }
static inline vector choose(mask m, vector yes, vector no) {
  return _mm_or_pd(_mm_and_pd((vector)m, yes), _mm_andnot_pd((vector)m, no));
}
#else
static inline mask equal(vector a, vector b) { return (mask)(a == b); }
static inline mask above(vector a, vector b) { return (mask)(a > b); } /* false for NaN */
static inline mask reaches(vector a, vector b) { return (mask)(a >= b); }
static inline vector choose(mask m, vector yes, vector no) { return (vector)((m & (mask)yes) | (~m & (mask)no)); }
#endif
static inline vector keep(mask m, vector v) { return (vector)(m & (mask)v); } /* 0 elsewhere */

#if WIDTH == 4
static inline vector splat(double x) { return (vector) { x, x, x, x }; }
static inline vector larger(vector a, vector b) { return _mm256_max_pd(a, b); }
static inline vector smaller(vector a, vector b) { return _mm256_min_pd(a, b); }
static inline vector root(vector a) { return _mm256_sqrt_pd(a); }
static inline vector multiply_add(vector a, vector b, vector c) { return _mm256_fmadd_pd(a, b, c); } /* rounded once */
static inline int any(mask m) { return _mm256_movemask_pd((vector)m) != 0; }
/* pairs of elements: the two halves exchanged; the first; the second */
static inline vector swap(vector x) { return __builtin_shufflevector(x, x, 1, 0, 3, 2); }
static inline vector first(vector x) { return __builtin_shufflevector(x, x, 0, 0, 2, 2); }
static inline vector second(vector x) { return __builtin_shufflevector(x, x, 1, 1, 3, 3); }
static inline vector load_pair(const double *p) { return (vector) { p[0], p[1], p[0], p[1] }; }
#define FIRST_HALVES ((mask) { -1, 0, -1, 0 })
#else
static inline vector splat(double x) { return (vector) { x, x }; }
#if defined(__SSE2__)
static inline vector larger(vector a, vector b) { return _mm_max_pd(a, b); }
static inline vector smaller(vector a, vector b) { return _mm_min_pd(a, b); }
static inline vector root(vector a) { return _mm_sqrt_pd(a); }
#else
static inline vector larger(vector a, vector b) { return choose(above(a, b), a, b); }
static inline vector smaller(vector a, vector b) { return choose(above(b, a), a, b); }
static inline vector root(vector a) { return (vector) { sqrt(a[0]), sqrt(a[1]) }; }
#endif
static inline vector multiply_add(vector a, vector b, vector c) { return a * b + c; } /* rounded twice */
static inline int any(mask m) { return (m[0] | m[1]) != 0; }
static inline vector swap(vector x) { return __builtin_shufflevector(x, x, 1, 0); }
static inline vector first(vector x) { return __builtin_shufflevector(x, x, 0, 0); }
static inline vector second(vector x) { return __builtin_shufflevector(x, x, 1, 1); }
static inline vector load_pair(const double *p) { return load(p); }
#define FIRST_HALVES ((mask) { -1, 0 })
#endif

static inline void store_pair(double *p, vector v) { memcpy(p, &v, 2 * sizeof *p); }
static inline vector magnitude(vector x) { return (vector)((mask)x & INT64_MAX); }
#endif
