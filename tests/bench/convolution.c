/* convolution.c -- the heart of a Taylor integrator: the product of two truncated power series of order 20 (231
** products) with interval coefficients, in several ways, and beside them the plain double product, which the compiler
** leaves scalar (it may not reorder a sum); the product of two matrices; then all of it together, the series of the
** double pendulum's equations. ns for the whole, the fastest of many passes; ratio to plain doubles.
*/
#include "graph/jet.h"
#include "graph/tape.h"
#include "num/product_variant.h"
#include "num/rounding.h"
#include "num/service.h"
#include "plugin.h"

#define ORDER 20
#define SLOPE_ORDER 8
#define NDIR 4
#define PASSES 400
#define REPEAT 20 /* calls in a pass: the clock itself takes as long as one */

static double fastest(void (*work)(void *), void *data) {
  double best = 1e18;
  for (int pass = 0; pass < PASSES; pass++) {
    double start = bench_now();
    for (int i = 0; i < REPEAT; i++) work(data);
    double each = (bench_now() - start) / REPEAT;
    if (each < best) best = each;
  }
  return best;
}

/* -- plain doubles, not inlined, so that it is really done */

typedef struct plain {
  double a[ORDER + 1], b[ORDER + 1], c[ORDER + 1];
} plain;

static __attribute__((noinline)) void plain_product(void *data) {
  plain *p = data;
  for (int k = 0; k <= ORDER; k++) {
    double sum = 0;
    for (int j = 0; j <= k; j++) sum += p->a[j] * p->b[k - j];
    p->c[k] = sum;
  }
}

/* -- the service `ambit.num/1`, and each variant behind it */

#define MATRIX 24

typedef struct bounds {
  double lo[MATRIX * MATRIX], hi[MATRIX * MATRIX];
} bounds;

typedef struct factors {
  const ambit_product_variant *variant; /* NULL: the service */
  size_t n;
  bounds a, b, r;
} factors;

static void by_series(void *data) {
  factors *f = data;
  if (!f->variant) {
    ambit_num_service_v1.convolve(f->n, f->r.lo, f->r.hi, f->a.lo, f->a.hi, f->b.lo, f->b.hi);
    return;
  }
  ambit_rounding old = ambit_round_up();
  f->variant->convolve(f->n, f->r.lo, f->r.hi, f->a.lo, f->a.hi, f->b.lo, f->b.hi);
  ambit_rounding_restore(old);
}

static void by_matrix(void *data) {
  factors *f = data;
  if (!f->variant) {
    ambit_num_service_v1.matmul(f->n, f->n, f->n, f->r.lo, f->r.hi, f->a.lo, f->a.hi, f->b.lo, f->b.hi);
    return;
  }
  ambit_rounding old = ambit_round_up();
  f->variant->matmul(f->n, f->n, f->n, f->r.lo, f->r.hi, f->a.lo, f->a.hi, f->b.lo, f->b.hi);
  ambit_rounding_restore(old);
}

static __attribute__((noinline)) void plain_matrix(void *data) {
  factors *f = data;
  for (size_t i = 0; i < f->n; i++)
    for (size_t j = 0; j < f->n; j++) {
      double sum = 0;
      for (size_t k = 0; k < f->n; k++) sum += f->a.lo[i * f->n + k] * f->b.lo[k * f->n + j];
      f->r.lo[i * f->n + j] = sum;
    }
}

static void print(const char *what, double ns, double reference) {
  printf("%-52s %10.0f %8.1f\n", what, ns, ns / reference);
}

static void print_variants(void (*work)(void *), factors *f, double reference) {
  f->variant = NULL;
  print("midpoint-radius kernel, as the service lends it", fastest(work, f), reference);
  f->variant = &ambit_product_portable;
  print("the same without AVX2", fastest(work, f), reference);
}

static void fill_factors(factors *f) {
  for (size_t i = 0; i < MATRIX * MATRIX; i++) {
    f->a.lo[i] = 2.3 / (double)(i + 1), f->a.hi[i] = f->a.lo[i] * (1 + 0x1p-30);
    f->b.lo[i] = 1 - f->a.lo[i], f->b.hi[i] = f->b.lo[i] + 0x1p-30;
  }
}

/* -- tier 1: elements in a row for each series; dot, or one multiplication and addition at a time */

typedef struct elements {
  bench_arithmetic *b;
  _Alignas(64) char block[4 * (ORDER + 1) * 16];
} elements;

enum { A = 0, B = ORDER + 1, C = 2 * (ORDER + 1), SCRATCH = 3 * (ORDER + 1) };

static void *element(elements *e, uint32_t i) { return e->block + 16 * (size_t)i; }

