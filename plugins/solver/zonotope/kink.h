/* kink.h -- abs, min and max, and tanh where the set is wide: which line stands for each of them in a step, and what it
** misses. */
#ifndef ZONOTOPE_KINK_H
#define ZONOTOPE_KINK_H
#include "zonotope.h"

typedef struct kink {
  double slope, offset; /* |d|, or tanh d, is about slope d + offset */
  double lo, hi;        /* d over the step, along the polynomials */
  double moved, drift;  /* of d's constant in this step, in the last one */
  double size;          /* of the operands over the step */
  double *total;        /* [K_max + 1] of each order of d */
  double more;          /* what a line misses more because of the distance from the polynomials */
  double missed, width; /* at the start of the step: by how much the line differs, half width of d */
  int is_line;          /* of tanh: a line stands for it in this step */
  uint32_t twin;        /* an earlier min or max of the same operands, of which this is a + b less; itself: none */
} kink;

typedef struct kinks {
  kink *of;             /* [ninstr] */
  uint8_t *may_cross;   /* [ninstr] 0: an equation that is solved for unknowns depends on them through it */
  double *row, *errors; /* [stride], [nx] scratch */
  double usual;         /* length of steps away from kinks */
  uint8_t *is_slot;     /* [nslot] of a kinked instruction, or a parameter that varies: lumps that short steps do not
                      ** make smaller */
} kinks;

static inline int is_kinked(uint32_t op) { return op == AMBIT_OP_ABS || op == AMBIT_OP_MIN || op == AMBIT_OP_MAX; }

static inline int is_line(const zono *z, uint32_t i) {
  return is_kinked(z->program.tape->op[i]) || z->kinks->of[i].is_line;
}

int kinks_open(zono *z); /* the program is open; 0: no memory */
/* phase 1: does a line stand for tanh, and which one? the operand's order 0 is there */
void tanh_choose(zono *z, uint32_t i);
/* tanh.c: the line that is about tanh over [lo, hi]; by how much it differs from tanh there, at most */
void tanh_line(const zono *z, kink *k, double lo, double hi);
double tanh_miss(const zono *z, const kink *k, double lo, double hi);
double tanh_half_width(const zono *z, double lo, double hi); /* of tanh [lo, hi]; about */
/* order k of instruction i */
void kink_row(zono *z, uint32_t i, uint32_t k);
static inline int has_twin(const zono *z, uint32_t i) { return z->kinks->of[i].twin != i; }
/* what the result is of its operands: a and b times these, plus a constant */
void kink_shares(const zono *z, uint32_t i, double *a, double *b);
/* phase 2: by how much the result differs over the step; rounding: of its rows, if they are no copies */
double kink_defect(zono *z, uint32_t i, double rounding, double length);
/* by how much more along values of the operand that are at most `distance` away; < 0: the kink may not be crossed */
double kink_second(const zono *z, uint32_t i, double distance);
void kinks_start(zono *z, double longest); /* defects are those of length 0; the longest step that may be tried */
/* are defects over this length, the last that were found, small enough? No proof depends on it. */
int kinks_fit(const zono *z, double length);
int kinks_steady(const zono *z); /* is the step short enough for the distances that its proof found? */
void kinks_note(zono *z);        /* the step is done */
#endif
