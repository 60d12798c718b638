/* test_pieces.c -- grids of pieces: they cover a box exactly, whatever its numbers; pieces dealt out by influence. */
#include "verbs/split/pieces.h"
#include "num/random.h"
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

static void check_cover(uint32_t nu, const double *lo, const double *hi, const uint32_t *parts) {
  ambit_arena *arena = ambit_arena_open();
  ambit_pieces p;
  ambit_failure f = { 0 };
  assert_int_equal(ambit_pieces_cut(arena, nu, lo, hi, parts, &p, &f), AMBIT_OK);
  uint64_t product = 1;
  for (uint32_t j = 0; j < nu; j++) {
    product *= p.parts[j];
    assert_true(p.parts[j] <= parts[j]);
    assert_true(p.edge[j][0] == lo[j] && p.edge[j][p.parts[j]] == hi[j]);
    for (uint32_t i = 0; i < p.parts[j]; i++)
      assert_true(lo[j] == hi[j] ? p.parts[j] == 1 : p.edge[j][i] < p.edge[j][i + 1]);
  }
  assert_true(product == p.count);
  double *count = calloc(p.count, sizeof *count);
  for (uint32_t k = 0; k < p.count; k++) { /* each cell of the grid is a piece, once */
    double a[4], b[4];
    ambit_pieces_range(&p, k, a, b);
    uint32_t cell = 0;
    for (uint32_t j = 0; j < nu; j++) {
      uint32_t i = 0;
      while (i < p.parts[j] && p.edge[j][i] != a[j]) i++;
      assert_true(i < p.parts[j] && p.edge[j][i + 1] == b[j]);
      cell = cell * p.parts[j] + i;
    }
    assert_true(count[cell]++ == 0);
  }
  free(count);
  ambit_arena_close(arena);
}

static void pieces_cover_the_box(void **state) {
  (void)state;
  ambit_random random = { 7 };
  for (int round = 0; round < 300; round++) {
    double lo[4], hi[4];
    uint32_t nu = 1 + (uint32_t)(ambit_random_bits(&random) % 4), parts[4];
    for (uint32_t j = 0; j < nu; j++) {
      double scale = ldexp(1, (int)(ambit_random_bits(&random) % 200) - 100);
      lo[j] = scale * ambit_random_in(&random, (ambit_interval) { -1, 1 });
      hi[j] = lo[j] + scale * ambit_random_in(&random, (ambit_interval) { 0, 1 });
      parts[j] = 1 + (uint32_t)(ambit_random_bits(&random) % 9);
    }
    check_cover(nu, lo, hi, parts);
  }
  const double a[] = { 1, -DBL_MAX, 0, 5 }, b[] = { 1 + 3 * DBL_EPSILON, DBL_MAX, 4.94e-324, 5 };
  const uint32_t parts[] = { 16, 7, 3, 4 }; /* fewer doubles than parts, no overflow, subnormal, a point */
  check_cover(4, a, b, parts);
  ambit_arena *arena = ambit_arena_open();
  ambit_pieces p;
  ambit_failure f = { 0 };
  const uint32_t many[] = { 60000, 60000, 60000, 60000 };
  assert_int_equal(ambit_pieces_cut(arena, 4, a, b, many, &p, &f), AMBIT_INVALID);
  assert_non_null(strstr(f.message, "65536 pieces"));
  ambit_arena_close(arena);
}

static void deals_pieces_out_by_influence(void **state) {
  (void)state;
  static const struct {
    double influence[3];
    uint32_t total, before[3], after[3];
  } expected[] = {
    { { 1, 1, 0 }, 10, { 0, 0, 0 }, { 3, 3, 1 } },
    { { 1, 0, 0 }, 32, { 0, 0, 0 }, { 32, 1, 1 } },
    { { 4, 1, 0 }, 16, { 0, 0, 0 }, { 8, 2, 1 } },
    { { 1, 9, 1 }, 12, { 4, 0, 0 }, { 4, 3, 1 } },
    { { 1, 1, 1 }, 8, { 0, 0, 0 }, { 2, 2, 2 } },
    { { 1, 1, 1 }, 3, { 5, 0, 0 }, { 5, 1, 1 } },
    { { 0, 0, 0 }, 100, { 0, 0, 0 }, { 1, 1, 1 } },
  };
  for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
    uint32_t parts[3];
    memcpy(parts, expected[i].before, sizeof parts);
    ambit_pieces_deal(3, expected[i].influence, expected[i].total, parts);
    for (int j = 0; j < 3; j++)
      if (parts[j] != expected[i].after[j]) fail_msg("case %zu: %u %u %u", i, parts[0], parts[1], parts[2]);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(pieces_cover_the_box),
    cmocka_unit_test(deals_pieces_out_by_influence),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
