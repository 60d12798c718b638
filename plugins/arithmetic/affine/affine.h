/* affine.h -- what the files of the affine plugin share.
**
** An element holds an interval and an affine form [Stolfi & de Figueiredo, TEMA 4(3), 2003]:
**
**   value in [-nlo, hi]   and   value = centre + sum_i coef[i] e_i + err e,   e_i and e in [-1, 1],
**
** where e_0 .. e_(nvar - 1) are the independent variables, the following e_i are symbols that operations made for
** their own errors, each shared by all elements that carry it, and e is nobody else's. Coefficients come in blocks of
** 8; the first `vblocks` blocks belong to the variables. Symbols of another epoch than the context's are nobody
** else's either: before such an element meets others they are folded into err.
**
** An element without a form (rad infinite) is empty (nlo = hi = -inf), unbounded, or wider than any double. Zero bytes
** are the number 0. All functions below but set and bounds need upward mode.
*/
#ifndef AFFINE_H
#define AFFINE_H
#include <ambit/arithmetic.h>
#include <ambit/meter.h>
#include <ambit/num.h>
#include <ambit/rounding.h>
#include <math.h>

#define AFFINE_BLOCK 8   /* coefficients */
#define AFFINE_SCRATCH 8 /* 0, 1: operands made fit; the others: steps of an operation */

typedef struct affine_element {
  double nlo, hi;              /* minus the lower bound, the upper bound */
  double centre, err, rad;     /* rad >= sum |coef[i]| + err */
  uint64_t epoch, blocks, pad; /* blocks of coefficients in use; those behind are not written */
  double coef[];
} affine_element;

typedef struct affine_context affine_context;

/* sums over coefficients, rounded upward: of the rounding errors, of the magnitudes of the results */
typedef struct affine_sums {
  double gap, size;
} affine_sums;

/* What is compiled once per instruction set (kernels.h). Operands are of this epoch and have forms, r is none of them;
** operations return an outcome. nx, ny count blocks; r has the more. */
typedef struct affine_kernels {
  /* r := x y; x + y, or x - y if negate */
  uint32_t (*multiply)(
      const affine_context *c, affine_element *r, const affine_element *x, const affine_element *y, int64_t symbol);
  uint32_t (*add)(const affine_context *c, affine_element *r, const affine_element *x, const affine_element *y,
      int negate, int64_t symbol);
  /* r := slope x + [glo, ghi], within the bounds that r already has */
  uint32_t (*apply)(const affine_context *c, affine_element *r, const affine_element *x, double slope, double glo,
      double ghi, int64_t symbol);
  /* r := p x + q y; r := p x */
  void (*combine)(
      double *r, double p, const double *x, size_t nx, double q, const double *y, size_t ny, affine_sums *s);
  void (*scale)(double *r, double p, const double *x, size_t nx, affine_sums *s);
  double (*size)(const double *x, size_t nx); /* sum |x_i| */
  /* sum over i < j of |x_i y_j + x_j y_i|, up to the rounding of each term */
  double (*pairs)(const double *x, const double *y, size_t n);
} affine_kernels;

/* the whole plugin with each of them */
extern const ambit_arithmetic affine_portable;
#if defined(__x86_64__)
extern const ambit_arithmetic affine_avx2, affine_avx512;
#endif

/* what a tape says about its slots; kept from one tape to the next for its memory */
typedef struct affine_plan {
  uint32_t room;
  uint8_t *uses;  /* [room] as an operand or output: 0, 1, 2 = more */
  uint32_t *last; /* [room] the last instruction that uses it; outputs: one behind the last of all */
  uint32_t *live; /* [room] a list of slots */
} affine_plan;

