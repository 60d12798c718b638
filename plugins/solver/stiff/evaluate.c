/* evaluate.c -- the right-hand side and its slopes along a piece. Round-to-nearest; what is returned is proved, except
** rates. */
#include "stiff.h"
#include <string.h>

#define SLACK (1 + 0x1p-40)

/* the time along piece j of m: t + h (2 j + 1) / (2 m) + half s; both operations on double-doubles below are off by at
** most 16 u^2 of what they are given */
static void put_time(const stiff *s, poly *r, uint32_t j, uint32_t m) {
  dd middle = dd_add((dd) { s->t, 0 }, dd_scale(s->h, (2.0 * j + 1) / (2.0 * m)));
  poly_set(r, 0, middle);
  poly_set(r, 1, s->half);
  r->n = 2;
  r->tail = 32 * DD_U * DD_U * (fabs(s->t) + fabs(s->h.hi)) * SLACK + DD_TINY;
}

/* r := a, no more than `room` coefficients, with a further radius */
static void put(poly *r, const poly *a, uint32_t room, double radius) {
  double rest = radius + a->tail;
  r->n = a->n < room ? a->n : room;
  for (uint32_t k = 0; k < r->n; k++) poly_set(r, k, poly_get(a, k));
  for (uint32_t k = room; k < a->n; k++) rest += fabs(a->hi[k]) * (1 + 2 * DD_U);
  r->tail = rest > 0 ? rest * SLACK : 0;
}

static const fields *put_fields(stiff *s, fields *to, const double *box, uint32_t j, uint32_t m) {
  spread_put(s, to, box);
  if (s->problem.uses_time) {
    field *time = fields_input(to, s->inputs);
    field_constant(to, time, (dd) { 0, 0 }, 0);
    put_time(s, &time->c, j, m);
  }
  fields_run(to);
  return to;
}

static void put_inputs(stiff *s, series *to, const double *box, uint32_t j, uint32_t m) {
  for (uint32_t i = 0; i < s->n; i++) put(series_input(to, i), &s->P[i], to->order + 1, box ? box[i] : 0);
  if (s->problem.uses_time) put_time(s, series_input(to, s->inputs), j, m);
}

/* r := half a */
static void halve(const stiff *s, poly *r, const poly *a) {
  double hi = s->half.hi, lo = s->half.lo;
  const poly half = { 1, &hi, &lo, 0 };
  poly_mul(r, a->n, a, &half);
}

/* sum_k (+-1)^k u_k; every one of its additions is off by at most 4 u^2 times the sum of magnitudes so far, twice */
static dd value_at_end(const poly *p, int at, double *error) {
  dd sum = { 0, 0 };
  double size = 0;
  for (uint32_t k = p->n; k-- > 0;) {
    dd x = poly_get(p, k);
    sum = dd_add(sum, at < 0 && k % 2 ? dd_neg(x) : x);
    size += fabs(x.hi);
  }
  *error = (9.0 * p->n * DD_U * DD_U * size + DD_TINY) * SLACK;
  return sum;
}

void evaluate_gap(stiff *s) {
  for (uint32_t i = 0; i < s->n; i++) {
    double error;
    dd at = value_at_end(&s->P[i], -1, &error), gap = dd_sub(s->end[i], at);
    s->gap[i] = gap.hi;
    error += fabs(gap.lo) + 5 * DD_U * DD_U * (fabs(at.hi) + fabs(s->end[i].hi)) + s->end_error[i];
    if (s->spread) error += spread_gap(s, i);
    s->gap_error[i] = error * SLACK;
  }
}

void evaluate_end(stiff *s) {
  for (uint32_t i = 0; i < s->n; i++) {
    s->end[i] = value_at_end(&s->P[i], 1, &s->end_error[i]);
    if (s->spread) s->end_error[i] = (s->end_error[i] + spread_end(s, i)) * SLACK;
  }
}

