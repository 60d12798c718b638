/* test_elementary.c -- inclusion and tightness of ambit_elementary against MPFR, in every variant and floating-point
** environment. */
#include "elementary_oracle.h"
#include "num/rounding.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <cmocka.h>

#define N 1021 /* no multiple of 4 or 8 */
#define POINT_ROUNDS 20
#define WIDE_ROUNDS 10

typedef struct batch {
  double alo[N], ahi[N], blo[N], bhi[N], rlo[N], rhi[N];
} batch;

static const char *const name[AMBIT_ELEMENTARY_COUNT] = { "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan",
  "atan2", "sinh", "cosh", "tanh" };

static bool below_by_one(double got, double want) { return nextafter(want, -INFINITY) <= got; }
static bool above_by_one(double got, double want) { return got <= nextafter(want, INFINITY); }

static void check(uint32_t op, const batch *b, size_t i) {
  ambit_interval x = { b->alo[i], b->ahi[i] }, y = { b->blo[i], b->bhi[i] }, want = image(op, x, y, 0);
  if (!(b->rlo[i] <= want.lo && want.hi <= b->rhi[i]))
    fail_msg("%s([%a, %a], [%a, %a]) = [%a, %a] misses [%a, %a]", name[op - AMBIT_OP_EXP], x.lo, x.hi, y.lo, y.hi,
        b->rlo[i], b->rhi[i], want.lo, want.hi);
  if (!(below_by_one(b->rlo[i], want.lo) && above_by_one(b->rhi[i], want.hi)))
    fail_msg("%s([%a, %a], [%a, %a]) = [%a, %a] is wider than [%a, %a] by more than 1 ulp", name[op - AMBIT_OP_EXP],
        x.lo, x.hi, y.lo, y.hi, b->rlo[i], b->rhi[i], want.lo, want.hi);
}

static void run(uint32_t op, batch *b) { ambit_elementary(op, N, b->alo, b->ahi, b->blo, b->bhi, b->rlo, b->rhi); }

#if defined(__x86_64__)
static void check_variant(const ambit_elementary_map *variant, uint32_t op, const batch *want) {
  static batch got;
  got = *want;
  ambit_rounding old = ambit_round_nearest();
  variant[op - AMBIT_OP_EXP](N, got.alo, got.ahi, got.blo, got.bhi, got.rlo, got.rhi);
  ambit_rounding_restore(old);
  assert_memory_equal(got.rlo, want->rlo, sizeof got.rlo);
  assert_memory_equal(got.rhi, want->rhi, sizeof got.rhi);
}

/* nearest, down, up, zero; with flush-to-zero and denormals-are-zero */
static void check_environments(uint32_t op, const batch *want) {
  static batch got;
  for (unsigned mode = 0; mode < 8; mode++) {
    got = *want;
    unsigned control = 0x1f80 | (mode & 3) << 13 | (mode & 4 ? 0x8040 : 0);
    ambit_rounding old = ambit_rounding_set(control);
    run(op, &got);
    unsigned after = ambit_rounding_set(old);
    assert_int_equal(after & 0xffc0, control);
    assert_memory_equal(got.rlo, want->rlo, sizeof got.rlo);
    assert_memory_equal(got.rhi, want->rhi, sizeof got.rhi);
  }
}

static void check_variants(uint32_t op, const batch *want) {
  check_variant(ambit_elementary_portable, op, want);
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    check_variant(ambit_elementary_fma, op, want);
    check_variant(ambit_elementary_avx2, op, want);
  }
  if (__builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    check_variant(ambit_elementary_avx512, op, want);
  check_environments(op, want);
}
#else
static void check_variants(uint32_t op, const batch *want) { (void)op, (void)want; }
#endif

static void points(void **state) {
  static batch b;
  uint64_t seed = 88172645463325252u;
  (void)state;
  for (uint32_t op = AMBIT_OP_EXP; op <= AMBIT_OP_TANH; op++)
    for (int round = 0; round < POINT_ROUNDS; round++) {
      for (size_t i = 0; i < N; i++) {
        b.alo[i] = b.ahi[i] = hard_argument(op, &seed);
        b.blo[i] = b.bhi[i] = random_bits(&seed) & 1 ? hard_real(&seed) : b.alo[i] * 4 * (random_unit(&seed) - 0.5);
        if (!isfinite(b.blo[i]) || b.blo[i] == 0) b.blo[i] = b.bhi[i] = 1;
      }
      run(op, &b);
      for (size_t i = 0; i < N; i++) check(op, &b, i);
      check_variants(op, &b);
    }
}

static ambit_interval wide_argument(uint32_t op, uint64_t *s) {
  double a = hard_argument(op, s), b = hard_argument(op, s);
  switch (random_bits(s) % 6) {
  case 0: break;
  case 1: b = a + random_scaled(s, 0, 2, 5); break;
  case 2: b = nextafter(a, INFINITY); break;
  case 3: b = a + PI_DOWN * (double)(1 + random_bits(s) % 2); break; /* widths next to pi and 2 pi */
  case 4: a = (double)((int)(random_bits(s) % 3) - 1) * 0.0; break;
  default: b = a + fabs(a) * random_scaled(s, 0, 0, 50);
  }
  if (op == AMBIT_OP_ASIN || op == AMBIT_OP_ACOS) a = fmax(-1, fmin(1, a)), b = fmax(-1, fmin(1, b));
  if (op == AMBIT_OP_LOG) a = a > 0 ? a : 1, b = b > 0 ? b : 1;
  if (!isfinite(b)) b = a;
  return a <= b ? (ambit_interval) { a, b } : (ambit_interval) { b, a };
}

static void intervals(void **state) {
  static batch b;
  uint64_t seed = 1234567890123456789u;
  (void)state;
  for (uint32_t op = AMBIT_OP_EXP; op <= AMBIT_OP_TANH; op++)
    for (int round = 0; round < WIDE_ROUNDS; round++) {
      for (size_t i = 0; i < N; i++) {
        ambit_interval x = wide_argument(op, &seed), y = wide_argument(op, &seed);
        if (random_bits(&seed) % 8 == 0) y = (ambit_interval) { x.lo, x.hi };
        if (y.lo == 0 && y.hi == 0) y.hi = 1;
        b.alo[i] = x.lo, b.ahi[i] = x.hi, b.blo[i] = y.lo, b.bhi[i] = y.hi;
      }
      run(op, &b);
      for (size_t i = 0; i < N; i++) check(op, &b, i);
      check_variants(op, &b);
    }
}

/* the slow path of these tests is the oracle; that of the product is tested in test_elementary_service.c */
static int use_oracle(void **state) {
  (void)state;
  ambit_elementary_set_slow(oracle_slow);
  return 0;
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(points), cmocka_unit_test(intervals) };
  return cmocka_run_group_tests(tests, use_oracle, NULL);
}
