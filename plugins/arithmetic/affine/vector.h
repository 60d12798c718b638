/* vector.h -- what the passes need of vectors besides shared/vector.h: pairs, and sums of elements. */
#ifndef VECTOR_H
#define VECTOR_H
#include "shared/vector.h"

/* two bounds side by side */
typedef double pair __attribute__((vector_size(16)));

static inline pair load_pair(const double *p) {
  pair v;
  memcpy(&v, p, sizeof v);
  return v;
}
static inline void store_pair(double *p, pair v) { memcpy(p, &v, sizeof v); }
static inline pair both(double x) { return (pair) { x, x }; }
#if defined(__SSE2__)
static inline pair larger_pair(pair a, pair b) { return (pair)_mm_max_pd((__m128d)a, (__m128d)b); }
static inline pair smaller_pair(pair a, pair b) { return (pair)_mm_min_pd((__m128d)a, (__m128d)b); }
#else
static inline pair larger_pair(pair a, pair b) {
  return (pair) { a[0] > b[0] ? a[0] : b[0], a[1] > b[1] ? a[1] : b[1] };
}
static inline pair smaller_pair(pair a, pair b) {
  return (pair) { a[0] < b[0] ? a[0] : b[0], a[1] < b[1] ? a[1] : b[1] };
}
#endif

/* a sum of the elements, in upward mode rounded upward */
static inline double total(vector x) {
#if WIDTH == 8
  __m256d lower = _mm512_castpd512_pd256((__m512d)x), upper = _mm512_extractf64x4_pd((__m512d)x, 1);
  __m256d half = _mm256_add_pd(lower, upper);
  __m128d last = _mm_add_pd(_mm256_castpd256_pd128(half), _mm256_extractf128_pd(half, 1));
  return last[0] + last[1];
#elif WIDTH == 4
  return (x[0] + x[2]) + (x[1] + x[3]);
#else
  return x[0] + x[1];
#endif
}

/* four of them at once */
typedef struct totals {
  double a, b, c, d;
} totals;

static inline totals total_each(vector a, vector b, vector c, vector d) {
#if WIDTH >= 4
#if WIDTH == 8
  __m256d a4 = _mm512_castpd512_pd256((__m512d)a) + _mm512_extractf64x4_pd((__m512d)a, 1);
  __m256d b4 = _mm512_castpd512_pd256((__m512d)b) + _mm512_extractf64x4_pd((__m512d)b, 1);
  __m256d c4 = _mm512_castpd512_pd256((__m512d)c) + _mm512_extractf64x4_pd((__m512d)c, 1);
  __m256d d4 = _mm512_castpd512_pd256((__m512d)d) + _mm512_extractf64x4_pd((__m512d)d, 1);
#else
  __m256d a4 = (__m256d)a, b4 = (__m256d)b, c4 = (__m256d)c, d4 = (__m256d)d;
#endif
  __m256d ab = _mm256_unpacklo_pd(a4, b4) + _mm256_unpackhi_pd(a4, b4);
  __m256d cd = _mm256_unpacklo_pd(c4, d4) + _mm256_unpackhi_pd(c4, d4);
  __m128d first = _mm256_castpd256_pd128(ab) + _mm256_extractf128_pd(ab, 1);
  __m128d second = _mm256_castpd256_pd128(cd) + _mm256_extractf128_pd(cd, 1);
  return (totals) { first[0], first[1], second[0], second[1] };
#else
  return (totals) { total(a), total(b), total(c), total(d) };
#endif
}

#endif
