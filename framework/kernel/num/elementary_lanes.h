/* elementary_lanes.h -- doubles side by side: one source for 1, 2, 4 and 8 lanes.
**
** A file sets AMBIT_LANES and includes this. Only + - * / sqrt and comparisons of doubles, integer operations on
** their bits, and an exact product are used; each is correctly rounded or exact, so that every width gives the same
** bits. The product of two doubles is exact by FMA where the compiler has it, else by Dekker's splitting (T. J.
** Dekker, Numer. Math. 18, 1971), which gives the same pair as long as nothing over- or underflows; the kernels see
** to that. Round-to-nearest, no flush-to-zero.
*/
#ifndef AMBIT_ELEMENTARY_LANES_H
#define AMBIT_ELEMENTARY_LANES_H
#include <stdint.h>
#include <string.h>
#if defined(__SSE2__)
#include <immintrin.h>
#endif
#if defined(__SSE2__) && defined(__FMA__)
#define HAVE_FMA 1
#endif
#ifdef __FAST_MATH__
#error "error-free transformations need IEEE arithmetic"
#endif
#if defined(__FLT_EVAL_METHOD__) && __FLT_EVAL_METHOD__ != 0
#error "error-free transformations need doubles without excess precision"
#endif

#define INLINE static inline __attribute__((always_inline))

#if AMBIT_LANES == 1
typedef double lanes;
typedef uint64_t bits; /* integers modulo 2^64, or masks: all ones or zero */
typedef int64_t signed_bits;
INLINE bits to_bits(lanes a) {
  bits i;
  memcpy(&i, &a, sizeof i);
  return i;
}
INLINE lanes to_lanes(bits i) {
  lanes a;
  memcpy(&a, &i, sizeof a);
  return a;
}
INLINE lanes all(double a) { return a; }
INLINE bits all_bits(int64_t a) { return (bits)a; }
INLINE lanes load(const double *p) { return *p; }
INLINE void store(double *p, lanes a) { *p = a; }
INLINE bits less(lanes a, lanes b) { return -(bits)(a < b); }
INLINE bits less_equal(lanes a, lanes b) { return -(bits)(a <= b); }
INLINE bits bits_less(bits a, bits b) { return -(bits)((signed_bits)a < (signed_bits)b); }
INLINE bits bits_equal(bits a, bits b) { return -(bits)(a == b); }
INLINE lanes choose(bits mask, lanes a, lanes b) { return mask ? a : b; }
INLINE int any(bits mask) { return mask != 0; }
INLINE lanes square_root(lanes a) { return __builtin_sqrt(a); }
#ifdef HAVE_FMA
INLINE lanes product_error(lanes a, lanes b, lanes p) {
  return _mm_cvtsd_f64(_mm_fmsub_sd(_mm_set_sd(a), _mm_set_sd(b), _mm_set_sd(p)));
}
#endif
/* two adjacent doubles of a table */
INLINE void gather(const double *table, bits i, lanes *first, lanes *second) {
  *first = table[i];
  *second = table[i + 1];
}

