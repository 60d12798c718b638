/* affine_truth.h -- affine forms against MPFR: random programs, their exact values at points of the box, and whether
** the forms allow them.
**
** A form promises more than bounds: for every point of the box there are values of the error symbols in [-1, 1],
** the same for all slots, with which centre + linear part is within err of the true value, in every slot at once.
*/
#ifndef AMBIT_AFFINE_TRUTH_H
#define AMBIT_AFFINE_TRUTH_H
#include "arithmetic/affine/affine.h"
#include "arithmetic_case.h"
#include "kit/tape_builder.h"

enum { TRUTH_SLOTS = 96, TRUTH_BITS = 320, TRUTH_ERRORS = 512 };

typedef struct truth {
  mpfr_t value[TRUTH_SLOTS]; /* NaN: outside the domain */
  mpfr_t unit[TRUTH_SLOTS];  /* of input v: its symbol's value, in [-1, 1] */
  mpfr_t error[TRUTH_ERRORS];
  bool known[TRUTH_ERRORS]; /* has error symbol k a value? */
  mpfr_t rest, term;
} truth;

static inline void truth_open(truth *t) {
  for (int i = 0; i < TRUTH_SLOTS; i++) mpfr_init2(t->value[i], TRUTH_BITS), mpfr_init2(t->unit[i], TRUTH_BITS);
  for (int i = 0; i < TRUTH_ERRORS; i++) mpfr_init2(t->error[i], TRUTH_BITS);
  mpfr_init2(t->rest, TRUTH_BITS), mpfr_init2(t->term, TRUTH_BITS);
}

static inline void truth_close(truth *t) {
  for (int i = 0; i < TRUTH_SLOTS; i++) mpfr_clear(t->value[i]), mpfr_clear(t->unit[i]);
  for (int i = 0; i < TRUTH_ERRORS; i++) mpfr_clear(t->error[i]);
  mpfr_clear(t->rest), mpfr_clear(t->term);
}

static inline void truth_apply(uint32_t op, mpfr_ptr r, mpfr_srcptr a, mpfr_srcptr b, int32_t n) {
  mpfr_rnd_t d = MPFR_RNDN;
  switch (op) {
  case AMBIT_OP_ADD: mpfr_add(r, a, b, d); break;
  case AMBIT_OP_SUB: mpfr_sub(r, a, b, d); break;
  case AMBIT_OP_NEG: mpfr_neg(r, a, d); break;
  case AMBIT_OP_MUL: mpfr_mul(r, a, b, d); break;
  case AMBIT_OP_SQR: mpfr_sqr(r, a, d); break;
  case AMBIT_OP_POWN:
    if (mpfr_zero_p(a) && n < 0)
      mpfr_set_nan(r);
    else
      mpfr_pow_si(r, a, n, d);
    break;
  case AMBIT_OP_DIV:
    if (mpfr_zero_p(b))
      mpfr_set_nan(r);
    else
      mpfr_div(r, a, b, d);
    break;
  case AMBIT_OP_SQRT: mpfr_sqrt(r, a, d); break;
  case AMBIT_OP_EXP: mpfr_exp(r, a, d); break;
  case AMBIT_OP_LOG:
    if (mpfr_sgn(a) <= 0)
      mpfr_set_nan(r);
    else
      mpfr_log(r, a, d);
    break;
  case AMBIT_OP_SIN: mpfr_sin(r, a, d); break;
  case AMBIT_OP_COS: mpfr_cos(r, a, d); break;
  case AMBIT_OP_TAN: mpfr_tan(r, a, d); break;
  case AMBIT_OP_ASIN: mpfr_asin(r, a, d); break;
  case AMBIT_OP_ACOS: mpfr_acos(r, a, d); break;
  case AMBIT_OP_ATAN: mpfr_atan(r, a, d); break;
  case AMBIT_OP_ATAN2:
    if (mpfr_zero_p(a) && mpfr_zero_p(b))
      mpfr_set_nan(r);
    else if (mpfr_zero_p(a) && mpfr_sgn(b) < 0)
      mpfr_const_pi(r, d); /* whatever the sign of zero */
    else
      mpfr_atan2(r, a, b, d);
    break;
  case AMBIT_OP_SINH: mpfr_sinh(r, a, d); break;
  case AMBIT_OP_COSH: mpfr_cosh(r, a, d); break;
  case AMBIT_OP_TANH: mpfr_tanh(r, a, d); break;
  case AMBIT_OP_ABS: mpfr_abs(r, a, d); break;
  case AMBIT_OP_MIN: mpfr_min(r, a, b, d); break;
  case AMBIT_OP_MAX: mpfr_max(r, a, b, d); break;
  default: mpfr_set_nan(r); break;
  }
  if (mpfr_nan_p(a) || (op != AMBIT_OP_POWN && mpfr_nan_p(b))) mpfr_set_nan(r); /* MIN and MAX ignore one */
}

