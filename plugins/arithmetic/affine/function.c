/* function.c -- runs of functions of one operand: SQR, POWN, SQRT and the elementary ones.
**
** Operands are gathered over instructions and lanes into chunks, so that the kernel's vector functions see long arrays
** even when there is one lane. The hull of each result is the function's over the operand's hull, cut at the domain;
** the form is slope x + g (linearise.c). Upward mode.
*/
#include "linearise.h"
#include <float.h>

typedef struct cursor { /* walks the elements of a run: lane by lane, instruction by instruction */
  size_t lanes, instruction, lane;
} cursor;

typedef struct call {
  affine_context *c;
  void *base;
  size_t pitch;
  const uint32_t *dst, *a;
  uint32_t op;
  int32_t power;
} call;

static void step(cursor *at) {
  if (++at->lane == at->lanes) at->lane = 0, at->instruction++;
}

static size_t place(const call *q, const cursor *at, const uint32_t *slot) {
  return slot[at->instruction] * q->pitch + at->lane;
}

/* hulls of the operands -> hulls of the results; flags */
static uint32_t gather(const call *q, cursor at, size_t n, double *operand, double *result) {
  for (size_t i = 0; i < n; i++, step(&at)) {
    const affine_element *x = affine_at(q->c, q->base, place(q, &at, q->a));
    operand[2 * i] = -x->nlo, operand[2 * i + 1] = x->hi;
  }
  return q->c->num->map(q->op, n, result, operand, NULL, q->power);
}

static double least(const affine_context *c, uint32_t op) {
  const ambit_function_facts *facts = c->num->facts(op);
  if (facts) return facts->least > -DBL_MAX ? facts->least : -DBL_MAX;
  return op == AMBIT_OP_SQRT ? 0 : op == AMBIT_OP_ASIN || op == AMBIT_OP_ACOS ? -1 : -DBL_MAX;
}
static double most(const affine_context *c, uint32_t op) {
  const ambit_function_facts *facts = c->num->facts(op);
  if (facts) return facts->most < DBL_MAX ? facts->most : DBL_MAX;
  return op == AMBIT_OP_ASIN || op == AMBIT_OP_ACOS ? 1 : DBL_MAX;
}

/* the entries that have coefficients and a bounded result, with their ranges inside the domain; the derivative of
** x^INT32_MIN has an exponent that is none */
static void select_entries(const call *q, cursor at, size_t n, const double *operand, const double *result,
    linearise_chunk *k, size_t *entry) {
  int derivable = q->power > INT32_MIN;
  double from = least(q->c, q->op), to = most(q->c, q->op);
  k->op = q->op == AMBIT_OP_SQR ? AMBIT_OP_POWN : q->op, k->power = q->op == AMBIT_OP_SQR ? 2 : q->power, k->n = 0;
  for (size_t i = 0; i < n; i++, step(&at)) {
    const affine_element *x = affine_at(q->c, q->base, place(q, &at, q->a));
    double a = operand[2 * i] > from ? operand[2 * i] : from, b = operand[2 * i + 1] < to ? operand[2 * i + 1] : to;
    int proper = result[2 * i] >= -DBL_MAX && result[2 * i + 1] <= DBL_MAX && result[2 * i] < result[2 * i + 1];
    entry[i] = LINEARISE_CHUNK;
    if (!affine_has_form(x) || x->blocks == 0 || !derivable || !proper || !(a < b)) continue;
    entry[i] = k->n;
    k->a[k->n] = a, k->b[k->n] = b, k->flo[k->n] = result[2 * i], k->fhi[k->n] = result[2 * i + 1];
    k->n++;
  }
}

static uint32_t store_one(
    const call *q, const cursor *at, const double *result, const linearise_chunk *k, size_t entry, int64_t symbol) {
  affine_element *r = affine_at(q->c, q->base, place(q, at, q->dst));
  if (entry == LINEARISE_CHUNK) return affine_constant(q->c, r, -result[0], result[1], symbol);
  const affine_element *x = affine_operand(q->c, affine_at(q->c, q->base, place(q, at, q->a)), 0);
  r->nlo = -result[0], r->hi = result[1];
  return q->c->kernels->apply(q->c, r, x, k->slope[entry], k->glo[entry], k->ghi[entry], symbol);
}