#else
typedef double lanes __attribute__((vector_size(8 * AMBIT_LANES)));
typedef uint64_t bits __attribute__((vector_size(8 * AMBIT_LANES)));
typedef int64_t signed_bits __attribute__((vector_size(8 * AMBIT_LANES)));
INLINE bits to_bits(lanes a) { return (bits)a; }
INLINE lanes to_lanes(bits i) { return (lanes)i; }
INLINE bits less(lanes a, lanes b) { return (bits)(a < b); }
INLINE bits less_equal(lanes a, lanes b) { return (bits)(a <= b); }
INLINE bits bits_less(bits a, bits b) { return (bits)((signed_bits)a < (signed_bits)b); }
INLINE bits bits_equal(bits a, bits b) { return (bits)(a == b); }
#if AMBIT_LANES == 2 /* any machine; SSE2 and FMA where the compiler has them */
INLINE lanes all(double a) { return (lanes) { a, a }; }
INLINE bits all_bits(int64_t a) { return (bits) { (uint64_t)a, (uint64_t)a }; }
INLINE lanes load(const double *p) { return (lanes) { p[0], p[1] }; }
INLINE void store(double *p, lanes a) { p[0] = a[0], p[1] = a[1]; }
INLINE lanes choose(bits mask, lanes a, lanes b) { return to_lanes((mask & to_bits(a)) | (~mask & to_bits(b))); }
INLINE int any(bits mask) { return (mask[0] | mask[1]) != 0; }
#ifdef __SSE2__
INLINE lanes square_root(lanes a) { return (lanes)_mm_sqrt_pd((__m128d)a); }
#else
INLINE lanes square_root(lanes a) { return (lanes) { __builtin_sqrt(a[0]), __builtin_sqrt(a[1]) }; }
#endif
#ifdef HAVE_FMA
INLINE lanes product_error(lanes a, lanes b, lanes p) {
  return (lanes)_mm_fmsub_pd((__m128d)a, (__m128d)b, (__m128d)p);
}
#endif
INLINE void gather(const double *table, bits i, lanes *first, lanes *second) {
  *first = (lanes) { table[i[0]], table[i[1]] };
  *second = (lanes) { table[i[0] + 1], table[i[1] + 1] };
}
#elif AMBIT_LANES == 4
INLINE lanes all(double a) { return (lanes)_mm256_set1_pd(a); }
INLINE bits all_bits(int64_t a) { return (bits)_mm256_set1_epi64x(a); }
INLINE lanes load(const double *p) { return (lanes)_mm256_loadu_pd(p); }
INLINE void store(double *p, lanes a) { _mm256_storeu_pd(p, (__m256d)a); }
INLINE lanes choose(bits mask, lanes a, lanes b) {
  return (lanes)_mm256_blendv_pd((__m256d)b, (__m256d)a, (__m256d)mask);
}
INLINE int any(bits mask) { return _mm256_movemask_pd((__m256d)mask); }
INLINE lanes square_root(lanes a) { return (lanes)_mm256_sqrt_pd((__m256d)a); }
INLINE lanes product_error(lanes a, lanes b, lanes p) {
  return (lanes)_mm256_fmsub_pd((__m256d)a, (__m256d)b, (__m256d)p);
}
/* four 16-byte loads are faster than two gather instructions */
INLINE void gather(const double *table, bits i, lanes *first, lanes *second) {
  __m256d even =
      _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(table + i[0])), _mm_loadu_pd(table + i[2]), 1);
  __m256d odd = _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(table + i[1])), _mm_loadu_pd(table + i[3]), 1);
  *first = (lanes)_mm256_unpacklo_pd(even, odd);
  *second = (lanes)_mm256_unpackhi_pd(even, odd);
}
#else
INLINE lanes all(double a) { return (lanes)_mm512_set1_pd(a); }
INLINE bits all_bits(int64_t a) { return (bits)_mm512_set1_epi64(a); }
INLINE lanes load(const double *p) { return (lanes)_mm512_loadu_pd(p); }
INLINE void store(double *p, lanes a) { _mm512_storeu_pd(p, (__m512d)a); }
INLINE lanes choose(bits mask, lanes a, lanes b) {
  return (lanes)_mm512_mask_blend_pd(_mm512_movepi64_mask((__m512i)mask), (__m512d)b, (__m512d)a);
}
INLINE int any(bits mask) { return _mm512_movepi64_mask((__m512i)mask); }
INLINE lanes square_root(lanes a) { return (lanes)_mm512_sqrt_pd((__m512d)a); }
INLINE lanes product_error(lanes a, lanes b, lanes p) {
  return (lanes)_mm512_fmsub_pd((__m512d)a, (__m512d)b, (__m512d)p);
}
INLINE void gather(const double *table, bits i, lanes *first, lanes *second) {
  *first = (lanes)_mm512_i64gather_pd((__m512i)i, table, 8);
  *second = (lanes)_mm512_i64gather_pd((__m512i)i, table + 1, 8);
}
#endif
#endif

