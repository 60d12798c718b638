/* test_power.c -- integer powers of intervals against MPFR: the tightest doubles for every exponent, in every variant
** and floating-point environment; IEEE 1788 sets at 0 and infinity.
*/
#include "elementary_oracle.h"
#include "num/power.h"
#include "num/power_variant.h"
#include "num/rounding.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <cmocka.h>

#define N 61 /* no multiple of 2, 4 or 8 */

typedef struct batch {
  double lo[N], hi[N], rlo[N], rhi[N];
} batch;

static const int32_t exponents[] = { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 13, 16, 31, 100, 255, 511, 512, 513, 1000, 1023,
  4097, 65535, 1000003, INT32_MAX - 1, INT32_MAX, -1, -2, -3, -4, -5, -6, -7, -8, -16, -31, -100, -511, -512, -513,
  -1000, -1074, -65536, -1000003, INT32_MIN + 1, INT32_MIN };

/* bases whose power is a usual number, or any */
static double base(int32_t n, uint64_t *s) {
  double size = fmax(1, fabs((double)n)), x;
  switch (random_bits(s) % 8) {
  case 0: return hard_real(s);
  case 1: x = (double)(random_bits(s) % 200); break; /* exact powers */
  case 2: x = random_scaled(s, -1, 100, 200); break;
  case 3: x = beside(1, s); break;
  case 4: x = beside(exp2(1024 / size), s); break;
  case 5: x = beside(exp2(-1074 / size), s); break;
  default: x = exp2((random_unit(s) - 0.5) * 2050 / size);
  }
  return random_bits(s) & 1 ? x : -x;
}

static void fill(batch *b, int32_t n, uint64_t *s) {
  for (size_t i = 0; i < N; i++) {
    double x = fmax(-DBL_MAX, fmin(base(n, s), DBL_MAX)), y = base(n, s);
    switch (random_bits(s) % 8) {
    case 0: break;
    case 1: y = x < 0 ? -INFINITY : INFINITY; break;
    case 2: y = x + fabs(x) * random_scaled(s, 0, 0, 50); break;
    case 3: y = 0; break;
    default: y = x;
    }
    b->lo[i] = fmin(x, y), b->hi[i] = fmax(x, y);
  }
}

static void check(int32_t n, const batch *b) {
  for (size_t i = 0; i < N; i++) {
    ambit_interval x = { b->lo[i], b->hi[i] }, want = image(AMBIT_OP_POWN, x, x, n);
    if (b->rlo[i] != want.lo || b->rhi[i] != want.hi)
      fail_msg("[%a, %a]^%d = [%a, %a], tightest [%a, %a]", x.lo, x.hi, n, b->rlo[i], b->rhi[i], want.lo, want.hi);
  }
}

static void same(const batch *got, const batch *want) {
  assert_memory_equal(got->rlo, want->rlo, sizeof got->rlo);
  assert_memory_equal(got->rhi, want->rhi, sizeof got->rhi);
}

#if defined(__x86_64__)
static void check_variant(ambit_power_map *map, int32_t n, const batch *want) {
  batch got = *want;
  ambit_rounding old = ambit_round_nearest();
  map(n, N, got.lo, got.hi, got.rlo, got.rhi);
  ambit_rounding_restore(old);
  same(&got, want);
}
static void check_environments(int32_t n, const batch *want) {
  for (unsigned mode = 0; mode < 8; mode++) {
    batch got = *want;
    unsigned control = 0x1f80 | (mode & 3) << 13 | (mode & 4 ? 0x8040 : 0);
    ambit_rounding old = ambit_rounding_set(control);
    ambit_power(n, N, got.lo, got.hi, got.rlo, got.rhi);
    unsigned after = ambit_rounding_set(old);
    assert_int_equal(after & 0xffc0, control);
    same(&got, want);
  }
}
static void check_variants(int32_t n, const batch *want) {
  check_environments(n, want);
  if (n == 0) return;
  check_variant(ambit_power_portable, n, want);
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    check_variant(ambit_power_fma, n, want);
    check_variant(ambit_power_avx2, n, want);
  }
  if (__builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    check_variant(ambit_power_avx512, n, want);
}
#else
static void check_variants(int32_t n, const batch *want) { (void)n, (void)want; }
#endif