/* the slope that is best for x^2, exactly: x^2 - s x is -a b at both ends and nowhere below -s^2/4 */
static void squares(linearise_chunk *k) {
  for (size_t i = 0; i < k->n; i++) {
    double a = k->a[i], b = k->b[i], s = a + b, half = 0.5 * s;
    double at_a = (-s) * a + a * a, at_b = (-s) * b + b * b;
    k->slope[i] = s;
    k->ghi[i] = at_a > at_b ? at_a : at_b;
    k->glo[i] = -(half * half) - (half == 0 && s != 0 ? 0x1p-1073 : 0);
  }
}

static void lines(const affine_context *c, linearise_chunk *k) {
  if (k->op == AMBIT_OP_POWN && k->power == 1)
    for (size_t i = 0; i < k->n; i++) k->slope[i] = 1, k->glo[i] = k->ghi[i] = 0;
  else if (k->op == AMBIT_OP_POWN && k->power == 2 && !c->min_range)
    squares(k);
  else
    linearise(c, k);
}

static void run_chunk(const call *q, cursor *at, size_t n, uint32_t *outcome) {
  double operand[2 * LINEARISE_CHUNK], result[2 * LINEARISE_CHUNK];
  size_t entry[LINEARISE_CHUNK];
  linearise_chunk k;
  *outcome |= gather(q, *at, n, operand, result);
  select_entries(q, *at, n, operand, result, &k, entry);
  lines(q->c, &k);
  for (size_t i = 0; i < n; i++) {
    int64_t symbol = affine_symbol(q->c, q->dst[at->instruction]);
    *outcome |= store_one(q, at, result + 2 * i, &k, entry[i], symbol);
    step(at);
    if (at->lane != 0) continue; /* the next instruction takes the next symbol */
    q->c->next += (*outcome & AFFINE_TAKEN) != 0;
    *outcome &= ~AFFINE_TAKEN;
  }
}

static uint32_t run(const call *q, size_t lanes, size_t count) {
  cursor at = { lanes, 0, 0 };
  uint32_t outcome = 0;
  size_t total = lanes * count;
  for (size_t done = 0; done < total; done += LINEARISE_CHUNK)
    run_chunk(q, &at, total - done < LINEARISE_CHUNK ? total - done : LINEARISE_CHUNK, &outcome);
  return outcome;
}

#define DEFINE(OP)                                                                                                     \
  uint32_t affine_run_##OP(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,            \
      size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {                                       \
    (void)self, (void)b;                                                                                               \
    const call q = { ctx, base, pitch, dst, a, AMBIT_OP_##OP, 0 };                                                     \
    return run(&q, lanes, count);                                                                                      \
  }
DEFINE(SQR)
DEFINE(SQRT)
DEFINE(EXP)
DEFINE(LOG)
DEFINE(SIN)
DEFINE(COS)
DEFINE(TAN)
DEFINE(ASIN)
DEFINE(ACOS)
DEFINE(ATAN)
DEFINE(SINH)
DEFINE(COSH)
DEFINE(TANH)

uint32_t affine_run_function(const ambit_arithmetic *self, void *ctx, uint32_t op, void *base, size_t pitch,
    size_t lanes, size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  (void)self, (void)b;
  const call q = { ctx, base, pitch, dst, a, op, 0 };
  return run(&q, lanes, count);
}

uint32_t affine_run_POWN(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes, size_t count,
    const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  (void)self;
  uint32_t flags = 0;
  for (size_t i = 0; i < count; i++) {
    const call q = { ctx, base, pitch, dst + i, a + i, AMBIT_OP_POWN, (int32_t)b[i] };
    flags |= run(&q, lanes, 1);
  }
  return flags;
}