static void by_dot(void *data) {
  elements *e = data;
  for (uint32_t k = 0; k <= ORDER; k++)
    e->b->full.dot(e->b->ctx, element(e, C + k), element(e, A), 1, element(e, B + k), -1, k + 1, 1);
}

static void by_runs(void *data) {
  elements *e = data;
  const ambit_arithmetic *full = &e->b->full;
  const double zero = 0;
  full->enter(e->b->ctx);
  for (uint32_t k = 0; k <= ORDER; k++) {
    uint32_t product = SCRATCH, sum = SCRATCH + 1, other = C + k;
    if (k % 2) sum = C + k, other = SCRATCH + 1; /* sums alternate, and the last one is in C + k */
    full->set(e->b->ctx, element(e, sum), 1, &zero, &zero, -1);
    for (uint32_t j = 0; j <= k; j++) {
      uint32_t a = A + j, b = B + k - j, old = j % 2 ? other : sum, new = j % 2 ? sum : other;
      full->run[AMBIT_OP_MUL](full, e->b->ctx, e->block, 1, 1, 1, &product, &a, &b);
      full->run[AMBIT_OP_ADD](full, e->b->ctx, e->block, 1, 1, 1, &new, &old, &product);
    }
  }
  full->leave(e->b->ctx);
}

/* -- tier 2: jets of a tape */

typedef struct series {
  const ambit_jets *jets;
  const ambit_tape *tape;
  void *self;
  uint32_t order, given; /* coefficients 0..given of each input are put; the rest follow from x' = outputs */
  double radius;
} series;

static void by_jets(void *data) {
  series *s = data;
  double slope[NDIR] = { 0 };
  for (uint32_t k = 0; k <= s->order; k++) {
    for (uint32_t i = 0; i < s->tape->nin && k <= s->given; i++) {
      slope[i] = k == 0;
      s->jets->put(s->self, i, k, 2.3 / ((k + 1.0) * (i + 1)), s->radius, slope, NULL);
      slope[i] = 0;
    }
    if (s->jets->advance(s->self, k)) exit(1);
    for (uint32_t i = 0; i < s->tape->nin && s->given == 0 && k < s->order; i++)
      s->jets->integrate(s->self, i, s->tape->out[i], k);
  }
}

static ambit_expr op(ambit_graph *g, uint32_t o, ambit_expr a, ambit_expr b) { return ambit_graph_op(g, o, a, b); }

/* unit masses and lengths, relative angles */
static void pendulum(ambit_graph *g, const ambit_expr *x, ambit_expr *f) {
  ambit_failure failure = { 0 };
  ambit_expr gravity = ambit_graph_decimal(g, "9.81", &failure), twice = ambit_graph_decimal(g, "19.62", &failure);
  ambit_expr s0 = op(g, AMBIT_OP_SIN, x[0], x[0]), s1 = op(g, AMBIT_OP_SIN, x[1], x[1]),
             c1 = op(g, AMBIT_OP_COS, x[1], x[1]);
  ambit_expr both = op(g, AMBIT_OP_ADD, x[0], x[1]), speed = op(g, AMBIT_OP_ADD, x[2], x[3]);
  ambit_expr r1 =
      op(g, AMBIT_OP_SUB, op(g, AMBIT_OP_MUL, s1, op(g, AMBIT_OP_SQR, speed, speed)), op(g, AMBIT_OP_MUL, twice, s0));
  ambit_expr r2 = op(g, AMBIT_OP_ADD, op(g, AMBIT_OP_MUL, gravity, op(g, AMBIT_OP_SIN, both, both)),
      op(g, AMBIT_OP_MUL, s1, op(g, AMBIT_OP_SQR, x[2], x[2])));
  ambit_expr mass = op(g, AMBIT_OP_ADD, ambit_graph_number(g, 1), op(g, AMBIT_OP_SQR, s1, s1));
  ambit_expr a1 = op(g, AMBIT_OP_DIV, op(g, AMBIT_OP_ADD, r1, op(g, AMBIT_OP_MUL, c1, r2)), mass);
  ambit_expr down = op(g, AMBIT_OP_ADD, op(g, AMBIT_OP_ADD, r2, r2), op(g, AMBIT_OP_MUL, c1, r1));
  f[0] = x[2], f[1] = x[3], f[2] = a1;
  f[3] = op(g, AMBIT_OP_NEG, op(g, AMBIT_OP_ADD, op(g, AMBIT_OP_DIV, down, mass), a1), a1);
}

enum { NOTHING, PRODUCT, PENDULUM };

