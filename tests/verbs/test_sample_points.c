/* test_sample_points.c -- blocks hold the same points whoever takes them; corners come each once where they are few;
** quasi-random points are spread more evenly than random ones; seeds shift them; what cannot be drawn is refused. */
#include "verbs/sample/sample_points.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define N_MAX 64u

static int set_up(void **state) {
  *state = ambit_registry_open(NULL);
  return *state ? 0 : 1;
}

static int tear_down(void **state) {
  ambit_registry_close(*state);
  return 0;
}

/* All points of a request, drawn in blocks of `most`: [draws][n], owned by the caller. */
static double *draw(ambit_registry *r, ambit_sample_points_request q, size_t most) {
  ambit_sample_points *points;
  ambit_failure f = { 0 };
  if (ambit_sample_points_open(r, &q, &points, &f) != AMBIT_OK) fail_msg("%s", f.message);
  double *all = calloc(q.draws * q.n, sizeof *all), *block = calloc(most * q.n, sizeof *block);
  size_t done = 0;
  assert_true(all && block);
  for (;;) {
    size_t first, count;
    assert_int_equal(ambit_sample_points_next(points, most, block, &first, &count), AMBIT_OK);
    if (!count) break;
    assert_int_equal(first, done);
    for (size_t k = 0; k < count; k++)
      for (size_t i = 0; i < q.n; i++) all[(first + k) * q.n + i] = block[i * count + k];
    done += count;
  }
  assert_int_equal(done, q.draws);
  free(block);
  ambit_sample_points_close(points);
  return all;
}

static ambit_interval unit[N_MAX];

static ambit_sample_points_request request(size_t draws, size_t n, const char *points) {
  for (size_t i = 0; i < N_MAX; i++) unit[i] = (ambit_interval) { 0, 1 };
  return (ambit_sample_points_request) { .draws = draws, .seed = 11, .points = points, .n = n, .range = unit };
}

static const char *const sequences[] = { "sobol", "niederreiter", "halton", "reverse_halton", "random" };
#define NSEQUENCE (sizeof sequences / sizeof *sequences)

static void blocks_do_not_matter(void **state) {
  for (size_t s = 0; s < NSEQUENCE; s++) {
    ambit_sample_points_request q = request(1000, 3, sequences[s]);
    double *one = draw(*state, q, 1000), *other = draw(*state, q, 37);
    assert_memory_equal(one, other, 3000 * sizeof *one);
    for (size_t i = 0; i < 3; i++) assert_true(one[i] == 0.5); /* draw 0 */
    q.seed = 12;
    double *shifted = draw(*state, q, 1000);
    assert_memory_not_equal(one, shifted, 3000 * sizeof *one);
    free(one), free(other), free(shifted);
  }
}

static void takes_each_corner_once(void **state) {
  ambit_sample_points_request q = request(200, 5, NULL);
  double *p = draw(*state, q, 64);
  uint32_t seen[32] = { 0 };
  for (size_t k = 0; k < 200; k++) {
    uint32_t corner = 0, sides = 0;
    for (size_t i = 0; i < 5; i++) {
      double v = p[k * 5 + i];
      assert_true(v >= 0 && v <= 1);
      sides += v == 0 || v == 1;
      corner |= (uint32_t)(v == 1) << i;
    }
    bool is_corner = k % 2 && k / 2 < 32;
    assert_int_equal(sides == 5, is_corner);
    if (is_corner) seen[corner]++;
  }
  for (size_t c = 0; c < 32; c++) assert_int_equal(seen[c], 1);
  free(p);
  q.n = 40; /* more corners than draws: every other draw is one */
  p = draw(*state, q, 64);
  size_t corners = 0;
  for (size_t k = 0; k < 200; k++) {
    size_t sides = 0;
    for (size_t i = 0; i < 40; i++) sides += p[k * 40 + i] == 0 || p[k * 40 + i] == 1;
    corners += sides == 40;
  }
  assert_int_equal(corners, 100);
  free(p);
}

