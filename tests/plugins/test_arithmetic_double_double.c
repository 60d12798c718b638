/* The worked example of docs/arithmetics.md: it passes the kit, it is as tight as it says, and what it does not take
** goes to the kernel. */
#include "arithmetic_case.h"

enum { A, B, C, D, SLOTS };

typedef struct number { /* as in the plugin: lo.h, lo.l, hi.h, hi.l */
  double lo, lo_low, hi, hi_low;
} number;

static arithmetic_loader loader;
static number block[SLOTS];

static int load(void **state) { return (void)state, arithmetic_load(&loader, "double_double") != NULL; }
static int unload(void **state) { return (void)state, arithmetic_unload(&loader), 0; }

static void passes_the_kit(void **state) {
  (void)state;
  size_t fallbacks;
  assert_int_equal(case_run(&loader, false, &fallbacks), 0);
  assert_int_equal(fallbacks, AMBIT_OP_COUNT - 7);
}

static uint32_t apply(uint32_t op, uint32_t dst, uint32_t a, uint32_t b) {
  loader.full.enter(loader.ctx);
  uint32_t flags = loader.full.run[op](&loader.full, loader.ctx, block, 1, 1, 1, &dst, &a, &b);
  loader.full.leave(loader.ctx);
  return flags;
}

static void put(uint32_t slot, double lo, double hi) { loader.full.set(loader.ctx, &block[slot], 1, &lo, &hi, -1); }

static void get(uint32_t slot, double *lo, double *hi) { loader.full.bounds(loader.ctx, &block[slot], 1, lo, hi); }

/* the slot is a set about 0 of at most this size */
static void assert_vanishes(uint32_t slot, double size) {
  double lo, hi;
  get(slot, &lo, &hi);
  if (!(lo <= 0 && hi >= 0 && hi - lo <= size)) fail_msg("[%a, %a]", lo, hi);
}

static void keeps_a_hundred_bits(void **state) {
  (void)state;
  assert_int_equal(loader.full.set_text(loader.ctx, &block[A], "0.1"), 1);
  put(B, 10, 10), put(C, 1, 1);
  apply(AMBIT_OP_MUL, D, A, B), apply(AMBIT_OP_SUB, A, D, C);
  assert_vanishes(A, 0x1p-97);
  put(A, 2, 2);
  apply(AMBIT_OP_SQRT, B, A, A), apply(AMBIT_OP_SQR, C, B, B), apply(AMBIT_OP_SUB, D, C, A);
  assert_vanishes(D, 0x1p-95);
  put(A, 3, 3), put(B, 1, 1);
  apply(AMBIT_OP_DIV, C, B, A), apply(AMBIT_OP_MUL, D, C, A), apply(AMBIT_OP_SUB, C, D, B);
  assert_vanishes(C, 0x1p-97);
}

/* "-7/3" times 3 is -7, "pi" lies between doubles; what is no such number is left to the enclosure */
static void reads_exact_constants(void **state) {
  (void)state;
  double lo, hi;
  assert_int_equal(loader.full.set_text(loader.ctx, &block[A], "-7/3"), 1);
  put(B, 3, 3), put(C, -7, -7);
  apply(AMBIT_OP_MUL, D, A, B), apply(AMBIT_OP_SUB, A, D, C);
  assert_vanishes(A, 0x1p-95);
  assert_int_equal(loader.full.set_text(loader.ctx, &block[A], "pi"), 1);
  get(A, &lo, &hi);
  assert_true(lo == 0x1.921fb54442d18p+1 && hi == 0x1.921fb54442d19p+1);
  static const char *const other[] = { "", ".", "-", "1/0", "1/", "1e5", "0.1234567890123456", "1.5/2", "[1, 2]", "e" };
  for (size_t i = 0; i < sizeof other / sizeof *other; i++)
    assert_int_equal(loader.full.set_text(loader.ctx, &block[A], other[i]), 0);
}

/* 2^600: outside of the fast path's range */
static void leaves_the_rest_to_the_kernel(void **state) {
  (void)state;
  double lo, hi;
  put(A, 0x1p600, 0x1p600), put(B, 0x1p-600, 0x1p-600);
  assert_int_equal(apply(AMBIT_OP_MUL, C, A, B), 0);
  get(C, &lo, &hi);
  assert_true(lo == 1 && hi == 1);
  assert_int_equal(apply(AMBIT_OP_MUL, C, A, A), AMBIT_F_UNBOUNDED);
  put(B, -1, 1);
  assert_int_equal(apply(AMBIT_OP_DIV, C, A, B), AMBIT_F_PARTIAL | AMBIT_F_UNBOUNDED);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(passes_the_kit),
    cmocka_unit_test(keeps_a_hundred_bits),
    cmocka_unit_test(reads_exact_constants),
    cmocka_unit_test(leaves_the_rest_to_the_kernel),
  };
  return cmocka_run_group_tests_name("arithmetic double_double", tests, load, unload);
}
