/* num.h -- service "ambit.num/1": the kernel's interval functions, lent to plugins.
**
** All functions: [any], in any rounding mode, which they leave as they found it. An interval is a pair of doubles
** (lo, hi) as in base.h; results are enclosures of the exact image and never NaN. FLAGS are AMBIT_F_* of arithmetic.h.
*/
#ifndef AMBIT_NUM_H
#define AMBIT_NUM_H
#include "tape.h"

#define AMBIT_NUM_SERVICE "ambit.num/1"

/* What is known of one of AMBIT_FUNCTIONS. With one operand it increases on its domain. With two it is monotone in each
** of them on either side of 0; its domain is that of the first, and shape, odd and touch are of no account. */
typedef struct ambit_function_facts {
  uint32_t size;
  int32_t shape;             /* AMBIT_CONVEX, ... */
  double least, most;        /* the ends of its domain, maybe infinite */
  int32_t open;              /* 1: they are outside */
  int32_t odd;               /* 1: f(-x) = -f(x) */
  double (*touch)(double s); /* about an x >= 0 (CONVEX, CONCAVE: x) with f'(x) = s; anything if there is none */
} ambit_function_facts;
/* everywhere convex, everywhere concave; convex where x > 0 and concave where x < 0, the other way round */
enum { AMBIT_CONVEX, AMBIT_CONCAVE, AMBIT_CONVEX_RIGHT, AMBIT_CONCAVE_RIGHT };

typedef struct ambit_num_service {
  uint32_t size;
  /* n intervals, 2 n doubles each: r[i] := op(a[i], b[i]) for every AMBIT_OP_*, functions too; b may be NULL when
  ** unary; POWN: a[i]^exponent. r may be a or b. + - * / sqr sqrt abs min max are the tightest doubles, the rest at
  ** most 1 ulp wider on each side. Returns flags. */
  uint32_t (*map)(uint32_t op, size_t n, double *r, const double *a, const double *b, int32_t exponent);
  /* [rlo[i], rhi[i]] := op([alo[i], ahi[i]]) for op in EXP .. TANH (ATAN2: b too), bounds in arrays of their own.
  ** Parts outside the domain are dropped without a flag. r must not be a or b. */
  void (*elementary)(uint32_t op, size_t n, const double *alo, const double *ahi, const double *blo, const double *bhi,
      double *rlo, double *rhi);
  /* [*lo, *hi] := a^n. Returns flags. */
  uint32_t (*pown)(double *lo, double *hi, double alo, double ahi, int32_t n);
  /* The tightest interval that holds what an IEEE 1788 literal says ("0.1", "[1/3, 2]", "3.56?2"). INVALID: `message`
  ** (room bytes) tells why. */
  ambit_status (*read)(const char *text, double *lo, double *hi, char *message, size_t room);
  /* The shortest text that reads back as x, terminated; returns its length. 64 bytes always suffice; 0 if `room` does
  ** not. */
  size_t (*shortest)(char *out, size_t room, double x);
  /* Truncated product of power series: r_k := sum_{j <= k} a_j b_(k-j), k < n, all terms of one sum being independent
  ** elements; bounds in arrays of their own, [n]. r must not overlap a or b. In midpoint-radius form: as tight as
  ** interval operations if the operands are thin, at most 1.5 times as wide if not (docs/numerics/interval.md).
  ** Unbounded operands are allowed; a sum with an empty term is empty. Returns flags EMPTY, UNBOUNDED. */
  uint32_t (*convolve)(
      size_t n, double *rlo, double *rhi, const double *alo, const double *ahi, const double *blo, const double *bhi);
  /* Matrix product r := a b; a is rows x inner, b is inner x cols, r is rows x cols, all by rows. As convolve. */
  uint32_t (*matmul)(size_t rows, size_t inner, size_t cols, double *rlo, double *rhi, const double *alo,
      const double *ahi, const double *blo, const double *bhi);
  /* Taylor coefficients of one of AMBIT_FUNCTIONS with one operand: [c[2 k], c[2 k + 1]] holds f^(k)(x) / k! for every
  ** x of [lo, hi] inside the domain, k <= n; entire where f has no derivative on a part of it. Returns flags of f. */
  uint32_t (*taylor)(uint32_t op, uint32_t n, double *c, double lo, double hi);
  const ambit_function_facts *(*facts)(uint32_t op); /* NULL: it is none of those */
} ambit_num_service;
#endif
