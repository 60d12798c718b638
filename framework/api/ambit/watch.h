/* watch.h -- what conditions on g(x, p, t) can be proved along a run, from its records as they come.
**
** A watch is a sink. Over each step it bounds g for all solutions of the run at once, cutting the step in time until
** the sign is known or the cuts are used up. A part `when` of the step is bounded by the natural extension of g over
** the enclosure of the states there and, where g is smooth, by the mean value theorem about its ends and its middle:
** g(t) in g(c) + (dg/dt)(when) (t - c), dg/dt = g_x f + g_t; where dg/dt has one sign this is the value at an end.
** docs/numerics/verify.md.
*/
#ifndef AMBIT_WATCH_H
#define AMBIT_WATCH_H
#include <ambit/arena.h>
#include <ambit/system.h>
#include <ambit/solver.h>

#ifdef __cplusplus
extern "C" {
#endif

/* When g <= 0 is wanted. */
#define AMBIT_WATCH_ALWAYS 0u /* at all times */
#define AMBIT_WATCH_END 1u    /* at the end */
#define AMBIT_WATCH_ONCE 2u   /* at some time */
#define AMBIT_WATCH_MOST 3u   /* g is no condition: a bound of max |g| over time is wanted */

typedef struct ambit_watch_condition {
  ambit_expr g; /* over states, unknowns and time */
  uint32_t kind;
  const char *name; /* for messages */
  /* MOST: as soon as the bound of this condition and those of its `rivals` next ones exceed their limits, the run is
  ** given up (rivals bound the same quantity in other ways). limit 0: none; more rivals than there are: never. */
  double limit;
  uint32_t rivals;
} ambit_watch_condition;

typedef struct ambit_watch_request {
  const ambit_system *system;
  size_t ncondition;
  const ambit_watch_condition *condition;
  const ambit_expr *initial; /* [nx] over unknowns, or NULL: then the start is known from the first record only */
  double start;              /* its time, s */
  /* unless NULL: the end is some instant between this time and that of the last record, s; `last` is an end of a
  ** step */
  const double *last;
  uint32_t cuts;  /* in time, for each condition in each step */
  size_t nnarrow; /* unknowns with a narrower range than their own: those of the run */
  const ambit_expr *narrow;
  const ambit_interval *range;
  ambit_sink *outer; /* its `progress` is passed on; or NULL */
} ambit_watch_request;

/* What is proved of a condition for every solution of the run (each point of its initial set, all values of data). */
typedef struct ambit_watch_finding {
  bool holds, fails;    /* for all of them */
  bool undefined;       /* g is not known to be defined everywhere it is needed */
  ambit_interval bound; /* encloses max g over time (ALWAYS), |g| (MOST), g at the end, min g over time (ONCE) */
  /* where `fails` (ALWAYS, END) or `holds` (ONCE) was seen: g is in `value` at all times of `when`, s, or where states
  ** leap at samples at one at least; else empty */
  ambit_interval when, value;
  ambit_interval worst; /* the part of time with the bound that is worst for a proof, s; empty: nothing was seen */
} ambit_watch_finding;

typedef struct ambit_watch ambit_watch;

/* INVALID: a condition depends on something that is neither a state nor an uncertain datum nor time (named). */
AMBIT_EXPORT ambit_status ambit_watch_open(
    const ambit_watch_request *q, ambit_arena *arena, ambit_watch **watch, ambit_failure *f);
AMBIT_EXPORT ambit_sink *ambit_watch_sink(ambit_watch *w);
/* Was the run given up because of a limit? */
AMBIT_EXPORT bool ambit_watch_gave_up(const ambit_watch *w);
/* After the run: complete, if it reached its end. finding [ncondition] */
AMBIT_EXPORT void ambit_watch_end(ambit_watch *w, bool complete, ambit_watch_finding *finding);

#ifdef __cplusplus
}
#endif
#endif
