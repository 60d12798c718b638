/* event_inside.h -- what the files of the watch share. Times of a piece (a, b) are in the order of the run: b < a
** backwards. "Way" is the sign of the change of g in that order. */
#ifndef AMBIT_EVENT_INSIDE_H
#define AMBIT_EVENT_INSIDE_H
#include "graph/contract.h"
#include "host/services.h"
#include <ambit/event.h>

typedef struct watched {
  ambit_event event;
  const ambit_tape *value, *both; /* g; g and g' */
  ambit_contractor *contractor;   /* of g alone: where g' is undefined there may be a zero all the same */
  int sign;                       /* the sign of g where it was last definite; 0: nowhere yet; AMBIT_EVENT_NOWHERE */
  bool open;                      /* g may have been 0 since `from` */
  bool mixed;                     /* not all g' there have the sign `way` */
  bool torn;                      /* g is not known to be defined and continuous everywhere there */
  bool seen;                      /* lo, hi hold a box */
  uint32_t tired;                 /* how often in a row, lately, the evaluations of a step were used up */
  int way;
  double from, until;
  double *lo, *hi; /* [nx] where g may be 0, since `from` */
} watched;

struct ambit_event_watch {
  ambit_sink sink; /* first: what ambit_simulate sees */
  ambit_sink *outer;
  ambit_arena *arena;
  ambit_scope *scope;
  uint32_t nx, nin;
  size_t n;
  watched *one;
  const ambit_tape *rate; /* f, for steps without a dense enclosure */
  ambit_interval *in;     /* [nin] states, unknowns, time */
  ambit_interval *slot;   /* of any tape */
  ambit_interval *before; /* [nx] at t_before */
  ambit_interval *speed;  /* [nx] f over the step */
  double *lo, *hi;        /* [nin] */
  const ambit_record *r;  /* the step */
  int way;                /* of the run: 1, or -1 backwards */
  double t_first;         /* the start of the run */
  double t_before, start; /* end of the step before; where this one is taken up (steps may overlap) */
  bool rigorous, has_speed;
  bool leaps;      /* samples make states leap: the end of one step says nothing of the next one */
  uint32_t budget; /* evaluations left for this step and event */
  size_t count, room, first, stopped_by;
  ambit_event_found *found; /* [room]; those of this step from `first` on */
  bool full;
};

#define AMBIT_EVENT_NOWHERE 2 /* as a sign: g is not defined, for no solution */

typedef struct ambit_event_values {
  ambit_interval g;    /* of every solution, where it is defined; empty: nowhere */
  ambit_interval rate; /* encloses g', which is continuous; entire where that is not known */
  bool torn;           /* g is not known to be defined and continuous all over the piece */
} ambit_event_values;

/* The times that the clock of the records may mean when it shows `when`: true samples are beside its doubles. */
ambit_interval ambit_event_watch_times(const ambit_event_watch *w, ambit_interval when);
/* -- event_value.c: over the piece (a, b) of the step */
void ambit_event_watch_step(ambit_event_watch *w, const ambit_record *r); /* takes up the next step */
ambit_event_values ambit_event_watch_value(ambit_event_watch *w, const watched *e, double a, double b);
/* w->lo, w->hi [nx] := where solutions can have g = 0; false: nowhere */
bool ambit_event_watch_zeros(ambit_event_watch *w, const watched *e, double a, double b);

/* -- event_scan.c */
void ambit_event_watch_scan(ambit_event_watch *w, watched *e);

/* -- event_decide.c */
void ambit_event_watch_note_sign(ambit_event_watch *w, watched *e, int sign);
/* g may be 0 in the piece; way: the one sign of its change there, or 0; torn: see ambit_event_values */
void ambit_event_watch_note_zero(ambit_event_watch *w, watched *e, double a, double b, int way, bool torn);
/* The run goes no further: is what is open an event? */
void ambit_event_watch_note_end(ambit_event_watch *w, watched *e);
#endif
