/* functions.c -- rows of quotients, roots and elementary functions. */
#include "implicit.h"
#include "turn.h"
#include "value.h"

typedef struct instr {
  uint32_t op, dst, a, b, aux, k;
} instr;

static instr instruction(const zono *z, uint32_t i, uint32_t k) {
  const ambit_tape *t = z->program.tape;
  return (instr) { t->op[i], t->dst[i], t->a[i], t->b[i], t->aux[i], k };
}

/* -- order 0: the Taylor polynomial of degree 2 about the constant */

/* u = (x dy - y dx) / r^2, w = (x dx + y dy) / r^2:  atan(u / (1 + w)) = u - u w + u w^2 - u^3 / 3 + ... */
static void put_angle(const zono *z, const instr *n, double *to) {
  const shape *s = &z->shape;
  const double *y = row_at(z, n->a, 0), *x = row_at(z, n->b, 0);
  double r = x[0] * x[0] + y[0] * y[0], turned = x[0] * row_low(s, y) - y[0] * row_low(s, x), *u = s->scratch,
         *w = u + s->stride, *square = w + s->stride;
  uint32_t parts = row_parts(s, 0);
  terms sum;
  terms_clear(&sum);
  terms_moving(s, &sum, x[0] / r, y), terms_moving(s, &sum, -y[0] / r, x);
  terms_sum(s, &sum, u, parts);
  terms_clear(&sum);
  terms_moving(s, &sum, x[0] / r, x), terms_moving(s, &sum, y[0] / r, y);
  terms_sum(s, &sum, w, parts);
  terms_clear(&sum);
  terms_outer(s, &sum, 1, w, w), terms_outer(s, &sum, -1.0 / 3, u, u);
  terms_moving(s, &sum, -1, w);
  terms_sum(s, &sum, square, parts); /* w^2 - u^2 / 3 - w */
  terms_clear(&sum);
  sum.c = value_of(z, AMBIT_OP_ATAN2, y[0], x[0]), sum.low = turned / r;
  terms_moving(s, &sum, 1, u), terms_outer(s, &sum, 1, u, square);
  terms_sum(s, &sum, to, row_parts(s, 0));
}

static void put_quotient(zono *z, uint32_t i, const instr *n, double *to) {
  const shape *s = &z->shape;
  double *inverse = zono_inverse(z, i);
  row_inverse(s, inverse, row_at(z, n->b, 0));
  terms sum;
  terms_clear(&sum);
  terms_product(s, &sum, 1, row_at(z, n->a, 0), inverse);
  terms_sum(s, &sum, to, row_parts(s, 0));
}

static void set(double g[4], double g0, double g1, double g2, double g3) { g[0] = g0, g[1] = g1, g[2] = g2, g[3] = g3; }

/* sin, cos, sinh or cosh, and the derivative, sin and sinh being first */
static void set_pair(const zono *z, uint32_t op, double c, double g[4]) {
  int turns = op == AMBIT_OP_SIN || op == AMBIT_OP_COS, first = op == AMBIT_OP_SIN || op == AMBIT_OP_SINH;
  double a = value_of(z, turns ? AMBIT_OP_SIN : AMBIT_OP_SINH, c, 0), sign = turns ? -1 : 1;
  double b = value_of(z, turns ? AMBIT_OP_COS : AMBIT_OP_COSH, c, 0);
  if (first)
    set(g, a, b, sign * a, sign * b);
  else
    set(g, b, sign * a, sign * b, a);
}

/* of tanh: 1 - v^2 = (1 - v) (1 + v) */
static void set_tanh(const zono *z, double c, double g[4]) {
  double v = value_of(z, AMBIT_OP_TANH, c, 0), q = (1 - v) * (1 + v);
  set(g, v, q, -2 * v * q, q * (6 * v * v - 2));
}

/* value and derivatives at c; 0: undefined */
static int derivatives(const zono *z, uint32_t op, double c, double g[4]) {
  double i = 1 / c, q = 1 / (1 + c * c), v;
  switch (op) {
  case AMBIT_OP_SQRT:
    v = c > 0 ? sqrt(c) : 0;
    set(g, v, 0.5 * v * i, -0.25 * v * i * i, 0.375 * v * i * i * i);
    return c > 0;
  case AMBIT_OP_EXP: v = value_of(z, op, c, 0), set(g, v, v, v, v); return 1;
  case AMBIT_OP_LOG:
    if (c > 0) set(g, value_of(z, op, c, 0), i, -i * i, 2 * i * i * i);
    return c > 0;
  case AMBIT_OP_SIN:
  case AMBIT_OP_COS:
  case AMBIT_OP_SINH:
  case AMBIT_OP_COSH: set_pair(z, op, c, g); return 1;
  case AMBIT_OP_TANH: set_tanh(z, c, g); return 1;
  case AMBIT_OP_ATAN: set(g, value_of(z, op, c, 0), q, -2 * c * q * q, (6 * c * c - 2) * q * q * q); return 1;
  default: return 0;
  }
}

