/* affine.c -- what affine operations cost, and how tight they are.
**
** Times: ns per operation of one lane inside a run over many instructions, the fastest of many passes, for operands
** with 10 and 50 symbols, with the widest vectors of this processor and with the portable passes. Ratios: to plain
** doubles (plugin `real`).
** Tightness: radius of the error of a product beside that of the trivial rule (radius times radius), random operands;
** width of a vector that is turned by uncertain angles beside plain intervals.
*/
#include "plugin.h"
#include "../plugins/arithmetic/affine/affine.h"
#include <string.h>

#define OPERANDS 12
#define RUN 240
#define PASSES 400

static uint64_t seed = 88172645463325252u;

static double random_double(double lo, double hi) {
  seed ^= seed << 13, seed ^= seed >> 7, seed ^= seed << 17;
  return lo + (hi - lo) * (double)(seed >> 11) * 0x1p-53;
}

typedef struct stage { /* one context and a block of slots */
  bench_arithmetic *b;
  void *ctx;
  char *base;
  size_t elem;
} stage;

static void *at(const stage *s, uint32_t slot) { return s->base + slot * s->elem; }

static stage open_stage(bench_arithmetic *b, uint32_t nvar, double symbols, double product) {
  stage s = { .b = b };
  const double option[3] = { symbols, product, 0 };
  if (b->full.open && b->full.open(&b->scope->host, option, nvar, &s.ctx) != AMBIT_OK) exit(1);
  s.elem = b->full.elem(s.ctx);
  s.base = b->scope->host.alloc(&b->scope->host, (4 * OPERANDS + nvar) * s.elem);
  if (!s.base) exit(1);
  return s;
}

static void run(const stage *s, uint32_t op, size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  if (s->b->full.enter) s->b->full.enter(s->ctx);
  s->b->full.run[op](&s->b->full, s->ctx, s->base, 1, 1, count, dst, a, b);
  if (s->b->full.leave) s->b->full.leave(s->ctx);
}

static void run_one(const stage *s, uint32_t op, uint32_t dst, uint32_t a, uint32_t b) { run(s, op, 1, &dst, &a, &b); }

/* slot := centre + sum of random multiples of all variables, radius near `radius`; uses the three last rows of slots */
static void fill(const stage *s, uint32_t slot, uint32_t nvar, double centre, double radius) {
  const uint32_t scratch = 3 * OPERANDS;
  const double one = 1, minus = -1;
  s->b->full.set(s->ctx, at(s, slot), 1, &centre, &centre, -1);
  for (uint32_t v = 0; v < nvar; v++) {
    double weight = random_double(-2, 2) * radius / nvar;
    s->b->full.set(s->ctx, at(s, scratch), 1, &minus, &one, (int32_t)v);
    s->b->full.set(s->ctx, at(s, scratch + 1), 1, &weight, &weight, -1);
    run_one(s, AMBIT_OP_MUL, scratch + 2, scratch, scratch + 1);
    run_one(s, AMBIT_OP_ADD, scratch + 3, slot, scratch + 2);
    memcpy(at(s, slot), at(s, scratch + 3), s->elem);
  }
}

static double measure(bench_arithmetic *b, uint32_t op, uint32_t nvar, double product) {
  uint32_t dst[RUN], x[RUN], y[RUN];
  stage s = open_stage(b, nvar, 0, product);
  double centre = op == AMBIT_OP_ASIN || op == AMBIT_OP_ACOS ? 0.4 : 1.25;
  for (uint32_t i = 0; i < OPERANDS; i++) fill(&s, i, nvar, centre, 0.1), fill(&s, OPERANDS + i, nvar, 2, 0.1);
  for (uint32_t i = 0; i < RUN; i++) {
    x[i] = i % OPERANDS, y[i] = OPERANDS + (i / OPERANDS + i) % OPERANDS, dst[i] = 2 * OPERANDS + i % OPERANDS;
    if (op == AMBIT_OP_POWN) y[i] = 7;
  }
  double best = 1e18;
  for (int pass = 0; pass < PASSES; pass++) {
    if (b->full.enter) b->full.enter(s.ctx);
    double start = bench_now();
    b->full.run[op](&b->full, s.ctx, s.base, 1, 1, RUN, dst, x, y);
    double each = (bench_now() - start) / RUN;
    if (b->full.leave) b->full.leave(s.ctx);
    if (each < best) best = each;
  }
  if (b->full.close) b->full.close(s.ctx);
  return best;
}

