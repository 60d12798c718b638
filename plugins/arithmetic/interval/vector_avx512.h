/* vector_avx512.h -- eight doubles (AVX-512 F, DQ, VL); masks are bits. Contracts: vector.h, vector_two.h. */
#ifndef VECTOR_AVX512_H
#define VECTOR_AVX512_H

typedef unsigned mask; /* bits above the eighth mean nothing */
#define FIRST_HALVES ((mask)0x55)

INLINE mask equal(vector a, vector b) { return _mm512_cmp_pd_mask(a, b, _CMP_EQ_OQ); }
INLINE mask above(vector a, vector b) { return _mm512_cmp_pd_mask(a, b, _CMP_GT_OQ); }
INLINE mask reaches(vector a, vector b) { return _mm512_cmp_pd_mask(a, b, _CMP_GE_OQ); }
INLINE vector choose(mask m, vector yes, vector no) { return _mm512_mask_blend_pd((__mmask8)m, no, yes); }
INLINE vector keep(mask m, vector v) { return _mm512_maskz_mov_pd((__mmask8)m, v); }
INLINE int any(mask m) { return (m & 0xffu) != 0; }
INLINE mask swap_mask(mask m) { return ((m & 0x55u) << 1) | ((m & 0xaau) >> 1); }
INLINE vector bits_below(vector v, mask m) {
  return (vector)_mm512_mask_sub_epi64((__m512i)v, (__mmask8)m, (__m512i)v, _mm512_set1_epi64(1));
}

INLINE vector root(vector a) { return _mm512_sqrt_pd(a); }

INLINE vector swap(vector x) { return _mm512_permute_pd(x, 0x55); }
INLINE vector first(vector x) { return _mm512_movedup_pd(x); }
INLINE vector second(vector x) { return _mm512_permute_pd(x, 0xff); }
INLINE vector firsts(vector x, vector y) { return _mm512_unpacklo_pd(x, y); }
INLINE vector seconds(vector x, vector y) { return _mm512_unpackhi_pd(x, y); }

INLINE vector load_pair(const double *p) { return _mm512_broadcast_f64x2(_mm_loadu_pd(p)); }
INLINE vector load_some(const double *p, size_t n) {
  return _mm512_mask_loadu_pd(load_pair(p), (__mmask8)((1u << (2 * n)) - 1), p);
}
INLINE void store_some(double *p, size_t n, vector v) { _mm512_mask_storeu_pd(p, (__mmask8)((1u << (2 * n)) - 1), v); }
INLINE vector load_pairs(const double *p, ptrdiff_t step) {
  __m256d low = _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(p)), _mm_loadu_pd(p + step), 1);
  __m256d high =
      _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(p + 2 * step)), _mm_loadu_pd(p + 3 * step), 1);
  return _mm512_insertf64x4(_mm512_castpd256_pd512(low), high, 1);
}
INLINE vector gather_pairs(const double *slots, size_t pitch, const uint32_t *i) {
  __m256d low = _mm256_insertf128_pd(
      _mm256_castpd128_pd256(_mm_loadu_pd(slots + pitch * i[0])), _mm_loadu_pd(slots + pitch * i[1]), 1);
  __m256d high = _mm256_insertf128_pd(
      _mm256_castpd128_pd256(_mm_loadu_pd(slots + pitch * i[2])), _mm_loadu_pd(slots + pitch * i[3]), 1);
  return _mm512_insertf64x4(_mm512_castpd256_pd512(low), high, 1);
}
INLINE void scatter_pairs(double *slots, size_t pitch, const uint32_t *i, vector v) {
  _mm_storeu_pd(slots + pitch * i[0], _mm512_castpd512_pd128(v));
  _mm_storeu_pd(slots + pitch * i[1], _mm512_extractf64x2_pd(v, 1));
  _mm_storeu_pd(slots + pitch * i[2], _mm512_extractf64x2_pd(v, 2));
  _mm_storeu_pd(slots + pitch * i[3], _mm512_extractf64x2_pd(v, 3));
}
INLINE vector only_pair(size_t i, vector v) { return _mm512_maskz_mov_pd((__mmask8)(3u << (2 * i)), v); }
#endif
