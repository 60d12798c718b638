/* random_expression.h -- random expressions over uncertain data, as plain data that no code of the kernel has seen.
**
** An expression is a list of nodes, each over earlier ones: shared sub-expressions are the rule. All opcodes come up,
** constants are doubles and literals. A range that goes along while it grows keeps operands inside domains and values
** of everyday size most of the time, but not always; it guides the choice and proves nothing.
*/
#ifndef AMBIT_TEST_RANDOM_EXPRESSION_H
#define AMBIT_TEST_RANDOM_EXPRESSION_H
#include "num/interval.h"
#include "oracle.h"
#include <stdio.h>

#define RANDOM_DATA_MAX 6
#define RANDOM_NODES_MAX 96

enum { LEAF_DATUM = AMBIT_OP_END, LEAF_NUMBER, LEAF_LITERAL };

typedef struct random_node {
  uint32_t op;      /* AMBIT_OP_* or LEAF_* */
  uint32_t a, b;    /* operands; b == a when unary; LEAF_DATUM: a is its number */
  int32_t n;        /* exponent of POWN */
  double number;    /* LEAF_NUMBER */
  const char *text; /* LEAF_LITERAL */
  ambit_interval range;
} random_node;

typedef struct random_expression {
  uint64_t state; /* of the generator */
  bool wild;      /* data and operands of any size, domains left to chance */
  uint32_t ndatum, count;
  ambit_interval box[RANDOM_DATA_MAX];
  random_node node[RANDOM_NODES_MAX]; /* the last one is the expression */
} random_expression;

static const char *const random_symbols[] = {
#define AMBIT_X(name, arity, symbol) symbol,
  AMBIT_OPS(AMBIT_X)
#undef AMBIT_X
#define AMBIT_X(name, arity, symbol) [AMBIT_OP_##name] = #symbol,
      AMBIT_FUNCTIONS(AMBIT_X)
#undef AMBIT_X
};

static inline bool random_is_binary(uint32_t op) { return ambit_op_arity(op) == 2; }

static inline uint32_t random_below(random_expression *x, uint32_t n) {
  return (uint32_t)(oracle_random(&x->state) >> 33) % n;
}

/* any operation */
static inline uint32_t random_operation(random_expression *x) {
  uint32_t k = random_below(x, AMBIT_OP_COUNT + AMBIT_OP_END - AMBIT_OP_FUNCTIONS);
  return k < AMBIT_OP_COUNT ? k : AMBIT_OP_FUNCTIONS + k - AMBIT_OP_COUNT;
}

/* true in `percent` of the cases */
static inline bool random_chance(random_expression *x, uint32_t percent) { return random_below(x, 100) < percent; }

static inline uint32_t random_add(random_expression *x, random_node node) {
  ambit_interval a = { 0, 0 }, b = a;
  if (node.op < AMBIT_OP_END) {
    a = x->node[node.a].range, b = x->node[node.b].range;
    if (node.op == AMBIT_OP_POWN)
      ambit_interval_pown(&node.range, a, node.n);
    else
      ambit_interval_op(node.op, &node.range, a, b);
  }
  x->node[x->count] = node;
  return x->count++;
}

static inline uint32_t random_apply(random_expression *x, uint32_t op, uint32_t a, uint32_t b) {
  return random_add(x, (random_node) { .op = op, .a = a, .b = random_is_binary(op) ? b : a });
}

static inline uint32_t random_number(random_expression *x, double value) {
  return random_add(x, (random_node) { .op = LEAF_NUMBER, .number = value, .range = { value, value } });
}

static inline uint32_t random_constant(random_expression *x) {
  static const struct {
    const char *text;
    double near;
  } literal[] = { { "0.1", 0.1 }, { "1/3", 1.0 / 3 }, { "pi", 3.141592653589793 }, { "0.7", 0.7 }, { "2.5e-3", 2.5e-3 },
    { "22/7", 22.0 / 7 }, { "9.81", 9.81 }, { "1e-20", 1e-20 } };
  static const double plain[] = { 0, 1, -1, 2, -2, 0.5, 3, -0.75, 10 };
  uint32_t kind = random_below(x, 10);
  if (kind < 4) {
    uint32_t i = random_below(x, sizeof literal / sizeof *literal);
    double near = literal[i].near;
    ambit_interval range = { nextafter(near, -INFINITY), nextafter(near, INFINITY) };
    return random_add(x, (random_node) { .op = LEAF_LITERAL, .text = literal[i].text, .range = range });
  }
  if (kind < 8) return random_number(x, plain[random_below(x, sizeof plain / sizeof *plain)]);
  return random_number(x, oracle_uniform(&x->state, -4, 4));
}

