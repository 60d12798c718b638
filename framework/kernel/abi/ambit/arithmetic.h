/* arithmetic.h -- "ambit.arithmetic/1": a way to compute with sets of reals.
**
** An element is elem(ctx) bytes, opaque to everybody else. Element (slot s, lane l) of a block lies at base + (s *
** pitch + l) * elem, with pitch >= lanes. Lanes are independent problems (boxes of a subdivision, samples).
**
** TIER 1 is enough: `elem`, `set` and `bounds` alone give every operation, because the kernel fills each NULL run[]
** with "hull the operands, apply the kernel's interval function, set", which is valid for any rigorous arithmetic,
** only loose. TIER 2 is speed only and obeys the same contract: the result encloses the exact image of the operands.
*/
#ifndef AMBIT_ARITHMETIC_H
#define AMBIT_ARITHMETIC_H
#include "tape.h"

#define AMBIT_ARITHMETIC "ambit.arithmetic/1"

/* Flags, OR-ed over all lanes of a call; the elements themselves stay valid supersets. */
#define AMBIT_F_PARTIAL 1u   /* some operand left the domain: the result holds for the part inside */
#define AMBIT_F_EMPTY 2u     /* some lane is proven empty */
#define AMBIT_F_UNBOUNDED 4u /* some lane is not bounded */

typedef struct ambit_arithmetic ambit_arithmetic; /* `self` below is the kernel's completed copy */
/* [ctx] dst, a, b are slot numbers (b of POWN: exponent); a dst slot never is an operand of the same call */
typedef uint32_t (*ambit_run_fn)(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,
    size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b);

/* [ctx] The same for one of AMBIT_FUNCTIONS, whose opcode it is told; b == a when unary. */
typedef uint32_t (*ambit_function_fn)(const ambit_arithmetic *self, void *ctx, uint32_t op, void *base, size_t pitch,
    size_t lanes, size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b);

/* Taylor coefficients of every slot of a SERIES tape in the arithmetic's own layout (tier 2; the kernel has a general
** form for arithmetics that offer none). Value coefficients u_k are given as midpoint +- radius. With ndir > 0 each
** slot also carries, for each direction j, a coefficient of the slope s_j: for all x in the box and the centre c,
** u(x) - u(c) = sum_j s_j (x_j - c_j) as power series in time. c need not be a point of the box. */
typedef struct ambit_jets {
  uint32_t size;
  /* [ctx] Orders 0..order. With ndir > 0, `centre` is another object of this kind, on the same tape, that holds the
  ** series at the centre point whenever advance() is called: then slopes over the box are computed (half the radius
  ** of derivatives); centre NULL: derivatives over the box. */
  ambit_status (*open)(const ambit_host *h, void *ctx, const ambit_tape *t, uint32_t order, uint32_t ndir,
      const void *centre, void **self);
  void (*close)(void *self);
  /* coefficient k of input `in`; dmid, drad [ndir] (NULL: zero) */
  void (*put)(void *self, uint32_t in, uint32_t k, double mid, double rad, const double *dmid, const double *drad);
  /* computes order k of every slot, from orders <= k of the inputs; orders ascend from 0. Returns AMBIT_F_*; PARTIAL
  ** or UNBOUNDED: the coefficients prove nothing */
  uint32_t (*advance)(void *self, uint32_t k);
  /* coefficient k of a slot, +- radius; dmid, drad [ndir]: each may be NULL, mid and rad may not */
  void (*get)(const void *self, uint32_t slot, uint32_t k, double *mid, double *rad, double *dmid, double *drad);
  /* upper bounds: mag[k] >= |u_k|, dmag[k*ndir + j] >= |s_j,k|, k < n; dmag may be NULL */
  void (*magnitude)(const void *self, uint32_t slot, uint32_t n, double *mag, double *dmag);
  /* coefficient k + 1 of input `in` := coefficient k of `slot` / (k + 1), slopes too; NULL: the kernel does it with
  ** get and put, which loses what an arithmetic knows besides midpoint and radius */
  void (*integrate)(void *self, uint32_t in, uint32_t slot, uint32_t k);
} ambit_jets;

/* What a rigorous arithmetic gave that no enclosure can be; the first of all that was. */
typedef struct ambit_fault {
  int32_t seen; /* 0: nothing */
  int32_t what; /* AMBIT_FAULT_* */
  double lo, hi;
} ambit_fault;
#define AMBIT_FAULT_BOUNDS 0     /* NaN, or lo > hi and not empty */
#define AMBIT_FAULT_EMPTY 1      /* empty, although nothing left its domain */
#define AMBIT_FAULT_DERIVATIVE 2 /* as BOUNDS, of gradient() */
#define AMBIT_FAULT_SERIES 3     /* a coefficient with a negative radius: lo +- hi */

struct ambit_arithmetic {
  uint32_t size;
  uint32_t rigorous;        /* 1: every result encloses the exact image */
  const ambit_param *param; /* options (degree, symbols); an entry with NULL name ends; NULL = none */

