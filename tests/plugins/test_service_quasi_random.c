/* test_service_quasi_random.c -- the service against values that its sequences are known to have, its limits, and
** misuse. */
#include <ambit/registry.h>
#include <ambit/quasi_random.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

static int set_up(void **state) {
  *state = ambit_registry_open(NULL);
  return *state ? 0 : 1;
}

static int tear_down(void **state) {
  ambit_registry_close(*state);
  return 0;
}

static const ambit_quasi_random_service *find(ambit_registry *r) {
  const ambit_plugin *plugin;
  ambit_failure f = { 0 };
  if (ambit_registry_plugin(r, "service", "quasi_random", &plugin, &f) != AMBIT_OK) fail_msg("%s", f.message);
  assert_null(plugin->get("ambit.quasi_random/2"));
  const ambit_quasi_random_service *s = plugin->get(AMBIT_QUASI_RANDOM_SERVICE);
  assert_non_null(s);
  return s;
}

static void gives_known_points(void **state) {
  const ambit_quasi_random_service *s = find(*state);
  /* van der Corput's numbers in the bases 2 and 3 (Halton 1960); Sobol's first two dimensions, in Gray's order */
  static const double halton[2][6] = { { 1. / 2, 1. / 4, 3. / 4, 1. / 8, 5. / 8, 3. / 8 },
    { 1. / 3, 2. / 3, 1. / 9, 4. / 9, 7. / 9, 2. / 9 } };
  static const double sobol[2][6] = { { 0.5, 0.75, 0.25, 0.375, 0.875, 0.625 },
    { 0.5, 0.25, 0.75, 0.375, 0.875, 0.125 } };
  static const char *const name[] = { "halton", "sobol" };
  for (int k = 0; k < 2; k++) {
    void *self;
    double p[2 * 8] = { 0 };
    assert_int_equal(s->open(name[k], 2, &self), AMBIT_OK);
    assert_int_equal(s->next(self, 2, p, 8), AMBIT_OK); /* in two parts */
    assert_int_equal(s->next(self, 4, p + 2, 8), AMBIT_OK);
    for (int i = 0; i < 2; i++)
      for (int j = 0; j < 6; j++) assert_true(fabs(p[i * 8 + j] - (k ? sobol : halton)[i][j]) < 1e-15);
    assert_true(p[6] == 0 && p[7] == 0);
    s->close(self);
  }
}

/* scipy 1.10, qmc.Sobol(256, scramble=False): point 777, an independent reading of the same table */
static void agrees_with_other_peoples_sobol(void **state) {
  const ambit_quasi_random_service *s = find(*state);
  static const struct {
    uint32_t dimension;
    double value;
  } known[] = { { 0, 0.6923828125 }, { 1, 0.9365234375 }, { 2, 0.1630859375 }, { 10, 0.7451171875 },
    { 40, 0.7216796875 }, { 99, 0.5107421875 }, { 180, 0.7041015625 }, { 254, 0.5791015625 }, { 255, 0.6357421875 } };
  void *self;
  double *p = calloc(256, 777 * sizeof *p);
  assert_non_null(p);
  assert_int_equal(s->open("sobol", 256, &self), AMBIT_OK);
  assert_int_equal(s->next(self, 777, p, 777), AMBIT_OK);
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    assert_true(p[known[i].dimension * 777 + 776] == known[i].value);
  free(p);
  s->close(self);
}

/* Of 2^m points of a digital sequence, 0 among them, each box with 2^-a and 2^-b as its sides in two dimensions, a + b
** = m - t, holds 2^t; Niederreiter's t is the sum of (degree - 1) (Niederreiter 1988, theorem 1). */
static void fills_boxes_evenly(void **state) {
  enum { M = 8, ALL = 1 << M, S = 6 };
  static const int excess[S] = { 0, 0, 1, 2, 2, 3 }; /* of the degrees 1, 1, 2, 3, 3, 4 over 1 */
  const ambit_quasi_random_service *s = find(*state);
  double p[S * ALL] = { 0 };
  void *self;
  assert_int_equal(s->open("niederreiter", S, &self), AMBIT_OK);
  assert_int_equal(s->next(self, ALL - 1, p + 1, ALL), AMBIT_OK);
  s->close(self);
  for (int i = 0; i < S; i++)
    for (int j = 0; j < i; j++) {
      int t = excess[i] + excess[j];
      for (int a = 0; a <= M - t; a++) {
        int held[ALL] = { 0 }, b = M - t - a;
        for (int k = 0; k < ALL; k++) held[((int)ldexp(p[i * ALL + k], a) << b) + (int)ldexp(p[j * ALL + k], b)]++;
        for (int k = 0; k < 1 << (M - t); k++) assert_int_equal(held[k], 1 << t);
      }
    }
}

static void knows_its_limits(void **state) {
  const ambit_quasi_random_service *s = find(*state);
  static const struct {
    const char *name;
    uint32_t dimensions;
  } known[] = { { "sobol", 256 }, { "niederreiter", 32 }, { "halton", 1229 }, { "reverse_halton", 1229 }, { "", 0 },
    { "random", 0 } };
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    uint32_t dimensions = 7;
    uint64_t points = 7;
    void *self = &points;
    s->most(known[i].name, &dimensions, &points);
    assert_int_equal(dimensions, known[i].dimensions);
    assert_int_equal(points > 0, dimensions > 0);
    assert_int_equal(s->open(known[i].name, dimensions + 1, &self), AMBIT_INVALID);
    assert_null(self);
    assert_int_equal(s->open(known[i].name, 0, &self), AMBIT_INVALID);
    if (!dimensions) continue;
    assert_int_equal(s->open(known[i].name, dimensions, &self), AMBIT_OK);
    double *p = calloc(dimensions, 3 * sizeof *p);
    assert_non_null(p);
    assert_int_equal(s->next(self, 3, p, 3), AMBIT_OK);
    for (size_t k = 0; k < 3 * (size_t)dimensions; k++) assert_true(p[k] >= 0 && p[k] < 1);
    assert_int_equal(s->next(self, points - 2, p, points), AMBIT_UNABLE); /* there are no more */
    free(p);
    s->close(self);
  }
  s->close(NULL);
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test_setup_teardown(gives_known_points, set_up, tear_down),
    cmocka_unit_test_setup_teardown(agrees_with_other_peoples_sobol, set_up, tear_down),
    cmocka_unit_test_setup_teardown(fills_boxes_evenly, set_up, tear_down),
    cmocka_unit_test_setup_teardown(knows_its_limits, set_up, tear_down) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