struct affine_context {
  const ambit_num_service *num;
  const ambit_meter_service *meter; /* NULL: not profiled */
  const affine_kernels *kernels;
  const ambit_run_fn *run; /* [AMBIT_OP_COUNT] */
  uint32_t nvar, symbols;  /* independent variables; symbols for errors */
  uint32_t next;           /* first symbol that is free in this epoch */
  int tight, min_range;    /* options product, linearisation */
  uint64_t epoch, vblocks;
  size_t elem;
  affine_plan plan;
  int planned;    /* plan holds for the slots being computed */
  double *weight; /* [2 * symbols] and */
  uint32_t *rank; /* [symbols], for condense.c */
  affine_element *scratch[AFFINE_SCRATCH];
  ambit_rounding outside; /* environment to restore on leave */
};

static inline double larger(double a, double b) { return a > b ? a : b; }
static inline double smaller(double a, double b) { return a < b ? a : b; }

/* a hull that says nothing yet */
static inline affine_element *affine_unbounded(affine_element *r) {
  r->nlo = r->hi = INFINITY;
  return r;
}

/* a point of the hull */
static inline double affine_middle(const affine_element *x) {
  return smaller(larger(0.5 * x->hi - 0.5 * x->nlo, -x->nlo), x->hi);
}

#define AFFINE_NO_SYMBOL (-1)
#define AFFINE_TAKEN 0x80000000u /* among flags: the symbol was used */
#define AFFINE_MATTERS 0x1p-30   /* an err below this part of rad gets no symbol of its own */

/* context.c; contracts in arithmetic.h */
extern const ambit_param affine_params[];
ambit_status affine_open(const ambit_host *h, const double *option, uint32_t nvar, const affine_kernels *kernels,
    const ambit_run_fn *run, void **ctx);
void affine_close(void *ctx);
size_t affine_elem(void *ctx);
void affine_enter(void *ctx);
void affine_leave(void *ctx);
void affine_set(void *ctx, void *dst, size_t n, const double *lo, const double *hi, int32_t var);
void affine_bounds(void *ctx, const void *src, size_t n, double *lo, double *hi);

/* element.c */
static inline affine_element *affine_at(const affine_context *c, void *base, size_t index) {
  return (affine_element *)(void *)((char *)base + index * c->elem);
}
static inline int affine_has_form(const affine_element *x) { return x->rad < INFINITY; }
static inline int affine_is_empty(const affine_element *x) { return x->hi == -INFINITY; }

/* the interval [-nlo, hi], whichever; its form has no coefficients */
void affine_of_hull(affine_element *r, double nlo, double hi);
/* x with the symbols of its coefficient blocks folded into err, from block `first` on */
void affine_fold(const affine_context *c, affine_element *r, const affine_element *x, uint64_t first);
const affine_element *affine_refresh(const affine_context *c, const affine_element *x, int place);
/* x as an operand of this epoch; place: 0 or 1, where to put a changed copy */
static inline const affine_element *affine_operand(const affine_context *c, const affine_element *x, int place) {
  int stale = x->blocks > c->vblocks && x->epoch != c->epoch;
  return stale ? affine_refresh(c, x, place) : x;
}
/* Completes r from nlo, hi, centre, blocks and coefficients: `size` bounds their magnitudes, err everything else; a
** number of a symbol: err becomes that symbol if it matters. Returns an outcome: flags, AFFINE_TAKEN if it does. */
uint32_t affine_finish(const affine_context *c, affine_element *r, double size, double err, int64_t symbol);
/* r := [-nlo, hi] without coefficients, but perhaps with that symbol; returns an outcome */
uint32_t affine_constant(const affine_context *c, affine_element *r, double nlo, double hi, int64_t symbol);
/* flags of a result's hull */
static inline uint32_t affine_flags(const affine_element *r) {
  if (r->hi == -INFINITY) return AMBIT_F_EMPTY;
  return r->nlo == INFINITY || r->hi == INFINITY ? AMBIT_F_UNBOUNDED : 0;
}
/* number of the symbol for the errors of slot dst, or AFFINE_NO_SYMBOL */
static inline int64_t affine_symbol(const affine_context *c, uint32_t dst) {
  int free = c->next < c->symbols && (!c->planned || c->plan.uses[dst] > 1);
  return free ? (int64_t)c->next : AFFINE_NO_SYMBOL;
}
/* result from the interval functions alone; flags */
uint32_t affine_by_hull(const affine_context *c, uint32_t op, affine_element *r, const affine_element *x,
    const affine_element *y, int32_t exponent);