  /* -- life: [ctx], one context per thread; NULL open and close = stateless, ctx is NULL */
  ambit_status (*open)(const ambit_host *h, const double *option, uint32_t nvar, void **ctx);
  void (*close)(void *ctx);
  size_t (*elem)(void *ctx);                             /* bytes per element, a multiple of 8 */
  ambit_status (*init)(void *ctx, void *base, size_t n); /* NULL: zero bytes are a valid element */
  void (*clear)(void *ctx, void *base, size_t n);        /* NULL: nothing owned */
  void (*enter)(void *ctx); /* e.g. set the rounding mode; brackets a batch of run[] calls */
  void (*leave)(void *ctx);

  /* -- TIER 1 (required: elem, set, bounds); both work inside and outside enter/leave */
  /* dst[i] := [lo[i], hi[i]]; var >= 0: the independent variable of that number, var < nvar */
  void (*set)(void *ctx, void *dst, size_t n, const double *lo, const double *hi, int32_t var);
  void (*bounds)(void *ctx, const void *src, size_t n, double *lo, double *hi); /* outward */
  ambit_run_fn run[32];                                                         /* by opcode; NULL = kernel default */

  /* -- TIER 2 (optional) */
  /* dst[l] := sum_{j<m} a[j*sa + l] * b[j*sb + l], the Taylor product; strides in elements */
  uint32_t (*dot)(
      void *ctx, void *dst, const void *a, ptrdiff_t sa, const void *b, ptrdiff_t sb, size_t m, size_t lanes);
  uint32_t (*eval_tape)(void *ctx, const ambit_tape *t, void *base, size_t pitch, size_t lanes);
  const ambit_jets *jets;
  /* element from a constant's text, tighter than its enclosure; returns 0 if it has no better than set() */
  int32_t (*set_text)(void *ctx, void *dst, const char *text);
  /* [lo[j], hi[j]], j < nvar, encloses the partial derivative of *src by variable j over the whole box (a generalised
  ** one where the function has a kink, so that a mean value theorem holds); returns 0 if it knows none: then a path to
  ** *src left the domain or is not continuous */
  int32_t (*gradient)(void *ctx, const void *src, double *lo, double *hi);
  /* the kernel's: where it notes what a rigorous arithmetic gave that is no enclosure; a plugin leaves it NULL */
  ambit_fault *fault;
  /* AMBIT_FUNCTIONS of one operand, of two; by what the service "ambit.num/1" says of any of them (map, taylor,
  ** facts). NULL: the tapes that this arithmetic gets have them written in other operations. */
  ambit_function_fn function, pair;
};

/* [ctx] One run of a tape, in a completed arithmetic. */
static inline uint32_t ambit_arithmetic_run(const ambit_arithmetic *a, void *ctx, uint32_t op, void *base, size_t pitch,
    size_t lanes, size_t count, const uint32_t *dst, const uint32_t *first, const uint32_t *second) {
  if (op < AMBIT_OP_COUNT) return a->run[op](a, ctx, base, pitch, lanes, count, dst, first, second);
  ambit_function_fn f = ambit_op_arity(op) == 2 ? a->pair : a->function;
  return f(a, ctx, op, base, pitch, lanes, count, dst, first, second);
}

/* [any] Notes a fault of a rigorous arithmetic; nothing that was computed with it is believed then. */
static inline void ambit_fault_note(const ambit_arithmetic *a, int32_t what, double lo, double hi) {
  if (!a->rigorous || !a->fault || __atomic_exchange_n(&a->fault->seen, 1, __ATOMIC_RELAXED)) return;
  a->fault->what = what, a->fault->lo = lo, a->fault->hi = hi;
}

/* [any] Bounds as an arithmetic gave them -> bounds that mean something: NaN, reversed ones and points at infinity
** bound nothing. NaN and reversed ones of a rigorous arithmetic are a fault; the empty set is +inf, -inf. Those of an
** arithmetic that is not rigorous may cross by rounding, and stay. */
static inline void ambit_bounds_check(const ambit_arithmetic *a, double *lo, double *hi) {
  const double infinity = __builtin_inf();
  if (*lo <= *hi && *lo != infinity && *hi != -infinity) return;
  if (*lo == infinity && *hi == -infinity) return;
  if (!a->rigorous && *lo > *hi) return;
  if (!(*lo <= *hi)) ambit_fault_note(a, AMBIT_FAULT_BOUNDS, *lo, *hi);
  *lo = -infinity, *hi = infinity;
}

/* [ctx] The bounds of n elements from src on, looked at one by one: how everybody but the arithmetic itself reads
** them. */
static inline void ambit_bounds_read(
    const ambit_arithmetic *a, void *ctx, const void *src, size_t n, double *lo, double *hi) {
  a->bounds(ctx, src, n, lo, hi);
  for (size_t i = 0; i < n; i++) ambit_bounds_check(a, &lo[i], &hi[i]);
}

/* [any] The bounds of a result behind ambit_bounds_check: the empty set is a fault where neither an operation left its
** domain (`flags` of all that led to it: AMBIT_F_PARTIAL) nor anything empty went in. */
static inline void ambit_empty_check(
    const ambit_arithmetic *a, uint32_t flags, int32_t given_empty, double lo, double hi) {
  if (lo > hi && a->rigorous && !given_empty && !(flags & AMBIT_F_PARTIAL))
    ambit_fault_note(a, AMBIT_FAULT_EMPTY, lo, hi);
}
#endif