/* The square of the L2 star discrepancy (Warnock 1972). */
static double discrepancy(const double *p, size_t count, size_t n) {
  double single = 0, both = 0;
  for (size_t a = 0; a < count; a++) {
    double product = 1;
    for (size_t i = 0; i < n; i++) product *= 1 - p[a * n + i] * p[a * n + i];
    single += product;
    for (size_t b = 0; b < count; b++) {
      product = 1;
      for (size_t i = 0; i < n; i++) product *= 1 - fmax(p[a * n + i], p[b * n + i]);
      both += product;
    }
  }
  double c = (double)count;
  return pow(3, -(double)n) - pow(2, 1 - (double)n) / c * single + both / (c * c);
}

static void sequences_are_even(void **state) {
  enum { COUNT = 1024, N = 4 };
  double expected = (pow(2, -N) - pow(3, -N)) / COUNT; /* of random points */
  for (size_t s = 0; s < NSEQUENCE; s++) {
    ambit_sample_points_request q = request(COUNT, N, sequences[s]);
    q.no_corners = true;
    double *p = draw(*state, q, 100), d = discrepancy(p, COUNT, N);
    if (strcmp(sequences[s], "random") == 0)
      assert_true(d > 0.3 * expected && d < 3 * expected);
    else
      assert_true(d > 0 && d < 0.3 * expected);
    free(p);
  }
}

/* The mean of a function of eight data, |mean - truth| over ten seeds: evenness pays. */
static void means_are_better(void **state) {
  enum { COUNT = 4096, N = 8 };
  double off[2] = { 0 };
  for (int way = 0; way < 2; way++)
    for (uint64_t seed = 1; seed <= 10; seed++) {
      ambit_sample_points_request q = request(COUNT, N, way ? "random" : "sobol");
      q.no_corners = true, q.seed = seed;
      double *p = draw(*state, q, 1024), sum = 0;
      for (size_t k = 0; k < COUNT; k++) {
        double f = 1;
        for (size_t i = 0; i < N; i++) f *= 1 + (p[k * N + i] - 0.5);
        sum += f;
      }
      off[way] += fabs(sum / COUNT - 1);
      free(p);
    }
  assert_true(off[0] < 0.25 * off[1]);
}

static void falls_back_and_says_so(void **state) {
  ambit_sample_points *points;
  ambit_failure f = { 0 };
  ambit_interval *many = calloc(2000, sizeof *many);
  assert_non_null(many);
  ambit_sample_points_request q = { .draws = 10, .seed = 1, .n = 41, .range = many };
  static const struct {
    size_t n;
    const char *name, *why;
  } expected[] = { { 256, "sobol", "" }, { 257, "reverse_halton", "" }, { 1229, "reverse_halton", "" },
    { 1230, "random", "1230 data" }, { 0, "random", "nothing is uncertain" } };
  for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
    q.n = expected[i].n;
    if (ambit_sample_points_open(*state, &q, &points, &f) != AMBIT_OK) fail_msg("%s", f.message);
    assert_string_equal(ambit_sample_points_name(points), expected[i].name);
    assert_non_null(strstr(ambit_sample_points_why(points), expected[i].why));
    ambit_sample_points_close(points);
  }
  q.n = 257, q.points = "sobol";
  assert_int_equal(ambit_sample_points_open(*state, &q, &points, &f), AMBIT_INVALID);
  assert_non_null(strstr(f.message, "257 data, and a sequence has at most 256 dimensions"));
  ambit_failure_clear(&f);
  q.n = 3, q.points = "sobal";
  assert_int_equal(ambit_sample_points_open(*state, &q, &points, &f), AMBIT_INVALID);
  assert_non_null(strstr(f.message, "got `sobal`"));
  free(many);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(blocks_do_not_matter, set_up, tear_down),
    cmocka_unit_test_setup_teardown(takes_each_corner_once, set_up, tear_down),
    cmocka_unit_test_setup_teardown(sequences_are_even, set_up, tear_down),
    cmocka_unit_test_setup_teardown(means_are_better, set_up, tear_down),
    cmocka_unit_test_setup_teardown(falls_back_and_says_so, set_up, tear_down),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
