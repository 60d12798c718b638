/* tape.c -- a tape of 10^4 operations over 10^4 lanes: ns per operation and lane, the fastest of a few passes. Mixed
** additions, subtractions, products and squares with a few quotients and roots, and the same with elementary functions;
** streamed in batches (verbs/sample/batch.h), and for a few lanes as a block, run by run and by the arithmetic's
** eval_tape.
*/
#include "verbs/sample/batch.h"
#include "graph/tape.h"
#include "plugin.h"

#define OPERATIONS 7200 /* about 10^4 instructions: the graph writes some differences as sums */
#define LANES 10000
#define INPUTS 16
#define PASSES 3
#define FRONT_MAX 1024

static uint64_t random_bits(uint64_t *s) {
  *s ^= *s << 13, *s ^= *s >> 7, *s ^= *s << 17;
  return *s >> 11;
}

typedef struct value {
  ambit_expr e;
  double size; /* upper bound, so that nothing overflows */
} value;

/* `front` values are waiting to be used; each operation takes the oldest of them and another one. */
typedef struct weaver {
  ambit_graph *g;
  value waiting[FRONT_MAX];
  value input[INPUTS];
  size_t front, made;
  uint64_t random;
  int functions; /* one operation in ten is an elementary function */
} weaver;

static value make(weaver *w, uint32_t op, value a, value b, double size) {
  w->made++;
  return (value) { ambit_graph_op(w->g, op, a.e, b.e), size };
}

static value function(weaver *w, value a) {
  static const uint32_t any[] = { AMBIT_OP_SIN, AMBIT_OP_COS, AMBIT_OP_ATAN, AMBIT_OP_TANH };
  return make(w, any[random_bits(&w->random) % 4], a, a, 2);
}

/* sqrt (1 + a^2) */
static value distance(weaver *w, value a) {
  value square = make(w, AMBIT_OP_SQR, a, a, 0), one = { ambit_graph_number(w->g, 1), 1 };
  value sum = make(w, AMBIT_OP_ADD, square, one, 0);
  return make(w, AMBIT_OP_SQRT, sum, sum, 1 + a.size);
}

static value next_value(weaver *w, value a, value b) {
  uint64_t draw = random_bits(&w->random) % 100;
  value x = w->input[random_bits(&w->random) % INPUTS];
  if (a.size > 1e12) return make(w, AMBIT_OP_MUL, a, (value) { ambit_graph_number(w->g, 0x1p-40), 1 }, 1);
  if (w->functions && draw >= 90) return function(w, a);
  if (draw < 4) return make(w, AMBIT_OP_DIV, a, x, a.size);
  if (draw < 6) return distance(w, a);
  if (draw < 20 && a.size < 1e6) return make(w, AMBIT_OP_SQR, a, a, a.size * a.size);
  if (draw < 50 && a.size * b.size < 1e12) return make(w, AMBIT_OP_MUL, a, b, a.size * b.size);
  return make(w, draw % 2 ? AMBIT_OP_ADD : AMBIT_OP_SUB, a, b, a.size + b.size);
}

static const ambit_tape *weave(ambit_arena *arena, size_t front, int functions) {
  static weaver w;
  w = (weaver) { .g = ambit_graph_open(), .front = front, .random = 88172645463325252u, .functions = functions };
  ambit_expr in[INPUTS], out[FRONT_MAX];
  for (int i = 0; i < INPUTS; i++) {
    char name[8];
    snprintf(name, sizeof name, "x%d", i);
    in[i] = ambit_graph_symbol(w.g, name, "1");
    w.input[i] = (value) { in[i], 2 };
  }
  for (size_t i = 0; i < front; i++)
    w.waiting[i] = make(&w, AMBIT_OP_ADD, w.input[i % INPUTS], w.input[i / INPUTS % INPUTS], 4);
  for (size_t i = 0; w.made < OPERATIONS; i++) {
    value *a = &w.waiting[i % front];
    *a = next_value(&w, *a, w.waiting[(i + 1 + random_bits(&w.random) % (front - 1)) % front]);
  }
  for (size_t i = 0; i < front; i++) out[i] = w.waiting[i].e;
  const ambit_tape *t = NULL;
  ambit_failure failure = { 0 };
  if (ambit_tape_seal(w.g, arena, front, out, INPUTS, in, 0, 0, &t, &failure) != AMBIT_OK) {
    fprintf(stderr, "%s\n", failure.message);
    exit(1);
  }
  ambit_graph_close(w.g);
  return t;
}