static void times(bench_arithmetic *fast, bench_arithmetic *portable, bench_arithmetic *real) {
  static const char *const name[] = {
#define NAME(name, arity, symbol) #name,
    AMBIT_OPS(NAME)
#undef NAME
  };
  printf("%-10s %10s %10s %14s %14s %8s %9s\n", "ns/op", "10 symbols", "50 symbols", "portable: 10", "50", "real",
      "50/real");
  for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++) {
    double ten = measure(fast, op, 10, 0), fifty = measure(fast, op, 50, 0), plain = measure(real, op, 1, 0);
    printf("%-10s %10.1f %10.1f %14.1f %14.1f %8.2f %9.1f\n", name[op], ten, fifty, measure(portable, op, 10, 0),
        measure(portable, op, 50, 0), plain, fifty / plain);
  }
  printf("%-10s %10.1f %10.1f %14.1f %14.1f\n", "MUL tight", measure(fast, AMBIT_OP_MUL, 10, 1),
      measure(fast, AMBIT_OP_MUL, 50, 1), measure(portable, AMBIT_OP_MUL, 10, 1),
      measure(portable, AMBIT_OP_MUL, 50, 1));
}

/* radius of the error of random products / product of the radii */
static double error_ratio(bench_arithmetic *b, uint32_t nvar, double product) {
  double sum = 0;
  stage s = open_stage(b, nvar, 0, product);
  seed = 4711;
  for (int i = 0; i < 200; i++) {
    fill(&s, 0, nvar, 10, 1), fill(&s, 1, nvar, 10, 1);
    run_one(&s, AMBIT_OP_MUL, 2, 0, 1);
    const affine_element *x = at(&s, 0), *y = at(&s, 1), *r = at(&s, 2);
    sum += r->err / (x->rad * y->rad);
  }
  if (b->full.close) b->full.close(s.ctx);
  return sum / 200;
}

/* width of x after `turns` turns of a vector by angles of 0.3 +- 0.01 each: wrapping makes intervals grow */
static double turned(bench_arithmetic *b, double product, uint32_t turns) {
  enum { X, Y, ANGLE, COS, SIN, CX, SY, SX, CY, NEW_X, NEW_Y };
  stage s = open_stage(b, turns + 2, 48, product);
  double lo[3] = { 0.99, -0.01, 0.29 }, hi[3] = { 1.01, 0.01, 0.31 }, low, high;
  b->full.set(s.ctx, at(&s, X), 1, &lo[0], &hi[0], 0), b->full.set(s.ctx, at(&s, Y), 1, &lo[1], &hi[1], 1);
  for (uint32_t i = 0; i < turns; i++) {
    b->full.set(s.ctx, at(&s, ANGLE), 1, &lo[2], &hi[2], (int32_t)i + 2);
    run_one(&s, AMBIT_OP_COS, COS, ANGLE, ANGLE), run_one(&s, AMBIT_OP_SIN, SIN, ANGLE, ANGLE);
    run_one(&s, AMBIT_OP_MUL, CX, COS, X), run_one(&s, AMBIT_OP_MUL, SY, SIN, Y);
    run_one(&s, AMBIT_OP_MUL, SX, SIN, X), run_one(&s, AMBIT_OP_MUL, CY, COS, Y);
    run_one(&s, AMBIT_OP_SUB, NEW_X, CX, SY), run_one(&s, AMBIT_OP_ADD, NEW_Y, SX, CY);
    memcpy(at(&s, X), at(&s, NEW_X), s.elem), memcpy(at(&s, Y), at(&s, NEW_Y), s.elem);
  }
  b->full.bounds(s.ctx, at(&s, X), 1, &low, &high);
  if (b->full.close) b->full.close(s.ctx);
  return high - low;
}

int main(void) {
  ambit_registry *r = ambit_registry_open(NULL);
  bench_arithmetic fast = bench_open(r, "affine", AMBIT_ARITHMETIC),
                   portable = bench_open(r, "affine", "ambit.arithmetic.portable/1"),
                   real = bench_open(r, "real", AMBIT_ARITHMETIC),
                   interval = bench_open(r, "interval", AMBIT_ARITHMETIC);
  times(&fast, &portable, &real);
  printf("\nerror of a product / trivial rule   fast     tight    tight/fast\n");
  for (uint32_t n = 2; n <= 50; n = n == 2 ? 10 : n == 10 ? 50 : 51) {
    double centred = error_ratio(&fast, n, 0), pairs = error_ratio(&fast, n, 1);
    printf("%2u symbols %30.4f %9.4f %11.4f\n", n, centred, pairs, pairs / centred);
  }
  printf("\nwidth after turns         interval   affine fast   affine tight   fast/interval\n");
  for (uint32_t turns = 2; turns <= 18; turns += 8) {
    double plain = turned(&interval, 0, turns), centred = turned(&fast, 0, turns), pairs = turned(&fast, 1, turns);
    printf("%2u %30.5f %13.5f %14.5f %15.4f\n", turns, plain, centred, pairs, centred / plain);
  }
  bench_close(&fast), bench_close(&portable), bench_close(&real), bench_close(&interval);
  ambit_registry_close(r);
  return 0;
}
