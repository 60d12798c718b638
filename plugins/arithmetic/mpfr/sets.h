/* sets.h -- what the files of the mpfr plugin share: closed intervals whose bounds are numbers of GNU MPFR.
**
** An element holds both bounds with their digits inside (mpfr_custom_*), so nothing is allocated per element and
** elements may be copied as bytes; a working `set` is a pair of headers on such digits. The empty set is (NaN, NaN),
** which zero bytes are, and no other set holds a NaN. Zeros are +0, so that the sign of a zero never matters.
** MPFR rounds every function correctly [Fousse et al., ACM TOMS 33(2), 2007]: a lower bound rounded down and an upper
** bound rounded up are the tightest of this precision, wherever the image's bounds are the function at known points.
*/
#ifndef MPFR_SETS_H
#define MPFR_SETS_H
#include <ambit/arithmetic.h>
#include <ambit/num.h>
#include <ambit/rounding.h>
#include <mpfr.h>

typedef struct set {
  mpfr_t lo, hi;
} set;

typedef struct half { /* a bound in an element */
  int64_t kind, exponent;
  mp_limb_t digits[];
} half;

typedef struct environment { /* what a call changes and puts back */
  mpfr_exp_t least, most;
  mpfr_flags_t flags;
  ambit_rounding rounding;
} environment;

enum { WORK = 4, FINE = 3 };

typedef struct context {
  mpfr_prec_t precision;
  size_t half; /* bytes of one bound in an element */
  const ambit_num_service *num;
  const ambit_function_facts *facts; /* of the function that runs */
  mpfr_t work[WORK];                 /* of the precision */
  mpfr_t fine[FINE];                 /* of 64 bits more */
  environment outside;
} context;

/* r := op(a, b), operands not empty, r with digits of its own. Returns AMBIT_F_PARTIAL and AMBIT_F_EMPTY; the caller
** tells what is unbounded. */
typedef uint32_t (*operation)(context *c, set *r, const set *a, const set *b, int32_t n);
typedef int (*function)(mpfr_ptr r, mpfr_srcptr x, mpfr_rnd_t rounding);

uint32_t sets_none(set *r, uint32_t flags); /* r := empty; flags | EMPTY */
void sets_entire(set *r);
void sets_hull_of(set *r, long lo, long hi);
void sets_divide_by_positive(set *r, const set *a, const set *b);

/* one for each operation: basic.c, functions.c, periodic.c */
#define SETS_DECLARE(OP, arity, symbol) uint32_t sets_##OP(context *c, set *r, const set *a, const set *b, int32_t n);
AMBIT_OPS(SETS_DECLARE)
#undef SETS_DECLARE

/* described.c: one of AMBIT_FUNCTIONS, of one operand or two; n is its opcode */
uint32_t sets_function(context *c, set *r, const set *a, const set *b, int32_t n);

/* text.c: 0 if it is no number, quotient of numbers, or "pi" */
int32_t sets_read(context *c, set *r, const char *text);
#endif