int evaluate_defect(stiff *s, uint32_t j, uint32_t m) {
  uint32_t w = (s->q.N + 1) * (s->spread ? s->terms.count : 1);
  poly *rate = &s->rhs.scratch[0], *slope = &s->rhs.scratch[1];
  if (s->spread)
    put_fields(s, &s->rhs_field, NULL, j, m);
  else {
    put_inputs(s, &s->rhs, NULL, j, m);
    series_run(&s->rhs);
  }
  for (uint32_t i = 0; i < s->nx; i++) {
    const poly *f = s->spread ? &fields_output(&s->rhs_field, i)->c : series_output(&s->rhs, i);
    if (!(f->tail < INFINITY)) return 0;
    halve(s, rate, f);
    poly_derive(slope, &s->P[i]);
    poly_add(slope, slope, rate, -1);
    double rest = slope->tail;
    for (uint32_t k = 0; k <= s->q.N; k++) s->defect[i * w + k] = k < slope->n ? slope->hi[k] : 0;
    for (uint32_t k = 0; k < slope->n; k++) rest += fabs(slope->lo[k]);
    if (s->spread) spread_defect(s, i, fields_output(&s->rhs_field, i), &rest);
    s->defect_tail[i] = rest * SLACK;
    if (!(rest < INFINITY)) return 0;
  }
  return 1;
}

/* `rows` bounds what is not in a */
static int take(stiff *s, const poly *a, double rows, uint32_t entry) {
  slopes *r = &s->slopes;
  poly *x = &s->jacobian.scratch[0];
  if (!(a->tail < INFINITY)) return 0;
  halve(s, x, a);
  double rest = x->tail + rows * fabs(s->half.hi) * SLACK;
  r->count[entry] = x->n;
  for (uint32_t k = 0; k < x->n; k++) {
    r->coefficient[(size_t)entry * (SLOPE_ORDER + 1) + k] = x->hi[k];
    rest += fabs(x->lo[k]);
  }
  r->tail[entry] = rest * SLACK;
  return rest < INFINITY;
}

static int evaluate_slope_fields(stiff *s, uint32_t j, uint32_t m) {
  const fields *f = put_fields(s, &s->jacobian_field, s->box, j, m);
  for (uint32_t k = 0; k < s->nx * s->nx; k++) {
    const field *a = fields_output(f, k);
    if (!take(s, &a->c, field_rest(f, a), k)) return 0;
  }
  return 1;
}

int evaluate_slopes(stiff *s, uint32_t j, uint32_t m) {
  if (s->spread) return evaluate_slope_fields(s, j, m);
  put_inputs(s, &s->jacobian, s->box, j, m);
  series_run(&s->jacobian);
  if (s->np) {
    put_inputs(s, &s->slope, s->box, j, m);
    series_run(&s->slope);
  }
  for (uint32_t i = 0; i < s->nx; i++)
    for (uint32_t k = 0; k < s->n; k++) {
      int good = k < s->nx ? take(s, series_output(&s->jacobian, i * s->nx + k), 0, i * s->n + k)
                           : take(s, series_output(&s->slope, i * s->np + k - s->nx), 0, i * s->n + k);
      if (!good) return 0;
    }
  return 1;
}

/* -- without proof */

static void put_point(stiff *s, real *r, const long double *y, long double t) {
  memcpy(real_input(r, 0), y, s->nx * sizeof *y);
  memcpy(real_input(r, s->nx), s->q.x + s->nx, s->problem.np * sizeof *y);
  if (s->problem.uses_time) *real_input(r, s->inputs) = t;
  real_run(r);
}

void evaluate_rates(stiff *s, uint32_t m) {
  uint32_t n = s->n, nx = s->nx;
  long double y[N_MAX];
  for (uint32_t j = 0; j <= m; j++) {
    long double tau = -1 + 2.0L * j / m, t = s->t + 0.5L * s->h.hi * (tau + 1);
    double *J = s->rate + (size_t)j * n * n;
    memset(J, 0, (size_t)n * n * sizeof *J);
    collocation_value(&s->q, tau, y);
    put_point(s, &s->jacobian_real, y, t);
    if (s->np) put_point(s, &s->slope_real, y, t);
    for (uint32_t i = 0; i < nx; i++)
      for (uint32_t k = 0; k < n; k++) {
        long double x =
            k < nx ? real_output(&s->jacobian_real, i * nx + k) : real_output(&s->slope_real, i * s->np + k - nx);
        J[i * n + k] = (double)x * s->half.hi;
      }
    eigen_find(n, J, s->q.scale, &s->spectrum[j]);
  }
}