/* -- measuring */

static double *array(size_t n) {
  double *p = malloc(n * sizeof *p);
  if (!p) exit(1);
  return p;
}

static void batch_time(const bench_arithmetic *b, const ambit_tape *t, const char *name) {
  double *lo = array(INPUTS * (size_t)LANES), *hi = array(INPUTS * (size_t)LANES);
  double *rlo = array(t->nout * (size_t)LANES), *rhi = array(t->nout * (size_t)LANES), best = 1e18;
  for (size_t i = 0; i < INPUTS * (size_t)LANES; i++) lo[i] = 1 + (double)(i % 997) / 1000, hi[i] = lo[i] + 0x1p-30;
  ambit_batch *batch;
  ambit_failure failure = { 0 };
  if (ambit_batch_open(t, &b->full, b->ctx, &batch, &failure) != AMBIT_OK) exit(1);
  for (int pass = 0; pass < PASSES; pass++) {
    double start = bench_now();
    ambit_batch_run(batch, LANES, lo, hi, NULL, rlo, rhi);
    double each = (bench_now() - start) / LANES / t->ninstr;
    if (each < best) best = each;
  }
  printf("%-40s %8u %8zu %6zu %8.2f\n", name, t->ninstr, ambit_batch_places(batch), ambit_batch_width(batch), best);
  ambit_batch_close(batch);
  free(lo), free(hi), free(rlo), free(rhi);
}

static void block_time(const bench_arithmetic *b, const ambit_tape *t, size_t lanes, int fused, const char *name) {
  ambit_arithmetic full = b->full;
  if (!fused) full.eval_tape = NULL;
  ambit_block *block;
  if (ambit_block_open(t, &full, b->ctx, lanes, &block, NULL) != AMBIT_OK) exit(1);
  for (uint32_t i = 0; i < INPUTS; i++)
    for (size_t l = 0; l < lanes; l++) {
      double x = 1 + (double)((i * lanes + l) % 997) / 1000;
      ambit_block_set(block, i, l, (ambit_interval) { x, x + 0x1p-30 }, -1);
    }
  double best = 1e18;
  for (int pass = 0; pass < 20; pass++) {
    double start = bench_now();
    ambit_block_run(block);
    double each = (bench_now() - start) / (double)lanes / t->ninstr;
    if (each < best) best = each;
  }
  printf("%-40s %8u %8u %6zu %8.2f\n", name, t->ninstr, t->nslot, lanes, best);
  ambit_block_close(block);
}

int main(void) {
  ambit_registry *r = ambit_registry_open(NULL);
  bench_arithmetic interval = bench_open(r, "interval", AMBIT_ARITHMETIC),
                   portable = bench_open(r, "interval", "ambit.arithmetic.portable/1"),
                   real = bench_open(r, "real", AMBIT_ARITHMETIC);
  ambit_arena *arena = ambit_arena_open();
  const ambit_tape *narrow = weave(arena, 64, 0), *wide = weave(arena, 1000, 0), *mixed = weave(arena, 64, 1);
  printf("%-40s %8s %8s %6s %8s\n", "10^4 lanes", "instr", "slots", "width", "ns");
  batch_time(&interval, narrow, "interval, 64 values alive");
  batch_time(&interval, wide, "interval, 1000 values alive");
  batch_time(&interval, mixed, "interval, every tenth a function");
  batch_time(&portable, narrow, "interval without AVX2, 64 values alive");
  batch_time(&real, narrow, "real, 64 values alive");
  printf("\n%-40s\n", "as a block");
  for (size_t lanes = 1; lanes <= 64; lanes *= 8) {
    block_time(&interval, narrow, lanes, 0, "interval, run by run");
    block_time(&interval, narrow, lanes, 1, "interval, eval_tape");
  }
  ambit_arena_close(arena);
  bench_close(&interval), bench_close(&portable), bench_close(&real);
  ambit_registry_close(r);
  return 0;
}
