/* product_series.h -- the product of two truncated power series; part of product_kernel.h.
**
** Coefficient k of a b is sum_j a_j b_(k-j): LANES coefficients at once are a sum of numbers a_j times LANES
** consecutive b, which are zero in front of the first. Two vectors of results are summed up together: then the same b
** serve a_j for the one and a_(j+LANES) for the other. Tiles: the results from `first` on get the terms of a from
** `from` on, which need the b around first - from.
*/
#define SERIES_TILE 32
#define SERIES_STEP (2 * LANES)
#define SERIES_EDGE (2 * LANES) /* zeros before and behind */

typedef struct series_tile {
  _Alignas(64) double a[SERIES_TILE + 2 * SERIES_EDGE],
      ra[SERIES_TILE + 2 * SERIES_EDGE]; /* a_j at [SERIES_EDGE + j - from] */
  /* b_i at [SERIES_TILE + i - shift], shift = first - from */
  double b[2 * SERIES_TILE + SERIES_EDGE], rb[2 * SERIES_TILE + SERIES_EDGE], reach[2 * SERIES_TILE + SERIES_EDGE];
} series_tile;

INLINE void clear(double *p) {
  for (size_t i = 0; i < SERIES_EDGE; i += LANES) store(p + i, all(0));
}

/* b first: its vectors are read across the borders of those that were written, which needs them to be in the cache */
INLINE mask load_window(series_tile *t, size_t shift, size_t n, const double *lo, const double *hi) {
  size_t from = shift < SERIES_TILE ? 0 : shift - SERIES_TILE, to = shift + SERIES_TILE;
  if (to > n) to = n;
  size_t at = SERIES_TILE + from - shift, end = at + to - from;
  if (at > 0) clear(t->b + at - SERIES_EDGE), clear(t->rb + at - SERIES_EDGE), clear(t->reach + at - SERIES_EDGE);
  clear(t->b + end), clear(t->rb + end), clear(t->reach + end);
  return write_spread(lo + from, hi + from, to - from, t->b + at, t->rb + at, t->reach + at);
}

INLINE mask load_terms(series_tile *t, size_t n, const double *lo, const double *hi) {
  size_t end = SERIES_EDGE + n;
  clear(t->a), clear(t->ra), clear(t->a + end), clear(t->ra + end);
  return write_spread(lo, hi, n, t->a + SERIES_EDGE, t->ra + SERIES_EDGE, NULL);
}

/* terms j < n of SERIES_STEP results from number k of the tile on */
INLINE void series_step(const series_tile *t, size_t k, size_t n, sums *total) {
  sums s[2] = { total[0], total[1] };
  const double *a = t->a + SERIES_EDGE, *ra = t->ra + SERIES_EDGE;
  const double *b = t->b + SERIES_TILE + k + LANES, *rb = t->rb + SERIES_TILE + k + LANES,
               *reach = t->reach + SERIES_TILE + k + LANES;
  for (size_t j = 0; j < n + LANES; j++, a++, ra++, b--, rb--, reach--) {
    spread factor = { held(load(b)), held(load(rb)), held(load(reach)) };
    add_term(&s[0], a[-LANES], ra[-LANES], factor);
    add_term(&s[1], a[0], ra[0], factor);
  }
  total[0] = s[0], total[1] = s[1];
}

static AMBIT_WORKER uint32_t convolve(
    size_t n, double *rlo, double *rhi, const double *alo, const double *ahi, const double *blo, const double *bhi) {
  uint32_t flags = 0;
  for (size_t first = 0; first < n; first += SERIES_TILE) {
    size_t results = n - first < SERIES_TILE ? n - first : SERIES_TILE;
    sums total[SERIES_TILE / LANES];
    for (size_t from = 0; from <= first; from += SERIES_TILE) {
      series_tile t;
      size_t terms = n - from < SERIES_TILE ? n - from : SERIES_TILE;
      mask plain = load_window(&t, first - from, n, blo, bhi);
      plain &= load_terms(&t, terms, alo + from, ahi + from);
      if (!is_everywhere(plain)) return AMBIT_PRODUCT_DECLINED;
      for (size_t k = 0; k < results; k += SERIES_STEP) {
        if (from == 0) total[k / LANES] = total[k / LANES + 1] = no_sums();
        size_t few = from == first && k + LANES < terms ? k + LANES : terms; /* the others meet zeros */
        series_step(&t, k, few, total + k / LANES);
      }
    }
    for (size_t k = 0; k < results; k += LANES) {
      size_t left = results - k;
      flags |= write_bounds(total[k / LANES], left < LANES ? left : LANES, rlo + first + k, rhi + first + k);
    }
  }
  return flags;
}
