/* tape.h -- a sealed straight-line program, read-only for plugins.
**
** Slots: [0, nconst) constants, [nconst, nconst + nin) inputs, then one slot per instruction in order (static single
** assignment: instruction i writes slot nconst + nin + i = dst[i]). Operands always precede.
** Instructions are grouped into runs: one opcode, independent of each other.
*/
#ifndef AMBIT_TAPE_H
#define AMBIT_TAPE_H
#include "base.h"

/* X(NAME, arity, symbol): values are ABI, append only. r := meaning; angles in rad. */
#define AMBIT_OPS(X)                                                                                                   \
  X(ADD, 2, "+")       /* r := a + b */                                                                                \
  X(SUB, 2, "-")       /* r := a - b */                                                                                \
  X(NEG, 1, "-")       /* r := -a */                                                                                   \
  X(MUL, 2, "*")       /* r := a * b */                                                                                \
  X(SQR, 1, "sqr")     /* r := a^2; its own opcode: tighter than MUL(a, a) on sets */                                  \
  X(POWN, 1, "pown")   /* r := a^n; b[i] is not a slot but the exponent n, an int32 stored as uint32 */                \
  X(DIV, 2, "/")       /* r := a / b; outside the domain where b = 0 */                                                \
  X(SQRT, 1, "sqrt")   /* r := sqrt a, a >= 0 */                                                                       \
  X(EXP, 1, "exp")     /* r := e^a */                                                                                  \
  X(LOG, 1, "log")     /* r := ln a, a > 0 */                                                                          \
  X(SIN, 1, "sin")     /* r := sin a */                                                                                \
  X(COS, 1, "cos")     /* r := cos a */                                                                                \
  X(TAN, 1, "tan")     /* r := tan a, a not an odd multiple of pi/2 */                                                 \
  X(ASIN, 1, "asin")   /* r := asin a in [-pi/2, pi/2], |a| <= 1 */                                                    \
  X(ACOS, 1, "acos")   /* r := acos a in [0, pi], |a| <= 1 */                                                          \
  X(ATAN, 1, "atan")   /* r := atan a in (-pi/2, pi/2) */                                                              \
  X(ATAN2, 2, "atan2") /* r := angle of the point (b, a) in (-pi, pi]; outside the domain at (0, 0) */                 \
  X(SINH, 1, "sinh")   /* r := sinh a */                                                                               \
  X(COSH, 1, "cosh")   /* r := cosh a */                                                                               \
  X(TANH, 1, "tanh")   /* r := tanh a */                                                                               \
  X(ABS, 1, "abs")     /* r := |a|; not smooth at 0 */                                                                 \
  X(MIN, 2, "min")     /* r := the smaller of a and b; not smooth where a = b */                                       \
  X(MAX, 2, "max")     /* r := the larger of a and b; not smooth where a = b */

/* Functions, each described in one file of framework/functions: X(NAME, arity, symbol), append only. Kernel and
** plugins take them by that description (num.h: map, taylor); no SERIES tape holds one. */
#define AMBIT_FUNCTIONS(X)                                                                                             \
  X(LOG1P, 1, log1p) /* r := ln(1 + a), a > -1 */                                                                      \
  X(EXPM1, 1, expm1) /* r := e^a - 1 */                                                                                \
  X(ASINH, 1, asinh) /* r := asinh a */                                                                                \
  X(ACOSH, 1, acosh) /* r := acosh a, a >= 1 */                                                                        \
  X(ATANH, 1, atanh) /* r := atanh a, |a| < 1 */                                                                       \
  X(LOG2, 1, log2)   /* r := logarithm of a to base 2, a > 0 */                                                        \
  X(LOG10, 1, log10) /* r := logarithm of a to base 10, a > 0 */                                                       \
  X(EXP2, 1, exp2)   /* r := 2^a */                                                                                    \
  X(CBRT, 1, cbrt)   /* r := cube root of a, negative if a is */                                                       \
  X(HYPOT, 2, hypot) /* r := sqrt(a^2 + b^2) */                                                                        \
  X(POW, 2, pow)     /* r := a^b, a > 0 */

enum {
#define AMBIT_X(name, arity, symbol) AMBIT_OP_##name,
  AMBIT_OPS(AMBIT_X)
#undef AMBIT_X
      AMBIT_OP_COUNT, /* behind the operations; the functions start at 32 */
  AMBIT_OP_BEFORE_FUNCTIONS = 31,
#define AMBIT_X(name, arity, symbol) AMBIT_OP_##name,
  AMBIT_FUNCTIONS(AMBIT_X)
#undef AMBIT_X
      AMBIT_OP_END
};
#define AMBIT_OP_FUNCTIONS (AMBIT_OP_BEFORE_FUNCTIONS + 1)

static inline int32_t ambit_op_is_function(uint32_t op) { return op >= AMBIT_OP_FUNCTIONS && op < AMBIT_OP_END; }

/* How many operands it has; POWN, whose exponent is none: 1. */
static inline uint32_t ambit_op_arity(uint32_t op) {
  switch (op) {
#define AMBIT_X(name, arity, symbol)                                                                                   \
  case AMBIT_OP_##name: return arity;
    AMBIT_OPS(AMBIT_X)
    AMBIT_FUNCTIONS(AMBIT_X)
#undef AMBIT_X
  default: return 0;
  }
}

#define AMBIT_NO_SLOT UINT32_MAX
#define AMBIT_DEGREE_ANY UINT32_MAX

/* A run: instructions [first, first + count), all of opcode op. */
typedef struct ambit_run {
  uint32_t op, first, count, pad;
} ambit_run;

/* Tape flags. A SERIES tape can be run on truncated power series: it holds only ADD SUB NEG MUL SQR DIV SQRT EXP LOG
** SIN COS ATAN ATAN2 SINH COSH TANH ABS MIN MAX (TAN, ASIN, ACOS, POWN and functions are written with these), and aux
** is set:
**   SIN, COS: slot of the cosine, sine of the same operand;  SINH, COSH: likewise;
**   TANH: slot of 1 - dst^2;  ATAN: slot of 1 + a^2;  ATAN2: slot of a^2 + b^2;  all others: AMBIT_NO_SLOT.
** An aux slot may lie behind its user; order by order both are defined. */
#define AMBIT_TAPE_SERIES 1u

typedef struct ambit_tape {
  uint32_t size, flags;
  uint32_t nslot, nconst, nin, nout, ninstr, nrun;
  const uint32_t *op;          /* [ninstr] opcode of each instruction */
  const uint32_t *dst, *a, *b; /* [ninstr] slots; b == a when unary (POWN: the exponent) */
  const uint32_t *aux;         /* [ninstr] see AMBIT_TAPE_SERIES, else AMBIT_NO_SLOT */
  const ambit_run *run;        /* [nrun] */
  const double *lo, *hi;       /* [nconst] tightest known enclosure of each constant */
  /* [nconst] what the constant is ("0.1", "1/3", "pi") for arithmetics of higher precision; NULL: the enclosure
  ** is all that is known */
  const char *const *text;
  const uint32_t *out; /* [nout] slots of the outputs */
  /* [nslot] degree as a polynomial in time when every state is a general function of time: 0 = constant,
  ** AMBIT_DEGREE_ANY */
  const uint32_t *degree;
  /* [nslot] bounds that hold for every real input (cos: [-1, 1]), an unknown datum being in its set; may be
  ** infinite */
  const double *range_lo, *range_hi;
  /* [ninstr] what an ABS, MIN or MAX is, for messages: "abs(v) of joint_friction `knee`"; NULL elsewhere */
  const char *const *kink;
} ambit_tape;
#endif