/* -- a program and a context */

typedef struct program {
  tape_builder builder;
  const ambit_tape *tape;
  double lo[TRUTH_SLOTS], hi[TRUTH_SLOTS]; /* of constants and inputs */
} program;

typedef struct stage {
  arithmetic_loader *l;
  void *ctx;
  char *base;
  size_t elem;
  uint32_t nvar;
} stage;

static inline affine_element *stage_at(const stage *s, uint32_t slot) {
  return (affine_element *)(void *)(s->base + slot * s->elem);
}

/* option: symbols, product, linearisation; NULL: the defaults */
static inline stage stage_open(arithmetic_loader *l, uint32_t nvar, const double *option) {
  stage s = { .l = l, .nvar = nvar };
  assert_int_equal(l->full.open(&l->scope->host, option, nvar, &s.ctx), AMBIT_OK);
  s.elem = l->full.elem(s.ctx);
  s.base = calloc(TRUTH_SLOTS, s.elem);
  return s;
}

static inline void stage_close(stage *s) {
  if (s->l->full.close) s->l->full.close(s->ctx);
  free(s->base);
}

static inline void stage_set(const stage *s, uint32_t slot, double lo, double hi, int32_t var) {
  s->l->full.set(s->ctx, stage_at(s, slot), 1, &lo, &hi, var);
}

static inline void stage_inputs(const stage *s, const program *p) {
  const ambit_tape *t = &p->builder.tape;
  for (uint32_t i = 0; i < t->nconst; i++) stage_set(s, i, p->lo[i], p->hi[i], -1);
  for (uint32_t i = 0; i < t->nin; i++)
    stage_set(s, t->nconst + i, p->lo[t->nconst + i], p->hi[t->nconst + i], (int32_t)i);
}

static inline uint32_t stage_run(const stage *s, uint32_t op, uint32_t dst, uint32_t a, uint32_t b) {
  const ambit_arithmetic *full = &s->l->full;
  full->enter(s->ctx);
  uint32_t flags = full->run[op](full, s->ctx, s->base, 1, 1, 1, &dst, &a, &b);
  full->leave(s->ctx);
  return flags;
}

static inline ambit_interval stage_bounds(const stage *s, uint32_t slot) {
  ambit_interval x;
  s->l->full.bounds(s->ctx, stage_at(s, slot), 1, &x.lo, &x.hi);
  return x;
}

/* -- random programs; each instruction is tried on the stage and taken if its result is of use */

static inline double random_width(uint64_t *r) {
  return oracle_random(r) % 8 == 0 ? 0 : ldexp(oracle_uniform(r, 0.5, 1), -(int)(oracle_random(r) % 30));
}

static inline void program_inputs(program *p, uint32_t nvar, uint64_t *r) {
  tape_begin(&p->builder);
  p->lo[0] = 0x1.999999999999ap-4, p->hi[0] = nextafter(p->lo[0], 1); /* not points: 0.1, and something wide */
  p->lo[1] = 2, p->hi[1] = 2;
  p->lo[2] = -0.5, p->hi[2] = -0.375;
  for (uint32_t i = 0; i < 3; i++) tape_constant(&p->builder, p->lo[i], p->hi[i]);
  for (uint32_t v = 0; v < nvar; v++) {
    uint32_t slot = tape_input(&p->builder, 0);
    double centre = oracle_uniform(r, -3, 3), width = random_width(r);
    p->lo[slot] = centre - width, p->hi[slot] = centre + width;
  }
}

static inline void program_build(program *p, const stage *s, uint32_t length, uint64_t *r) {
  tape_builder *t = &p->builder;
  stage_inputs(s, p);
  for (uint32_t tries = 0; t->tape.ninstr < length && tries < 20 * length; tries++) {
    uint32_t op = (uint32_t)(oracle_random(r) % AMBIT_OP_COUNT), n = t->tape.nslot;
    uint32_t a = (uint32_t)(oracle_random(r) % n), b = (uint32_t)(oracle_random(r) % n);
    int unary = op != AMBIT_OP_ADD && op != AMBIT_OP_SUB && op != AMBIT_OP_MUL && op != AMBIT_OP_DIV &&
                op != AMBIT_OP_ATAN2 && op != AMBIT_OP_MIN && op != AMBIT_OP_MAX;
    if (unary) b = a;
    uint32_t word = op == AMBIT_OP_POWN ? (uint32_t)((int32_t)(oracle_random(r) % 13) - 6) : b;
    stage_run(s, op, n, a, word);
    ambit_interval x = stage_bounds(s, n);
    if (!(x.lo >= -1e4 && x.hi <= 1e4 && x.hi - x.lo < 8)) continue;
    tape_op(t, op, a, word);
  }
  p->tape = tape_seal(t, AMBIT_NO_SLOT);
}

