/* series_oracle.h -- Taylor coefficients of every slot of a SERIES tape in 300-bit arithmetic (MPFR), as the judge of
** jets.
**
** Written from the textbook recursions [Griewank & Walther, table 13.2], term by term, with none of the shortcuts of
** the code under test: no degrees, no helper slots, every logarithmic or inverse function from its own differential
** equation.
*/
#ifndef AMBIT_SERIES_ORACLE_H
#define AMBIT_SERIES_ORACLE_H
#include <ambit/tape.h>
#include <mpfr.h>
#include <stdlib.h>

#define SERIES_BITS 300

typedef struct series_oracle {
  const ambit_tape *tape;
  uint32_t order;
  mpfr_t *u;        /* [nslot][order + 1] */
  mpfr_t *partner;  /* [ninstr][order + 1]: the cosine to a sine, 1 + a^2 to an arc tangent, ... */
  mpfr_t sum, term; /* scratch */
} series_oracle;

static inline mpfr_t *series_u(series_oracle *s, uint32_t slot, uint32_t k) {
  return &s->u[(size_t)slot * (s->order + 1) + k];
}
static inline mpfr_t *series_partner(series_oracle *s, uint32_t i, uint32_t k) {
  return &s->partner[(size_t)i * (s->order + 1) + k];
}

static inline mpfr_t *series_room(size_t n) {
  mpfr_t *x = malloc(n * sizeof *x);
  for (size_t i = 0; x && i < n; i++) mpfr_init2(x[i], SERIES_BITS), mpfr_set_zero(x[i], 1);
  return x;
}

static inline void series_open(series_oracle *s, const ambit_tape *t, uint32_t order) {
  *s = (series_oracle) { .tape = t, .order = order };
  s->u = series_room((size_t)t->nslot * (order + 1));
  s->partner = series_room((size_t)t->ninstr * (order + 1));
  mpfr_init2(s->sum, SERIES_BITS), mpfr_init2(s->term, SERIES_BITS);
}

static inline void series_close(series_oracle *s) {
  for (size_t i = 0; i < (size_t)s->tape->nslot * (s->order + 1); i++) mpfr_clear(s->u[i]);
  for (size_t i = 0; i < (size_t)s->tape->ninstr * (s->order + 1); i++) mpfr_clear(s->partner[i]);
  mpfr_clear(s->sum), mpfr_clear(s->term);
  free(s->u), free(s->partner);
}

/* sum := sum + factor * sum_{j=from}^{to} w(j) a_j b_(k-j), w(j) = j if weighted */
static inline void series_add(
    series_oracle *s, mpfr_t *a, mpfr_t *b, uint32_t k, uint32_t from, uint32_t to, int weighted, long factor) {
  for (uint32_t j = from; j <= to && to != UINT32_MAX; j++) {
    mpfr_mul(s->term, a[j], b[k - j], MPFR_RNDN);
    mpfr_mul_si(s->term, s->term, factor * (weighted ? (long)j : 1), MPFR_RNDN);
    mpfr_add(s->sum, s->sum, s->term, MPFR_RNDN);
  }
}

/* r_k := sum / (scale * d) */
static inline void series_divide(series_oracle *s, mpfr_t r, mpfr_t d, uint32_t scale) {
  mpfr_div(s->term, s->sum, d, MPFR_RNDN);
  mpfr_div_ui(r, s->term, scale, MPFR_RNDN);
}

static inline void series_circular(
    series_oracle *s, mpfr_t *sine, mpfr_t *cosine, mpfr_t *a, uint32_t k, int hyperbolic) {
  if (k == 0) {
    (hyperbolic ? mpfr_sinh : mpfr_sin)(sine[0], a[0], MPFR_RNDN);
    (hyperbolic ? mpfr_cosh : mpfr_cos)(cosine[0], a[0], MPFR_RNDN);
    return;
  }
  mpfr_set_zero(s->sum, 1), series_add(s, a, cosine, k, 1, k, 1, 1);
  mpfr_div_ui(sine[k], s->sum, k, MPFR_RNDN);
  mpfr_set_zero(s->sum, 1), series_add(s, a, sine, k, 1, k, 1, hyperbolic ? 1 : -1);
  mpfr_div_ui(cosine[k], s->sum, k, MPFR_RNDN);
}

/* w r' = f: the terms of r itself; sum holds coefficient k-1 of f */
static inline void series_logarithmic(series_oracle *s, mpfr_t *r, mpfr_t *w, uint32_t k) {
  series_add(s, r, w, k, 1, k - 1, 1, -1);
  series_divide(s, r[k], w[0], k);
}

static inline void series_atan2(series_oracle *s, mpfr_t *r, mpfr_t *w, mpfr_t *y, mpfr_t *x, uint32_t k) {
  mpfr_set_zero(s->sum, 1);
  series_add(s, x, x, k, 0, k, 0, 1), series_add(s, y, y, k, 0, k, 0, 1);
  mpfr_set(w[k], s->sum, MPFR_RNDN);
  if (k == 0) {
    mpfr_atan2(r[0], y[0], x[0], MPFR_RNDN);
    return;
  }
  mpfr_set_zero(s->sum, 1);
  series_add(s, y, x, k, 1, k, 1, 1), series_add(s, x, y, k, 1, k, 1, -1);
  series_logarithmic(s, r, w, k);
}

