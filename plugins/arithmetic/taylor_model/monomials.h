/* monomials.h -- the monomials of nvar variables up to a total degree, in graded order, and how they multiply.
**
** A monomial of degree q is a word w_1 >= ... >= w_q of variables; within a degree words are in lexicographic order, so
** the monomials m x_0, ..., m x_last of one m are neighbours. The index of a product comes from a table with a row for
** each left factor, C(2 nvar + order, order) entries in all. Where it pays (few variables, high order) the product is
** also laid out in rows along the powers of x_0, which are one-dimensional convolutions.
*/
#ifndef MONOMIALS_H
#define MONOMIALS_H
#include <stddef.h>
#include <stdint.h>

#define MONOMIALS_ORDER_MAX 60
#define MONOMIALS_BLOCK 8     /* coefficients that are present or absent together */
#define MONOMIALS_MIXED 255   /* a block with monomials of several degrees */
#define MONOMIALS_ROW_PAD 8   /* widest vector */
#define MONOMIALS_ROW_GROUP 4 /* pairs of rows come in fours */

typedef struct row_pair {
  uint32_t left, right; /* where the two rows start in the packed operands */
} row_pair;

/* Rows: monomials m x_0^k, k = 0 .. order - degree(m), one row for each m without x_0. They are sorted by the degree
** of m, then by the number of pairs, so that loops over pairs rarely end at another count than before. */
typedef struct monomial_rows {
  uint32_t count;        /* rows; 0: not laid out */
  uint32_t packed;       /* doubles of a packed operand, where a row of zeros follows: rows start at multiples of 8 */
  const uint8_t *degree; /* [count] of m */
  const uint32_t *item;  /* [count + 1] where the row's monomials start in `index` */
  const uint32_t *index; /* [monomials] monomial of each item */
  const uint32_t *pairs; /* [count + 1] where the pairs start whose product is this row */
  const row_pair *pair;  /* by target row, filled up with pairs of zeros */
  const uint32_t *place; /* [monomials] position in a packed operand */
} monomial_rows;

typedef struct monomials {
  uint32_t nvar, order;
  uint32_t count;         /* C(nvar + order, order) */
  uint32_t blocks, words; /* of 8 coefficients; of 64 blocks */
  size_t products;        /* C(2 nvar + order, order) */
  const uint32_t *first;  /* [order + 2] the first monomial of each degree */
  const uint8_t *degree;  /* [count] */
  const uint32_t *parent; /* [count] the monomial without its last variable */
  const uint32_t *last;   /* [count] the last (lowest) variable */
  const uint32_t *child;  /* [count] the monomial times x_0; times x_v, v <= last, follows; 0 at the highest degree */
  const size_t *row;      /* [count] start of the row of `times` */
  const uint32_t *times;  /* times[row[i] + j]: the product, degree(i) + degree(j) <= order */
  const uint8_t *uniform; /* [blocks] degree, or MONOMIALS_MIXED */
  const int64_t *odd;     /* [8 blocks] all ones if the monomial may be negative, 0 if it is a square */
  const double *terms;    /* [order + 1] at most so many products go into a coefficient of this degree */
  monomial_rows rows;
} monomials;

/* C(n, k), rounded; monomial_count(nvar, order) = C(nvar + order, order) */
double monomial_count(double nvar, uint32_t order);
/* Bytes that monomials_lay needs, by formula; larger than any address space if that is so. */
double monomials_bytes(uint32_t nvar, uint32_t order);
/* Are products laid out in rows, since a pair of rows has several products? */
int monomials_has_rows(uint32_t nvar, uint32_t order);
/* Lays the tables into `room` (8-byte aligned, monomials_bytes). */
void monomials_lay(monomials *m, uint32_t nvar, uint32_t order, void *room);
/* exponent [nvar] of monomial i */
void monomials_exponents(const monomials *m, uint32_t i, uint32_t *exponent);
/* the monomial with these exponents; UINT32_MAX above the order */
uint32_t monomials_index(const monomials *m, const uint32_t *exponent);

static inline uint32_t monomials_product(const monomials *m, uint32_t i, uint32_t j) { return m->times[m->row[i] + j]; }
#endif
