/* event.c -- a watch as a sink: each step is scanned for every event, what was found goes on in the order of time in
** front of it.
*/
#include "verbs/event/event_inside.h"

/* The first event of this step that ends the run. */
static size_t find_stop(const ambit_event_watch *w) {
  for (size_t i = w->first; i < w->count; i++)
    if (w->one[w->found[i].event].event.stop) return i;
  return SIZE_MAX;
}

/* A run that ends with an event says of the others what is known until then: what may have begun is undecided, what
** comes after is no matter. */
static void stop(ambit_event_watch *w) {
  size_t i = find_stop(w);
  if (i == SIZE_MAX) return;
  double until = w->found[i].t_hi;
  for (size_t k = 0; k < w->n; k++) {
    if (w->one[k].open && (w->one[k].from - until) * w->way <= 0) ambit_event_watch_note_end(w, &w->one[k]);
    w->one[k].open = false;
  }
  i = find_stop(w);
  w->stopped_by = i;
  while (w->count > i + 1 && (w->found[w->count - 1].t_lo - w->found[i].t_hi) * w->way > 0) w->count--;
}

static int32_t pass_event(const ambit_event_watch *w, ambit_event_found *e) {
  if (e->t_lo > e->t_hi) {
    double t = e->t_lo;
    e->t_lo = e->t_hi;
    e->t_hi = t;
  }
  bool backwards = w->way < 0;
  ambit_record r = { .size = sizeof r, .kind = AMBIT_REC_EVENT, .nx = w->nx, .event = e->event + 1, .lo = e->lo };
  r.t_from = backwards ? e->t_hi : e->t_lo;
  r.t_to = backwards ? e->t_lo : e->t_hi;
  r.hi = e->hi;
  r.rigorous = e->rigorous && e->outcome == AMBIT_EVENT_CROSSED;
  return w->outer && w->outer->emit ? w->outer->emit(w->outer, &r) : 0;
}

static int32_t pass_events(ambit_event_watch *w) {
  int32_t ends = 0;
  for (size_t i = w->first; i < w->count; i++) ends |= pass_event(w, &w->found[i]);
  w->first = w->count;
  return ends;
}

static int32_t emit(ambit_sink *s, const ambit_record *r) {
  ambit_event_watch *w = (ambit_event_watch *)(void *)s;
  if (r->kind == AMBIT_REC_STEP) {
    ambit_event_watch_step(w, r);
    for (size_t k = 0; k < w->n; k++) ambit_event_watch_scan(w, &w->one[k]);
    stop(w);
  }
  int32_t ends = pass_events(w);
  if (w->outer && w->outer->emit) ends |= w->outer->emit(w->outer, r);
  if (r->kind == AMBIT_REC_STEP) {
    for (uint32_t i = 0; i < w->nx; i++) w->before[i] = (ambit_interval) { r->lo[i], r->hi[i] };
    w->t_before = r->t_to;
  }
  return ends || w->stopped_by != SIZE_MAX || w->full;
}

static int32_t progress(ambit_sink *s, double done, const char *message) {
  ambit_sink *outer = ((ambit_event_watch *)(void *)s)->outer;
  return outer && outer->progress ? outer->progress(outer, done, message) : 0;
}

ambit_sink *ambit_event_watch_sink(ambit_event_watch *w, ambit_sink *outer) {
  w->sink = (ambit_sink) { sizeof(ambit_sink), emit, progress };
  w->outer = outer;
  return &w->sink;
}

static double begin_of(const ambit_event_watch *w, size_t i) {
  return w->way < 0 ? -w->found[i].t_hi : w->found[i].t_lo;
}

/* One that took many steps to end may have begun before others that were passed on by then. */
static void sort_found(ambit_event_watch *w) {
  for (size_t i = 1; i < w->count; i++)
    for (size_t k = i; k > 0 && begin_of(w, k) < begin_of(w, k - 1); k--) {
      ambit_event_found later = w->found[k - 1];
      w->found[k - 1] = w->found[k];
      w->found[k] = later;
      if (w->stopped_by == k || w->stopped_by == k - 1) w->stopped_by = 2 * k - 1 - w->stopped_by;
    }
}

void ambit_event_watch_end(ambit_event_watch *w) {
  for (size_t k = 0; k < w->n; k++) ambit_event_watch_note_end(w, &w->one[k]);
  pass_events(w);
  sort_found(w);
}

size_t ambit_event_watch_count(const ambit_event_watch *w) { return w->count; }

const ambit_event_found *ambit_event_watch_found(const ambit_event_watch *w, size_t i) { return &w->found[i]; }

size_t ambit_event_watch_stopped_by(const ambit_event_watch *w) { return w->stopped_by; }

bool ambit_event_watch_is_full(const ambit_event_watch *w) { return w->full; }

bool ambit_event_watch_is_open(const ambit_event_watch *w) {
  for (size_t k = 0; k < w->n; k++)
    if (w->one[k].open) return true;
  return false;
}
