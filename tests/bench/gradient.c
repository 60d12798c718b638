/* gradient.c -- what derivatives cost and what they buy: time of a run of the tape beside `interval` (the fastest of
** many), and the width of the result: of `interval`, of `gradient` alone (mean-value form), and of `evaluate` in
** `gradient`, which adds the monotonicity test.
*/
#include "graph/tape.h"
#include "verbs/run/context.h"
#include <ambit/evaluate.h>
#include "plugin.h"
#include <math.h>

#define PASSES 2000
#define UNKNOWNS_MAX 64

typedef struct scene {
  ambit_graph *g;
  ambit_expr unknown[UNKNOWNS_MAX];
  size_t n;
} scene;

static ambit_expr around(scene *s, double c, double r) {
  return s->unknown[s->n++] = ambit_graph_unknown(s->g, NULL, (ambit_interval) { c - r, c + r });
}
static ambit_expr op(scene *s, uint32_t o, ambit_expr a, ambit_expr b) { return ambit_graph_op(s->g, o, a, b); }
static ambit_expr times(scene *s, double c, ambit_expr a) {
  return op(s, AMBIT_OP_MUL, ambit_graph_number(s->g, c), a);
}

/* -- the scenes */

/* five arms, tolerances of 0.1 % and 0.1 degrees, a play of 2 mm either way at each joint; x of the hand */
static ambit_expr manipulator(scene *s) {
  static const double length[] = { 6.5, 4, 4, 4, 3.5 }, angle[] = { 60, -20, -20, -20, -30 };
  const double degree = 0x1.1df46a2529d39p-6;
  ambit_expr x = ambit_graph_number(s->g, 0), turned = x;
  for (int i = 0; i < 5; i++) {
    turned = op(s, AMBIT_OP_ADD, turned, around(s, angle[i] * degree, 0.1 * degree));
    x = op(s, AMBIT_OP_ADD, x, around(s, 0, 0.002));
    ambit_expr c = op(s, AMBIT_OP_COS, turned, turned);
    x = op(s, AMBIT_OP_ADD, x, op(s, AMBIT_OP_MUL, around(s, length[i], 1e-3 * length[i]), c));
  }
  return x;
}

static ambit_expr expanded_square(scene *s) { /* x^2 - 2 x y + y^2 */
  ambit_expr x = around(s, 1, 0.1), y = around(s, 1, 0.1);
  ambit_expr r = op(s, AMBIT_OP_SUB, op(s, AMBIT_OP_SQR, x, x), times(s, 2, op(s, AMBIT_OP_MUL, x, y)));
  return op(s, AMBIT_OP_ADD, r, op(s, AMBIT_OP_SQR, y, y));
}

static ambit_expr polynomial(scene *s) { /* Horner's form of 1 - 2 x + 3 x^2 - 4 x^3 + 5 x^4 */
  ambit_expr x = around(s, 0.6, 0.2), r = ambit_graph_number(s->g, 5);
  for (int k = 4; k > 0; k--)
    r = op(s, AMBIT_OP_ADD, ambit_graph_number(s->g, k % 2 ? k : -k), op(s, AMBIT_OP_MUL, r, x));
  return r;
}

static ambit_expr oscillation(scene *s) { /* exp(-x) sin(x y) / (1 + x^2) */
  ambit_expr x = around(s, 0.5, 0.05), y = around(s, 2, 0.1), one = ambit_graph_number(s->g, 1);
  ambit_expr e = op(s, AMBIT_OP_EXP, op(s, AMBIT_OP_NEG, x, x), 0), p = op(s, AMBIT_OP_MUL, x, y);
  ambit_expr below = op(s, AMBIT_OP_ADD, one, op(s, AMBIT_OP_SQR, x, x));
  return op(s, AMBIT_OP_DIV, op(s, AMBIT_OP_MUL, e, op(s, AMBIT_OP_SIN, p, p)), below);
}

static ambit_expr saddle(scene *s) { /* x y / (x + y) - sqrt(x y) */
  ambit_expr x = around(s, 2, 0.5), y = around(s, 3, 0.5), p = op(s, AMBIT_OP_MUL, x, y);
  ambit_expr q = op(s, AMBIT_OP_DIV, p, op(s, AMBIT_OP_ADD, x, y));
  return op(s, AMBIT_OP_SUB, q, op(s, AMBIT_OP_SQRT, p, p));
}

/* -- measuring */

static void die(const ambit_failure *f) {
  fprintf(stderr, "%s\n", f->message);
  exit(1);
}

/* ns per run; *x: bounds */
static double run(ambit_registry *r, const char *name, scene *s, ambit_expr e, ambit_interval *x) {
  ambit_failure f = { 0 };
  ambit_context c;
  ambit_block *block;
  const ambit_tape *tape;
  ambit_arena *arena = ambit_arena_open();
  if (!arena || ambit_tape_seal(s->g, arena, 1, &e, s->n, s->unknown, 0, 0, &tape, &f) != AMBIT_OK) die(&f);
  if (ambit_context_open(r, name, 0, NULL, (uint32_t)s->n, &c, &f) != AMBIT_OK) die(&f);
  if (ambit_block_open(tape, c.arithmetic, c.ctx, 1, &block, &f) != AMBIT_OK) die(&f);
  for (size_t i = 0; i < s->n; i++)
    ambit_block_set(block, (uint32_t)i, 0, ambit_graph_node(s->g, s->unknown[i])->value, (int32_t)i);
  double best = 1e18;
  for (int pass = 0; pass < PASSES; pass++) {
    double start = bench_now();
    ambit_block_run(block);
    double each = bench_now() - start;
    if (each < best) best = each;
  }
  *x = ambit_block_get(block, 0, 0);
  ambit_block_close(block);
  ambit_context_close(&c);
  ambit_arena_close(arena);
  return best;
}

static void compare(ambit_registry *r, const char *name, ambit_expr (*build)(scene *)) {
  scene s = { .g = ambit_graph_open() };
  ambit_failure f = { 0 };
  ambit_expr e = build(&s);
  ambit_interval natural, mean, best;
  double plain = run(r, "interval", &s, e, &natural), ours = run(r, "gradient", &s, e, &mean);
  const ambit_evaluate_request q = { .graph = s.g, .registry = r, .arithmetic = "gradient", .nexpr = 1, .expr = &e };
  if (ambit_evaluate(&q, &best, NULL, NULL, &f) != AMBIT_OK) die(&f);
  double width = natural.hi - natural.lo;
  printf("%-16s %4zu %9.0f %9.0f %6.1f %10.4g %9.3f %9.3f\n", name, s.n, plain, ours, ours / plain, width,
      (mean.hi - mean.lo) / width, (best.hi - best.lo) / width);
  ambit_graph_close(s.g);
}

int main(void) {
  ambit_registry *r = ambit_registry_open(NULL);
  if (!r) return 1;
  printf("%-16s %4s %9s %9s %6s %10s %9s %9s\n", "", "", "interval", "gradient", "", "interval", "mean", "monotone");
  printf("%-16s %4s %9s %9s %6s %10s %9s %9s\n", "", "data", "ns", "ns", "ratio", "width", "ratio", "ratio");
  compare(r, "manipulator", manipulator);
  compare(r, "expanded square", expanded_square);
  compare(r, "polynomial", polynomial);
  compare(r, "oscillation", oscillation);
  compare(r, "saddle", saddle);
  ambit_registry_close(r);
  return 0;
}
