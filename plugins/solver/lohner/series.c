/* series.c -- Taylor coefficients of the centre and of the slopes over the set's box, and the values of their
** polynomials.
**
** x(t) = sum_{k<=p} x_k t^k +- excess for the solution from the centre, and for any other state of the set x(t) -
** centre(t) = sum_j (sum_{k<=q} s_jk t^k +- slope_excess_j) v_j, where v are the coordinates (xi, G e + low) of that
** state.
*/
#include "lohner.h"

static uint32_t input(const lohner *s, uint32_t in) { return s->problem.rhs->nconst + in; }

static uint32_t put_time_and_solve(lohner *s, ambit_jet *jet, uint32_t order) {
  if (s->problem.uses_time) {
    s->jet->put(jet, s->nx + s->np, 0, s->t, 0, NULL, NULL);
    s->jet->put(jet, s->nx + s->np, 1, 1, 0, NULL, NULL);
  }
  return s->jet->solve(jet, s->nx, order);
}

void lohner_put_centre(const lohner *s, ambit_jet *jet) {
  for (uint32_t i = 0; i < s->nx; i++) s->jet->put(jet, i, 0, s->centre[i], 0, NULL, NULL);
  for (uint32_t i = 0; i < s->np; i++) s->jet->put(jet, s->nx + i, 0, s->fixed[i], 0, NULL, NULL);
}

uint32_t lohner_centre_series(lohner *s) {
  uint32_t p = s->options.order;
  lohner_put_centre(s, s->centre_jet);
  uint32_t flags = put_time_and_solve(s, s->centre_jet, p);
  for (uint32_t i = 0; i < s->nx && !flags; i++)
    for (uint32_t k = 0; k <= p; k++) {
      size_t at = (size_t)i * (p + 1u) + k;
      s->jet->get(s->centre_jet, input(s, i), k, &s->series_mid[at], &s->series_rad[at], NULL, NULL);
    }
  return flags;
}

/* centre + row xi over xi in [from, to], with more of radius `rest` */
static ball box_of(double centre, uint32_t nc, const double *row, const double *from, const double *to, double rest) {
  double low = rest - centre, high = centre + rest;
  for (uint32_t j = 0; j < nc; j++) {
    low += larger((-row[j]) * from[j], (-row[j]) * to[j]);
    high += larger(row[j] * from[j], row[j] * to[j]);
  }
  return ball_of(low, high);
}

static void put_parameter(lohner *s, ambit_jet *jet, uint32_t i, const double *from, const double *to) {
  const double *row = s->fixed_column + (size_t)i * s->nc;
  ball box = box_of(s->fixed[i], s->nc, row, from, to, 0);
  for (uint32_t j = 0; j < s->ndir; j++) s->seed[j] = j < s->nc ? row[j] : 0;
  s->jet->put(jet, s->nx + i, 0, box.mid, box.rad, s->seed, s->no_radius);
}

void lohner_put_parameter(lohner *s, ambit_jet *jet, uint32_t i) { put_parameter(s, jet, i, s->all_from, s->all_to); }

void lohner_put_box(lohner *s, ambit_jet *jet, const double *from, const double *to) {
  uint32_t nc = s->nc;
  for (uint32_t i = 0; i < s->nx; i++) {
    const double *row = s->column + (size_t)i * nc;
    ball box = box_of(s->centre[i], nc, row, from, to, s->rest[i] + fabs(s->low[i]));
    for (uint32_t j = 0; j < s->ndir; j++) s->seed[j] = j < nc ? row[j] : j - nc == i;
    s->jet->put(jet, i, 0, box.mid, box.rad, s->seed, s->no_radius);
  }
  for (uint32_t i = 0; i < s->np; i++) put_parameter(s, jet, i, from, to);
}

uint32_t lohner_box_series(lohner *s, const double *from, const double *to) {
  uint32_t q = s->slope_order;
  lohner_put_box(s, s->box_jet, from, to);
  uint32_t flags = put_time_and_solve(s, s->box_jet, q);
  for (uint32_t i = 0; i < s->nx && !flags; i++)
    for (uint32_t k = 0; k <= q; k++) {
      double mid, rad;
      size_t at = ((size_t)i * (q + 1u) + k) * s->ndir;
      s->jet->get(s->box_jet, input(s, i), k, &mid, &rad, s->slope_mid + at, s->slope_rad + at);
    }
  return flags;
}