static void tightest(void **state) {
  uint64_t seed = 88172645463325252u;
  batch b;
  (void)state;
  for (int round = 0; round < 12; round++)
    for (size_t k = 0; k < sizeof exponents / sizeof *exponents + 20; k++) {
      size_t count = sizeof exponents / sizeof *exponents;
      int32_t n = k < count ? exponents[k] : (int32_t)random_bits(&seed) >> (random_bits(&seed) % 31);
      fill(&b, n, &seed);
      ambit_power(n, N, b.lo, b.hi, b.rlo, b.rhi);
      check(n, &b);
      check_variants(n, &b);
    }
}

/* (1 + 2^-52)^n lies C(n, 2) 2^-104 above a double; the powers of 1 +- 2^-k are as near as powers come */
static void next_to_a_double(void **state) {
  (void)state;
  for (int k = 1; k <= 53; k++)
    for (int32_t n = -40; n <= 40; n++)
      for (int side = -1; side <= 1; side += 2) {
        double x = 1 + side * ldexp(1, -k);
        ambit_interval r, want = image(AMBIT_OP_POWN, (ambit_interval) { x, x }, AMBIT_EMPTY, n);
        ambit_power(n, 1, &x, &x, &r.lo, &r.hi);
        if (r.lo != want.lo || r.hi != want.hi) fail_msg("%a^%d = [%a, %a]", x, n, r.lo, r.hi);
      }
}

typedef struct expectation {
  double lo, hi;
  int32_t n;
  double want_lo, want_hi;
} expectation;

static void sets(void **state) {
  const double inf = INFINITY;
  const expectation table[] = { { inf, -inf, 2, inf, -inf }, { NAN, NAN, 0, inf, -inf }, { 3, 2, -1, inf, -inf },
    { -inf, inf, 0, 1, 1 }, { 0, 0, 0, 1, 1 }, { -inf, inf, 2, 0, inf }, { -inf, inf, 3, -inf, inf },
    { -2, 3, 2, 0, 9 }, { -3, 2, 3, -27, 8 }, { 0, 0, 5, 0, 0 }, { -0.0, 0, 4, 0, 0 }, { 0, 0, -1, inf, -inf },
    { -0.0, 0.0, -2, inf, -inf }, { 0, 2, -1, 0.5, inf }, { -2, 0, -1, -inf, -0.5 }, { -2, 0, -2, 0.25, inf },
    { -2, 4, -1, -inf, inf }, { -2, 4, -2, 0.0625, inf }, { -inf, inf, -1, -inf, inf }, { -inf, inf, -2, 0, inf },
    { 2, inf, -3, 0, 0.125 }, { -inf, -2, -3, -0.125, 0 }, { -inf, 0, -3, -inf, 0 }, { 0, inf, -1, 0, inf },
    { 3, 3, 33, 0x1.3bfefa65abb83p+52, 0x1.3bfefa65abb83p+52 }, { -3, -3, 3, -27, -27 },
    { 2, 2, 1023, 0x1p1023, 0x1p1023 }, { 2, 2, 1024, DBL_MAX, inf }, { 2, 2, -1074, 0x1p-1074, 0x1p-1074 },
    { 2, 2, -1075, 0, 0x1p-1074 }, { -2, -2, 1025, -inf, -DBL_MAX }, { -2, -2, INT32_MIN, 0, 0x1p-1074 },
    { 0.5, 0.5, INT32_MIN, DBL_MAX, inf }, { -1, -1, INT32_MIN, 1, 1 }, { -1, -1, INT32_MAX, -1, -1 },
    { -inf, inf, INT32_MIN, 0, inf }, { 0x1p-1074, 0x1p-1074, 1, 0x1p-1074, 0x1p-1074 },
    { 0x1p-1074, 0x1p-1074, 2, 0, 0x1p-1074 }, { 0x1p-1074, 0x1p-1074, -1, DBL_MAX, inf },
    { DBL_MAX, DBL_MAX, 1, DBL_MAX, DBL_MAX } };
  (void)state;
  for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
    expectation e = table[i];
    double lo[9], hi[9]; /* every variant's group and remainder */
    for (int k = 0; k < 9; k++) lo[k] = e.lo, hi[k] = e.hi;
    ambit_power(e.n, 9, lo, hi, lo, hi);
    for (int k = 0; k < 9; k++)
      if (lo[k] != e.want_lo || hi[k] != e.want_hi)
        fail_msg("[%a, %a]^%d = [%a, %a], expected [%a, %a]", e.lo, e.hi, e.n, lo[k], hi[k], e.want_lo, e.want_hi);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(tightest), cmocka_unit_test(next_to_a_double),
    cmocka_unit_test(sets) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
