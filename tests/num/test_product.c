/* Products of interval series and matrices: inclusion against exact sums (MPFR), tightness against interval operations,
** every variant, sizes around the tiles, data that are not bounded. */
#include "num/interval.h"
#include "num/product.h"
#include "num/product_variant.h"
#include "num/rounding.h"
#include "oracle.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define ROOM 4000
#define EXACT_BITS 4400 /* holds any sum of a few thousand products of doubles */

typedef struct data {
  double alo[ROOM], ahi[ROOM], blo[ROOM], bhi[ROOM], rlo[ROOM], rhi[ROOM];
} data;

static data d;

enum { THIN, NARROW, WIDE, NASTY };

static void fill(double *lo, double *hi, size_t n, int kind, uint64_t *state) {
  for (size_t i = 0; i < n; i++) {
    double x = kind == NASTY ? oracle_double(state) : oracle_uniform(state, -3, 3), y = x;
    if (kind == NARROW) y = x + fabs(x) * 0x1p-40;
    if (kind == WIDE) y = oracle_uniform(state, -3, 3);
    if (kind == NASTY && oracle_random(state) % 2) y = oracle_double(state);
    lo[i] = x < y ? x : y, hi[i] = x < y ? y : x;
  }
}

/* a point of [lo, hi]: an end, or between */
static double sample(double lo, double hi, uint64_t *state) {
  switch (oracle_random(state) % 3) {
  case 0: return lo;
  case 1: return hi;
  default: return fmin(hi, fmax(lo, lo / 2 + hi / 2));
  }
}

typedef struct sum_of { /* sum_i a[i sa] b[i sb] */
  const double *alo, *ahi, *blo, *bhi;
  ptrdiff_t sa, sb;
  size_t n;
} sum_of;

static void exact_sample(mpfr_t sum, const sum_of *s, uint64_t *state) {
  mpfr_t x, y;
  mpfr_init2(x, 53), mpfr_init2(y, 53);
  mpfr_set_zero(sum, 1);
  mpfr_t p;
  mpfr_init2(p, 106);
  for (size_t i = 0; i < s->n; i++) {
    ptrdiff_t a = s->sa * (ptrdiff_t)i, b = s->sb * (ptrdiff_t)i;
    mpfr_set_d(x, sample(s->alo[a], s->ahi[a], state), MPFR_RNDN);
    mpfr_set_d(y, sample(s->blo[b], s->bhi[b], state), MPFR_RNDN);
    assert_int_equal(mpfr_mul(p, x, y, MPFR_RNDN), 0);
    assert_int_equal(mpfr_add(sum, sum, p, MPFR_RNDN), 0);
  }
  mpfr_clear(x), mpfr_clear(y), mpfr_clear(p);
}

static void check_result(const sum_of *s, double lo, double hi, int kind, uint64_t *state) {
  mpfr_t sum;
  mpfr_init2(sum, EXACT_BITS);
  assert_false(isnan(lo) || isnan(hi));
  for (int i = 0; i < 3; i++) {
    exact_sample(sum, s, state);
    if (mpfr_cmp_d(sum, lo) < 0 || mpfr_cmp_d(sum, hi) > 0)
      fail_msg("%zu terms, kind %d: [%a, %a] misses %a", s->n, kind, lo, hi, mpfr_get_d(sum, MPFR_RNDN));
  }
  mpfr_clear(sum);
}

/* By interval operations; every partial sum tightest. */
static ambit_interval plainly(const sum_of *s) {
  ambit_interval total = { 0, 0 };
  for (size_t i = 0; i < s->n; i++) {
    ptrdiff_t a = s->sa * (ptrdiff_t)i, b = s->sb * (ptrdiff_t)i;
    total = ambit_interval_add(total,
        ambit_interval_mul((ambit_interval) { s->alo[a], s->ahi[a] }, (ambit_interval) { s->blo[b], s->bhi[b] }));
  }
  return total;
}

static double magnitude_of(const sum_of *s) {
  double sum = 0;
  for (size_t i = 0; i < s->n; i++)
    sum += fmax(fabs(s->alo[s->sa * (ptrdiff_t)i]), fabs(s->ahi[s->sa * (ptrdiff_t)i])) *
           fmax(fabs(s->blo[s->sb * (ptrdiff_t)i]), fabs(s->bhi[s->sb * (ptrdiff_t)i]));
  return sum;
}

