/* test_elementary_service.c -- the plugin service/elementary: correct rounding outward, and MPFR's own state left
** alone. */
#define _POSIX_C_SOURCE 200809L
#include "elementary_oracle.h"
#include "num/rounding.h"
#include <ambit/elementary.h>
#include <dlfcn.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>

static const ambit_elementary_service *service;

static int load(void **state) {
  char file[4096];
  const char *path = getenv("AMBIT_PATH");
  assert_non_null(path);
  snprintf(file, sizeof file, "%s/service/elementary.so", path);
  *state = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  if (!*state) fail_msg("%s", dlerror());
  const ambit_plugin *plugin = dlsym(*state, "ambit_entry");
  assert_non_null(plugin);
  assert_string_equal(plugin->id, "service.elementary");
  assert_null(plugin->get("ambit.elementary/2"));
  service = plugin->get(AMBIT_ELEMENTARY_SERVICE);
  assert_non_null(service);
  assert_true(service->size >= sizeof *service);
  return 0;
}
static int unload(void **state) { return dlclose(*state); }

static void tightest(void **state) {
  uint64_t seed = 521288629u;
  (void)state;
  for (uint32_t op = AMBIT_OP_EXP; op <= AMBIT_OP_TANH; op++)
    for (int i = 0; i < 3000; i++) {
      double x = hard_argument(op, &seed), y = hard_real(&seed), lo, hi, want_lo, want_hi;
      if (op == AMBIT_OP_ATAN2 && x == 0) x = 0, y = y == 0 ? 1 : y; /* the number 0, on the axis */
      service->point(op, x, y, &lo, &hi);
      oracle_slow(op, x, y, &want_lo, &want_hi);
      if (lo != want_lo || hi != want_hi)
        fail_msg("op %u at (%a, %a): [%a, %a], expected [%a, %a]", (unsigned)op, x, y, lo, hi, want_lo, want_hi);
    }
}

static void known_values(void **state) {
  double lo, hi;
  (void)state;
  service->point(AMBIT_OP_EXP, 0, 0, &lo, &hi);
  assert_true(lo == 1 && hi == 1);
  service->point(AMBIT_OP_EXP, -1e308, 0, &lo, &hi);
  assert_true(lo == 0 && hi == 0x1p-1074);
  service->point(AMBIT_OP_SINH, -1e308, 0, &lo, &hi);
  assert_true(lo == -INFINITY && hi == -DBL_MAX);
  service->point(AMBIT_OP_SIN, 0x1p-1074, 0, &lo, &hi);
  assert_true(lo == 0 && hi == 0x1p-1074);
  service->point(AMBIT_OP_ATAN2, 0, -1, &lo, &hi);
  assert_true(lo == PI_DOWN && hi == PI_UP);
}

/* a host program that uses MPFR with a narrow exponent range of its own */
static void leaves_mpfr_as_it_was(void **state) {
  mpfr_exp_t least = mpfr_get_emin(), most = mpfr_get_emax();
  double lo, hi;
  (void)state;
  mpfr_set_emin(-4), mpfr_set_emax(4);
  mpfr_clear_flags();
  mpfr_set_erangeflag();
  mpfr_flags_t flags = mpfr_flags_save();
  service->point(AMBIT_OP_EXP, 100, 0, &lo, &hi);
  assert_true(mpfr_get_emin() == -4 && mpfr_get_emax() == 4 && mpfr_flags_save() == flags);
  mpfr_set_emin(least), mpfr_set_emax(most);
  mpfr_clear_flags();
  double want_lo, want_hi;
  oracle_slow(AMBIT_OP_EXP, 100, 0, &want_lo, &want_hi);
  assert_true(lo == want_lo && hi == want_hi);
}

#if defined(__x86_64__)
#define COUNT 509

/* Every rounding mode, with and without flush-to-zero and denormals-are-zero, arguments of the slow path among them. */
static void same_in_every_environment(void **state) {
  static double lo[COUNT], hi[COUNT], xlo[COUNT], xhi[COUNT], want[2][COUNT], got[2][COUNT];
  uint64_t seed = 1234567u;
  (void)state;
  ambit_elementary_set_slow(service->point);
  for (uint32_t op = AMBIT_OP_EXP; op <= AMBIT_OP_TANH; op++) {
    for (size_t i = 0; i < COUNT; i++) {
      double x = hard_argument(op, &seed), y = hard_real(&seed);
      if (i % 4 == 0 && op >= AMBIT_OP_SIN && op <= AMBIT_OP_TAN) x = beside(ldexp(y, 600), &seed);
      if (!isfinite(x)) x = 1e300;
      lo[i] = x, hi[i] = i % 2 ? x : nextafter(x, INFINITY), xlo[i] = xhi[i] = y;
    }
    ambit_elementary(op, COUNT, lo, hi, xlo, xhi, want[0], want[1]);
    for (unsigned mode = 0; mode < 8; mode++) {
      unsigned control = 0x1f80 | (mode & 3) << 13 | (mode & 4 ? 0x8040 : 0);
      ambit_rounding old = ambit_rounding_set(control);
      ambit_elementary(op, COUNT, lo, hi, xlo, xhi, got[0], got[1]);
      unsigned after = ambit_rounding_set(old);
      assert_int_equal(after & 0xffc0, control);
      assert_memory_equal(got, want, sizeof got);
    }
  }
  ambit_elementary_set_slow(NULL);
}
#else
static void same_in_every_environment(void **state) { (void)state; }
#endif

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(tightest), cmocka_unit_test(known_values),
    cmocka_unit_test(leaves_mpfr_as_it_was), cmocka_unit_test(same_in_every_environment) };
  return cmocka_run_group_tests(tests, load, unload);
}
