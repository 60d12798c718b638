/* taylor_model.c -- what Taylor models cost beside the same polynomial product in plain doubles (a table in graded
** order, no bounds at all), and how wide their results are. Times: the fastest of many passes, microseconds. ratio: to
** the plain product of the same run.
*/
#include "plugin.h"
#include <ambit/taylor.h>
#include <math.h>
#include <string.h>

#define ROOM 64 /* elements */

static const char *const variant[] = { AMBIT_ARITHMETIC, "ambit.arithmetic.avx2/1", "ambit.arithmetic.portable/1" };
static const char *const variant_name[] = { "widest", "AVX2", "portable" };

typedef struct bench_model {
  ambit_arithmetic full;
  ambit_scope *scope;
  void *ctx;
  const ambit_taylor *taylor;
  size_t elem;
  char *block;
} bench_model;

static bench_model open_model(ambit_registry *r, int which, uint32_t nvar, uint32_t order) {
  bench_model b = { 0 };
  ambit_failure f = { 0 };
  const ambit_plugin *plugin = NULL;
  const double option[] = { order, 16 };
  if (ambit_registry_plugin(r, "arithmetic", "taylor_model", &plugin, &f) != AMBIT_OK ||
      ambit_arithmetic_complete(plugin->get(variant[which]), &b.full, &f) != AMBIT_OK ||
      ambit_scope_open(&b.scope, NULL, NULL) != AMBIT_OK ||
      b.full.open(&b.scope->host, option, nvar, &b.ctx) != AMBIT_OK) {
    fprintf(stderr, "taylor_model: %s\n", f.message);
    exit(1);
  }
  b.taylor = plugin->get(AMBIT_TAYLOR);
  b.elem = b.full.elem(b.ctx);
  b.block = b.scope->host.alloc(&b.scope->host, ROOM * b.elem);
  if (!b.block) exit(1);
  return b;
}

static void close_model(bench_model *b) {
  b->full.close ? b->full.close(b->ctx) : (void)0;
  ambit_scope_close(b->scope);
}

static void *at(const bench_model *b, uint32_t slot) { return b->block + slot * b->elem; }

/* a polynomial with every coefficient, falling with the degree, and range about 1 +- 0.1 */
static void fill(const bench_model *b, uint32_t slot, uint64_t seed) {
  static uint32_t index[1 << 16];
  static double value[1 << 16];
  uint32_t nvar, order, count, exponent[64];
  b->taylor->shape(b->ctx, &nvar, &order, &count);
  for (uint32_t i = 0; i < count; i++) {
    uint32_t degree = 0;
    b->taylor->exponents(b->ctx, i, exponent);
    for (uint32_t v = 0; v < nvar; v++) degree += exponent[v];
    seed ^= seed << 13, seed ^= seed >> 7, seed ^= seed << 17;
    index[i] = i, value[i] = i ? ((double)(seed >> 11) * 0x1p-52 - 1) * 0.04 / pow(4, degree) : 1;
  }
  b->taylor->build(b->ctx, at(b, slot), count, index, value, -1e-12, 1e-12);
}

/* us for `count` instructions in one run */
static double measure(
    const bench_model *b, uint32_t op, size_t count, const uint32_t *dst, const uint32_t *x, const uint32_t *y) {
  double best = 1e18, spent = 0;
  for (int pass = 0; pass < 20000 && (pass < 20 || spent < 2e8); pass++) {
    if (b->full.enter) b->full.enter(b->ctx);
    double start = bench_now();
    b->full.run[op](&b->full, b->ctx, b->block, 1, 1, count, dst, x, y);
    double each = bench_now() - start;
    if (b->full.leave) b->full.leave(b->ctx);
    spent += each;
    if (each < best) best = each;
  }
  return best / 1e3;
}

/* -- the plain product */

typedef struct plain {
  uint32_t count, *end, *table; /* end[i]: number of partners of monomial i */
  double *a, *b, *c;
} plain;

static __attribute__((noinline)) void plain_product(const plain *p) {
  const uint32_t *t = p->table;
  memset(p->c, 0, p->count * sizeof *p->c);
  for (uint32_t i = 0; i < p->count; i++)
    for (uint32_t j = 0; j < p->end[i]; j++) p->c[*t++] += p->a[i] * p->b[j];
}

static double plain_time(const bench_model *b, size_t *products) {
  plain p = { 0 };
  uint32_t nvar, order, x[64], y[64];
  b->taylor->shape(b->ctx, &nvar, &order, &p.count);
  p.end = calloc(p.count, sizeof *p.end), p.table = NULL;
  p.a = calloc(3 * (size_t)p.count, sizeof *p.a), p.b = p.a + p.count, p.c = p.b + p.count;
  if (!p.end || !p.a) exit(1);
  size_t n = 0;
  for (int pass = 0; pass < 2; pass++, n = pass < 2 ? 0 : n) {
    for (uint32_t i = 0; i < p.count; i++) {
      p.a[i] = p.b[i] = 1.0 / (i + 1);
      b->taylor->exponents(b->ctx, i, x);
      for (p.end[i] = 0; p.end[i] < p.count; p.end[i]++, n++) {
        b->taylor->exponents(b->ctx, p.end[i], y);
        for (uint32_t v = 0; v < nvar; v++) y[v] += x[v];
        uint32_t k = b->taylor->index(b->ctx, y);
        if (k == UINT32_MAX) break;
        if (pass) p.table[n] = k;
      }
    }
    if (!pass && !(p.table = calloc(n, sizeof *p.table))) exit(1);
  }
  double best = 1e18, spent = 0;
  for (int pass = 0; pass < 20000 && (pass < 20 || spent < 2e8); pass++) {
    double start = bench_now();
    plain_product(&p);
    double each = bench_now() - start;
    spent += each;
    if (each < best) best = each;
  }
  *products = n;
  free(p.end), free(p.table), free(p.a);
  return best / 1e3;
}