/* thin: no wider than interval operations but for a rounding of the whole; wide: at most 1.5 times */
static void check_width(const sum_of *s, double lo, double hi, int kind) {
  ambit_interval other = plainly(s);
  double width = other.hi - other.lo, slack = 4 * 0x1p-52 * magnitude_of(s) + 0x1p-1000;
  double factor = kind == WIDE ? 1.5 : 1 + 0x1p-12;
  if (hi - lo > factor * width + slack)
    fail_msg("%zu terms, kind %d: width %g, by interval operations %g", s->n, kind, hi - lo, width);
}

typedef uint32_t convolve_fn(
    size_t n, double *rlo, double *rhi, const double *alo, const double *ahi, const double *blo, const double *bhi);
typedef uint32_t matmul_fn(size_t rows, size_t inner, size_t cols, double *rlo, double *rhi, const double *alo,
    const double *ahi, const double *blo, const double *bhi);

static void check_series(convolve_fn *convolve, size_t n, int kind, uint64_t *state) {
  fill(d.alo, d.ahi, n, kind, state), fill(d.blo, d.bhi, n, kind, state);
  d.rlo[n] = d.rhi[n] = 4711;
  ambit_rounding old = ambit_round_up();
  uint32_t flags = convolve(n, d.rlo, d.rhi, d.alo, d.ahi, d.blo, d.bhi);
  ambit_rounding_restore(old);
  assert_true(d.rlo[n] == 4711 && d.rhi[n] == 4711);
  uint32_t want = 0;
  if (flags == AMBIT_PRODUCT_DECLINED) {
    assert_int_equal(kind, NASTY);
    return;
  }
  for (size_t k = 0; k < n; k++) {
    sum_of s = { d.alo, d.ahi, d.blo + k, d.bhi + k, 1, -1, k + 1 };
    check_result(&s, d.rlo[k], d.rhi[k], kind, state);
    if (kind != NASTY) check_width(&s, d.rlo[k], d.rhi[k], kind);
    if (d.rlo[k] == -INFINITY || d.rhi[k] == INFINITY) want = AMBIT_F_UNBOUNDED;
  }
  assert_int_equal(flags, want);
}

static void check_matrix(matmul_fn *matmul, size_t rows, size_t inner, size_t cols, int kind, uint64_t *state) {
  fill(d.alo, d.ahi, rows * inner, kind, state), fill(d.blo, d.bhi, inner * cols, kind, state);
  d.rlo[rows * cols] = d.rhi[rows * cols] = 4711;
  ambit_rounding old = ambit_round_up();
  uint32_t flags = matmul(rows, inner, cols, d.rlo, d.rhi, d.alo, d.ahi, d.blo, d.bhi);
  ambit_rounding_restore(old);
  assert_true(d.rlo[rows * cols] == 4711 && d.rhi[rows * cols] == 4711);
  if (flags == AMBIT_PRODUCT_DECLINED) {
    assert_int_equal(kind, NASTY);
    return;
  }
  for (size_t i = 0; i < rows; i++)
    for (size_t j = 0; j < cols; j++) {
      size_t at = i * cols + j;
      sum_of s = { d.alo + i * inner, d.ahi + i * inner, d.blo + j, d.bhi + j, 1, (ptrdiff_t)cols, inner };
      check_result(&s, d.rlo[at], d.rhi[at], kind, state);
      if (kind != NASTY) check_width(&s, d.rlo[at], d.rhi[at], kind);
    }
}

static int variants(const ambit_product_variant **variant) {
  int n = 0;
  variant[n++] = &ambit_product_portable;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) variant[n++] = &ambit_product_avx2;
#endif
  return n;
}

