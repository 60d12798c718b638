/* control.h -- what decides how long steps are, and when there should be no more: no proof rests on it. */
#ifndef LOHNER_CONTROL_H
#define LOHNER_CONTROL_H
#include "set.h"
#include <ambit/ends.h>
#include <ambit/work.h>

/* how far states may count as more than they are by themselves (size.c) */
enum leniency { LENIENT_NOT, LENIENT_NEAR, LENIENT_FAR };

typedef struct sizes {
  enum leniency lenient; /* at first of this step, then of the next */
  double *size;          /* [nx] how large each state is, for tolerances */
  double *unit, *grown;  /* [nx] sizes of states, and of the set, in a step, also of what is zero */
  double *limit;         /* [nx] widest that each state may be */
  double *euler;         /* [nx x (nx + 2)] scratch */
} sizes;

/* steps of a run (pace.c) */
typedef struct stretch {
  double from, longest; /* time at its start; longest step planned in it */
  uint64_t wide;        /* steps in it over wide sets */
} stretch;
typedef struct pace {
  uint64_t steps, until; /* done; end of this stretch, twice as far as that of the last one */
  stretch stretch[3];    /* the one before the last, the last, this one */
} pace;

typedef struct control {
  uint32_t next;         /* the instant ahead */
  int at_instant;        /* the step ends on it */
  uint32_t slope_order;  /* of the next step */
  double guess, longest; /* next step length to try; what its slopes are likely to allow */
  sizes sizes;
  pace pace;
  ambit_work *counted;
} control;

/* Why no step could be made; the run ends with a sentence about it (run.c). */
enum why {
  WHY_NOTHING,
  WHY_CENTRE,      /* the right-hand side has no series at the midpoint */
  WHY_BOX,         /* nor over the whole set */
  WHY_NO_STEP,     /* no step that is long enough could be proved */
  WHY_SHORT_STEPS, /* steps shrink so fast that the end is out of reach */
  WHY_WIDE,
  WHY_APART, /* the set does not meet an invariant */
  WHY_STOPPED
};

int control_open(const field *f, control *c); /* 0: out of memory */
void control_start(const field *f, const set *x, control *c);

/* step.c */
double control_least_step(const field *f, double t);
/* series, a length, and its proof; slopes at the end, over the whole set */
enum why control_find_step(const field *f, const set *x, control *c, slopes *S, flow *phi);

/* size.c, all after the series of the step */
void sizes_choose_unit(const field *f, const flow *phi, sizes *z);                /* sizes of states in the step */
void sizes_choose_grown(const field *f, const set *x, const flow *phi, sizes *z); /* what the step makes of the set */
/* what rounding adds to state i in the step: more than its size, where it stays at zero */
double sizes_noise(const flow *phi, uint32_t i);
int sizes_are_filled(const field *f, const sizes *z); /* some state counts as more than it is */

/* pace.c */
void pace_start(pace *p, double t);
/* To be asked after each step, at t: `length`, what is planned next; `wide`: slopes varied over the set. 1: the end is
** out of reach */
int pace_is_hopeless(const options *o, double t, double end, double length, int wide, pace *p);
#endif
