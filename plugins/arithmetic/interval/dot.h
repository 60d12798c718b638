/* dot.h -- sums of products of elements, in upward mode.
**
** Terms j = i mod 4 are added up in four sums, and those as (s0 + s2) + (s1 + s3), whatever the width of vectors, so
** that every variant gives the same bits. Every partial sum is rounded up, so it bounds its exact value. Products of
** bounded operands cannot be NaN, and need no care; `doubt` becomes NaN if an operand is infinite or empty, and then
** all is done again with care.
*/
#define SUMS 4

INLINE vector bounded_product(vector x, vector y) {
  vector a = first(x), b = second(x), z = swap(y);
  return larger_each(larger_each(a * z, b * y), larger_each((-a) * y, (-b) * z));
}

typedef struct sums {
  vector part[SUMS], doubt;
} sums;

INLINE void add_term(sums *s, size_t part, vector x, vector y) {
  s->part[part] += bounded_product(x, y);
  s->doubt = multiply_add(y, splat(0), multiply_add(x, splat(0), s->doubt));
}

INLINE vector some_lanes(const double *p, size_t lanes) { return lanes < PAIRS ? load_some(p, lanes) : load(p); }

/* lanes side by side */
INLINE sums sum_lanes(const double *x, ptrdiff_t sx, const double *y, ptrdiff_t sy, size_t m, size_t lanes) {
  sums s = { 0 };
  for (size_t j = 0; j < m; j += SUMS)
    for (size_t i = 0; i < SUMS && j + i < m; i++, x += sx, y += sy)
      add_term(&s, i, some_lanes(x, lanes), some_lanes(y, lanes));
  s.part[0] = (s.part[0] + s.part[2]) + (s.part[1] + s.part[3]);
  return s;
}

/* one lane: several terms in each vector; only the first pair of the result counts */
INLINE sums sum_single(const double *x, ptrdiff_t sx, const double *y, ptrdiff_t sy, size_t m) {
  sums s = { 0 };
  for (; m >= SUMS; m -= SUMS)
    for (size_t i = 0; i < SUMS; i += PAIRS, x += PAIRS * sx, y += PAIRS * sy)
      add_term(&s, i / PAIRS, load_pairs(x, sx), load_pairs(y, sy));
  for (size_t i = 0; i < SUMS - 1; i++, x += sx, y += sy)
    if (i < m) add_term(&s, i / PAIRS, only_pair(i % PAIRS, load_pair(x)), only_pair(i % PAIRS, load_pair(y)));
  double part[2 * SUMS];
  for (size_t i = 0; i < SUMS; i += PAIRS) store(part + 2 * i, s.part[i / PAIRS]);
  for (size_t h = 0; h < 2; h++) part[h] = (part[h] + part[4 + h]) + (part[2 + h] + part[6 + h]);
  s.part[0] = load_pair(part);
  return s;
}

/* any operands; for bounded ones the same bits, as they may lie beside others in a vector */
INLINE vector sum_carefully(
    findings *f, const double *x, ptrdiff_t sx, const double *y, ptrdiff_t sy, size_t m, size_t lanes) {
  vector part[SUMS] = { splat(0), splat(0), splat(0), splat(0) };
  findings inner = { 0 };
  for (size_t j = 0; j < m; j++, x += sx, y += sy) {
    vector term = mul(&inner, some_lanes(x, lanes), some_lanes(y, lanes));
    part[j % SUMS] = add(&inner, part[j % SUMS], term);
  }
  vector total = add(&inner, add(&inner, part[0], part[2]), add(&inner, part[1], part[3]));
  return finish(f, is_empty(total), total);
}

INLINE vector sum_row(
    findings *f, const double *x, ptrdiff_t sx, const double *y, ptrdiff_t sy, size_t m, size_t lanes, int single) {
  sums s = single ? sum_single(x, sx, y, sy, m) : sum_lanes(x, sx, y, sy, m, lanes);
  if (any(~equal(s.doubt, s.doubt))) return sum_carefully(f, x, sx, y, sy, m, lanes);
  return finish(f, is_empty(s.part[0]), s.part[0]);
}

static AMBIT_WORKER uint32_t dot_lanes(
    double *r, const double *x, ptrdiff_t sx, const double *y, ptrdiff_t sy, size_t m, size_t lanes) {
  findings f = { 0 };
  if (lanes == 1) {
    store_pair(r, sum_row(&f, x, sx, y, sy, m, 1, 1));
    return flags_of(&f);
  }
  size_t l = 0;
  for (; l + PAIRS <= lanes; l += PAIRS) store(r + 2 * l, sum_row(&f, x + 2 * l, sx, y + 2 * l, sy, m, PAIRS, 0));
  size_t left = lanes - l;
  if (left) store_some(r + 2 * l, left, sum_row(&f, x + 2 * l, sx, y + 2 * l, sy, m, left, 0));
  return flags_of(&f);
}

static uint32_t dot(
    void *ctx, void *dst, const void *a, ptrdiff_t sa, const void *b, ptrdiff_t sb, size_t m, size_t lanes) {
  (void)ctx;
  ambit_rounding old = ambit_round_up();
  uint32_t flags = dot_lanes(dst, a, 2 * sa, b, 2 * sb, m, lanes);
  ambit_rounding_restore(old);
  return flags;
}