static inline void series_atan(series_oracle *s, mpfr_t *r, mpfr_t *w, mpfr_t *a, uint32_t k) {
  mpfr_set_ui(s->sum, k == 0, MPFR_RNDN);
  series_add(s, a, a, k, 0, k, 0, 1);
  mpfr_set(w[k], s->sum, MPFR_RNDN);
  if (k == 0) {
    mpfr_atan(r[0], a[0], MPFR_RNDN);
    return;
  }
  mpfr_mul_ui(s->sum, a[k], k, MPFR_RNDN);
  series_logarithmic(s, r, w, k);
}

static inline void series_log(series_oracle *s, mpfr_t *r, mpfr_t *a, uint32_t k) {
  if (k == 0) {
    mpfr_log(r[0], a[0], MPFR_RNDN);
    return;
  }
  mpfr_mul_ui(s->sum, a[k], k, MPFR_RNDN);
  series_logarithmic(s, r, a, k);
}

static inline void series_exp(series_oracle *s, mpfr_t *r, mpfr_t *a, uint32_t k) {
  if (k == 0) {
    mpfr_exp(r[0], a[0], MPFR_RNDN);
    return;
  }
  mpfr_set_zero(s->sum, 1), series_add(s, a, r, k, 1, k, 1, 1);
  mpfr_div_ui(r[k], s->sum, k, MPFR_RNDN);
}

/* r' = w a', w = 1 - r^2 */
static inline void series_tanh(series_oracle *s, mpfr_t *r, mpfr_t *w, mpfr_t *a, uint32_t k) {
  if (k == 0) {
    mpfr_tanh(r[0], a[0], MPFR_RNDN);
  } else {
    mpfr_set_zero(s->sum, 1), series_add(s, a, w, k, 1, k, 1, 1);
    mpfr_div_ui(r[k], s->sum, k, MPFR_RNDN);
  }
  mpfr_set_ui(s->sum, k == 0, MPFR_RNDN), series_add(s, r, r, k, 0, k, 0, -1);
  mpfr_set(w[k], s->sum, MPFR_RNDN);
}

static inline void series_sqrt(series_oracle *s, mpfr_t *r, mpfr_t *a, uint32_t k) {
  if (k == 0) {
    mpfr_sqrt(r[0], a[0], MPFR_RNDN);
    return;
  }
  mpfr_set(s->sum, a[k], MPFR_RNDN), series_add(s, r, r, k, 1, k - 1, 0, -1);
  series_divide(s, r[k], r[0], 2);
}

static inline void series_quotient(series_oracle *s, mpfr_t *r, mpfr_t *a, mpfr_t *b, uint32_t k) {
  mpfr_set(s->sum, a[k], MPFR_RNDN);
  if (k) series_add(s, r, b, k, 0, k - 1, 0, -1);
  series_divide(s, r[k], b[0], 1);
}

static inline void series_choice(uint32_t op, mpfr_t *r, mpfr_t *a, mpfr_t *b, uint32_t k) {
  int first = op == AMBIT_OP_ABS ? mpfr_sgn(a[0]) >= 0 : (mpfr_cmp(a[0], b[0]) >= 0) == (op == AMBIT_OP_MAX);
  if (first)
    mpfr_set(r[k], a[k], MPFR_RNDN);
  else if (op == AMBIT_OP_ABS)
    mpfr_neg(r[k], a[k], MPFR_RNDN);
  else
    mpfr_set(r[k], b[k], MPFR_RNDN);
}

static inline void series_instruction(series_oracle *s, uint32_t i, uint32_t k) {
  const ambit_tape *t = s->tape;
  mpfr_t *r = series_u(s, t->dst[i], 0), *a = series_u(s, t->a[i], 0), *b = series_u(s, t->b[i], 0);
  mpfr_t *p = series_partner(s, i, 0);
  mpfr_set_zero(s->sum, 1);
  switch (t->op[i]) {
  case AMBIT_OP_ADD: mpfr_add(r[k], a[k], b[k], MPFR_RNDN); break;
  case AMBIT_OP_SUB: mpfr_sub(r[k], a[k], b[k], MPFR_RNDN); break;
  case AMBIT_OP_NEG: mpfr_neg(r[k], a[k], MPFR_RNDN); break;
  case AMBIT_OP_MUL:
  case AMBIT_OP_SQR:
    series_add(s, a, b, k, 0, k, 0, 1);
    mpfr_set(r[k], s->sum, MPFR_RNDN);
    break;
  case AMBIT_OP_DIV: series_quotient(s, r, a, b, k); break;
  case AMBIT_OP_SQRT: series_sqrt(s, r, a, k); break;
  case AMBIT_OP_EXP: series_exp(s, r, a, k); break;
  case AMBIT_OP_LOG: series_log(s, r, a, k); break;
  case AMBIT_OP_SIN: series_circular(s, r, p, a, k, 0); break;
  case AMBIT_OP_COS: series_circular(s, p, r, a, k, 0); break;
  case AMBIT_OP_SINH: series_circular(s, r, p, a, k, 1); break;
  case AMBIT_OP_COSH: series_circular(s, p, r, a, k, 1); break;
  case AMBIT_OP_TANH: series_tanh(s, r, p, a, k); break;
  case AMBIT_OP_ATAN: series_atan(s, r, p, a, k); break;
  case AMBIT_OP_ATAN2: series_atan2(s, r, p, a, b, k); break;
  default: series_choice(t->op[i], r, a, b, k); break;
  }
}

/* The coefficients of constants and inputs must have been written (mpfr_set_d(*series_u(...), ...)). */
static inline void series_run(series_oracle *s) {
  for (uint32_t k = 0; k <= s->order; k++)
    for (uint32_t i = 0; i < s->tape->ninstr; i++) series_instruction(s, i, k);
}
#endif
