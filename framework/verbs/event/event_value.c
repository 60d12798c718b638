/* event_value.c -- where the states, g and g' are over a part of a step.
**
** The states: the dense enclosure intersected with the tube, and with the enclosures at the ends where the part is an
** end. Without a dense enclosure the mean value theorem gives one: x(t) is in x(t_from) + (t - t_from) f(tube), and in
** x(t_to) - (t_to - t) f(tube). All sets are of whole solutions, so intersecting is sound.
*/
#include "graph/hull.h"
#include "verbs/run/dense.h"
#include "verbs/event/event_inside.h"
#include "num/interval.h"

static ambit_interval part(double a, double b) {
  return a <= b ? (ambit_interval) { a, b } : (ambit_interval) { b, a };
}

static ambit_interval point(double t) { return (ambit_interval) { t, t }; }

/* Of a solver that proves nothing intersections may be empty. */
static void narrow_to(ambit_interval *x, ambit_interval y) {
  ambit_interval both = ambit_interval_intersect(*x, y);
  if (!ambit_interval_is_empty(both)) *x = both;
}

static ambit_interval end_of_step(const ambit_record *r, uint32_t i) { return (ambit_interval) { r->lo[i], r->hi[i] }; }

/* Over the step as a whole. Without a tube nothing is known between the ends; the hull of both is a guess, and the
** record says that it proves nothing. */
static ambit_interval whole(const ambit_event_watch *w, uint32_t i, ambit_interval when) {
  if (!w->r->tube_lo && !w->r->ndense && !w->r->rigorous)
    return ambit_interval_hull(w->before[i], end_of_step(w->r, i));
  return ambit_dense_state(w->r, i, when);
}

static ambit_interval state(const ambit_event_watch *w, uint32_t i, double a, double b) {
  const ambit_record *r = w->r;
  ambit_interval x = whole(w, i, part(a, b)), now = end_of_step(r, i);
  if (w->has_speed) {
    ambit_interval gone = ambit_interval_sub(part(a, b), point(w->start));
    ambit_interval left = ambit_interval_sub(point(r->t_to), part(a, b));
    narrow_to(&x, ambit_interval_add(w->before[i], ambit_interval_mul(gone, w->speed[i])));
    narrow_to(&x, ambit_interval_sub(now, ambit_interval_mul(left, w->speed[i])));
  }
  if (b == w->t_before && !w->leaps) narrow_to(&x, w->before[i]);
  if (a == r->t_to) narrow_to(&x, now);
  return x;
}

ambit_interval ambit_event_watch_times(const ambit_event_watch *w, ambit_interval when) {
  double off = w->r->clock_error;
  if (!(off > 0)) return when;
  ambit_interval wide = ambit_interval_add(when, (ambit_interval) { -off, off });
  return w->way < 0 ? (ambit_interval) { wide.lo, fmin(wide.hi, w->t_first) }
                    : (ambit_interval) { fmax(wide.lo, w->t_first), wide.hi };
}

static void set_inputs(ambit_event_watch *w, double a, double b) {
  for (uint32_t i = 0; i < w->nx; i++) w->in[i] = state(w, i, a, b);
  w->in[w->nin - 1] = ambit_event_watch_times(w, part(a, b));
}

void ambit_event_watch_step(ambit_event_watch *w, const ambit_record *r) {
  w->r = r;
  w->way = r->t_to < r->t_from ? -1 : 1;
  w->rigorous = r->rigorous;
  w->has_speed = false;
  w->start = (w->t_before - r->t_from) * w->way > 0 ? w->t_before : r->t_from;
  if (r->ndense || !r->tube_lo || !r->tube_hi || w->start != w->t_before || w->leaps) return;
  set_inputs(w, w->start, r->t_to);
  if (ambit_hull(w->rate, w->in, w->slot) & (AMBIT_F_PARTIAL | AMBIT_F_EMPTY)) return;
  for (uint32_t i = 0; i < w->nx; i++) w->speed[i] = w->slot[w->rate->out[i]];
  w->has_speed = true;
}

static bool is_total(uint32_t flags) { return !(flags & (AMBIT_F_PARTIAL | AMBIT_F_EMPTY)); }

/* g over the inputs in place, also where g' is not defined. */
static ambit_event_values value_alone(ambit_event_watch *w, const watched *e) {
  uint32_t flags = ambit_hull(e->value, w->in, w->slot);
  bool torn = !is_total(flags) || ambit_hull_jumps(e->value, w->slot);
  return (ambit_event_values) { w->slot[e->value->out[0]], AMBIT_ENTIRE, torn };
}

ambit_event_values ambit_event_watch_value(ambit_event_watch *w, const watched *e, double a, double b) {
  set_inputs(w, a, b);
  if (w->budget) w->budget--;
  uint32_t flags = ambit_hull(e->both, w->in, w->slot);
  if (!is_total(flags) || ambit_hull_jumps(e->both, w->slot)) return value_alone(w, e);
  return (ambit_event_values) { w->slot[e->both->out[0]], w->slot[e->both->out[1]], false };
}

bool ambit_event_watch_zeros(ambit_event_watch *w, const watched *e, double a, double b) {
  static const double zero[] = { 0 };
  set_inputs(w, a, b);
  for (uint32_t i = 0; i < w->nin; i++) {
    w->lo[i] = w->in[i].lo;
    w->hi[i] = w->in[i].hi;
  }
  return ambit_contract_service_v1.narrow(e->contractor, w->lo, w->hi, zero, zero) != AMBIT_DOMAIN;
}