static void series_contain_exact_sums(void **unused) {
  (void)unused;
  static const size_t size[] = { 1, 2, 3, 4, 5, 7, 8, 9, 15, 16, 17, 21, 31, 32, 33, 41, 63, 64, 65, 97, 130 };
  const ambit_product_variant *variant[2];
  uint64_t state = 11;
  for (int v = variants(variant) - 1; v >= 0; v--)
    for (size_t i = 0; i < sizeof size / sizeof *size; i++)
      for (int kind = THIN; kind <= NASTY; kind++)
        for (int pass = 0; pass < (size[i] < 30 ? 20 : 2); pass++)
          check_series(variant[v]->convolve, size[i], kind, &state);
}

static void matrices_contain_exact_sums(void **unused) {
  (void)unused;
  static const size_t shape[][3] = { { 1, 1, 1 }, { 2, 3, 4 }, { 3, 1, 5 }, { 4, 4, 4 }, { 5, 7, 3 }, { 12, 12, 12 },
    { 1, 30, 1 }, { 24, 24, 24 }, { 25, 24, 26 }, { 3, 50, 27 }, { 49, 2, 5 }, { 7, 25, 49 } };
  const ambit_product_variant *variant[2];
  uint64_t state = 12;
  for (int v = variants(variant) - 1; v >= 0; v--)
    for (size_t i = 0; i < sizeof shape / sizeof *shape; i++)
      for (int kind = THIN; kind <= NASTY; kind++)
        for (int pass = 0; pass < (shape[i][0] < 10 ? 10 : 1); pass++)
          check_matrix(variant[v]->matmul, shape[i][0], shape[i][1], shape[i][2], kind, &state);
}

/* The functions that others call set the rounding mode themselves. */
static void callers_need_no_rounding_mode(void **unused) {
  (void)unused;
  uint64_t state = 15;
  for (size_t n = 1; n < 20; n++)
    for (int kind = THIN; kind <= WIDE; kind++) {
      check_series(ambit_product_convolve, n, kind, &state);
      check_matrix(ambit_product_matmul, n, n, n, kind, &state);
    }
}

static void an_empty_sum_is_zero(void **unused) {
  (void)unused;
  memset(d.rlo, 1, 6 * sizeof(double)), memset(d.rhi, 1, 6 * sizeof(double));
  assert_int_equal(ambit_product_matmul(2, 0, 3, d.rlo, d.rhi, d.alo, d.ahi, d.blo, d.bhi), 0);
  for (int i = 0; i < 6; i++) assert_true(d.rlo[i] == 0 && d.rhi[i] == 0);
  assert_int_equal(ambit_product_convolve(0, d.rlo, d.rhi, d.alo, d.ahi, d.blo, d.bhi), 0);
}

/* what midpoint and radius cannot say: the answer is that of interval operations, term by term */
static void odd_data_go_the_slow_way(void **unused) {
  (void)unused;
  static const double odd[][2] = { { INFINITY, -INFINITY }, { -INFINITY, INFINITY }, { 1, INFINITY }, { -INFINITY, 0 },
    { NAN, 1 }, { 2, 1 }, { -DBL_MAX, DBL_MAX }, { DBL_MAX, DBL_MAX }, { INFINITY, INFINITY } };
  uint64_t state = 13;
  for (size_t o = 0; o < sizeof odd / sizeof *odd; o++)
    for (size_t n = 1; n < 40; n += 4)
      for (int side = 0; side < 2; side++) {
        fill(d.alo, d.ahi, n, NARROW, &state), fill(d.blo, d.bhi, n, NARROW, &state);
        d.alo[0] = d.ahi[0] = d.blo[0] = d.bhi[0] = 0;
        size_t at = oracle_random(&state) % n;
        (side ? d.alo : d.blo)[at] = odd[o][0], (side ? d.ahi : d.bhi)[at] = odd[o][1];
        uint32_t flags = ambit_product_convolve(n, d.rlo, d.rhi, d.alo, d.ahi, d.blo, d.bhi), want = 0;
        for (size_t k = 0; k < n; k++) {
          ambit_interval r = { 0, 0 };
          for (size_t j = 0; j <= k; j++)
            r = ambit_interval_add(r, ambit_interval_mul(ambit_interval_of(d.alo[j], d.ahi[j]),
                                          ambit_interval_of(d.blo[k - j], d.bhi[k - j])));
          assert_false(isnan(d.rlo[k]) || isnan(d.rhi[k]));
          if (ambit_interval_is_empty(r))
            assert_true(d.rlo[k] == INFINITY && d.rhi[k] == -INFINITY);
          else if (fabs(odd[o][0]) == DBL_MAX) /* bounded after all */
            assert_true(d.rlo[k] <= r.hi && r.lo <= d.rhi[k]);
          else
            assert_true(d.rlo[k] == r.lo && r.hi == d.rhi[k]);
          want |= d.rlo[k] > d.rhi[k] ? AMBIT_F_EMPTY : isinf(d.rlo[k]) || isinf(d.rhi[k]) ? AMBIT_F_UNBOUNDED : 0;
        }
        assert_int_equal(flags, want);
      }
}

