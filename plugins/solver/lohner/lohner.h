/* lohner.h -- a run of the lohner plugin, put together from what lives through all of it, through a set, a step, a
** record. Each part has a header that says what it is; functions take the parts that they read, and change only those
** that are not const. All arithmetic is in upward mode (ball.h). Proofs: docs/numerics/lohner.md, which also has a
** table of its symbols and their names here.
*/
#ifndef LOHNER_H
#define LOHNER_H
#include "constraint.h"
#include "control.h"

/* what a record says besides bounds, where the problem asks for it (dense.c) */
typedef struct extras {
  double *about, *scale;              /* [nu] xi of an unknown is (u - about) / scale */
  balls dense;                        /* [nx x (order + 1)]; NULL: not asked for, as the next ones */
  double *dense_column;               /* [nx x ndir x (slope_order + 1)] */
  double *set_coefficient, *set_rest; /* [nx x (nu + 1)] [nx] */
  ambit_set set;
} extras;

/* the set at time[0] */
typedef struct origin {
  double *centre, *rest, *column; /* [nx] [nx] [nx x nc] */
} origin;

typedef struct lohner {
  field field;
  origin origin;
  set set;
  flow flow;
  slopes slopes;
  control control;
  constraint constraint;
  extras extras;
  uint32_t blamed;  /* the state that is too wide */
  const char *kink; /* why there is no step, or NULL */
} lohner;

/* start.c: the initial set, from open() on */
ambit_status lohner_open(const ambit_host *h, const ambit_problem *p, const double *option, void **self);
void lohner_close(void *self);
enum why lohner_start(lohner *s); /* the set at time[0]; WHY_NOTHING or WHY_APART */

/* run.c */
ambit_status lohner_run(void *self, ambit_sink *sink);

/* dense.c */
int extras_open(const field *f, extras *e);                                      /* 0: out of memory */
void extras_take_step(const field *f, const set *x, const flow *phi, extras *e); /* the enclosure over the step */
void extras_grant(const field *f, const set *x, const flow *phi, extras *e, ambit_record *r);

/* kink.c */
/* the operation whose kink the set meets, or, if not `met`, comes near to; NULL: none. After no step was found */
const char *lohner_kink(const field *f, const flow *phi, int met);
#endif