/* r := p x + q y within the bounds that r already has; returns an outcome */
uint32_t affine_combine(const affine_context *c, affine_element *r, double p, const affine_element *x, double q,
    const affine_element *y, int64_t symbol);
/* product.c: a bound of the quadratic part of x y, at most `radius`, pair by pair; `squares` bounds the terms with
** e_i^2, xy the product of the radii */
double affine_pairwise(const affine_context *c, const affine_element *x, const affine_element *y, double xy,
    double squares, double radius);

/* An operation on two operands of this epoch that have forms; returns an outcome. */
typedef uint32_t (*affine_operation)(
    const affine_context *c, affine_element *r, const affine_element *x, const affine_element *y, int64_t symbol);

/* A run of it; where an operand has no form, of `op` on hulls. Returns flags. Inlined with its operation. */
static inline __attribute__((always_inline)) uint32_t affine_run(affine_context *c, uint32_t op,
    affine_operation operation, char *base, size_t pitch, size_t lanes, size_t count, const uint32_t *dst,
    const uint32_t *a, const uint32_t *b) {
  size_t elem = c->elem, stride = pitch * elem;
  uint32_t flags = 0;
  for (size_t i = 0; i < count; i++) {
    int64_t symbol = affine_symbol(c, dst[i]);
    uint32_t outcome = 0;
    for (size_t l = 0; l < lanes * elem; l += elem) {
      affine_element *r = (void *)(base + dst[i] * stride + l);
      const affine_element *x = affine_operand(c, (void *)(base + a[i] * stride + l), 0);
      const affine_element *y = affine_operand(c, (void *)(base + b[i] * stride + l), 1);
      int forms = affine_has_form(x) && affine_has_form(y);
      outcome |= forms ? operation(c, r, x, y, symbol) : affine_by_hull(c, op, r, x, y, 0);
    }
    c->next += (outcome & AFFINE_TAKEN) != 0;
    flags |= outcome & ~AFFINE_TAKEN;
  }
  return flags;
}

/* the run function of an opcode; other: a when unary */
#define AFFINE_RUN(name, OP, operation, other)                                                                         \
  uint32_t name(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes, size_t count,         \
      const uint32_t *dst, const uint32_t *a, const uint32_t *b) {                                                     \
    (void)self, (void)b;                                                                                               \
    return affine_run(ctx, AMBIT_OP_##OP, operation, base, pitch, lanes, count, dst, a, other);                        \
  }

#define AFFINE_RUNS(X)                                                                                                 \
  X(NEG)                                                                                                               \
  X(SQR)                                                                                                               \
  X(POWN)                                                                                                              \
  X(DIV)                                                                                                               \
  X(SQRT)                                                                                                              \
  X(EXP) X(LOG) X(SIN) X(COS) X(TAN) X(ASIN) X(ACOS) X(ATAN) X(ATAN2) X(SINH) X(COSH) X(TANH) X(ABS) X(MIN) X(MAX)
#define AFFINE_DECLARE(OP)                                                                                             \
  uint32_t affine_run_##OP(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,            \
      size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b);
AFFINE_RUNS(AFFINE_DECLARE)
#undef AFFINE_DECLARE
uint32_t affine_run_function(const ambit_arithmetic *self, void *ctx, uint32_t op, void *base, size_t pitch,
    size_t lanes, size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b);

/* tape.c */
uint32_t affine_eval_tape(void *ctx, const ambit_tape *t, void *base, size_t pitch, size_t lanes);
void affine_close_plan(affine_plan *p);

/* condense.c: leaves at most `keep` symbols, over the first nlive slots of plan.live; a new epoch begins, so elements
** anywhere else lose theirs when they meet a new one */
void affine_condense(affine_context *c, void *base, size_t pitch, size_t lanes, uint32_t nlive, uint32_t keep);
#endif
