/* flow.c -- Taylor coefficients of the midpoint and of the slopes over the set's box, and the values of their
** polynomials (flow.h).
*/
#include "set.h"

#define MANY_STEPS                                                                                                     \
  64 /* in a run of so many steps each may lose its share; in longer runs less, so that the sum is bounded */

ambit_status flow_open(const field *f, flow *phi) {
  const ambit_problem *problem = &f->problem;
  size_t nx = f->nx, nd = f->ndir, nin = problem->rhs->nin, p = f->options.order, q = f->options.slope_order_max;
  const request list[] = { { &phi->centre.mid, nx * (p + 1) }, { &phi->centre.rad, nx * (p + 1) },
    { &phi->slope.mid, nx * (q + 1) * nd }, { &phi->slope.rad, nx * (q + 1) * nd }, { &phi->excess, nx },
    { &phi->slope_excess, nx * nd }, { &phi->box_excess, nx }, { &phi->tube_lo, nx }, { &phi->tube_hi, nx },
    { &phi->eps, nx }, { &phi->slope_eps, nx * nd }, { &phi->tail_in, nin }, { &phi->dtail_in, nin * nd },
    { &phi->tail_out, nx }, { &phi->dtail_out, nx * nd } };
  if (!field_allocate(f->host, sizeof list / sizeof *list, list)) return field_no_memory(f->host);
  phi->p = f->options.order;
  ambit_status status =
      f->jet->open(f->host, problem->rhs, problem->arithmetic, problem->actx, phi->p, 0, NULL, &phi->centre_jet);
  if (status != AMBIT_OK) return status;
  return f->jet->open(f->host, problem->rhs, problem->arithmetic, problem->actx, f->options.slope_order_max, f->ndir,
      phi->centre_jet, &phi->box_jet);
}

void flow_close(const field *f, flow *phi) {
  if (phi->centre_jet) f->jet->close(phi->centre_jet);
  if (phi->box_jet) f->jet->close(phi->box_jet);
}

double flow_share_of_time(const field *f, const flow *phi) {
  return smaller(1, MANY_STEPS * phi->step.length / field_span(f));
}

/* -- series */

static uint32_t input(const field *f, uint32_t in) { return f->problem.rhs->nconst + in; }

static uint32_t put_time_and_solve(const field *f, double t, ambit_jet *jet, uint32_t order) {
  if (f->problem.uses_time) {
    f->jet->put(jet, f->nx + f->np, 0, t, 0, NULL, NULL);
    f->jet->put(jet, f->nx + f->np, 1, 1, 0, NULL, NULL);
  }
  return f->jet->solve(jet, f->nx, order);
}

void flow_put_centre(const field *f, const set *x, ambit_jet *jet) {
  for (uint32_t i = 0; i < f->nx; i++) f->jet->put(jet, i, 0, x->centre[i], 0, NULL, NULL);
  for (uint32_t i = 0; i < f->np; i++) f->jet->put(jet, f->nx + i, 0, f->fixed[i], 0, NULL, NULL);
}

uint32_t flow_centre_series(const field *f, const set *x, flow *phi) {
  uint32_t p = phi->p;
  flow_put_centre(f, x, phi->centre_jet);
  uint32_t flags = put_time_and_solve(f, x->t, phi->centre_jet, p);
  for (uint32_t i = 0; i < f->nx && !flags; i++)
    for (uint32_t k = 0; k <= p; k++) {
      balls c = balls_at(phi->centre, (size_t)i * (p + 1u) + k);
      f->jet->get(phi->centre_jet, input(f, i), k, c.mid, c.rad, NULL, NULL);
    }
  return flags;
}

/* centre + row xi over a part of the cube of xi, with more of radius `rest` */
static ball box_of(double centre, uint32_t nc, const double *row, part of, double rest) {
  double low = rest - centre, high = centre + rest;
  for (uint32_t j = 0; j < nc; j++) {
    low += larger((-row[j]) * of.from[j], (-row[j]) * of.to[j]);
    high += larger(row[j] * of.from[j], row[j] * of.to[j]);
  }
  return ball_of(low, high);
}

void flow_put_parameter(const field *f, part of, ambit_jet *jet, uint32_t i) {
  const double *row = f->fixed_column + (size_t)i * f->nc;
  ball box = box_of(f->fixed[i], f->nc, row, of, 0);
  for (uint32_t j = 0; j < f->ndir; j++) f->seed[j] = j < f->nc ? row[j] : 0;
  f->jet->put(jet, f->nx + i, 0, box.mid, box.rad, f->seed, NULL);
}

void flow_put_box(const field *f, const set *x, part of, ambit_jet *jet) {
  uint32_t nc = f->nc;
  for (uint32_t i = 0; i < f->nx; i++) {
    const double *row = x->column + (size_t)i * nc;
    ball box = box_of(x->centre[i], nc, row, of, x->rest[i] + fabs(x->low[i]));
    for (uint32_t j = 0; j < f->ndir; j++) f->seed[j] = j < nc ? row[j] : j - nc == i;
    f->jet->put(jet, i, 0, box.mid, box.rad, f->seed, NULL);
  }
  for (uint32_t i = 0; i < f->np; i++) flow_put_parameter(f, of, jet, i);
}

