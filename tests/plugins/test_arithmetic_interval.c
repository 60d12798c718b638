/* The interval plugin, with and without vector extensions: conformance, equality with the kernel's functions, IEEE
** 1788's special sets. */
#include "arithmetic_case.h"
#include "num/interval.h"

static const char *const variant[] = { AMBIT_ARITHMETIC, "ambit.arithmetic.portable/1", "ambit.arithmetic.avx2/1",
  "ambit.arithmetic.avx512/1" };
#define VARIANTS 4

/* false: not for this processor */
static bool load_variant(arithmetic_loader *l, int which) {
  const char *problem = arithmetic_load_as(l, "interval", variant[which]);
  if (problem && l->library && !l->plugin && which > 1) {
    arithmetic_unload(l);
    return false;
  }
  if (problem) fail_msg("%s", problem);
  return true;
}

static void passes_the_kit(void **state) {
  (void)state;
  for (int v = 0; v < VARIANTS; v++) {
    arithmetic_loader l;
    size_t fallbacks;
    if (!load_variant(&l, v)) continue;
    assert_int_equal(l.plugin->rigorous, 1);
    assert_int_equal(case_run(&l, true, &fallbacks), 0);
    assert_int_equal(fallbacks, 0);
    arithmetic_unload(&l);
  }
}

typedef struct element { /* opaque */
  double half[2];
} element;

static uint32_t apply(
    const arithmetic_loader *l, uint32_t op, int32_t n, ambit_interval a, ambit_interval b, ambit_interval *r) {
  element block[3];
  const double lo[2] = { a.lo, b.lo }, hi[2] = { a.hi, b.hi };
  const uint32_t dst = 2, x = 0, y = op == AMBIT_OP_POWN ? (uint32_t)n : 1;
  l->full.set(l->ctx, block, 2, lo, hi, -1);
  l->full.enter(l->ctx);
  uint32_t flags = l->full.run[op](&l->full, l->ctx, block, 1, 1, 1, &dst, &x, &y);
  l->full.leave(l->ctx);
  l->full.bounds(l->ctx, block + 2, 1, &r->lo, &r->hi);
  return flags;
}

/* an operand of every kind */
static ambit_interval any_set(uint64_t *state) {
  double a = oracle_double(state), b = oracle_double(state);
  switch (oracle_random(state) % 10) {
  case 0: return AMBIT_EMPTY;
  case 1: return AMBIT_ENTIRE;
  case 2: return (ambit_interval) { -INFINITY, a };
  case 3: return (ambit_interval) { a, INFINITY };
  case 4: return (ambit_interval) { a, a };
  case 5: return a < 0 ? (ambit_interval) { a, 0 } : (ambit_interval) { 0, a };
  case 6: return (ambit_interval) { 0, 0 };
  default: return a <= b ? (ambit_interval) { a, b } : (ambit_interval) { b, a };
  }
}

/* The kernel's functions are tested against MPFR for inclusion and tightness (tests/num); these must be the same,
** flags included. */
static void equals_the_kernel(void **state) {
  (void)state;
  for (int v = 0; v < VARIANTS; v++) {
    arithmetic_loader l;
    uint64_t random = 5;
    if (!load_variant(&l, v)) continue;
    for (int i = 0; i < 20000; i++)
      for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++) {
        ambit_interval a = any_set(&random), b = any_set(&random), want, r;
        int32_t n = (int32_t)(oracle_random(&random) % 25) - 12;
        uint32_t flags = op == AMBIT_OP_POWN ? ambit_interval_pown(&want, a, n) : ambit_interval_op(op, &want, a, b);
        uint32_t got = apply(&l, op, n, a, b, &r);
        if (r.lo != want.lo || r.hi != want.hi || got != flags)
          fail_msg("%s: op %u of [%a, %a], [%a, %a], n = %d: [%a, %a] flags %u, the kernel has [%a, %a] flags %u",
              variant[v], op, a.lo, a.hi, b.lo, b.hi, n, r.lo, r.hi, got, want.lo, want.hi, flags);
      }
    arithmetic_unload(&l);
  }
}

