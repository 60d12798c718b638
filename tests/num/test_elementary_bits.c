/* test_elementary_bits.c -- the same bits from every build: checksums of the results over fixed arguments, easy and
** hard, are compared with recorded ones in every variant that this processor runs. So gcc, clang, every optimisation
** and the sanitizers must agree. The slow path is left out: its library may be another one.
**
** To record new constants after a change of the kernels, run the test: it prints what it found.
*/
#include "elementary_oracle.h"
#include "num/power_variant.h"
#include "num/rounding.h"
#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <cmocka.h>

#define N 4099 /* no multiple of 2, 4 or 8 */

typedef struct batch {
  double alo[N], ahi[N], blo[N], bhi[N], rlo[N], rhi[N];
} batch;

static const uint64_t recorded[AMBIT_ELEMENTARY_COUNT] = { 0xd4e5e5d157892052, 0x019c25c0986ba2fe, 0xa99bb2d858a68973,
  0x6c2bc6e25ac4037e, 0xe25822ade44e234f, 0x810a1b13551e5006, 0x5f73f7f5b8269429, 0xd5ba92b8234dacf7,
  0x19c8d833faf6a507, 0x3ca00c6cd765634e, 0x52a049e1646692ce, 0xef8b627b12135d16 };

static const struct {
  int32_t n;
  uint64_t sum;
} recorded_power[] = { { 2, 0xbc1d23a37256f772 }, { 3, 0x4ab8c2f1dabe8554 }, { -1, 0xcf72d18cdbb5d8f1 },
  { 7, 0x676a88927526f9a2 }, { -8, 0x48f3411ca88a1526 }, { 513, 0xbb21dd209dcef744 }, { -1000, 0xe124945baaef22e1 },
  { 2147483647, 0xe0ef7e8ee0aaad95 }, { INT32_MIN, 0x93c00ed04881feaa } };

/* FNV-1a (Fowler, Noll, Vo) over the bits of all bounds */
static uint64_t checksum(const batch *b) {
  uint64_t h = 14695981039346656037u;
  for (size_t i = 0; i < 2 * N; i++) {
    uint64_t bits;
    memcpy(&bits, i < N ? &b->rlo[i] : &b->rhi[i - N], sizeof bits);
    h = (h ^ bits) * 1099511628211u;
  }
  return h;
}

/* only exact or correctly rounded functions of the C library are used */
static void fill(batch *b, uint32_t op) {
  uint64_t s = 88172645463325252u + op;
  for (size_t i = 0; i < N; i++) {
    double x = hard_argument(op, &s), y = hard_real(&s), w = fabs(x) * random_scaled(&s, 0, 0, 50);
    b->alo[i] = x, b->ahi[i] = i % 3 ? x + w : x;
    b->blo[i] = y, b->bhi[i] = i % 3 ? y + fabs(y) / 8 : y;
    if (i % 16 == 0) b->ahi[i] = INFINITY;
    if (i % 17 == 0) b->alo[i] = -INFINITY;
    if (i % 19 == 0) b->ahi[i] = -b->alo[i];
  }
}

static void expect(const char *variant, uint32_t op, const batch *b, uint64_t want) {
  uint64_t got = checksum(b);
  if (got != want) fail_msg("%s, opcode %u: 0x%016" PRIx64 ", recorded 0x%016" PRIx64, variant, op, got, want);
}

static void elementary(const char *variant, const ambit_elementary_map *map) {
  static batch b;
  for (uint32_t op = AMBIT_OP_EXP; op <= AMBIT_OP_TANH; op++) {
    fill(&b, op);
    ambit_rounding old = ambit_round_nearest();
    map[op - AMBIT_OP_EXP](N, b.alo, b.ahi, b.blo, b.bhi, b.rlo, b.rhi);
    ambit_rounding_restore(old);
    expect(variant, op, &b, recorded[op - AMBIT_OP_EXP]);
  }
}

static void power(const char *variant, ambit_power_map *map) {
  static batch b;
  fill(&b, AMBIT_OP_POWN);
  for (size_t k = 0; k < sizeof recorded_power / sizeof *recorded_power; k++) {
    ambit_rounding old = ambit_round_nearest();
    map(recorded_power[k].n, N, b.alo, b.ahi, b.rlo, b.rhi);
    ambit_rounding_restore(old);
    expect(variant, AMBIT_OP_POWN, &b, recorded_power[k].sum);
  }
}

static void same_bits_in_every_build(void **state) {
  (void)state;
  elementary("portable", ambit_elementary_portable);
  power("portable", ambit_power_portable);
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    elementary("fma", ambit_elementary_fma);
    power("fma", ambit_power_fma);
    elementary("avx2", ambit_elementary_avx2);
    power("avx2", ambit_power_avx2);
  }
  if (__builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) {
    elementary("avx512", ambit_elementary_avx512);
    power("avx512", ambit_power_avx512);
  }
#endif
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(same_bits_in_every_build) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