static void a_matrix_with_one_empty_element(void **unused) {
  (void)unused;
  uint64_t state = 14;
  fill(d.alo, d.ahi, 9, NARROW, &state), fill(d.blo, d.bhi, 9, NARROW, &state);
  d.alo[4] = INFINITY, d.ahi[4] = -INFINITY;
  assert_int_equal(ambit_product_matmul(3, 3, 3, d.rlo, d.rhi, d.alo, d.ahi, d.blo, d.bhi), AMBIT_F_EMPTY);
  for (int i = 0; i < 9; i++) assert_int_equal(d.rlo[i] > d.rhi[i], i / 3 == 1);
  d.alo[4] = 1, d.ahi[4] = INFINITY, d.blo[3] = d.bhi[3] = 0;
  assert_int_equal(ambit_product_matmul(3, 3, 3, d.rlo, d.rhi, d.alo, d.ahi, d.blo, d.bhi), AMBIT_F_UNBOUNDED);
  for (int i = 0; i < 9; i++) assert_int_equal(isinf(d.rlo[i]) || isinf(d.rhi[i]), i == 4 || i == 5);
}

/* integers: every step is exact, so the bounds must be too */
static void exact_data_give_exact_results(void **unused) {
  (void)unused;
  for (size_t i = 0; i < 60; i++) {
    d.alo[i] = d.ahi[i] = (double)i - 20;
    d.blo[i] = d.bhi[i] = 3 * (double)i + 1;
  }
  assert_int_equal(ambit_product_convolve(60, d.rlo, d.rhi, d.alo, d.ahi, d.blo, d.bhi), 0);
  for (size_t k = 0; k < 60; k++) {
    double sum = 0;
    for (size_t j = 0; j <= k; j++) sum += d.alo[j] * d.blo[k - j];
    assert_true(d.rlo[k] == sum && d.rhi[k] == sum);
  }
}

/* points stay points among subnormal numbers too, whose halves are no doubles */
static void subnormal_points_give_exact_results(void **unused) {
  (void)unused;
  const ambit_product_variant *variant[2];
  for (size_t i = 0; i < 9; i++) {
    d.alo[i] = d.ahi[i] = (2 * (double)i + 1) * 0x1p-1074;
    d.blo[i] = d.bhi[i] = (double)i * 0x1p100;
  }
  for (int v = variants(variant) - 1; v >= 0; v--) {
    ambit_rounding old = ambit_round_up();
    uint32_t flags = variant[v]->convolve(9, d.rlo, d.rhi, d.alo, d.ahi, d.blo, d.bhi);
    ambit_rounding_restore(old);
    assert_int_equal(flags, 0);
    for (size_t k = 0; k < 9; k++) {
      double sum = 0;
      for (size_t j = 0; j <= k; j++) sum += d.alo[j] * d.blo[k - j];
      assert_true(d.rlo[k] == sum && d.rhi[k] == sum);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(series_contain_exact_sums),
    cmocka_unit_test(matrices_contain_exact_sums),
    cmocka_unit_test(callers_need_no_rounding_mode),
    cmocka_unit_test(an_empty_sum_is_zero),
    cmocka_unit_test(odd_data_go_the_slow_way),
    cmocka_unit_test(a_matrix_with_one_empty_element),
    cmocka_unit_test(exact_data_give_exact_results),
    cmocka_unit_test(subnormal_points_give_exact_results),
  };
  return cmocka_run_group_tests_name("product", tests, NULL, NULL);
}