static void times(ambit_registry *r, uint32_t nvar, uint32_t order) {
  for (int which = 0; which < 3; which++) {
    bench_model b = open_model(r, which, nvar, order);
    size_t products;
    uint32_t dst[16], x[16], y[16], many = 8;
    fill(&b, 0, 1234567), fill(&b, 1, 7654321);
    for (uint32_t i = 0; i < 16; i++) dst[i] = 2 + i, x[i] = 0, y[i] = 1;
    double plain = plain_time(&b, &products);
    double one = measure(&b, AMBIT_OP_MUL, 1, dst, x, y), eight = measure(&b, AMBIT_OP_MUL, many, dst, x, y) / many;
    printf("%4u %5u %8zu  %-8s %9.3f %9.3f %5.2f %9.3f %5.2f", nvar, order, products, variant_name[which], plain, one,
        one / plain, eight, eight / plain);
    static const uint32_t op[] = { AMBIT_OP_ADD, AMBIT_OP_SIN, AMBIT_OP_EXP, AMBIT_OP_DIV, AMBIT_OP_ATAN };
    for (size_t i = 0; i < sizeof op / sizeof *op; i++) printf(" %9.3f", measure(&b, op[i], 1, dst, x, y));
    printf("\n");
    close_model(&b);
  }
}

/* -- how wide: sin(x y) + exp(x) / (2 + y) over x, y in +-radius, width beyond the true range, relative */

static double true_width(double radius) {
  double lo = INFINITY, hi = -INFINITY;
  for (int i = 0; i <= 400; i++)
    for (int j = 0; j <= 400; j++) {
      double x = radius * (i / 200.0 - 1), y = radius * (j / 200.0 - 1), f = sin(x * y) + exp(x) / (2 + y);
      lo = fmin(lo, f), hi = fmax(hi, f);
    }
  return hi - lo;
}

static void widths(ambit_registry *r, double radius) {
  printf("%8.3g", radius);
  for (uint32_t order = 0; order <= 10; order += order < 4 ? 1 : 2) {
    bench_model b = open_model(r, 0, 2, order);
    const double lo = -radius, hi = radius, two = 2;
    enum { X, Y, TWO, XY, SINE, SUM, E, Q, F };
    static const uint32_t op[] = { AMBIT_OP_MUL, AMBIT_OP_SIN, AMBIT_OP_ADD, AMBIT_OP_EXP, AMBIT_OP_DIV, AMBIT_OP_ADD };
    static const uint32_t dst[] = { XY, SINE, SUM, E, Q, F }, x[] = { X, XY, TWO, X, E, SINE },
                          y[] = { Y, XY, Y, X, SUM, Q };
    b.full.set(b.ctx, at(&b, X), 1, &lo, &hi, 0), b.full.set(b.ctx, at(&b, Y), 1, &lo, &hi, 1);
    b.full.set(b.ctx, at(&b, TWO), 1, &two, &two, -1);
    b.full.enter(b.ctx);
    for (int i = 0; i < 6; i++) b.full.run[op[i]](&b.full, b.ctx, b.block, 1, 1, 1, &dst[i], &x[i], &y[i]);
    b.full.leave(b.ctx);
    double down, up;
    b.full.bounds(b.ctx, at(&b, F), 1, &down, &up);
    printf(" %9.2g", (up - down) / true_width(radius) - 1);
    close_model(&b);
  }
  printf("\n");
}

int main(void) {
  ambit_registry *r = ambit_registry_open(NULL);
  printf("us\nnvar order products  variant      plain   product ratio  eight at a time   add       sin       exp       "
         "div      atan\n");
  static const uint32_t shape[][2] = { { 4, 6 }, { 4, 10 }, { 1, 11 }, { 2, 8 }, { 8, 4 }, { 20, 3 } };
  for (size_t i = 0; i < sizeof shape / sizeof *shape; i++) times(r, shape[i][0], shape[i][1]);
  printf("\nwidth of sin(x y) + exp(x) / (2 + y) beyond the true range, relative; x, y in +-radius\n  radius");
  for (uint32_t order = 0; order <= 10; order += order < 4 ? 1 : 2) printf("   order %-2u", order);
  printf("\n");
  for (int i = 0; i < 5; i++) widths(r, (const double[]) { 1e-3, 0.1, 0.3, 0.6, 1 }[i]);
  ambit_registry_close(r);
  return 0;
}