static void expect(uint32_t op, ambit_interval a, ambit_interval b, ambit_interval want, uint32_t want_flags) {
  for (int v = 0; v < VARIANTS; v++) {
    arithmetic_loader l;
    ambit_interval r;
    if (!load_variant(&l, v)) continue;
    uint32_t flags = apply(&l, op, 0, a, b, &r);
    if (r.lo != want.lo || r.hi != want.hi || flags != want_flags)
      fail_msg(
          "op %u: [%a, %a] flags %u, expected [%a, %a] flags %u", op, r.lo, r.hi, flags, want.lo, want.hi, want_flags);
    arithmetic_unload(&l);
  }
}

#define I(lo, hi) ((ambit_interval) { lo, hi })

static void special_sets(void **state) {
  (void)state;
  const uint32_t P = AMBIT_F_PARTIAL, U = AMBIT_F_UNBOUNDED, E = AMBIT_F_EMPTY;
  expect(AMBIT_OP_ADD, AMBIT_EMPTY, AMBIT_ENTIRE, AMBIT_EMPTY, E);
  expect(AMBIT_OP_SUB, I(1, INFINITY), I(1, INFINITY), AMBIT_ENTIRE, U);
  expect(AMBIT_OP_MUL, I(0, 0), AMBIT_ENTIRE, I(0, 0), 0);
  expect(AMBIT_OP_MUL, I(-INFINITY, 0), I(0, INFINITY), I(-INFINITY, 0), U);
  expect(AMBIT_OP_DIV, I(1, 1), I(0, 0), AMBIT_EMPTY, P | E);
  expect(AMBIT_OP_DIV, I(1, 2), I(0, 4), I(0.25, INFINITY), P | U);
  expect(AMBIT_OP_DIV, I(-2, -1), I(-4, 0), I(0.25, INFINITY), P | U);
  expect(AMBIT_OP_DIV, I(0, 2), I(0, 4), I(0, INFINITY), P | U);
  expect(AMBIT_OP_DIV, I(0, 0), I(-1, 1), I(0, 0), P);
  expect(AMBIT_OP_DIV, I(1, INFINITY), I(2, INFINITY), I(0, INFINITY), U);
  expect(AMBIT_OP_DIV, AMBIT_EMPTY, I(0, 0), AMBIT_EMPTY, E);
  expect(AMBIT_OP_SQRT, I(-4, 9), I(0, 0), I(0, 3), P);
  expect(AMBIT_OP_SQRT, I(-4, -1), I(0, 0), AMBIT_EMPTY, P | E);
  expect(AMBIT_OP_SQRT, I(0, INFINITY), I(0, 0), I(0, INFINITY), U);
  expect(AMBIT_OP_SQR, I(-INFINITY, 2), I(0, 0), I(0, INFINITY), U);
  expect(AMBIT_OP_ABS, I(-3, 2), I(0, 0), I(0, 3), 0);
  expect(AMBIT_OP_MIN, AMBIT_EMPTY, I(1, 2), AMBIT_EMPTY, E);
  expect(AMBIT_OP_MAX, I(-INFINITY, 0), I(1, 2), I(1, 2), 0);
}

static void bad_data_is_empty(void **state) {
  (void)state;
  arithmetic_loader l;
  const double lo[] = { 2, NAN, 0, INFINITY, -INFINITY }, hi[] = { 1, 1, NAN, INFINITY, -INFINITY };
  element x[5];
  double down[5], up[5];
  load_variant(&l, 0);
  l.full.set(l.ctx, x, 5, lo, hi, -1);
  l.full.bounds(l.ctx, x, 5, down, up);
  for (int i = 0; i < 5; i++) assert_true(down[i] == INFINITY && up[i] == -INFINITY);
  arithmetic_unload(&l);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(passes_the_kit),
    cmocka_unit_test(equals_the_kernel),
    cmocka_unit_test(special_sets),
    cmocka_unit_test(bad_data_is_empty),
  };
  return cmocka_run_group_tests_name("arithmetic interval", tests, NULL, NULL);
}
