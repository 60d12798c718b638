/* point.c -- the right-hand side and its derivatives at a point, in plain doubles by the forward mode: for approximate
** solutions, which need not be proved. Where abs, min or max switch, one of the one-sided derivatives is taken.
*/
#include "valencia.h"

typedef struct partial {
  double value, a, b; /* and derivatives by the operands */
} partial;

static double power(double x, int32_t n) {
  double r = 1, f = n < 0 ? 1 / x : x;
  for (uint32_t k = n < 0 ? 0u - (uint32_t)n : (uint32_t)n; k; k >>= 1, f *= f)
    if (k & 1u) r *= f;
  return r;
}

static partial algebraic(uint32_t op, double a, double b, int32_t n) {
  switch (op) {
  case AMBIT_OP_ADD: return (partial) { a + b, 1, 1 };
  case AMBIT_OP_SUB: return (partial) { a - b, 1, -1 };
  case AMBIT_OP_NEG: return (partial) { -a, -1, 0 };
  case AMBIT_OP_MUL: return (partial) { a * b, b, a };
  case AMBIT_OP_SQR: return (partial) { a * a, 2 * a, 0 };
  case AMBIT_OP_POWN: return (partial) { power(a, n), n ? n * power(a, n - 1) : 0, 0 };
  case AMBIT_OP_DIV: return (partial) { a / b, 1 / b, -a / b / b };
  case AMBIT_OP_ABS: return (partial) { fabs(a), a < 0 ? -1 : 1, 0 };
  case AMBIT_OP_MIN: return a < b ? (partial) { a, 1, 0 } : (partial) { b, 0, 1 };
  default: return a > b ? (partial) { a, 1, 0 } : (partial) { b, 0, 1 }; /* MAX */
  }
}

static partial elementary(uint32_t op, double a, double b) {
  double r;
  switch (op) {
  case AMBIT_OP_SQRT: r = sqrt(a); return (partial) { r, r > 0 ? 0.5 / r : 0, 0 };
  case AMBIT_OP_EXP: r = exp(a); return (partial) { r, r, 0 };
  case AMBIT_OP_LOG: return (partial) { log(a), 1 / a, 0 };
  case AMBIT_OP_SIN: return (partial) { sin(a), cos(a), 0 };
  case AMBIT_OP_COS: return (partial) { cos(a), -sin(a), 0 };
  case AMBIT_OP_TAN: r = tan(a); return (partial) { r, 1 + r * r, 0 };
  case AMBIT_OP_ASIN: return (partial) { asin(a), 1 / sqrt(1 - a * a), 0 };
  case AMBIT_OP_ACOS: return (partial) { acos(a), -1 / sqrt(1 - a * a), 0 };
  case AMBIT_OP_ATAN: return (partial) { atan(a), 1 / (1 + a * a), 0 };
  case AMBIT_OP_ATAN2: r = a * a + b * b; return (partial) { atan2(a, b), b / r, -a / r };
  case AMBIT_OP_SINH: return (partial) { sinh(a), cosh(a), 0 };
  case AMBIT_OP_COSH: return (partial) { cosh(a), sinh(a), 0 };
  default: r = tanh(a); return (partial) { r, 1 - r * r, 0 };
  }
}

static int is_elementary(uint32_t op) { return op == AMBIT_OP_SQRT || (op >= AMBIT_OP_EXP && op <= AMBIT_OP_TANH); }

int valencia_point(const valencia *s, const double *x, const double *p, double t, double *f, double *df) {
  const ambit_tape *tape = s->problem.rhs;
  uint32_t n = s->ndir, pitch = 1 + n, input = tape->nconst;
  double *slot = s->stages.slot;
  for (uint32_t i = 0; i < input + tape->nin; i++) {
    double *v = slot + (size_t)i * pitch;
    for (uint32_t j = 0; j < n; j++) v[1 + j] = i >= input && i - input == j;
    if (i < input)
      v[0] = middle((interval) { tape->lo[i], tape->hi[i] });
    else
      v[0] = i - input < s->nx ? x[i - input] : i - input < n ? p[i - input - s->nx] : t;
  }
  for (uint32_t i = 0; i < tape->ninstr; i++) {
    uint32_t op = tape->op[i];
    const double *a = slot + (size_t)tape->a[i] * pitch;
    const double *b = op == AMBIT_OP_POWN ? a : slot + (size_t)tape->b[i] * pitch;
    partial r = is_elementary(op) ? elementary(op, a[0], b[0]) : algebraic(op, a[0], b[0], (int32_t)tape->b[i]);
    double *v = slot + (size_t)tape->dst[i] * pitch;
    v[0] = r.value;
    for (uint32_t j = 1; j < pitch; j++) v[j] = r.a * a[j] + r.b * b[j];
  }
  for (uint32_t i = 0; i < s->nx; i++) {
    const double *v = slot + (size_t)tape->out[i] * pitch;
    f[i] = v[0];
    for (uint32_t j = 0; j < n; j++) df[(size_t)i * n + j] = v[1 + j];
    for (uint32_t j = 0; j < pitch; j++)
      if (!isfinite(v[j])) return 0;
  }
  return 1;
}
