/* field.h -- what a tape does to polynomials of s and of the unknowns xi, with proved remainders.
**
** Every slot holds a function of s in [-1, 1] and xi in [-1, 1]^nu, enclosed by c(s) + sum_a r_a(s) xi^a +- tail: c is
** a polynomial with double-double coefficients (series.h), whose tail is that of the whole, the r_a have doubles.
** Products keep powers of xi up to a total degree. Runs in round-to-nearest. Proofs: docs/numerics/stiff.md.
*/
#ifndef STIFF_FIELD_H
#define STIFF_FIELD_H
#include "series.h"

#define TERMS_MAX 128
#define FIELD_SCRATCH 6

/* Powers of the unknowns in ascending total degree; term 0 is 1. */
typedef struct terms {
  uint32_t nu, degree, count;
  uint32_t *exponent;        /* [count x nu] */
  uint32_t *grade;           /* [count] total degrees */
  uint32_t below[TERMS_MAX]; /* [degree + 1] how many terms have at most that degree */
  uint16_t *product;         /* [count x count] where it is at most `degree` */
  uint32_t pairs;            /* no product is a sum of more products of terms */
} terms;

typedef struct field {
  poly c;
  double *r;  /* [count x width]; row 0 is not used */
  uint8_t *n; /* [count] coefficients of each row; n[0] = 0 */
} field;

typedef struct fields {
  const ambit_tape *tape;
  const terms *terms;
  series *base;   /* of the same tape: its constants and its functions */
  uint32_t width; /* coefficients of a row */
  field *slot, scratch[FIELD_SCRATCH];
  double *sum, *part; /* [count x 2 width], [2 width] */
  uint8_t *sum_n;
} fields;

/* 0: no memory */
int terms_open(const ambit_host *h, uint32_t nu, uint32_t degree, terms *t);
uint32_t terms_degree(uint32_t nu);                 /* what is affordable; 0: none */
uint32_t terms_count(uint32_t nu, uint32_t degree); /* binomial(nu + degree, degree) */

int fields_open(const ambit_host *h, series *base, const terms *t, fields *f);
static inline field *fields_input(fields *f, uint32_t in) { return &f->slot[f->tape->nconst + in]; }
static inline const field *fields_output(const fields *f, uint32_t out) { return &f->slot[f->tape->out[out]]; }
static inline double *field_row(const fields *f, const field *a, uint32_t t) { return a->r + (size_t)t * f->width; }
void fields_run(fields *f); /* all inputs must have been set */

void field_constant(const fields *f, field *r, dd x, double tail);
void field_copy(const fields *f, field *r, const field *a);
double field_rest(const fields *f, const field *a); /* >= |sum_a r_a(s) xi^a| */
void field_trim(const fields *f, field *a);         /* tiny coefficients at the ends of rows go to the tail */
/* r := a + sign b, a b; r is not an operand of a product */
void field_add(const fields *f, field *r, const field *a, const field *b, double sign);
void field_mul(fields *f, field *r, const field *a, const field *b);

/* field_functions.c */
void field_function(fields *f, uint32_t op, field *r, const field *a, const field *b);
void field_power(fields *f, field *r, const field *a, int32_t n);
#endif
