/* vector_two.h -- two doubles, one pair: SSE2 on x86-64, compiler vectors elsewhere; and what each operation means. */
#ifndef VECTOR_TWO_H
#define VECTOR_TWO_H

typedef words mask; /* all ones or zero in each element */
#define FIRST_HALVES ((mask) { -1, 0 })

/* comparisons are false for NaN; choose and keep (0 elsewhere) select double by double */
#if defined(__SSE2__)
INLINE mask equal(vector a, vector b) { return (mask)_mm_cmpeq_pd(a, b); }
INLINE mask above(vector a, vector b) { return (mask)_mm_cmpgt_pd(a, b); }
INLINE mask reaches(vector a, vector b) { return (mask)_mm_cmpge_pd(a, b); }
INLINE vector choose(mask m, vector yes, vector no) {
  return _mm_or_pd(_mm_and_pd((vector)m, yes), _mm_andnot_pd((vector)m, no));
}
INLINE int any(mask m) { return _mm_movemask_pd((vector)m) != 0; }
INLINE vector root(vector a) { return _mm_sqrt_pd(a); }
#else
INLINE mask equal(vector a, vector b) { return (mask)(a == b); }
INLINE mask above(vector a, vector b) { return (mask)(a > b); }
INLINE mask reaches(vector a, vector b) { return (mask)(a >= b); }
INLINE vector choose(mask m, vector yes, vector no) { return (vector)((m & (mask)yes) | (~m & (mask)no)); }
INLINE int any(mask m) { return (m[0] | m[1]) != 0; }
INLINE vector root(vector a) { return (vector) { sqrt(a[0]), sqrt(a[1]) }; }
#endif
INLINE vector keep(mask m, vector v) { return (vector)(m & (mask)v); }
INLINE mask swap_mask(mask m) { return __builtin_shufflevector(m, m, 1, 0); }
/* where m: the bit pattern less 1, which is the double below if v is positive */
INLINE vector bits_below(vector v, mask m) { return (vector)((words)v + m); }

/* within each pair: exchanged; the first half twice; the second half twice */
INLINE vector swap(vector x) { return __builtin_shufflevector(x, x, 1, 0); }
INLINE vector first(vector x) { return __builtin_shufflevector(x, x, 0, 0); }
INLINE vector second(vector x) { return __builtin_shufflevector(x, x, 1, 1); }
/* the first and the second halves of the pairs of x and y, taken in turn; of both results, in this order, they give x
** and y back */
INLINE vector firsts(vector x, vector y) { return __builtin_shufflevector(x, y, 0, 2); }
INLINE vector seconds(vector x, vector y) { return __builtin_shufflevector(x, y, 1, 3); }

/* one double (AVX2: also two), 0 elsewhere */
INLINE vector load_one(const double *p) { return (vector) { *p, 0 }; }
/* one pair repeated; n < PAIRS pairs, and the first one again in the room that is left; n pairs back */
INLINE vector load_pair(const double *p) { return load(p); }
INLINE vector load_some(const double *p, size_t n) { return (void)n, load_pair(p); }
INLINE void store_some(double *p, size_t n, vector v) { (void)n, store_pair(p, v); }
/* the PAIRS pairs at p, p + step, ...; those at slots + pitch i; the same back */
INLINE vector load_pairs(const double *p, ptrdiff_t step) { return (void)step, load(p); }
INLINE vector gather_pairs(const double *slots, size_t pitch, const uint32_t *i) { return load(slots + pitch * i[0]); }
INLINE void scatter_pairs(double *slots, size_t pitch, const uint32_t *i, vector v) { store(slots + pitch * i[0], v); }
/* pair number i of v, 0 elsewhere */
INLINE vector only_pair(size_t i, vector v) { return (void)i, v; }
#endif