INLINE bits shift_right(bits a, int n) { return a >> n; } /* fills with zeros */
INLINE bits shift_left(bits a, int n) { return a << n; }
INLINE bits choose_bits(bits mask, bits a, bits b) { return to_bits(choose(mask, to_lanes(a), to_lanes(b))); }
INLINE lanes magnitude(lanes a) { return to_lanes(to_bits(a) & all_bits(INT64_MAX)); }
INLINE bits sign_bit(lanes a) { return to_bits(a) & all_bits(INT64_MIN); }
INLINE lanes flip(lanes a, bits sign) { return to_lanes(to_bits(a) ^ sign); } /* -a where the sign bit is set */
INLINE lanes smaller(lanes a, lanes b) { return choose(less(b, a), b, a); }
INLINE lanes larger(lanes a, lanes b) { return choose(less(a, b), b, a); }
/* neighbours of a finite nonzero double towards +inf and -inf, without arithmetic on doubles */
INLINE lanes next_above(lanes a) {
  return to_lanes(to_bits(a) + all_bits(1) - shift_left(shift_right(to_bits(a), 63), 1));
}
INLINE lanes next_below(lanes a) {
  return to_lanes(to_bits(a) - all_bits(1) + shift_left(shift_right(to_bits(a), 63), 1));
}
/* the nearest integer of |a| < 2^51, as a double and as bits; a * 2^52 has no fraction bits left */
#define INTEGER_SHIFT 0x1.8p52
INLINE lanes nearest_integer(lanes a, bits *n) {
  lanes t = a + all(INTEGER_SHIFT);
  *n = to_bits(t) - to_bits(all(INTEGER_SHIFT));
  return t - all(INTEGER_SHIFT);
}
/* 2^k, -1022 <= k <= 1023 */
INLINE lanes power_of_two(bits k) { return to_lanes(shift_left(k + all_bits(1023), 52)); }

/* An unevaluated sum h + l. */
typedef struct pair {
  lanes h, l;
} pair;
INLINE pair fast_two_sum(lanes a, lanes b) { /* exact if |a| >= |b| or a = 0 */
  lanes s = a + b;
  return (pair) { s, b - (s - a) };
}
INLINE pair two_sum(lanes a, lanes b) { /* exact */
  lanes s = a + b, t = s - a;
  return (pair) { s, (a - (s - t)) + (b - t) };
}
#ifdef HAVE_FMA
INLINE pair two_product(lanes a, lanes b) { /* exact unless it underflows */
  lanes p = a * b;
  return (pair) { p, product_error(a, b, p) };
}
#else
INLINE pair split(lanes a) { /* two halves of at most 26 bits */
  lanes c = 134217729.0 * a, h = c - (c - a);
  return (pair) { h, a - h };
}
INLINE pair two_product(lanes a, lanes b) {
  lanes p = a * b;
  pair x = split(a), y = split(b);
  return (pair) { p, ((x.h * y.h - p) + x.h * y.l + x.l * y.h) + x.l * y.l };
}
#endif
/* a / b, |a| and |b| in [2^-900, 2^900]; relative error under 2^-100 */
INLINE pair pair_divide(pair a, pair b) {
  lanes inverse = 1.0 / b.h, q = a.h * inverse;
  pair v = two_product(q, b.h);
  return fast_two_sum(q, (((a.h - v.h) - v.l) + (a.l - q * b.l)) * inverse);
}
INLINE pair pair_flip(pair a, bits sign) { return (pair) { flip(a.h, sign), flip(a.l, sign) }; }
INLINE pair pair_choose(bits mask, pair a, pair b) { return (pair) { choose(mask, a.h, b.h), choose(mask, a.l, b.l) }; }
#endif
