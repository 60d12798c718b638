/* program_oracle.h -- a tape at a point in 400-bit arithmetic (MPFR), as the judge of programs.
**
** Its error is far below anything that bounds in double can show; comparisons leave 2^-80 of room for it.
*/
#ifndef AMBIT_PROGRAM_ORACLE_H
#define AMBIT_PROGRAM_ORACLE_H
#include <ambit/tape.h>
#include <math.h>
#include <mpfr.h>
#include <stdbool.h>

#define PROGRAM_BITS 400
#define PROGRAM_SLOTS 64

typedef struct program_oracle {
  mpfr_t u[PROGRAM_SLOTS]; /* NaN outside the domain */
} program_oracle;

static inline void program_open(program_oracle *p) {
  for (int i = 0; i < PROGRAM_SLOTS; i++) mpfr_init2(p->u[i], PROGRAM_BITS);
}

static inline void program_close(program_oracle *p) {
  for (int i = 0; i < PROGRAM_SLOTS; i++) mpfr_clear(p->u[i]);
}

/* the angle of (x, 0) is 0 or pi, whatever the sign of this zero */
static inline void program_angle(mpfr_t r, mpfr_t y, mpfr_t x) {
  if (!mpfr_zero_p(y))
    mpfr_atan2(r, y, x, MPFR_RNDN);
  else if (mpfr_sgn(x) > 0)
    mpfr_set_zero(r, 1);
  else
    mpfr_const_pi(r, MPFR_RNDN);
}

/* r := a op b, or a^n */
static inline void program_step(uint32_t op, mpfr_t r, mpfr_t a, mpfr_t b, int32_t n) {
  switch (op) {
  case AMBIT_OP_ADD: mpfr_add(r, a, b, MPFR_RNDN); break;
  case AMBIT_OP_SUB: mpfr_sub(r, a, b, MPFR_RNDN); break;
  case AMBIT_OP_NEG: mpfr_neg(r, a, MPFR_RNDN); break;
  case AMBIT_OP_MUL: mpfr_mul(r, a, b, MPFR_RNDN); break;
  case AMBIT_OP_SQR: mpfr_sqr(r, a, MPFR_RNDN); break;
  case AMBIT_OP_POWN: mpfr_pow_si(r, a, n, MPFR_RNDN); break;
  case AMBIT_OP_DIV: mpfr_div(r, a, b, MPFR_RNDN); break;
  case AMBIT_OP_SQRT: mpfr_sqrt(r, a, MPFR_RNDN); break;
  case AMBIT_OP_EXP: mpfr_exp(r, a, MPFR_RNDN); break;
  case AMBIT_OP_LOG: mpfr_log(r, a, MPFR_RNDN); break;
  case AMBIT_OP_SIN: mpfr_sin(r, a, MPFR_RNDN); break;
  case AMBIT_OP_COS: mpfr_cos(r, a, MPFR_RNDN); break;
  case AMBIT_OP_TAN: mpfr_tan(r, a, MPFR_RNDN); break;
  case AMBIT_OP_ASIN: mpfr_asin(r, a, MPFR_RNDN); break;
  case AMBIT_OP_ACOS: mpfr_acos(r, a, MPFR_RNDN); break;
  case AMBIT_OP_ATAN: mpfr_atan(r, a, MPFR_RNDN); break;
  case AMBIT_OP_ATAN2: program_angle(r, a, b); break;
  case AMBIT_OP_SINH: mpfr_sinh(r, a, MPFR_RNDN); break;
  case AMBIT_OP_COSH: mpfr_cosh(r, a, MPFR_RNDN); break;
  case AMBIT_OP_TANH: mpfr_tanh(r, a, MPFR_RNDN); break;
  case AMBIT_OP_ABS: mpfr_abs(r, a, MPFR_RNDN); break;
  case AMBIT_OP_MIN: mpfr_min(r, a, b, MPFR_RNDN); break;
  default: mpfr_max(r, a, b, MPFR_RNDN); break;
  }
  if (mpfr_inf_p(r)) mpfr_set_nan(r);
}

/* min and max of MPFR ignore a NaN, atan2 takes (0, 0) */
static inline bool program_defined(uint32_t op, mpfr_t a, mpfr_t b) {
  bool both = op == AMBIT_OP_MIN || op == AMBIT_OP_MAX, angle = op == AMBIT_OP_ATAN2;
  if ((both || angle) && (mpfr_nan_p(a) || mpfr_nan_p(b))) return false;
  return !(angle && mpfr_zero_p(a) && mpfr_zero_p(b));
}

/* every slot at the point; constants are their lower bounds, which must be exact */
static inline void program_run(program_oracle *p, const ambit_tape *t, const double *point) {
  mpfr_set_emin(mpfr_get_emin_min()), mpfr_set_emax(mpfr_get_emax_max()); /* another judge may have narrowed them */
  for (uint32_t i = 0; i < t->nconst; i++) mpfr_set_d(p->u[i], t->lo[i], MPFR_RNDN);
  for (uint32_t i = 0; i < t->nin; i++) mpfr_set_d(p->u[t->nconst + i], point[i], MPFR_RNDN);
  for (uint32_t i = 0; i < t->ninstr; i++) {
    uint32_t b = t->op[i] == AMBIT_OP_POWN ? t->a[i] : t->b[i];
    if (program_defined(t->op[i], p->u[t->a[i]], p->u[b]))
      program_step(t->op[i], p->u[t->dst[i]], p->u[t->a[i]], p->u[b], (int32_t)t->b[i]);
    else
      mpfr_set_nan(p->u[t->dst[i]]);
  }
}

/* lo <= v <= hi, but for the error of the judge */
static inline bool program_encloses(double lo, double hi, mpfr_t v) {
  mpfr_t d, room;
  mpfr_init2(d, PROGRAM_BITS), mpfr_init2(room, PROGRAM_BITS);
  mpfr_abs(room, v, MPFR_RNDU);
  mpfr_mul_2si(room, room, -80, MPFR_RNDU);
  mpfr_add_d(room, room, 0x1p-200, MPFR_RNDU);
  bool good = !isnan(lo) && !isnan(hi);
  mpfr_d_sub(d, lo, v, MPFR_RNDN);
  good = good && mpfr_cmp(d, room) <= 0;
  mpfr_sub_d(d, v, hi, MPFR_RNDN);
  good = good && mpfr_cmp(d, room) <= 0;
  mpfr_clear(d), mpfr_clear(room);
  return good;
}
#endif