uint32_t flow_box_series(const field *f, const set *x, part of, flow *phi) {
  uint32_t q = phi->q;
  flow_put_box(f, x, of, phi->box_jet);
  uint32_t flags = put_time_and_solve(f, x->t, phi->box_jet, q);
  for (uint32_t i = 0; i < f->nx && !flags; i++)
    for (uint32_t k = 0; k <= q; k++) {
      double mid, rad;
      balls s = balls_at(phi->slope, ((size_t)i * (q + 1u) + k) * f->ndir);
      f->jet->get(phi->box_jet, input(f, i), k, &mid, &rad, s.mid, s.rad);
    }
  return flags;
}

/* -- the end of the step */

ball flow_increment(const flow *phi, uint32_t i) {
  uint32_t p = phi->p;
  balls x = balls_at(phi->centre, (size_t)i * (p + 1u));
  ball v = { x.mid[p], x.rad[p] };
  for (uint32_t k = p; k-- > 1;) v = ball_horner(v, phi->step, (ball) { x.mid[k], x.rad[k] });
  v = ball_horner(v, phi->step, (ball) { 0, 0 });
  v.rad += phi->excess[i];
  return v;
}

/* m, r := (m +- r) h + (a +- b), all directions */
static void horner(const span *t, size_t n, double *restrict m, double *restrict r, const double *restrict a,
    const double *restrict b) {
  for (size_t j = 0; j < n; j++) {
    double high = m[j] * t->h + a[j], low = (-m[j]) * t->h - a[j];
    double rad = r[j] * t->length + fabs(m[j]) * t->error + b[j];
    m[j] = 0.5 * (high - low);
    r[j] = rad + larger(high - m[j], m[j] + low);
  }
}

void flow_slopes_at_end(const field *f, const flow *phi, balls S) {
  size_t n = f->ndir, q = phi->q;
  for (uint32_t i = 0; i < f->nx; i++) {
    balls s = balls_at(phi->slope, (size_t)i * (q + 1) * n);
    double *m = S.mid + (size_t)i * n, *r = S.rad + (size_t)i * n;
    for (size_t j = 0; j < n; j++) m[j] = s.mid[q * n + j], r[j] = s.rad[q * n + j];
    for (size_t k = q; k-- > 0;) horner(&phi->step, n, m, r, s.mid + k * n, s.rad + k * n);
    for (size_t j = 0; j < n; j++) r[j] += phi->slope_excess[(size_t)i * n + j];
  }
}

/* -- bounds over the whole step */

static ball times(ball a, double b) {
  ball r = ball_of((-a.mid) * b, a.mid * b);
  return (ball) { r.mid, r.rad + a.rad * fabs(b) };
}

typedef struct bounds { /* [-low, high] */
  double low, high;
} bounds;

static bounds widest(bounds a, ball b) {
  return (bounds) { larger(a.low, b.rad - b.mid), larger(a.high, b.mid + b.rad) };
}

/* Of sum_{k<n} c_k t^k over the step, n >= 4: with s = t/h the first four terms are a cubic on [0, 1], which lies
** within its Bernstein coefficients b_0 .. b_3 [Farouki 2012]; here three times these. The rest by magnitudes. */
static bounds range(span step, size_t n, balls c, size_t stride) {
  double length = step.length, h = step.h < 0 ? -length : length, rest = 0;
  for (size_t k = n; k-- > 4;) rest = rest * length + (fabs(c.mid[k * stride]) + c.rad[k * stride]);
  for (int i = 0; i < 4; i++) rest *= length;
  ball u[4];
  for (size_t k = 0; k < 4; k++) {
    u[k] = (ball) { c.mid[k * stride], c.rad[k * stride] };
    for (size_t i = 0; i < k; i++) u[k] = times(u[k], h);
  }
  ball start = times(u[0], 3), second = ball_add(start, u[1]);
  ball third = ball_add(ball_add(start, times(u[1], 2)), u[2]);
  ball end = times(ball_add(ball_add(u[0], u[1]), ball_add(u[2], u[3])), 3);
  bounds b = { -INFINITY, -INFINITY };
  b = widest(widest(widest(widest(b, start), second), third), end);
  return (bounds) { b.low / 3 + rest, b.high / 3 + rest };
}

static bounds slope_range(const field *f, const flow *phi, uint32_t i, uint32_t j) {
  size_t n = f->ndir, q = phi->q;
  return range(phi->step, q + 1, balls_at(phi->slope, (size_t)i * (q + 1) * n + j), n);
}

ball flow_slope_over_step(const field *f, const flow *phi, uint32_t i, uint32_t j) {
  bounds b = slope_range(f, phi, i, j);
  ball r = ball_of(b.low, b.high);
  return (ball) { r.mid, r.rad + phi->slope_excess[(size_t)i * f->ndir + j] };
}

void flow_tube(const field *f, const set *x, flow *phi) {
  size_t p = phi->p, n = f->ndir;
  for (uint32_t i = 0; i < f->nx; i++) {
    bounds b = range(phi->step, p + 1, balls_at(phi->centre, (size_t)i * (p + 1)), 1);
    double rest = phi->excess[i];
    for (size_t j = 0; j < n; j++) {
      double reach = set_reach(f, x, (uint32_t)j);
      if (reach == 0) continue;
      bounds d = slope_range(f, phi, i, (uint32_t)j);
      rest += (larger(d.low, d.high) + phi->slope_excess[(size_t)i * n + j]) * reach;
    }
    phi->tube_lo[i] = -(b.low + rest);
    phi->tube_hi[i] = b.high + rest;
  }
}