ball lohner_increment(const lohner *s, uint32_t i) {
  uint32_t p = s->options.order;
  const double *mid = s->series_mid + (size_t)i * (p + 1u), *rad = s->series_rad + (size_t)i * (p + 1u);
  ball v = { mid[p], rad[p] };
  for (uint32_t k = p; k-- > 1;) v = ball_horner(v, s->step, (ball) { mid[k], rad[k] });
  v = ball_horner(v, s->step, (ball) { 0, 0 });
  v.rad += s->excess[i];
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

void lohner_transfer(const lohner *s, double *mid, double *rad) {
  size_t n = s->ndir, q = s->slope_order;
  for (uint32_t i = 0; i < s->nx; i++) {
    const double *a = s->slope_mid + (size_t)i * (q + 1) * n, *b = s->slope_rad + (size_t)i * (q + 1) * n;
    double *m = mid + (size_t)i * n, *r = rad + (size_t)i * n;
    for (size_t j = 0; j < n; j++) m[j] = a[q * n + j], r[j] = b[q * n + j];
    for (size_t k = q; k-- > 0;) horner(&s->step, n, m, r, a + k * n, b + k * n);
    for (size_t j = 0; j < n; j++) r[j] += s->slope_excess[(size_t)i * n + j];
  }
}

double lohner_reach(const lohner *s, uint32_t j) {
  return j < s->nc ? 1 : s->rest[j - s->nc] + fabs(s->low[j - s->nc]);
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
static bounds range(const lohner *s, size_t n, const double *mid, const double *rad, size_t stride) {
  double length = s->step.length, h = s->step.h < 0 ? -length : length, rest = 0;
  for (size_t k = n; k-- > 4;) rest = rest * length + (fabs(mid[k * stride]) + rad[k * stride]);
  for (int i = 0; i < 4; i++) rest *= length;
  ball u[4];
  for (size_t k = 0; k < 4; k++) {
    u[k] = (ball) { mid[k * stride], rad[k * stride] };
    for (size_t i = 0; i < k; i++) u[k] = times(u[k], h);
  }
  ball start = times(u[0], 3), second = ball_add(start, u[1]);
  ball third = ball_add(ball_add(start, times(u[1], 2)), u[2]);
  ball end = times(ball_add(ball_add(u[0], u[1]), ball_add(u[2], u[3])), 3);
  bounds b = { -INFINITY, -INFINITY };
  b = widest(widest(widest(widest(b, start), second), third), end);
  return (bounds) { b.low / 3 + rest, b.high / 3 + rest };
}

static bounds slope_range(const lohner *s, uint32_t i, uint32_t j) {
  size_t n = s->ndir, q = s->slope_order, at = (size_t)i * (q + 1) * n + j;
  return range(s, q + 1, s->slope_mid + at, s->slope_rad + at, n);
}

ball lohner_slope_over_step(const lohner *s, uint32_t i, uint32_t j) {
  bounds b = slope_range(s, i, j);
  ball r = ball_of(b.low, b.high);
  return (ball) { r.mid, r.rad + s->slope_excess[(size_t)i * s->ndir + j] };
}

void lohner_tube(lohner *s) {
  size_t p = s->options.order, n = s->ndir;
  for (uint32_t i = 0; i < s->nx; i++) {
    size_t at = (size_t)i * (p + 1);
    bounds b = range(s, p + 1, s->series_mid + at, s->series_rad + at, 1);
    double rest = s->excess[i];
    for (size_t j = 0; j < n; j++) {
      double reach = lohner_reach(s, (uint32_t)j);
      if (reach == 0) continue;
      bounds d = slope_range(s, i, (uint32_t)j);
      rest += (larger(d.low, d.high) + s->slope_excess[(size_t)i * n + j]) * reach;
    }
    s->tube_lo[i] = -(b.low + rest);
    s->tube_hi[i] = b.high + rest;
  }
}