/* -- the true values at a point of the box */

static inline void random_unit(mpfr_ptr u, uint64_t *r) {
  uint64_t kind = oracle_random(r) % 4;
  mpfr_set_d(u, kind == 0 ? -1 : kind == 1 ? 1 : oracle_uniform(r, -1, 1), MPFR_RNDN);
}

/* a point within [lo, hi] */
static inline void place_between(mpfr_ptr x, double lo, double hi, mpfr_srcptr unit) {
  mpfr_t half;
  mpfr_init2(half, TRUTH_BITS);
  mpfr_set_d(half, hi, MPFR_RNDN), mpfr_sub_d(half, half, lo, MPFR_RNDN), mpfr_div_2ui(half, half, 1, MPFR_RNDN);
  mpfr_mul(x, half, unit, MPFR_RNDN), mpfr_add(x, x, half, MPFR_RNDN), mpfr_add_d(x, x, lo, MPFR_RNDN);
  if (mpfr_cmp_d(x, lo) < 0) mpfr_set_d(x, lo, MPFR_RNDN); /* where these bits do not suffice */
  if (mpfr_cmp_d(x, hi) > 0) mpfr_set_d(x, hi, MPFR_RNDN);
  mpfr_clear(half);
}

static inline void truth_sample(truth *t, const program *p, const stage *s, uint64_t *r) {
  const ambit_tape *tape = p->tape;
  for (uint32_t i = 0; i < tape->nconst + tape->nin; i++) {
    random_unit(t->unit[i], r);
    place_between(t->value[i], p->lo[i], p->hi[i], t->unit[i]);
  }
  /* the symbol's value that the form of the input gives that point */
  for (uint32_t v = 0; v < tape->nin; v++) {
    const affine_element *x = stage_at(s, tape->nconst + v);
    mpfr_set_zero(t->unit[tape->nconst + v], 1);
    if (x->blocks == 0 || x->coef[v] == 0) continue;
    mpfr_sub_d(t->unit[tape->nconst + v], t->value[tape->nconst + v], x->centre, MPFR_RNDN);
    mpfr_div_d(t->unit[tape->nconst + v], t->unit[tape->nconst + v], x->coef[v], MPFR_RNDN);
  }
  for (uint32_t i = 0; i < tape->ninstr; i++)
    truth_apply(tape->op[i], t->value[tape->dst[i]], t->value[tape->a[i]],
        tape->op[i] == AMBIT_OP_POWN ? t->value[tape->a[i]] : t->value[tape->b[i]], (int32_t)tape->b[i]);
  memset(t->known, 0, sizeof t->known);
}

/* rest := value - centre - part of the data */
static inline void truth_rest(truth *t, const program *p, const affine_element *x, uint32_t slot) {
  mpfr_sub_d(t->rest, t->value[slot], x->centre, MPFR_RNDN);
  for (uint32_t v = 0; v < p->tape->nin && v < x->blocks * AFFINE_BLOCK; v++) {
    mpfr_mul_d(t->term, t->unit[p->tape->nconst + v], x->coef[v], MPFR_RNDN);
    mpfr_sub(t->rest, t->rest, t->term, MPFR_RNDN);
  }
}

/* |rest| <= bound, up to the precision of the truth for values of that size */
static inline bool truth_within(truth *t, double bound, double size) {
  mpfr_abs(t->term, t->rest, MPFR_RNDN);
  mpfr_sub_d(t->term, t->term, bound, MPFR_RNDN);
  mpfr_mul_2ui(t->term, t->term, 200, MPFR_RNDN);
  return mpfr_cmp_d(t->term, size) <= 0;
}

/* likewise: value in x */
static inline bool truth_in_hull(truth *t, ambit_interval x, uint32_t slot) {
  if (mpfr_cmp_d(t->value[slot], x.lo) < 0) {
    mpfr_set(t->rest, t->value[slot], MPFR_RNDN), mpfr_sub_d(t->rest, t->rest, x.lo, MPFR_RNDN);
    return truth_within(t, 0, fabs(x.lo));
  }
  mpfr_set(t->rest, t->value[slot], MPFR_RNDN), mpfr_sub_d(t->rest, t->rest, x.hi, MPFR_RNDN);
  return mpfr_sgn(t->rest) <= 0 || truth_within(t, 0, fabs(x.hi));
}
#endif
