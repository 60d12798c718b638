/* The smallest arithmetic plugin passes the kit with every operation left to the kernel; and the kit finds what is
** broken. */
#include "arithmetic_case.h"
#include <ambit/rounding.h>
#include <string.h>

static void passes_the_kit(void **state) {
  (void)state;
  arithmetic_loader l;
  size_t fallbacks;
  case_load(&l, "minimal");
  assert_int_equal(case_run(&l, true, &fallbacks), 0);
  assert_int_equal(fallbacks, AMBIT_OP_COUNT);
  arithmetic_unload(&l);
}

/* A kit that finds nothing proves little: each of these plugins breaks one promise. */

static void quiet(void *user, const char *check, const char *message) {
  (void)message;
  char *first = user;
  if (!first[0]) strncpy(first, check, 31);
}

static const ambit_arithmetic *sound; /* the completed minimal arithmetic */

static uint32_t inward_add(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,
    size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  uint32_t flags = sound->run[AMBIT_OP_ADD](self, ctx, base, pitch, lanes, count, dst, a, b);
  double *r = (double *)base + 2 * pitch * dst[0];
  if (r[0] < r[1]) r[1] = nextafter(r[1], -INFINITY);
  return flags;
}

static uint32_t silent_sqrt(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,
    size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  return sound->run[AMBIT_OP_SQRT](self, ctx, base, pitch, lanes, count, dst, a, b) & ~AMBIT_F_PARTIAL;
}

static uint32_t greedy_neg(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,
    size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  return sound->run[AMBIT_OP_NEG](self, ctx, base, pitch, lanes + 1, count, dst, a, b);
}

static uint32_t hollow_mul(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,
    size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  uint32_t flags = sound->run[AMBIT_OP_MUL](self, ctx, base, pitch, lanes, count, dst, a, b);
  double *r = (double *)base + 2 * pitch * dst[0];
  for (size_t l = 0; l < lanes; l++)
    if (r[2 * l] > r[2 * l + 1]) r[2 * l] = 0, r[2 * l + 1] = 0;
  return flags;
}

static void forget_mode(void *ctx) {
  (void)ctx;
  (void)ambit_round_up();
}

static const char *first_finding(const arithmetic_loader *l, const ambit_arithmetic *broken, char check[32]) {
  check[0] = '\0';
  arithmetic_kit kit = { .plugin = broken,
    .full = broken,
    .host = &l->lease->host,
    .isotonic = true,
    .seed = 1,
    .oracle = case_oracle,
    .finding = quiet,
    .user = check };
  return arithmetic_kit_run(&kit) ? check : "nothing";
}

static void finds_what_is_broken(void **state) {
  (void)state;
  arithmetic_loader l;
  char check[32];
  case_load(&l, "minimal");
  sound = &l.full;
  ambit_arithmetic broken = l.full;
  broken.run[AMBIT_OP_ADD] = inward_add;
  assert_string_equal(first_finding(&l, &broken, check), "inclusion");
  broken = l.full, broken.run[AMBIT_OP_SQRT] = silent_sqrt;
  assert_string_equal(first_finding(&l, &broken, check), "partial");
  broken = l.full, broken.run[AMBIT_OP_NEG] = greedy_neg;
  assert_string_equal(first_finding(&l, &broken, check), "layout");
  broken = l.full, broken.run[AMBIT_OP_MUL] = hollow_mul;
  assert_string_equal(first_finding(&l, &broken, check), "empty");
  broken = l.full, broken.enter = forget_mode;
  assert_string_equal(first_finding(&l, &broken, check), "environment");
  ambit_rounding_restore(0x1f80);
  arithmetic_unload(&l);
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(passes_the_kit), cmocka_unit_test(finds_what_is_broken) };
  return cmocka_run_group_tests_name("arithmetic kit, minimal plugin", tests, NULL, NULL);
}
