/* invariant.c -- the invariants, linear over the set.
**
** For every state x of the set with coordinates v = (xi, z + low),
**   g(x, p, t) = g(m, p_c, t) + S v,   S in slope,
** with slopes about the midpoint as those of the flow (series.c), of order zero. Columns are formed inside the slopes,
** so what an invariant does not see of an uncertain datum cancels there, and a datum that it depends on itself (a
** length in a closed loop) is seen. The series say nothing where some invariant is undefined or has a kink in the set
** (|x| around 0); then none is used.
*/
#include "constraint.h"

ambit_status constraint_open(const field *f, const set *x, constraint *c) {
  const ambit_problem *p = &f->problem;
  size_t k = c->k = p->invariant ? p->ninvariant : 0, nx = f->nx, nc = f->nc, nd = f->ndir;
  if (k == 0) return AMBIT_OK;
  const request list[] = { { &c->value, k }, { &c->varies, k }, { &c->slope.mid, k * nd }, { &c->slope.rad, k * nd },
    { &c->part.mid, nd }, { &c->part.rad, nd }, { &c->low, k }, { &c->high, k }, { &c->away, nx * nc },
    { &c->outward, k * nc }, { &c->spread, k * x->history.pitch }, { &c->cross, k * nx }, { &c->gain, k * nx },
    { &c->normal, k * k }, { &c->whole, k }, { &c->done, k }, { &c->unit, k }, { &c->before, nx },
    { &c->move, nx * nx }, { &c->pivot.mid, k * nx }, { &c->pivot.rad, k * nx }, { &c->largest, k }, { &c->least, k } };
  if (!field_allocate(f->host, sizeof list / sizeof *list, list)) return field_no_memory(f->host);
  ambit_status status = f->jet->open(f->host, p->invariant, p->arithmetic, p->actx, 0, 0, NULL, &c->centre_jet);
  if (status != AMBIT_OK) return status;
  return f->jet->open(f->host, p->invariant, p->arithmetic, p->actx, 0, f->ndir, c->centre_jet, &c->box_jet);
}

void constraint_close(const field *f, constraint *c) {
  if (c->centre_jet) f->jet->close(c->centre_jet);
  if (c->box_jet) f->jet->close(c->box_jet);
}

/* -- invariants over the set, and over a part of it */

static uint32_t evaluate_centre(const field *f, const set *x, ambit_jet *jet) {
  flow_put_centre(f, x, jet);
  if (f->problem.uses_time) f->jet->put(jet, f->nx + f->np, 0, x->t, 0, NULL, NULL);
  return f->jet->advance(jet, 0);
}

static uint32_t evaluate_box(const field *f, const set *x, part of, ambit_jet *jet) {
  flow_put_box(f, x, of, jet);
  if (f->problem.uses_time) f->jet->put(jet, f->nx + f->np, 0, x->t, 0, NULL, NULL);
  return f->jet->advance(jet, 0);
}

static void get_slopes(const field *f, const constraint *c, uint32_t r, balls slope) {
  double mid, rad;
  f->jet->get(c->box_jet, f->problem.invariant->out[r], 0, &mid, &rad, slope.mid, slope.rad);
}

/* Slopes over the whole set; their midpoints are the linear part. */
static int take_whole(const field *f, const set *x, constraint *c) {
  /* slopes build on the centre */
  if (evaluate_centre(f, x, c->centre_jet) || evaluate_box(f, x, f->whole, c->box_jet)) return 0;
  for (uint32_t r = 0; r < c->k; r++) {
    balls slope = balls_at(c->slope, (size_t)r * f->ndir);
    get_slopes(f, c, r, slope);
    slopes_beyond(f, x, slope, slope.mid, f->whole, &c->low[r], &c->high[r]);
  }
  return 1;
}

/* What the linear part lacks is quadratic: bounded piece by piece, as in slopes.c. */
static void take_pieces(const field *f, const set *x, const pieces *all, constraint *c) {
  for (uint32_t k = 0; k < all->count; k++) {
    if (evaluate_box(f, x, all->part[k], c->box_jet)) {
      take_whole(f, x, c);
      return;
    }
    for (uint32_t r = 0; r < c->k; r++) {
      double low, high;
      get_slopes(f, c, r, c->part);
      slopes_beyond(f, x, c->part, c->slope.mid + (size_t)r * f->ndir, all->part[k], &low, &high);
      c->low[r] = k ? larger_or_nan(c->low[r], low) : low;
      c->high[r] = k ? larger_or_nan(c->high[r], high) : high;
    }
  }
}

int constraint_linearise(const field *f, const set *x, const pieces *all, constraint *c) {
  if (!take_whole(f, x, c)) return 0;
  if (all && all->count > 1) take_pieces(f, x, all, c);
  for (uint32_t r = 0; r < c->k; r++) {
    ball g;
    f->jet->get(c->centre_jet, f->problem.invariant->out[r], 0, &g.mid, &g.rad, NULL, NULL);
    g = ball_add(g, ball_of(c->low[r], c->high[r]));
    c->value[r] = g.mid, c->varies[r] = g.rad;
    if (!(fabs(g.mid) + g.rad < INFINITY)) return 0;
  }
  return 1;
}
