/* product_matrix.h -- the product of two matrices; part of product_kernel.h.
**
** Rows of the result are sums of one number of a times rows of b, a few rows at a time. In tiles, for the sake of the
** stack: a tile of b is made ready once for all rows of a tile of the result.
*/
#define MATRIX_TILE 24
#define MATRIX_ROWS (LANES == 2 ? 2 : 3) /* enough sums to hide the latency of adding, few enough for the registers */

typedef struct matrix_tile { /* part of a, part of b */
  _Alignas(64) double a[MATRIX_TILE][MATRIX_TILE + LANES], ra[MATRIX_TILE][MATRIX_TILE + LANES];
  double b[MATRIX_TILE][MATRIX_TILE + LANES], rb[MATRIX_TILE][MATRIX_TILE + LANES];
  double reach[MATRIX_TILE][MATRIX_TILE + LANES];
} matrix_tile;

typedef struct extent { /* of a tile: from row, column or inner index `at` on, n of them */
  size_t at, n;
} extent;

INLINE extent extent_at(size_t at, size_t total) {
  return (extent) { at, total - at < MATRIX_TILE ? total - at : MATRIX_TILE };
}

INLINE mask load_left(matrix_tile *t, extent i, extent k, size_t inner, const double *lo, const double *hi) {
  mask plain = everywhere();
  for (size_t r = 0; r < i.n; r++) {
    size_t at = (i.at + r) * inner + k.at;
    plain &= write_spread(lo + at, hi + at, k.n, t->a[r], t->ra[r], NULL);
  }
  return plain;
}

INLINE mask load_right(matrix_tile *t, extent k, extent j, size_t cols, const double *lo, const double *hi) {
  mask plain = everywhere();
  for (size_t r = 0; r < k.n; r++) {
    size_t at = (k.at + r) * cols + j.at;
    plain &= write_spread(lo + at, hi + at, j.n, t->b[r], t->rb[r], t->reach[r]);
  }
  return plain;
}

/* one vector of columns of `count` rows; fresh: the first terms of these results */
INLINE void matrix_step(
    const matrix_tile *t, size_t row, size_t column, size_t inner, sums *total, size_t count, int fresh) {
  sums s[MATRIX_ROWS];
  for (size_t i = 0; i < count; i++) s[i] = fresh ? no_sums() : total[i * (MATRIX_TILE / LANES)];
  for (size_t k = 0; k < inner; k++) {
    spread b = { load(t->b[k] + column), load(t->rb[k] + column), load(t->reach[k] + column) };
    for (size_t i = 0; i < count; i++) add_term(&s[i], t->a[row + i][k], t->ra[row + i][k], b);
  }
  for (size_t i = 0; i < count; i++) total[i * (MATRIX_TILE / LANES)] = s[i];
}

typedef sums matrix_sums[MATRIX_TILE][MATRIX_TILE / LANES];

INLINE void add_tile(const matrix_tile *t, size_t rows, size_t inner, size_t cols, matrix_sums total, int fresh) {
  for (size_t c = 0; c < cols; c += LANES) {
    size_t r = 0;
    for (; r + MATRIX_ROWS <= rows; r += MATRIX_ROWS)
      matrix_step(t, r, c, inner, &total[r][c / LANES], MATRIX_ROWS, fresh);
    for (; r < rows; r++) matrix_step(t, r, c, inner, &total[r][c / LANES], 1, fresh);
  }
}

INLINE uint32_t write_tile(matrix_sums total, extent i, extent j, size_t cols, double *lo, double *hi) {
  uint32_t flags = 0;
  for (size_t r = 0; r < i.n; r++)
    for (size_t c = 0; c < j.n; c += LANES) {
      size_t left = j.n - c, at = (i.at + r) * cols + j.at + c;
      flags |= write_bounds(total[r][c / LANES], left < LANES ? left : LANES, lo + at, hi + at);
    }
  return flags;
}

static AMBIT_WORKER uint32_t matmul(size_t rows, size_t inner, size_t cols, double *rlo, double *rhi, const double *alo,
    const double *ahi, const double *blo, const double *bhi) {
  uint32_t flags = 0;
  for (size_t column = 0; column < cols; column += MATRIX_TILE)
    for (size_t row = 0; row < rows; row += MATRIX_TILE) {
      extent i = extent_at(row, rows), j = extent_at(column, cols);
      matrix_sums total;
      for (size_t k = 0; k == 0 || k < inner; k += MATRIX_TILE) { /* an empty sum too */
        matrix_tile t;
        extent m = extent_at(k, inner);
        mask plain = load_left(&t, i, m, inner, alo, ahi) & load_right(&t, m, j, cols, blo, bhi);
        if (!is_everywhere(plain)) return AMBIT_PRODUCT_DECLINED;
        add_tile(&t, i.n, m.n, j.n, total, k == 0);
      }
      flags |= write_tile(total, i, j, cols, rlo, rhi);
    }
  return flags;
}
