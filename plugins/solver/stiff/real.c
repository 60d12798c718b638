/* real.c -- a tape at a point (real.h). */
#include "real.h"
#include <math.h>

int real_open(const ambit_host *h, const series *s, real *r) {
  *r = (real) { .tape = s->tape, .slot = h->alloc(h, s->tape->nslot * sizeof *r->slot), .counted = s->counted };
  r->terms = h->alloc(h, s->tape->nslot * sizeof *r->terms);
  if (!r->slot || !r->terms) return 0;
  for (uint32_t i = 0; i < s->tape->nconst; i++) r->slot[i] = dd_long(poly_get(&s->slot[i], 0));
  return 1;
}

static long double operate(uint32_t op, long double a, long double b) {
  switch (op) {
  case AMBIT_OP_ADD: return a + b;
  case AMBIT_OP_SUB: return a - b;
  case AMBIT_OP_NEG: return -a;
  case AMBIT_OP_MUL: return a * b;
  case AMBIT_OP_SQR: return a * a;
  case AMBIT_OP_DIV: return a / b;
  case AMBIT_OP_SQRT: return sqrtl(a);
  case AMBIT_OP_EXP: return expl(a);
  case AMBIT_OP_LOG: return logl(a);
  case AMBIT_OP_SIN: return sinl(a);
  case AMBIT_OP_COS: return cosl(a);
  case AMBIT_OP_ATAN: return atanl(a);
  case AMBIT_OP_ATAN2: return atan2l(a, b);
  case AMBIT_OP_SINH: return sinhl(a);
  case AMBIT_OP_COSH: return coshl(a);
  case AMBIT_OP_TAN: return tanl(a);
  case AMBIT_OP_TANH: return tanhl(a);
  case AMBIT_OP_ASIN: return asinl(a);
  case AMBIT_OP_ACOS: return acosl(a);
  case AMBIT_OP_ABS: return fabsl(a);
  case AMBIT_OP_MIN: return a < b ? a : b;
  case AMBIT_OP_MAX: return a > b ? a : b;
  default: return NAN;
  }
}

void real_run(real *r) {
  const ambit_tape *t = r->tape;
  ambit_work_evaluate(r->counted, t->ninstr, 1);
  for (uint32_t i = 0; i < t->ninstr; i++) {
    long double a = r->slot[t->a[i]];
    r->slot[t->dst[i]] = t->op[i] == AMBIT_OP_POWN ? powl(a, (int32_t)t->b[i]) : operate(t->op[i], a, r->slot[t->b[i]]);
  }
}

void real_terms(real *r) {
  const ambit_tape *t = r->tape;
  for (uint32_t i = 0; i < t->nconst + t->nin; i++) r->terms[i] = fabs((double)r->slot[i]);
  for (uint32_t i = 0; i < t->ninstr; i++) {
    uint32_t op = t->op[i], at = op == AMBIT_OP_POWN ? t->a[i] : t->b[i];
    double a = fabs((double)r->slot[t->a[i]]), b = fabs((double)r->slot[at]), terms = fabs((double)r->slot[t->dst[i]]);
    double ta = r->terms[t->a[i]], tb = r->terms[at];
    switch (op) {
    case AMBIT_OP_ADD:
    case AMBIT_OP_SUB: terms = ta + tb; break;
    case AMBIT_OP_NEG: terms = ta; break;
    case AMBIT_OP_MUL: terms = ta * b + a * tb; break;
    case AMBIT_OP_SQR: terms = 2 * ta * a; break;
    case AMBIT_OP_DIV: terms = b > 0 ? (ta + terms * tb) / b : terms; break;
    default: break;
    }
    r->terms[t->dst[i]] = terms;
  }
}
