/* constraint.h -- k invariants, linear over the set: 0 in value +- varies + slope (xi, z + low) (invariant.c), and the
** gain that uses them (contract.c).
*/
#ifndef LOHNER_CONSTRAINT_H
#define LOHNER_CONSTRAINT_H
#include "set.h"

typedef struct constraint {
  uint32_t k; /* 0: there are none, and nothing below is used */
  ambit_jet *centre_jet, *box_jet;
  double *value, *varies;        /* [k] gamma, r */
  balls slope;                   /* [k x ndir] over the set; its midpoints are J_xi, J */
  balls part;                    /* [ndir] over a piece of it */
  double *low, *high;            /* [k] what slopes leave, over all pieces */
  double *away, *outward;        /* [nx x nc] columns that lead away from the manifold; [k x nc] J of them */
  double *spread;                /* [k x history.pitch] J G */
  double *cross, *gain;          /* [k x nx] J Q; P, transposed */
  double *normal, *whole, *done; /* [k x k] J Q J^T + R; [k] [k] */
  double *unit;                  /* [k] one over how far each row reaches */
  double *before;                /* [nx] mean squares of the set */
  double *move;                  /* [nx x nx] I - P J */
  balls pivot;                   /* [k x nx] scratch of the rank */
  double *largest;               /* [k] unit of each row, from the start */
  double *least;                 /* [k] pivots at the start, 0: none */
  uint32_t blamed;               /* the invariant that is not met, or loses rank */
  int lost;                      /* it loses rank */
} constraint;

/* invariant.c */
ambit_status constraint_open(const field *f, const set *x, constraint *c);
void constraint_close(const field *f, constraint *c);
/* invariants over the set, piece by piece of it (NULL: as a whole); 0: they cannot be used */
int constraint_linearise(const field *f, const set *x, const pieces *pieces, constraint *c);
/* contract.c: the part of the set on which the invariants vanish, and its hull; 0: there is none */
int constraint_cut(const field *f, set *x, const pieces *pieces, constraint *c);
/* rank.c */
void constraint_note_rank(const field *f, const set *x, constraint *c); /* as it is at the start */
/* 1: constraint.blamed depends on others here, as far as can be told */
int constraint_loses_rank(const field *f, const set *x, constraint *c);
#endif