/* at the constant of a, its low part included: to twice the digits, if turn.h or arithmetic knows so many */
static dd middle_of(const shape *s, uint32_t op, const double *a, const double g[4]) {
  dd sine = { 0, 0 }, cosine = { 0, 0 }, value = { g[0], 0 };
  if (op == AMBIT_OP_SQRT) return dd_sqrt(row_middle(s, a));
  if ((op == AMBIT_OP_SIN || op == AMBIT_OP_COS) && turn_at(a[0], &sine, &cosine))
    value = op == AMBIT_OP_SIN ? sine : cosine;
  return dd_make(value.hi, value.lo + g[1] * row_low(s, a));
}

int zono_function_order0(zono *z, uint32_t i) {
  const instr n = instruction(z, i, 0);
  const double *a = row_at(z, n.a, 0);
  double *to = row_at(z, n.dst, 0), g[4] = { 0 };
  if (n.op == AMBIT_OP_DIV) {
    if (row_at(z, n.b, 0)[0] == 0) return 0;
    return put_quotient(z, i, &n, to), 1;
  }
  if (n.op == AMBIT_OP_ATAN2) {
    if (a[0] == 0 && row_at(z, n.b, 0)[0] == 0) return 0;
    return put_angle(z, &n, to), 1;
  }
  if (!derivatives(z, n.op, a[0], g)) return 0;
  row_function(&z->shape, to, a, middle_of(&z->shape, n.op, a, g), g);
  return 1;
}

/* -- order k > 0: recurrences */

/* sum += scale / k sum_{from <= j <= to} j u_j (*) v_(k-j) */
static void add_weighted(
    const zono *z, terms *sum, double scale, uint32_t u, uint32_t v, uint32_t k, uint32_t from, uint32_t to) {
  uint32_t nu = orders(z, u), nv = orders(z, v);
  for (uint32_t j = from; j <= to && j < nu; j++)
    if (k - j < nv) terms_share(&z->shape, sum, scale, j, k, row_at(z, u, j), row_at(z, v, k - j));
}

/* what is divided by the inverse at order k; the function's own rows below k are known */
static void add_dividend(const zono *z, terms *sum, const instr *n) {
  const shape *s = &z->shape;
  uint32_t k = n->k;
  if (n->op != AMBIT_OP_ATAN2) terms_row(s, sum, 1, coefficient(z, n->a, k));
  switch (n->op) {
  case AMBIT_OP_DIV:
    for (uint32_t j = 1; j <= k && j < orders(z, n->b); j++)
      terms_product(s, sum, -1, row_at(z, n->b, j), row_at(z, n->dst, k - j));
    break;
  case AMBIT_OP_SQRT:
    for (uint32_t j = 1; 2 * j < k; j++) terms_product(s, sum, -2, row_at(z, n->dst, j), row_at(z, n->dst, k - j));
    if (k % 2 == 0) terms_product(s, sum, -1, row_at(z, n->dst, k / 2), row_at(z, n->dst, k / 2));
    break;
  case AMBIT_OP_LOG: add_weighted(z, sum, -1, n->dst, n->a, k, 1, k - 1); break;
  case AMBIT_OP_ATAN: add_weighted(z, sum, -1, n->dst, n->aux, k, 1, k - 1); break;
  default:
    add_weighted(z, sum, 1, n->a, n->b, k, 1, k);
    add_weighted(z, sum, -1, n->b, n->a, k, 1, k);
    add_weighted(z, sum, -1, n->dst, n->aux, k, 1, k - 1);
  }
}

/* the inverse that the recurrence of instruction i needs; the operands' order 0 is final */
static int find_inverse(zono *z, uint32_t i, const instr *n) {
  const shape *s = &z->shape;
  if (n->op == AMBIT_OP_DIV) return 1;
  uint32_t of = n->op == AMBIT_OP_SQRT ? n->dst : n->op == AMBIT_OP_LOG ? n->a : n->aux;
  const double *a = row_at(z, of, 0);
  if (a[0] == 0) return 0;
  row_inverse(s, zono_inverse(z, i), a);
  if (n->op == AMBIT_OP_SQRT) row_over(s, zono_inverse(z, i), 2, zono_inverse(z, i), row_parts(s, 0));
  return 1;
}

int zono_function(zono *z, uint32_t i, uint32_t k) {
  const instr n = instruction(z, i, k);
  const shape *s = &z->shape;
  double *to = row_at(z, n.dst, k);
  terms sum;
  terms_clear(&sum);
  switch (n.op) {
  case AMBIT_OP_EXP: add_weighted(z, &sum, 1, n.a, n.dst, k, 1, k); break;
  case AMBIT_OP_SIN:
  case AMBIT_OP_SINH:
  case AMBIT_OP_COSH:
  case AMBIT_OP_TANH: add_weighted(z, &sum, 1, n.a, n.aux, k, 1, k); break;
  case AMBIT_OP_COS: add_weighted(z, &sum, -1, n.a, n.aux, k, 1, k); break;
  default:
    if (!z->has_inverse[i]) return 0;
    if (k == 1 && !find_inverse(z, i, &n)) return 0;
    add_dividend(z, &sum, &n);
    terms_sum(s, &sum, z->scratch, row_parts(&z->shape, k));
    terms_clear(&sum);
    terms_product(s, &sum, 1, z->scratch, inverse_at(z, i));
  }
  terms_sum(s, &sum, to, row_parts(&z->shape, k));
  return 1;
}
