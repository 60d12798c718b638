/* solution_oracle.h -- solutions of a problem in 300-bit arithmetic: Taylor series of high order on the problem's own
** tape, as the judge of integrators.
**
** Constants are read from their text, so the problem must be built with AMBIT_SEAL_KEEP. Steps are chosen such that the
** last terms are below 10^-50: no proof, but forty digits beyond what is judged.
*/
#ifndef AMBIT_SOLUTION_ORACLE_H
#define AMBIT_SOLUTION_ORACLE_H
#include "kit/series_oracle.h"
#include <ambit/solver.h>
#include <math.h>
#include <string.h>

#define SOLUTION_ORDER 40
#define SOLUTION_DIGITS 50

typedef struct solution_oracle {
  const ambit_problem *problem;
  series_oracle rhs, start;
  mpfr_t t, h, power, term;
} solution_oracle;

/* "pi", "0.1", "8/3"; without text the constant is a point */
static inline void solution_constant(mpfr_t c, const ambit_tape *t, uint32_t i) {
  const char *text = t->text ? t->text[i] : NULL, *slash = text ? strchr(text, '/') : NULL;
  if (!text) {
    if (t->lo[i] != t->hi[i]) abort();
    mpfr_set_d(c, t->lo[i], MPFR_RNDN);
  } else if (strcmp(text, "pi") == 0)
    mpfr_const_pi(c, MPFR_RNDN);
  else {
    mpfr_t divisor;
    mpfr_init2(divisor, SERIES_BITS);
    mpfr_strtofr(c, text, NULL, 10, MPFR_RNDN);
    if (slash) {
      mpfr_strtofr(divisor, slash + 1, NULL, 10, MPFR_RNDN);
      mpfr_div(c, c, divisor, MPFR_RNDN);
    }
    mpfr_clear(divisor);
  }
}

static inline void solution_constants(series_oracle *s) {
  for (uint32_t i = 0; i < s->tape->nconst; i++) solution_constant(*series_u(s, i, 0), s->tape, i);
}

static inline mpfr_t *solution_state(solution_oracle *o, uint32_t i) {
  return series_u(&o->rhs, o->problem->rhs->nconst + i, 0);
}

static inline void solution_open(solution_oracle *o, const ambit_problem *p) {
  o->problem = p;
  series_open(&o->rhs, p->rhs, SOLUTION_ORDER);
  series_open(&o->start, p->initial, 0);
  mpfr_inits2(SERIES_BITS, o->t, o->h, o->power, o->term, (mpfr_ptr)0);
  solution_constants(&o->rhs);
  solution_constants(&o->start);
}

static inline void solution_close(solution_oracle *o) {
  series_close(&o->rhs);
  series_close(&o->start);
  mpfr_clears(o->t, o->h, o->power, o->term, (mpfr_ptr)0);
}

/* the solution at time[0] for the unknowns u[nu] */
static inline void solution_start(solution_oracle *o, const double *u) {
  const ambit_problem *p = o->problem;
  for (uint32_t i = 0; i < p->nu; i++) mpfr_set_d(*series_u(&o->start, p->initial->nconst + i, 0), u[i], MPFR_RNDN);
  series_run(&o->start);
  for (uint32_t i = 0; i < p->nx + p->np; i++)
    mpfr_set(*solution_state(o, i), *series_u(&o->start, p->initial->out[i], 0), MPFR_RNDN);
  mpfr_set_d(o->t, p->time[0], MPFR_RNDN);
}

static inline void solution_series(solution_oracle *o) {
  const ambit_problem *p = o->problem;
  if (p->uses_time) {
    mpfr_set(*solution_state(o, p->nx + p->np), o->t, MPFR_RNDN);
    mpfr_set_si(*series_u(&o->rhs, p->rhs->nconst + p->nx + p->np, 1), 1, MPFR_RNDN);
  }
  for (uint32_t k = 0; k < SOLUTION_ORDER; k++) {
    for (uint32_t j = 0; j < p->rhs->ninstr; j++) series_instruction(&o->rhs, j, k);
    for (uint32_t i = 0; i < p->nx; i++)
      mpfr_div_ui(
          *series_u(&o->rhs, p->rhs->nconst + i, k + 1), *series_u(&o->rhs, p->rhs->out[i], k), k + 1, MPFR_RNDN);
  }
}

static inline double solution_length(solution_oracle *o) {
  double length = INFINITY;
  for (uint32_t i = 0; i < o->problem->nx; i++)
    for (uint32_t k = SOLUTION_ORDER - 1; k <= SOLUTION_ORDER; k++) {
      mpfr_t *c = series_u(&o->rhs, o->problem->rhs->nconst + i, k);
      if (mpfr_zero_p(*c)) continue;
      double exponent = (double)mpfr_get_exp(*c) * 0.30103 + SOLUTION_DIGITS;
      length = fmin(length, pow(10, -exponent / k));
    }
  return length;
}

/* to the time `end`, in either direction */
static inline void solution_advance(solution_oracle *o, double end) {
  while (mpfr_cmp_d(o->t, end) != 0) {
    solution_series(o);
    double length = solution_length(o);
    mpfr_d_sub(o->h, end, o->t, MPFR_RNDN);
    int last = fabs(mpfr_get_d(o->h, MPFR_RNDN)) <= length;
    if (!last) mpfr_set_d(o->h, copysign(length, mpfr_get_d(o->h, MPFR_RNDN)), MPFR_RNDN);
    for (uint32_t i = 0; i < o->problem->nx; i++) {
      mpfr_t *x = solution_state(o, i); /* [order + 1] */
      mpfr_set(o->term, x[SOLUTION_ORDER], MPFR_RNDN);
      for (uint32_t k = SOLUTION_ORDER; k-- > 0;) mpfr_fma(o->term, o->term, o->h, x[k], MPFR_RNDN);
      mpfr_set(x[0], o->term, MPFR_RNDN);
    }
    if (last)
      mpfr_set_d(o->t, end, MPFR_RNDN);
    else
      mpfr_add(o->t, o->t, o->h, MPFR_RNDN);
  }
}

/* lo <= x_i <= hi */
static inline int solution_within(solution_oracle *o, uint32_t i, double lo, double hi) {
  return mpfr_cmp_d(*solution_state(o, i), lo) >= 0 && mpfr_cmp_d(*solution_state(o, i), hi) <= 0;
}
#endif