static const ambit_tape *seal(ambit_arena *arena, int what) {
  ambit_graph *g = ambit_graph_open();
  const char *name[] = { "a", "b", "c", "d" };
  ambit_expr x[4], f[4];
  uint32_t n = what == PENDULUM ? 4 : 2;
  for (uint32_t i = 0; i < n; i++) x[i] = ambit_graph_symbol(g, name[i], "1");
  if (what == PENDULUM)
    pendulum(g, x, f);
  else
    f[0] = what == PRODUCT ? op(g, AMBIT_OP_MUL, x[0], x[1]) : x[0];
  const ambit_tape *t = NULL;
  ambit_failure failure = { 0 };
  if (ambit_tape_seal(g, arena, what == PENDULUM ? 4 : 1, f, n, x, n, AMBIT_TAPE_SERIES, &t, &failure) != AMBIT_OK) {
    fprintf(stderr, "%s\n", failure.message);
    exit(1);
  }
  ambit_graph_close(g);
  return t;
}

static double jets_time(
    const bench_arithmetic *b, int general, const ambit_tape *t, uint32_t order, uint32_t ndir, uint32_t given) {
  ambit_jet_source source = { &b->full, b->ctx };
  const ambit_jets *jets = general ? &ambit_jets_general : b->full.jets;
  void *ctx = general ? (void *)&source : b->ctx;
  series s = { jets, t, NULL, order, given, ndir ? 0x1p-30 : 0 }, centre = { jets, t, NULL, order, given, 0 };
  if (jets->open(&b->scope->host, ctx, t, order, 0, NULL, &centre.self) != AMBIT_OK) exit(1);
  if (jets->open(&b->scope->host, ctx, t, order, ndir, ndir ? centre.self : NULL, &s.self) != AMBIT_OK) exit(1);
  if (ndir) by_jets(&centre);
  double best = fastest(by_jets, &s);
  jets->close(s.self), jets->close(centre.self);
  return best;
}

int main(void) {
  ambit_registry *r = ambit_registry_open(NULL);
  bench_arithmetic b = bench_open(r, "interval", AMBIT_ARITHMETIC),
                   p = bench_open(r, "interval", "ambit.arithmetic.portable/1");
  ambit_arena *arena = ambit_arena_open();
  const ambit_tape *product = seal(arena, PRODUCT), *whole = seal(arena, PENDULUM);
  const ambit_tape *nothing = seal(arena, NOTHING);
  plain doubles;
  elements e = { .b = &b };
  for (uint32_t i = 0; i <= ORDER; i++) {
    doubles.a[i] = 2.3 / (i + 1.0), doubles.b[i] = doubles.a[i] / 2;
    b.full.set(b.ctx, element(&e, A + i), 1, &doubles.a[i], &doubles.a[i], -1);
    b.full.set(b.ctx, element(&e, B + i), 1, &doubles.b[i], &doubles.b[i], -1);
  }
  double reference = fastest(plain_product, &doubles);
  printf("%-52s %10s %8s\n", "product of two series of order 20", "ns", "ratio");
  print("plain double", reference, reference);
  static factors f;
  fill_factors(&f);
  f.n = ORDER + 1;
  print_variants(by_series, &f, reference);
  for (f.n = 12; f.n <= MATRIX; f.n += 12) {
    double plain = fastest(plain_matrix, &f);
    printf("\nproduct of two matrices, %zu x %zu\n", f.n, f.n);
    print("plain double", plain, plain);
    print_variants(by_matrix, &f, plain);
  }
  printf("\n%-52s %10s %8s\n", "product of two series of order 20, order by order", "ns", "ratio");
  double without = jets_time(&b, 0, nothing, ORDER, 0, ORDER),
         portable_without = jets_time(&p, 0, nothing, ORDER, 0, ORDER);
  print(
      "interval jets, less the same with no product", jets_time(&b, 0, product, ORDER, 0, ORDER) - without, reference);
  print("portable, likewise", jets_time(&p, 0, product, ORDER, 0, ORDER) - portable_without, reference);
  print("interval dot", fastest(by_dot, &e), reference);
  print("interval runs, one operation at a time", fastest(by_runs, &e), reference);
  printf("\n%-52s %10s %8s\n", "double pendulum: order 20; order 8 with 4 slopes", "ns", "ratio");
  double jets = jets_time(&b, 0, whole, ORDER, 0, 0), slopes = jets_time(&b, 0, whole, SLOPE_ORDER, NDIR, 0);
  print("interval jets, values", jets, jets), print("interval jets, slopes", slopes, slopes);
  print("portable, values", jets_time(&p, 0, whole, ORDER, 0, 0), jets);
  print("portable, slopes", jets_time(&p, 0, whole, SLOPE_ORDER, NDIR, 0), slopes);
  print("kernel's general jets, values", jets_time(&b, 1, whole, ORDER, 0, 0), jets);
  print("kernel's general jets, slopes", jets_time(&b, 1, whole, SLOPE_ORDER, NDIR, 0), slopes);
  ambit_arena_close(arena);
  bench_close(&b), bench_close(&p);
  ambit_registry_close(r);
  return 0;
}
