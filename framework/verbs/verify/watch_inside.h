/* watch_inside.h -- a watch and its conditions, seen by the files watch*.c. */
#ifndef AMBIT_WATCH_INSIDE_H
#define AMBIT_WATCH_INSIDE_H
#include "graph/tape.h"
#include <ambit/watch.h>

#define STACK 1200 /* halving an interval of doubles ends before */

typedef struct watched watched;
struct watched {
  const ambit_watch_condition *condition;
  const ambit_tape *value, *slope; /* slope: NULL if g has no derivative */
  bool open;                       /* some part of time was not settled */
  double level;                    /* MOST: |g| is that large somewhere, as g at single times is enclosed */
  bool *wanted;                    /* [nx] states that the tapes read */
  ambit_interval end;              /* g while the run may end (request.last) */
  bool end_undefined;
  ambit_watch_finding finding;
};

struct ambit_watch {
  ambit_sink sink; /* first */
  const ambit_watch_request *q;
  size_t n;
  watched *watched;
  ambit_interval *in, *slot; /* inputs of the tapes: states, unknowns, time */
  size_t nx, nin;
  ambit_interval *before; /* [nx] the box at the end of the last step */
  double reached, clock_error;
  bool started, gave_up;
  bool is_ending; /* the step at hand may be beyond the end: what is seen in it need not happen */
};

/* The states that c depends on while t is in `when`, as inputs of its tapes. */
void ambit_watch_place(ambit_watch *w, const watched *c, const ambit_record *r, ambit_interval when);
/* AMBIT_EMPTY: not known to be defined */
ambit_interval ambit_watch_run(ambit_watch *w, const ambit_tape *t);
/* Of a step: adds to the bound of max |g| (AMBIT_WATCH_MOST). */
void ambit_watch_scan_most(ambit_watch *w, watched *c, const ambit_record *r);
#endif
