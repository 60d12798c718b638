/* vector.h -- the few vector operations that the kernels need, for the instruction set of the including file. */
#ifndef VECTOR_H
#define VECTOR_H
#include <math.h>
#include <stdint.h>
#include <string.h>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#if defined(__AVX512F__) && defined(__AVX512DQ__)
#define WIDTH 8
#elif defined(__AVX2__) && defined(__FMA__)
#define WIDTH 4
#else
#define WIDTH 2
#endif

typedef double vector __attribute__((vector_size(8 * WIDTH)));
typedef int64_t mask __attribute__((vector_size(8 * WIDTH)));

static inline vector load(const double *p) {
  vector v;
  memcpy(&v, p, sizeof v);
  return v;
}
static inline mask load_mask(const int64_t *p) {
  mask v;
  memcpy(&v, p, sizeof v);
  return v;
}
static inline void store(double *p, vector v) { memcpy(p, &v, sizeof v); }
static inline vector magnitude(vector x) { return (vector)((mask)x & INT64_MAX); }
static inline vector negated(vector x) { return (vector)((mask)x ^ INT64_MIN); }

#if WIDTH == 8
static inline vector splat(double x) { return _mm512_set1_pd(x); }
static inline vector multiply_add(vector a, vector b, vector c) { return _mm512_fmadd_pd(a, b, c); }
static inline vector larger(vector a, vector b) { return _mm512_max_pd(a, b); }
#elif WIDTH == 4
static inline vector splat(double x) { return _mm256_set1_pd(x); }
static inline vector multiply_add(vector a, vector b, vector c) { return _mm256_fmadd_pd(a, b, c); }
static inline vector larger(vector a, vector b) { return _mm256_max_pd(a, b); }
#else
static inline vector splat(double x) { return (vector) { x, x }; }
static inline vector multiply_add(vector a, vector b, vector c) { return a * b + c; } /* rounded twice */
#if defined(__SSE2__)
static inline vector larger(vector a, vector b) { return _mm_max_pd(a, b); }
#else
static inline vector larger(vector a, vector b) {
  return (vector) { a[0] > b[0] ? a[0] : b[0], a[1] > b[1] ? a[1] : b[1] };
}
#endif
#endif

/* Rows are short: 512-bit vectors would be half empty, and are no faster. */
#if WIDTH > 2
#define ROW_WIDTH 4
typedef __m256d row_vector;
static inline row_vector row_load(const double *p) { return _mm256_loadu_pd(p); }
static inline void row_store(double *p, row_vector v) { _mm256_storeu_pd(p, v); }
static inline row_vector row_splat(double x) { return _mm256_set1_pd(x); }
static inline row_vector row_multiply_add(row_vector a, row_vector b, row_vector c) { return _mm256_fmadd_pd(a, b, c); }
#else
#define ROW_WIDTH WIDTH
typedef vector row_vector;
static inline row_vector row_load(const double *p) { return load(p); }
static inline void row_store(double *p, row_vector v) { store(p, v); }
static inline row_vector row_splat(double x) { return splat(x); }
static inline row_vector row_multiply_add(row_vector a, row_vector b, row_vector c) { return multiply_add(a, b, c); }
#endif

#if WIDTH > 2
static inline double multiply_add_one(double a, double b, double c) { return __builtin_fma(a, b, c); }
#else
static inline double multiply_add_one(double a, double b, double c) { return a * b + c; }
#endif

/* the sum of the elements, in some order */
static inline double total(vector v) {
  double sum = v[0];
  for (int i = 1; i < WIDTH; i++) sum += v[i];
  return sum;
}
#endif
