/* vector_avx2.h -- four doubles (AVX2 and FMA). Contracts: vector.h, vector_two.h. */
#ifndef VECTOR_AVX2_H
#define VECTOR_AVX2_H

typedef words mask; /* all ones or zero in each element */
#define FIRST_HALVES ((mask) { -1, 0, -1, 0 })

INLINE mask equal(vector a, vector b) { return (mask)_mm256_cmp_pd(a, b, _CMP_EQ_OQ); }
INLINE mask above(vector a, vector b) { return (mask)_mm256_cmp_pd(a, b, _CMP_GT_OQ); }
INLINE mask reaches(vector a, vector b) { return (mask)_mm256_cmp_pd(a, b, _CMP_GE_OQ); }
INLINE vector choose(mask m, vector yes, vector no) { return _mm256_blendv_pd(no, yes, (vector)m); }
INLINE vector keep(mask m, vector v) { return (vector)(m & (mask)v); }
INLINE int any(mask m) { return _mm256_movemask_pd((vector)m) != 0; }
INLINE mask swap_mask(mask m) { return __builtin_shufflevector(m, m, 1, 0, 3, 2); }
INLINE vector bits_below(vector v, mask m) { return (vector)((words)v + m); }

INLINE vector root(vector a) { return _mm256_sqrt_pd(a); }

INLINE vector swap(vector x) { return __builtin_shufflevector(x, x, 1, 0, 3, 2); }
INLINE vector first(vector x) { return __builtin_shufflevector(x, x, 0, 0, 2, 2); }
INLINE vector second(vector x) { return __builtin_shufflevector(x, x, 1, 1, 3, 3); }
INLINE vector firsts(vector x, vector y) { return _mm256_unpacklo_pd(x, y); }
INLINE vector seconds(vector x, vector y) { return _mm256_unpackhi_pd(x, y); }

INLINE vector load_two(const double *p) { return _mm256_zextpd128_pd256(_mm_loadu_pd(p)); }
INLINE vector load_one(const double *p) { return _mm256_zextpd128_pd256(_mm_load_sd(p)); }
INLINE vector two_pairs(const double *p, const double *q) {
  return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(p)), _mm_loadu_pd(q), 1);
}
INLINE vector load_pair(const double *p) { return two_pairs(p, p); }
INLINE vector load_some(const double *p, size_t n) { return (void)n, load_pair(p); }
INLINE void store_some(double *p, size_t n, vector v) { (void)n, store_pair(p, v); }
INLINE vector load_pairs(const double *p, ptrdiff_t step) { return two_pairs(p, p + step); }
INLINE vector gather_pairs(const double *slots, size_t pitch, const uint32_t *i) {
  return two_pairs(slots + pitch * i[0], slots + pitch * i[1]);
}
INLINE void scatter_pairs(double *slots, size_t pitch, const uint32_t *i, vector v) {
  _mm_storeu_pd(slots + pitch * i[0], _mm256_castpd256_pd128(v));
  _mm_storeu_pd(slots + pitch * i[1], _mm256_extractf128_pd(v, 1));
}
INLINE vector only_pair(size_t i, vector v) {
  vector none = splat(0);
  return i ? _mm256_blend_pd(none, v, 12) : _mm256_blend_pd(none, v, 3);
}
#endif
