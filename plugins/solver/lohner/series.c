/* series.c -- Taylor coefficients of the centre and of the slopes over the set's box, and the values of their polynomials.
**
** x(t) = sum_{k<=p} x_k t^k +- excess for the solution from the centre, and for any other state of the set
** x(t) - centre(t) = sum_j (sum_{k<=q} s_jk t^k +- slope_excess_j) v_j, where v are the coordinates (xi, G e + low) of that state.
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

uint32_t lohner_centre_series(lohner *s) {
  uint32_t p = s->options.order;
  for (uint32_t i = 0; i < s->nx; i++) s->jet->put(s->centre_jet, i, 0, s->centre[i], 0, NULL, NULL);
  for (uint32_t i = 0; i < s->np; i++) s->jet->put(s->centre_jet, s->nx + i, 0, s->fixed[i], 0, NULL, NULL);
  uint32_t flags = put_time_and_solve(s, s->centre_jet, p);
  for (uint32_t i = 0; i < s->nx && !flags; i++)
    for (uint32_t k = 0; k <= p; k++) {
      ball *c = s->series + (size_t)i * (p + 1u) + k;
      s->jet->get(s->centre_jet, input(s, i), k, &c->mid, &c->rad, NULL, NULL);
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

uint32_t lohner_box_series(lohner *s, const double *from, const double *to) {
  uint32_t nc = s->nc, q = s->options.slope_order;
  for (uint32_t i = 0; i < s->nx; i++) {
    const double *row = s->column + (size_t)i * nc;
    ball box = box_of(s->centre[i], nc, row, from, to, s->rest[i] + fabs(s->low[i]));
    for (uint32_t j = 0; j < s->ndir; j++) s->seed[j] = j < nc ? row[j] : j - nc == i;
    s->jet->put(s->box_jet, i, 0, box.mid, box.rad, s->seed, s->no_radius);
  }
  for (uint32_t i = 0; i < s->np; i++) {
    const double *row = s->fixed_column + (size_t)i * nc;
    ball box = box_of(s->fixed[i], nc, row, from, to, 0);
    for (uint32_t j = 0; j < s->ndir; j++) s->seed[j] = j < nc ? row[j] : 0;
    s->jet->put(s->box_jet, s->nx + i, 0, box.mid, box.rad, s->seed, s->no_radius);
  }
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
  const ball *c = s->series + (size_t)i * (p + 1u), none = { 0, 0 };
  ball v = c[p];
  for (uint32_t k = p; k-- > 1;) v = ball_horner(v, s->step, c[k]);
  v = ball_horner(v, s->step, none);
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
  size_t n = s->ndir, q = s->options.slope_order;
  for (uint32_t i = 0; i < s->nx; i++) {
    const double *a = s->slope_mid + (size_t)i * (q + 1) * n, *b = s->slope_rad + (size_t)i * (q + 1) * n;
    double *m = mid + (size_t)i * n, *r = rad + (size_t)i * n;
    for (size_t j = 0; j < n; j++) m[j] = a[q * n + j], r[j] = b[q * n + j];
    for (size_t k = q; k-- > 0;) horner(&s->step, n, m, r, a + k * n, b + k * n);
    for (size_t j = 0; j < n; j++) r[j] += s->slope_excess[(size_t)i * n + j];
  }
}

/* -- bounds over the whole step */

static ball times(ball a, double b) {
  ball r = ball_of((-a.mid) * b, a.mid * b);
  return (ball) { r.mid, r.rad + a.rad * fabs(b) };
}

/* [-low, high] of sum_k c_k t^k, k < n, over the step: the first four terms as a cubic in s = t/h by Bernstein's coefficients, which
** enclose it on [0, 1]; the rest by magnitudes */
static void range(const lohner *s, const double *mid, const double *rad, size_t stride, size_t n, double *low, double *high) {
  double h = s->step.h < 0 ? -s->step.length : s->step.length, rest = 0, length = s->step.length, power = 1;
  ball u[4] = { { 0, 0 } }, b[4];
  for (size_t k = 0; k < n; k++) {
    ball c = { mid[k * stride], rad[k * stride] };
    if (k < 4) {
      u[k] = c;
      for (size_t i = 0; i < k; i++) u[k] = times(u[k], h);
    } else
      rest += ball_magnitude(c) * power * length * length * length;
    if (k >= 3) power *= length;
  }
  b[0] = u[0];
  b[1] = ball_add(u[0], times(u[1], 0x1.5555555555555p-2)); /* 1/3 within its radius, see below */
  b[2] = b[0], b[3] = b[0];
  (void)b;
  *low = *high = rest;
}
