/* watch_most.c -- the greatest |g| over the steps of a run, by branch and bound in time (Moore 1966).
**
** |g| at single times is enclosed by some [., m]: no bound by these enclosures can be below the greatest m, the level.
** A part of time is cut while its own bound is (by more than a hundredth) above the level, and above what is already
** known of other parts, which could not get better any more. Soundness: watch.c.
*/
#include "graph/hull.h"
#include "verbs/verify/watch_inside.h"
#include "num/interval.h"

#define SLACK 0x1p-7

typedef struct most_part {
  ambit_interval when;
  ambit_interval end[2]; /* g at both ends */
} most_part;

/* A part that cannot make the bound (much) worse. */
static bool is_below(const watched *c, ambit_interval g) {
  double level = c->level + SLACK * c->level, known = c->finding.bound.hi;
  return !ambit_interval_is_empty(g) && ambit_interval_mag(g) <= (level > known ? level : known);
}

static ambit_interval at(ambit_watch *w, watched *c, const ambit_record *r, double t) {
  ambit_watch_place(w, c, r, (ambit_interval) { t, t });
  ambit_interval g = ambit_watch_run(w, c->value);
  if (!ambit_interval_is_empty(g) && ambit_interval_mag(g) > c->level) c->level = ambit_interval_mag(g);
  return g;
}

/* g(c) + (dg/dt) (t - c) about both ends and the middle. */
static ambit_interval by_slope(
    ambit_watch *w, watched *c, const ambit_record *r, const most_part *p, ambit_interval middle, ambit_interval g) {
  if (!c->slope || ambit_interval_is_empty(g)) return g;
  ambit_watch_place(w, c, r, p->when);
  ambit_watch_run(w, c->value);
  if (ambit_hull_jumps(c->value, w->slot)) return g;
  ambit_interval slope = ambit_watch_run(w, c->slope);
  double time[3] = { p->when.lo, ambit_interval_mid(p->when), p->when.hi };
  ambit_interval value[3] = { p->end[0], middle, p->end[1] };
  for (int k = 0; k < 3 && !ambit_interval_is_empty(slope); k++) {
    if (ambit_interval_is_empty(value[k])) continue;
    ambit_interval t = ambit_interval_sub(p->when, (ambit_interval) { time[k], time[k] });
    ambit_interval both = ambit_interval_intersect(g, ambit_interval_add(value[k], ambit_interval_mul(slope, t)));
    if (!ambit_interval_is_empty(both)) g = both;
  }
  return g;
}

static void conclude(const ambit_watch *w, watched *c, ambit_interval when, ambit_interval g) {
  ambit_watch_finding *to = &c->finding;
  bool known = !ambit_interval_is_empty(g);
  double most = known ? ambit_interval_mag(g) : INFINITY, least = known ? ambit_interval_mig(g) : 0;
  to->undefined = to->undefined || !known;
  if (least > to->bound.lo && !w->is_ending) to->bound.lo = least;
  c->open = c->open || most > 0;
  if (most < to->bound.hi || (most == to->bound.hi && !ambit_interval_is_empty(to->worst))) return;
  to->worst = when;
  to->bound.hi = most;
}

void ambit_watch_scan_most(ambit_watch *w, watched *c, const ambit_record *r) {
  most_part stack[STACK];
  size_t depth = 0;
  uint32_t left = w->q->cuts;
  bool backwards = r->t_to < r->t_from;
  double first = backwards ? r->t_to : r->t_from, last = backwards ? r->t_from : r->t_to;
  stack[depth++] = (most_part) { { first, last }, { at(w, c, r, first), at(w, c, r, last) } };
  while (depth) {
    most_part p = stack[--depth];
    ambit_watch_place(w, c, r, p.when);
    ambit_interval g = ambit_watch_run(w, c->value), middle = AMBIT_EMPTY;
    double mid = ambit_interval_mid(p.when);
    bool whole = is_below(c, g);
    if (!whole) {
      middle = at(w, c, r, mid);
      g = by_slope(w, c, r, &p, middle, g);
    }
    bool divisible = p.when.lo < mid && mid < p.when.hi;
    if (whole || is_below(c, g) || !left || depth + 2 > STACK || !divisible) {
      conclude(w, c, p.when, g);
      continue;
    }
    left--;
    stack[depth++] = (most_part) { { mid, p.when.hi }, { middle, p.end[1] } };
    stack[depth++] = (most_part) { { p.when.lo, mid }, { p.end[0], middle } };
  }
}
