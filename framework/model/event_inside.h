/* event_inside.h -- what the files of the watch share. Times of a piece (a, b) are in the order of the run: b < a
** backwards. "Way" is the sign of the change of g in that order. */
#ifndef AMBIT_EVENT_INSIDE_H
#define AMBIT_EVENT_INSIDE_H
#include "graph/contract.h"
#include "host/services.h"
#include "model/event.h"

typedef struct watched {
  ambit_event event;
  const ambit_tape *tape; /* g, g' */
  ambit_contractor *contractor;
  bool bends;     /* the tape has an operation that can jump */
  int sign;       /* the sign of g where it was last definite; 0: nowhere yet */
  bool open;      /* g may have been 0 since `from` */
  bool mixed;     /* not all g' there have the sign `way` */
  bool seen;      /* lo, hi hold a box */
  uint32_t tired; /* how often in a row, lately, the evaluations of a step were used up */
  int way;
  double from, until;
  double *lo, *hi; /* [nx] where g may be 0, since `from` */
} watched;

struct ambit_event_watch {
  ambit_sink sink; /* first: what ambit_simulate sees */
  ambit_sink *outer;
  ambit_arena *arena;
  ambit_lease *lease;
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
  double t_before, start; /* end of the step before; where this one is taken up (steps may overlap) */
  bool rigorous, has_speed;
  uint32_t budget; /* evaluations left for this step and event */
  size_t count, room, first, stopped_by;
  ambit_event_found *found; /* [room]; those of this step from `first` on */
  bool full;
};

/* -- event_value.c: over the piece (a, b) of the step */
void ambit_event_watch_step(ambit_event_watch *w, const ambit_record *r); /* takes up the next step */
/* Encloses g and g' of every solution; both entire where g is not smooth and defined. */
void ambit_event_watch_value(
    ambit_event_watch *w, const watched *e, double a, double b, ambit_interval *g, ambit_interval *rate);
/* w->lo, w->hi [nx] := where solutions can have g = 0; false: nowhere */
bool ambit_event_watch_zeros(ambit_event_watch *w, const watched *e, double a, double b);

/* -- event_scan.c */
void ambit_event_watch_scan(ambit_event_watch *w, watched *e);

/* -- event_decide.c */
void ambit_event_watch_note_sign(ambit_event_watch *w, watched *e, int sign);
/* g may be 0 in the piece; way: the one sign of its change there, or 0 */
void ambit_event_watch_note_zero(ambit_event_watch *w, watched *e, double a, double b, int way);
/* The run goes no further: is what is open an event? */
void ambit_event_watch_note_end(ambit_event_watch *w, watched *e);
#endif
