/* event_decide.c -- from signs and possible zeros, piece after piece, to events.
**
** Between two places of definite sign g may be 0 in some pieces. If its change has one sign (way) in all of them, each
** solution has at most one zero there, and has it exactly if the signs are -way and way: intermediate value theorem.
** With signs way and way, or -way and -way, none has a zero: a change of sign would need a change the other way. If
** the change has no one sign, only that much is known: the signs differ, or they do not. Where g is not known to be
** defined and continuous, not even the signs say anything: there may be a zero.
*/
#include "verbs/event/event_inside.h"
#include <string.h>

static void report(ambit_event_watch *w, const watched *e, uint32_t outcome) {
  if (w->count == w->room) {
    w->full = true;
    return;
  }
  size_t i = w->count++;
  double *lo = w->found[i].lo, *hi = w->found[i].hi; /* each place has its own */
  for (; i > w->first && (e->from - w->found[i - 1].t_lo) * w->way < 0; i--) w->found[i] = w->found[i - 1];
  memcpy(lo, e->lo, w->nx * sizeof *lo);
  memcpy(hi, e->hi, w->nx * sizeof *hi);
  w->found[i] = (ambit_event_found) { .event = (uint32_t)(e - w->one),
    .outcome = outcome,
    .rigorous = w->rigorous,
    .direction = e->mixed ? 0 : e->way * w->way,
    .t_lo = e->from,
    .t_hi = e->until,
    .lo = lo,
    .hi = hi };
}

/* From g = 0 at the start in the direction that is looked for, which may not be? */
static bool goes_through(const watched *e) { return e->event.must_leave && e->event.direction; }

/* Zeros of g in a region that began behind sign `before` (0: at the start of the run) and ended in front of sign
** `after` (0: at the end of the run); 0: there are none, or not in the direction wanted. */
static uint32_t decide(const ambit_event_watch *w, const watched *e, int before, int after) {
  if (!e->seen) return 0;
  if (e->torn || before == AMBIT_EVENT_NOWHERE || after == AMBIT_EVENT_NOWHERE) return AMBIT_EVENT_EDGE;
  if (e->mixed) {
    if (!after) return AMBIT_EVENT_PART;
    if (!before) return e->event.starts_on ? AMBIT_EVENT_TOUCHES : AMBIT_EVENT_STARTS;
    return before == after ? AMBIT_EVENT_TOUCHES : AMBIT_EVENT_CROSSES;
  }
  int direction = e->way * w->way;
  if (e->event.direction && e->event.direction != direction) return 0;
  if (before == e->way && after == -e->way) return AMBIT_EVENT_TOUCHES; /* cannot be, unless nothing is proved */
  if (before == e->way || after == -e->way) return 0;
  if (!before) return e->event.starts_on && !goes_through(e) ? 0 : AMBIT_EVENT_STARTS;
  return after ? AMBIT_EVENT_CROSSED : AMBIT_EVENT_PART;
}

static void close(ambit_event_watch *w, watched *e, int after) {
  if (!e->open) return;
  e->open = false;
  uint32_t outcome = decide(w, e, e->sign, after);
  if (outcome) report(w, e, outcome);
}

void ambit_event_watch_note_sign(ambit_event_watch *w, watched *e, int sign) {
  close(w, e, sign);
  e->sign = sign;
}

void ambit_event_watch_note_end(ambit_event_watch *w, watched *e) { close(w, e, 0); }

void ambit_event_watch_note_zero(ambit_event_watch *w, watched *e, double a, double b, int way, bool torn) {
  ambit_interval times = ambit_event_watch_times(w, a < b ? (ambit_interval) { a, b } : (ambit_interval) { b, a });
  if (!e->open) {
    e->open = true;
    e->mixed = e->torn = e->seen = false;
    e->way = way;
    e->from = w->way < 0 ? times.hi : times.lo;
  }
  e->mixed = e->mixed || !way || way != e->way;
  e->torn = e->torn || torn;
  e->until = w->way < 0 ? times.lo : times.hi;
  if (!ambit_event_watch_zeros(w, e, a, b)) return;
  for (uint32_t i = 0; i < w->nx; i++) {
    e->lo[i] = e->seen ? fmin(e->lo[i], w->lo[i]) : w->lo[i];
    e->hi[i] = e->seen ? fmax(e->hi[i], w->hi[i]) : w->hi[i];
  }
  e->seen = true;
}
