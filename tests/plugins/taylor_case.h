/* taylor_case.h -- the Taylor-model plugin opened for a test, and MPFR as the judge of its polynomials. */
#ifndef AMBIT_TAYLOR_CASE_H
#define AMBIT_TAYLOR_CASE_H
#include "arithmetic_case.h"
#include <ambit/taylor.h>
#include <string.h>

#define TAYLOR_BITS 1200 /* of the judge: its own error is far below what a double can hold */

static const char *const taylor_variant[] = { AMBIT_ARITHMETIC, "ambit.arithmetic.avx2/1",
  "ambit.arithmetic.portable/1" };

typedef struct taylor_case {
  arithmetic_loader l;
  const ambit_arithmetic *a;
  const ambit_taylor *t;
  void *ctx;
  char *block;
  size_t elem, slots, lanes;
  uint32_t nvar, order, count;
} taylor_case;

static inline void taylor_open(taylor_case *c, int which, uint32_t nvar, uint32_t order, size_t slots, size_t lanes) {
  const double option[] = { order, 16 };
  *c = (taylor_case) { .slots = slots, .lanes = lanes };
  const char *problem = arithmetic_load_as(&c->l, "taylor_model", taylor_variant[which]);
  if (problem) fail_msg("%s", problem);
  const ambit_plugin *entry = dlsym(c->l.library, "ambit_entry");
  c->a = &c->l.full, c->t = entry->get(AMBIT_TAYLOR);
  assert_non_null(c->t);
  if (c->a->open(&c->l.scope->host, option, nvar, &c->ctx) != AMBIT_OK) fail_msg("%s", c->l.scope->failure.message);
  c->t->shape(c->ctx, &c->nvar, &c->order, &c->count);
  c->elem = c->a->elem(c->ctx);
  c->block = c->l.scope->host.alloc(&c->l.scope->host, slots * lanes * c->elem);
  assert_non_null(c->block);
}

static inline void taylor_close(taylor_case *c) { arithmetic_unload(&c->l); }

static inline void *taylor_at(const taylor_case *c, size_t slot, size_t lane) {
  return c->block + (slot * c->lanes + lane) * c->elem;
}

static inline uint32_t taylor_run(const taylor_case *c, uint32_t op, uint32_t dst, uint32_t a, uint32_t b) {
  if (c->a->enter) c->a->enter(c->ctx);
  uint32_t flags = c->a->run[op](c->a, c->ctx, c->block, c->lanes, c->lanes, 1, &dst, &a, &b);
  if (c->a->leave) c->a->leave(c->ctx);
  return flags;
}

/* p(x), in r; x [nvar] */
static inline void taylor_value(const taylor_case *c, const void *element, const double *x, mpfr_t r) {
  static uint32_t index[1 << 16], exponent[256];
  static double value[1 << 16];
  uint32_t n = c->t->terms(c->ctx, element, index, value);
  mpfr_t term;
  mpfr_init2(term, TAYLOR_BITS);
  mpfr_set_d(r, 0, MPFR_RNDN);
  for (uint32_t i = 0; i < n; i++) {
    c->t->exponents(c->ctx, index[i], exponent);
    mpfr_set_d(term, value[i], MPFR_RNDN);
    for (uint32_t v = 0; v < c->nvar; v++)
      for (uint32_t k = 0; k < exponent[v]; k++) mpfr_mul_d(term, term, x[v], MPFR_RNDN);
    mpfr_add(r, r, term, MPFR_RNDN);
  }
  mpfr_clear(term);
}

/* Is v within the claims of the element at x, given that v has an error of `error` itself? */
static inline bool taylor_holds(const taylor_case *c, const void *element, const double *x, mpfr_t v, double error) {
  double lo, hi, rest = c->t->remainder(c->ctx, element);
  mpfr_t p;
  mpfr_init2(p, TAYLOR_BITS);
  taylor_value(c, element, x, p);
  mpfr_sub(p, v, p, MPFR_RNDN), mpfr_abs(p, p, MPFR_RNDN);
  mpfr_sub_d(p, p, error, MPFR_RNDN);
  bool inside = mpfr_cmp_d(p, rest) <= 0;
  c->a->bounds(c->ctx, element, 1, &lo, &hi);
  mpfr_add_d(p, v, error, MPFR_RNDN);
  inside = inside && mpfr_cmp_d(p, lo) >= 0;
  mpfr_sub_d(p, v, error, MPFR_RNDN);
  inside = inside && mpfr_cmp_d(p, hi) <= 0;
  mpfr_clear(p);
  return inside;
}

/* op at a point; false outside the domain, or where the judge would have to think too long */
static inline bool taylor_judge(uint32_t op, mpfr_t r, mpfr_t a, mpfr_t b, int32_t n) {
  const mpfr_rnd_t N = MPFR_RNDN;
  bool trig = op >= AMBIT_OP_SIN && op <= AMBIT_OP_TAN,
       grows = op == AMBIT_OP_EXP || op == AMBIT_OP_SINH || op == AMBIT_OP_COSH;
  if ((trig && mpfr_cmpabs_ui(a, 1u << 30) > 0) || (grows && mpfr_cmpabs_ui(a, 800) > 0)) return false;
  switch (op) {
  case AMBIT_OP_ADD: mpfr_add(r, a, b, N); break;
  case AMBIT_OP_SUB: mpfr_sub(r, a, b, N); break;
  case AMBIT_OP_NEG: mpfr_neg(r, a, N); break;
  case AMBIT_OP_MUL: mpfr_mul(r, a, b, N); break;
  case AMBIT_OP_SQR: mpfr_sqr(r, a, N); break;
  case AMBIT_OP_POWN:
    if (mpfr_zero_p(a) && n < 0) return false;
    mpfr_pow_si(r, a, n, N);
    break;
  case AMBIT_OP_DIV:
    if (mpfr_zero_p(b)) return false;
    mpfr_div(r, a, b, N);
    break;
  case AMBIT_OP_SQRT: mpfr_sqrt(r, a, N); break;
  case AMBIT_OP_EXP: mpfr_exp(r, a, N); break;
  case AMBIT_OP_LOG:
    if (mpfr_sgn(a) <= 0) return false;
    mpfr_log(r, a, N);
    break;
  case AMBIT_OP_SIN: mpfr_sin(r, a, N); break;
  case AMBIT_OP_COS: mpfr_cos(r, a, N); break;
  case AMBIT_OP_TAN: mpfr_tan(r, a, N); break;
  case AMBIT_OP_ASIN: mpfr_asin(r, a, N); break;
  case AMBIT_OP_ACOS: mpfr_acos(r, a, N); break;
  case AMBIT_OP_ATAN: mpfr_atan(r, a, N); break;
  case AMBIT_OP_ATAN2:
    if (mpfr_zero_p(a) && mpfr_zero_p(b)) return false;
    if (mpfr_zero_p(a)) mpfr_abs(a, a, N);
    mpfr_atan2(r, a, b, N);
    break;
  case AMBIT_OP_SINH: mpfr_sinh(r, a, N); break;
  case AMBIT_OP_COSH: mpfr_cosh(r, a, N); break;
  case AMBIT_OP_TANH: mpfr_tanh(r, a, N); break;
  case AMBIT_OP_ABS: mpfr_abs(r, a, N); break;
  case AMBIT_OP_MIN: mpfr_min(r, a, b, N); break;
  default: mpfr_max(r, a, b, N); break;
  }
  return mpfr_number_p(r);
}
#endif
