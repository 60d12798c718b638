/* interval.c -- what an interval operation costs beside one in plain double precision: ns per operation over lanes of
** mixed sign, the fastest of many passes. Columns: plugin `real`; plugin `interval` as chosen for this processor, its
** variants with AVX2 and without, with one lane, and with every operation left to the kernel (what a plugin of three
** functions gets). ratio = interval / real.
*/
#include "plugin.h"
#include <string.h>

#define LANES 1000
#define PASSES 300

static const char *const op_name[] = {
#define NAME(name, arity, symbol) #name,
  AMBIT_OPS(NAME)
#undef NAME
};

static double random_double(uint64_t *s) {
  *s ^= *s << 13, *s ^= *s >> 7, *s ^= *s << 17;
  return (double)(*s >> 11) * 0x1p-52 - 1; /* [-1, 1) */
}

/* operands within the domain of every operation */
static void fill(const bench_arithmetic *b, char *block, uint32_t op) {
  uint64_t s = 88172645463325252u;
  size_t elem = b->full.elem(b->ctx);
  double shift = op == AMBIT_OP_SQRT || op == AMBIT_OP_LOG ? 1.5 : 0;
  for (size_t l = 0; l < LANES; l++) {
    double x = random_double(&s) + shift, y = random_double(&s) < 0 ? -2 : 2, lo[2] = { x, y },
           hi[2] = { x + 0x1p-20, y + 0x1p-20 };
    for (int slot = 0; slot < 2; slot++)
      b->full.set(b->ctx, block + ((size_t)slot * LANES + l) * elem, 1, &lo[slot], &hi[slot], -1);
  }
}

/* ns per operation: one instruction with LANES lanes, or LANES instructions with one lane each */
static double measure(const bench_arithmetic *b, uint32_t op, int by_lanes) {
  static char block[3 * LANES * 16];
  static uint32_t dst[LANES], x[LANES], y[LANES];
  size_t lanes = by_lanes ? LANES : 1, count = by_lanes ? 1 : LANES, pitch = lanes;
  for (uint32_t i = 0; i < count; i++) {
    x[i] = i, y[i] = (uint32_t)count + i, dst[i] = 2 * (uint32_t)count + i;
    if (op == AMBIT_OP_POWN) y[i] = 7;
  }
  fill(b, block, op);
  double best = 1e18;
  for (int pass = 0; pass < PASSES; pass++) {
    if (b->full.enter) b->full.enter(b->ctx);
    double start = bench_now();
    b->full.run[op](&b->full, b->ctx, block, pitch, lanes, count, dst, x, y);
    double each = (bench_now() - start) / LANES;
    if (b->full.leave) b->full.leave(b->ctx);
    if (each < best) best = each;
  }
  return best;
}

static int has_avx2(void) {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return 0;
#endif
}

int main(void) {
  ambit_registry *r = ambit_registry_open(NULL);
  bench_arithmetic real = bench_open(r, "real", AMBIT_ARITHMETIC),
                   interval = bench_open(r, "interval", AMBIT_ARITHMETIC);
  bench_arithmetic portable = bench_open(r, "interval", "ambit.arithmetic.portable/1"),
                   kernel = bench_open(r, "interval", AMBIT_ARITHMETIC),
                   avx2 = bench_open(r, "interval", has_avx2() ? "ambit.arithmetic.avx2/1" : AMBIT_ARITHMETIC);
  ambit_arithmetic bare = kernel.full;
  memset(bare.run, 0, sizeof bare.run);
  if (ambit_arithmetic_complete(&bare, &kernel.full, NULL) != AMBIT_OK) return 1;
  printf("%-6s %8s %9s %9s %9s %9s %9s %7s\n", "ns/op", "real", "interval", "AVX2", "portable", "one lane", "kernel",
      "ratio");
  for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++) {
    double plain = measure(&real, op, 1), ours = measure(&interval, op, 1);
    printf("%-6s %8.2f %9.2f %9.2f %9.2f %9.2f %9.2f %7.2f\n", op_name[op], plain, ours, measure(&avx2, op, 1),
        measure(&portable, op, 1), measure(&interval, op, 0), measure(&kernel, op, 1), ours / plain);
  }
  bench_close(&real), bench_close(&interval), bench_close(&portable), bench_close(&kernel), bench_close(&avx2);
  ambit_registry_close(r);
  return 0;
}
