/* function.h -- what the kernel knows of a function that is described in one place, framework/functions/NAME.c.
**
** Everything that looks at opcodes takes AMBIT_FUNCTIONS by this description: intervals and Taylor coefficients (num),
** derivatives, inverses and tapes (graph), arithmetics through "ambit.num/1", units and source texts. Those of one
** operand increase on their domain, an interval.
*/
#ifndef AMBIT_FUNCTION_H
#define AMBIT_FUNCTION_H
#include "num/interval.h"
#include <ambit/num.h>

struct ambit_graph;

/* How a language writes it: head a tail, or head a middle b tail; b is a once more if there is one operand. tight: a is
** bracketed unless it is a name or a number. */
typedef struct ambit_function_form {
  const char *head, *middle, *tail;
  bool tight;
} ambit_function_form;

/* What it does to dimensions: a number of a number, the dimension of both operands, the third root of the operand's. */
typedef enum ambit_function_unit {
  AMBIT_FUNCTION_OF_NUMBERS,
  AMBIT_FUNCTION_KEEPS,
  AMBIT_FUNCTION_ROOT_3
} ambit_function_unit;

typedef struct ambit_described {
  ambit_function_facts facts;
  ambit_function_unit unit;
  bool positive; /* no value is 0 or less, though 0 may be a limit */
  ambit_function_form latex, modelica;

  /* -- one operand */
  ambit_interval image; /* its range, closed */
  /* encloses f at a point of the closed domain, as a limit at its ends and at +-infinity; round to nearest */
  ambit_interval (*at)(double x);
  /* c[k], 1 <= k <= n, encloses f^(k)(x) / k! for all x of a part of the inner of the domain where f is smooth */
  void (*taylor)(uint32_t n, ambit_interval x, ambit_interval *c);
  bool (*is_smooth)(ambit_interval x);         /* NULL: on all of the inner of its domain */
  ambit_interval (*inverse)(ambit_interval r); /* holds all x with f(x) in r, a part of the image */
  uint32_t (*slope)(struct ambit_graph *g, uint32_t e, uint32_t a); /* f'(a) as an expression; e = f(a) */

  /* -- two operands; monotone in each of them on either side of 0, so that its extremes over a box are at corners or
  ** where one is 0 */
  ambit_interval (*at_pair)(double x, double y);                            /* as `at`, where y is finite or not */
  bool (*contract)(ambit_interval r, ambit_interval *a, ambit_interval *b); /* as ambit_inverse */
  /* the derivative by a, or by b, as an expression */
  uint32_t (*partial)(struct ambit_graph *g, uint32_t e, uint32_t a, uint32_t b, bool by_b);

  /* in operations that have power series, node by node as it is to be; an identity on the domain. Nodes made with
  ** ambit_store_make, without folding. */
  uint32_t (*written)(struct ambit_graph *g, uint32_t a, uint32_t b);
} ambit_described;

/* The description of an opcode; NULL: it is no function. */
const ambit_described *ambit_function_of(uint32_t op);

/* [any] r := f(a) or f(a, b), as ambit_interval_op; elementwise, called by it. */
uint32_t ambit_function_map(uint32_t op, size_t n, ambit_interval *r, const ambit_interval *a, const ambit_interval *b);
/* [any] As ambit_num_service.taylor. */
uint32_t ambit_function_taylor(uint32_t op, uint32_t n, ambit_interval *c, ambit_interval x);
#endif