static inline ambit_interval random_box(random_expression *x) {
  double centre = random_chance(x, x->wild ? 50 : 3) ? oracle_double(&x->state) : oracle_uniform(&x->state, -3, 3),
         radius;
  if (random_chance(x, 20)) centre = rint(centre);
  uint32_t kind = random_below(x, 20);
  if (kind < 3)
    radius = 0;
  else if (kind < 12)
    radius = exp2(oracle_uniform(&x->state, -45, -3));
  else if (kind < 19)
    radius = oracle_uniform(&x->state, 0, 1);
  else
    radius = oracle_uniform(&x->state, 0, 20);
  if (x->wild) radius *= fabs(centre);
  ambit_interval box = ambit_interval_of(centre - radius, centre + radius);
  if (random_chance(x, 10)) box.lo = fmin(0, box.hi); /* touches zero */
  return ambit_interval_is_bounded(box) ? box : (ambit_interval) { -1, 1 };
}

/* An operand: a recent one more often than not. */
static inline uint32_t random_pick(random_expression *x) {
  uint32_t recent = x->count < 8 ? x->count : 8;
  if (random_chance(x, 12)) return random_constant(x);
  if (random_chance(x, 25)) return random_below(x, x->ndatum);
  return x->count - 1 - random_below(x, recent);
}

static inline bool random_within(const random_expression *x, uint32_t a, double lo, double hi) {
  return lo <= x->node[a].range.lo && x->node[a].range.hi <= hi;
}

/* An expression of a that lies in [c, c + 1 + a^2] for some c > 0. */
static inline uint32_t random_positive(random_expression *x, uint32_t a) {
  uint32_t base = random_apply(x, random_chance(x, 70) ? AMBIT_OP_SQR : AMBIT_OP_ABS, a, a);
  return random_apply(x, AMBIT_OP_ADD, base, random_number(x, random_chance(x, 50) ? 1 : 0.0625));
}

static inline uint32_t random_angle(random_expression *x, uint32_t a) {
  return random_apply(x, random_chance(x, 50) ? AMBIT_OP_SIN : AMBIT_OP_TANH, a, a);
}

static inline bool random_fits(const random_expression *x, uint32_t op, uint32_t a, int32_t n) {
  ambit_interval r = x->node[a].range;
  switch (op) {
  case AMBIT_OP_DIV: return r.lo > 0 || r.hi < 0;
  case AMBIT_OP_POWN: return (n >= 0 || r.lo > 0 || r.hi < 0) && random_within(x, a, -30, 30);
  case AMBIT_OP_SQRT: return r.lo >= 0;
  case AMBIT_OP_LOG:
  case AMBIT_OP_LOG2:
  case AMBIT_OP_LOG10: return r.lo > 0;
  case AMBIT_OP_LOG1P: return r.lo > -1;
  case AMBIT_OP_ACOSH: return r.lo >= 1;
  case AMBIT_OP_POW: return r.lo > 0 && r.hi < 30;
  case AMBIT_OP_ATANH: return random_within(x, a, -0.99, 0.99);
  case AMBIT_OP_ASIN:
  case AMBIT_OP_ACOS: return random_within(x, a, -1, 1);
  case AMBIT_OP_TAN: return random_within(x, a, -1.5, 1.5);
  case AMBIT_OP_EXP:
  case AMBIT_OP_EXPM1:
  case AMBIT_OP_EXP2:
  case AMBIT_OP_SINH:
  case AMBIT_OP_COSH: return random_within(x, a, -20, 20);
  default: return random_within(x, a, -1e6, 1e6);
  }
}

/* The operand, or an expression of it that fits the operation. */
static inline uint32_t random_operand(random_expression *x, uint32_t op, uint32_t a, int32_t n) {
  if (random_fits(x, op, a, n) || random_chance(x, x->wild ? 70 : 20)) return a;
  switch (op) {
  case AMBIT_OP_DIV:
  case AMBIT_OP_SQRT:
  case AMBIT_OP_LOG:
  case AMBIT_OP_LOG2:
  case AMBIT_OP_LOG10:
  case AMBIT_OP_LOG1P: return random_positive(x, a);
  case AMBIT_OP_POW: return random_positive(x, random_angle(x, a));
  case AMBIT_OP_ACOSH: return random_apply(x, AMBIT_OP_ADD, random_positive(x, a), random_number(x, 1));
  case AMBIT_OP_POWN: return n < 0 ? random_positive(x, random_angle(x, a)) : random_angle(x, a);
  default: return random_angle(x, a);
  }
}

