/* vector.h -- what the kernels need of vectors besides shared/vector.h: masks, rows, and sums of elements. */
#ifndef VECTOR_H
#define VECTOR_H
#include "shared/vector.h"
#include <math.h>

INLINE words load_mask(const int64_t *p) {
  words v;
  memcpy(&v, p, sizeof v);
  return v;
}
INLINE vector negated(vector x) { return flip(x, splat_words(INT64_MIN)); }

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
