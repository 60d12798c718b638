/* invariant.c -- the invariants, linear over the set.
**
** For every state x of the set with coordinates v = (xi, G e + low),
**   g(x, p, t) = g(m, p_c, t) + S v,   S in slope_mid +- slope_rad,
** with slopes about the midpoint as those of the flow (series.c), of order zero. Columns are formed inside the slopes,
** so what an invariant does not see of an uncertain datum cancels there, and a datum that it depends on itself (a
** length in a closed loop) is seen. The series say nothing where some invariant is undefined or has a kink in the set
** (|x| around 0); then none is used.
*/
#include "lohner.h"

static void *room(const ambit_host *h, size_t count, size_t size) { return h->alloc(h, count ? count * size : size); }

static int allocate(lohner *s) {
  constraint *c = &s->constraint;
  size_t k = c->k, nx = s->nx, nd = s->ndir;
  const struct {
    double **array;
    size_t count;
  } list[] = { { &c->from, s->nc }, { &c->to, s->nc }, { &c->value, k }, { &c->varies, k }, { &c->slope_mid, k * nd },
    { &c->slope_rad, k * nd }, { &c->part_mid, nd }, { &c->part_rad, nd }, { &c->low, k }, { &c->high, k },
    { &c->away, nx * s->nc }, { &c->outward, k * s->nc }, { &c->spread, k * s->history.pitch }, { &c->cross, k * nx },
    { &c->gain, k * nx }, { &c->normal, k * k }, { &c->whole, k }, { &c->done, k }, { &c->unit, k }, { &c->before, nx },
    { &c->move, nx * nx }, { &c->pivot_mid, k * nx }, { &c->pivot_rad, k * nx }, { &c->largest, k }, { &c->least, k } };
  for (size_t i = 0; i < sizeof list / sizeof *list; i++)
    if (!(*list[i].array = room(s->host, list[i].count, sizeof(double)))) return 0;
  return 1;
}

ambit_status lohner_open_invariants(lohner *s) {
  const ambit_problem *p = &s->problem;
  constraint *c = &s->constraint;
  c->k = p->invariant ? p->ninvariant : 0;
  if (c->k == 0) return AMBIT_OK;
  if (!allocate(s)) return s->host->fail(s->host, AMBIT_NOMEM, "lohner: out of memory");
  for (uint32_t j = 0; j < s->nc; j++) c->from[j] = -1, c->to[j] = 1;
  ambit_status status = s->jet->open(s->host, p->invariant, p->arithmetic, p->actx, 0, 0, NULL, &c->centre_jet);
  if (status != AMBIT_OK) return status;
  return s->jet->open(s->host, p->invariant, p->arithmetic, p->actx, 0, s->ndir, c->centre_jet, &c->box_jet);
}

void lohner_close_invariants(lohner *s) {
  if (s->constraint.centre_jet) s->jet->close(s->constraint.centre_jet);
  if (s->constraint.box_jet) s->jet->close(s->constraint.box_jet);
}

static void put_time(const lohner *s, ambit_jet *jet, double t) {
  if (s->problem.uses_time) s->jet->put(jet, s->nx + s->np, 0, t, 0, NULL, NULL);
}

static uint32_t evaluate_centre(lohner *s, double t) {
  lohner_put_centre(s, s->constraint.centre_jet);
  put_time(s, s->constraint.centre_jet, t);
  return s->jet->advance(s->constraint.centre_jet, 0);
}

static uint32_t evaluate_box(lohner *s, double t, const double *from, const double *to) {
  lohner_put_box(s, s->constraint.box_jet, from, to);
  put_time(s, s->constraint.box_jet, t);
  return s->jet->advance(s->constraint.box_jet, 0);
}

static void get_slopes(const lohner *s, uint32_t r, double *slope_mid, double *slope_rad) {
  double mid, rad;
  s->jet->get(s->constraint.box_jet, s->problem.invariant->out[r], 0, &mid, &rad, slope_mid, slope_rad);
}

/* Slopes over the whole set; their midpoints are the linear part. */
static int take_whole(lohner *s, double t) {
  constraint *c = &s->constraint;
  if (evaluate_centre(s, t) || evaluate_box(s, t, c->from, c->to)) return 0; /* slopes build on the centre */
  for (uint32_t r = 0; r < c->k; r++) {
    double *mid = c->slope_mid + (size_t)r * s->ndir, *rad = c->slope_rad + (size_t)r * s->ndir;
    get_slopes(s, r, mid, rad);
    lohner_beyond(s, mid, rad, mid, c->from, c->to, &c->low[r], &c->high[r]);
  }
  return 1;
}

/* What the linear part lacks is quadratic: bounded piece by piece, as in set.c. */
static void take_pieces(lohner *s, double t, uint32_t pieces) {
  constraint *c = &s->constraint;
  for (uint32_t k = 0; k < pieces; k++) {
    const double *from = s->piece_from + (size_t)k * s->nc, *to = s->piece_to + (size_t)k * s->nc;
    if (evaluate_box(s, t, from, to)) {
      take_whole(s, t);
      return;
    }
    for (uint32_t r = 0; r < c->k; r++) {
      double low, high;
      get_slopes(s, r, c->part_mid, c->part_rad);
      lohner_beyond(s, c->part_mid, c->part_rad, c->slope_mid + (size_t)r * s->ndir, from, to, &low, &high);
      c->low[r] = k ? larger_or_nan(c->low[r], low) : low;
      c->high[r] = k ? larger_or_nan(c->high[r], high) : high;
    }
  }
}

int lohner_linearise(lohner *s, double t, uint32_t pieces) {
  constraint *c = &s->constraint;
  if (!take_whole(s, t)) return 0;
  if (pieces > 1) take_pieces(s, t, pieces);
  for (uint32_t r = 0; r < c->k; r++) {
    ball g;
    s->jet->get(c->centre_jet, s->problem.invariant->out[r], 0, &g.mid, &g.rad, NULL, NULL);
    g = ball_add(g, ball_of(c->low[r], c->high[r]));
    c->value[r] = g.mid, c->varies[r] = g.rad;
    if (!(fabs(g.mid) + g.rad < INFINITY)) return 0;
  }
  return 1;
}
