/* approximate.c -- one operation after the other, in the C library's functions. */
#include "verbs/split/approximate.h"
#include "num/interval.h"
#include <math.h>
#include <string.h>

static double power(double x, uint32_t bits) {
  int32_t n;
  memcpy(&n, &bits, sizeof n);
  return pow(x, n);
}

static double function(uint32_t op, double a, double b) {
  ambit_interval r, x = { a, a }, y = { b, b };
  if (!ambit_op_is_function(op) || isnan(a) || isnan(b)) return NAN; /* newer than this file */
  return ambit_interval_op(op, &r, x, y) & AMBIT_F_EMPTY ? NAN : ambit_interval_mid(r);
}

static double apply(uint32_t op, double a, double b) {
  switch (op) {
  case AMBIT_OP_ADD: return a + b;
  case AMBIT_OP_SUB: return a - b;
  case AMBIT_OP_NEG: return -a;
  case AMBIT_OP_MUL: return a * b;
  case AMBIT_OP_SQR: return a * a;
  case AMBIT_OP_DIV: return b != 0 ? a / b : NAN;
  case AMBIT_OP_SQRT: return sqrt(a);
  case AMBIT_OP_EXP: return exp(a);
  case AMBIT_OP_LOG: return log(a);
  case AMBIT_OP_SIN: return sin(a);
  case AMBIT_OP_COS: return cos(a);
  case AMBIT_OP_TAN: return tan(a);
  case AMBIT_OP_ASIN: return asin(a);
  case AMBIT_OP_ACOS: return acos(a);
  case AMBIT_OP_ATAN: return atan(a);
  case AMBIT_OP_ATAN2: return a != 0 || b != 0 ? atan2(a, b) : NAN;
  case AMBIT_OP_SINH: return sinh(a);
  case AMBIT_OP_COSH: return cosh(a);
  case AMBIT_OP_TANH: return tanh(a);
  case AMBIT_OP_ABS: return fabs(a);
  case AMBIT_OP_MIN: return a < b ? a : b;
  case AMBIT_OP_MAX: return a > b ? a : b;
  default: return function(op, a, b);
  }
}

void ambit_approximate(const ambit_tape *t, const double *in, double *slot) {
  for (uint32_t i = 0; i < t->nconst; i++) slot[i] = 0.5 * t->lo[i] + 0.5 * t->hi[i];
  memcpy(slot + t->nconst, in, t->nin * sizeof *in);
  for (uint32_t i = 0; i < t->ninstr; i++)
    slot[t->dst[i]] =
        t->op[i] == AMBIT_OP_POWN ? power(slot[t->a[i]], t->b[i]) : apply(t->op[i], slot[t->a[i]], slot[t->b[i]]);
}
