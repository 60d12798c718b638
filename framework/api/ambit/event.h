/* event.h -- zero crossings of g(x, p, t) along every solution of a run, located with proof.
**
** A watch is a sink between ambit_simulate and the receiver of the records. It needs nothing from a solver but
** enclosures: over each step it evaluates g and g' = dg/dx f + dg/dt. Where g has one sign there is no zero; where g'
** is defined and has one sign every solution has at most one. Zeros are looked for wherever g is defined. An event is
** passed on as a record (AMBIT_REC_EVENT; t_from, t_to: where it happens; lo, hi: the states then; `event`: its number
** from 1; rigorous: it is proved that every solution crosses exactly once) in front of the step in which it ended.
** Proofs: docs/numerics/events.md.
**
** What cannot be decided is reported as such: touches, edges of the domain of g, zeros where it is not smooth.
*/
#ifndef AMBIT_EVENT_H
#define AMBIT_EVENT_H
#include <ambit/system.h>
#include <ambit/solver.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ambit_event {
  const char *name;    /* for messages */
  ambit_expr g;        /* over the states, unknowns and time */
  int32_t direction;   /* of g as time grows: 1 rising, -1 falling, 0 both */
  uint32_t stop;       /* the run ends with it */
  uint32_t starts_on;  /* g = 0 at the start is known, though the enclosures may not show it: the start is no event */
  uint32_t must_leave; /* but going on from it in `direction` (not 0) is one: AMBIT_EVENT_STARTS */
} ambit_event;

/* What is known of an event. */
#define AMBIT_EVENT_CROSSED 1u /* every solution crosses exactly once, with g' != 0 */
#define AMBIT_EVENT_CROSSES 2u /* every solution crosses, but perhaps more than once or with g' = 0 */
#define AMBIT_EVENT_TOUCHES 3u /* some solutions may touch g = 0, or cross and come back */
#define AMBIT_EVENT_PART 4u    /* the run ended while some solutions may have crossed and others not */
#define AMBIT_EVENT_STARTS 5u  /* the initial set lies on both sides: only some solutions cross */
#define AMBIT_EVENT_EDGE 6u    /* g may leave its domain or jump: some solutions may have a zero there */

typedef struct ambit_event_found {
  uint32_t event; /* index of the list */
  uint32_t outcome, rigorous;
  int32_t direction; /* in which it is crossed as time grows; 0: not known */
  double t_lo, t_hi; /* all zeros of g in question are within */
  double *lo, *hi;   /* [nx] where g may be 0 then */
} ambit_event_found;

typedef struct ambit_event_watch_request {
  const ambit_system *system;
  const ambit_expr *initial; /* [nx] over unknowns, as for ambit_simulate */
  double t_start;
  size_t n;
  const ambit_event *event;
  size_t room; /* most events that are kept: more end the run */
} ambit_event_watch_request;

typedef struct ambit_event_watch ambit_event_watch;

/* All memory is taken here. INVALID: f names the event and what is wrong with it. */
AMBIT_EXPORT ambit_status ambit_event_watch_open(
    const ambit_event_watch_request *q, ambit_event_watch **w, ambit_failure *f);
AMBIT_EXPORT void ambit_event_watch_close(ambit_event_watch *w); /* NULL is allowed */

/* The sink to run the solver with (AMBIT_EXTRA_DENSE makes it tight); everything goes on to `outer`, which may be
** NULL. One run per watch. */
AMBIT_EXPORT ambit_sink *ambit_event_watch_sink(ambit_event_watch *w, ambit_sink *outer);
/* After the run: decides what is still undecided. */
AMBIT_EXPORT void ambit_event_watch_end(ambit_event_watch *w);

AMBIT_EXPORT size_t ambit_event_watch_count(const ambit_event_watch *w);
AMBIT_EXPORT const ambit_event_found *ambit_event_watch_found(
    const ambit_event_watch *w, size_t i); /* in the order of the run */
/* Index of the found event that ended the run, or SIZE_MAX. */
AMBIT_EXPORT size_t ambit_event_watch_stopped_by(const ambit_event_watch *w);
AMBIT_EXPORT bool ambit_event_watch_is_full(
    const ambit_event_watch *w); /* did the run end because there were more events than room? */
/* Up to the end of the step last passed on: may there be a zero that has not been decided on? */
AMBIT_EXPORT bool ambit_event_watch_is_open(const ambit_event_watch *w);

#ifdef __cplusplus
}
#endif
#endif