static inline void random_grow(random_expression *x) {
  static const uint32_t common[] = { AMBIT_OP_ADD, AMBIT_OP_SUB, AMBIT_OP_MUL, AMBIT_OP_MUL, AMBIT_OP_SIN, AMBIT_OP_COS,
    AMBIT_OP_DIV, AMBIT_OP_SQR };
  uint32_t op = random_chance(x, 45) ? common[random_below(x, sizeof common / sizeof *common)] : random_operation(x);
  uint32_t a = random_pick(x), b = random_chance(x, 10) ? a : random_pick(x);
  int32_t n = (int32_t)random_below(x, 12) - 4;
  if (op == AMBIT_OP_DIV)
    b = random_operand(x, op, b, n);
  else
    a = random_operand(x, op, a, n);
  if (op == AMBIT_OP_POW && !random_within(x, b, -8, 8)) b = random_angle(x, b);
  random_add(x, (random_node) { .op = op, .a = a, .b = random_is_binary(op) ? b : a, .n = n });
}

/* Joins what nothing uses yet, so that the last node depends on nearly all of them and data meet themselves again. */
static inline void random_gather(random_expression *x) {
  static const uint32_t joint[] = { AMBIT_OP_ADD, AMBIT_OP_SUB, AMBIT_OP_MUL, AMBIT_OP_MIN };
  bool used[RANDOM_NODES_MAX] = { false };
  uint32_t count = x->count, last = count - 1;
  for (uint32_t i = 0; i < count; i++)
    if (x->node[i].op < AMBIT_OP_END) used[x->node[i].a] = used[x->node[i].b] = true;
  for (uint32_t i = 0; i + 1 < count && x->count + 2 < RANDOM_NODES_MAX; i++) {
    if (used[i] || x->node[i].op >= AMBIT_OP_END || random_chance(x, 40)) continue;
    uint32_t a = random_operand(x, AMBIT_OP_ADD, i, 0);
    last = random_apply(x, joint[random_below(x, 20) < 19 ? random_below(x, 3) : 3], last, a);
  }
}

/* The expression of that seed. */
static inline void random_make(random_expression *x, uint64_t seed) {
  x->state = seed * 0x9e3779b97f4a7c15u + 0x2545f4914f6cdd1du;
  if (x->state == 0) x->state = 1;
  for (int i = 0; i < 4; i++) oracle_random(&x->state);
  x->count = 0;
  x->wild = random_chance(x, 10);
  x->ndatum = 1 + random_below(x, RANDOM_DATA_MAX);
  for (uint32_t i = 0; i < x->ndatum; i++) {
    x->box[i] = random_box(x);
    random_add(x, (random_node) { .op = LEAF_DATUM, .a = i, .range = x->box[i] });
  }
  uint32_t size = x->ndatum + 3 + random_below(x, 30);
  while (x->count < size) random_grow(x);
  random_gather(x);
}

/* Writes node `last` and all below it as a scene that evaluates it. */
static inline void random_print(const random_expression *x, uint32_t last, FILE *out) {
  bool used[RANDOM_NODES_MAX] = { false };
  used[last] = true;
  for (uint32_t i = last + 1; i-- > 0;)
    if (used[i] && x->node[i].op < AMBIT_OP_END) used[x->node[i].a] = used[x->node[i].b] = true;
  fprintf(out, "local ambit = require \"ambit\"\n");
  for (uint32_t i = 0; i <= last; i++) {
    const random_node *q = &x->node[i];
    if (!used[i]) continue;
    fprintf(out, "local n%u = ", i);
    if (q->op == LEAF_DATUM)
      fprintf(out, "ambit.between(%.17g, %.17g)\n", x->box[q->a].lo, x->box[q->a].hi);
    else if (q->op == LEAF_NUMBER)
      fprintf(out, "ambit.number(%.17g)\n", q->number);
    else if (q->op == LEAF_LITERAL)
      fprintf(out, "ambit.number \"%s\"\n", q->text);
    else if (q->op == AMBIT_OP_POWN)
      fprintf(out, "n%u ^ %d\n", q->a, q->n);
    else if (q->op == AMBIT_OP_NEG)
      fprintf(out, "-n%u\n", q->a);
    else if (q->op == AMBIT_OP_ADD || q->op == AMBIT_OP_SUB || q->op == AMBIT_OP_MUL || q->op == AMBIT_OP_DIV)
      fprintf(out, "n%u %s n%u\n", q->a, random_symbols[q->op], q->b);
    else if (random_is_binary(q->op))
      fprintf(out, "ambit.%s(n%u, n%u)\n", random_symbols[q->op], q->a, q->b);
    else
      fprintf(out, "ambit.%s(n%u)\n", random_symbols[q->op], q->a);
  }
  fprintf(out, "print(ambit.evaluate { n%u, arithmetic = arg[1] })\n", last);
}
#endif
