/* functions.c -- elementary functions of polynomials with a radius.
**
** A polynomial y near f(u) is made by Horner's scheme from Taylor coefficients of f in plain arithmetic. It need not be
** good: what it is off by is proved afterwards. On the ray s -> s xi, 0 <= s <= 1, of the cube, y(s xi) and f(u(s xi))
** obey a differential equation with respect to s, where s d/ds is Euler's operator E = sum xi_j d/dxi_j; the residual
** R = E y - f'(..) E u is a polynomial (and what lies beyond degree d), and its part of degree j integrates to at most
** |R_j| / j over the ray. Proofs: docs/numerics/taylor_flow.md.
*/
#include "series.h"
#include <string.h>

#define BAD AMBIT_F_UNBOUNDED

typedef struct bounds {
  double lo, hi;
} bounds;

/* -- ranges */

void series_range(const series *s, cell x, double *low, double *high) {
  polynomial_bounds(s->space, x.c, low, high);
  double rad = cell_rad(x), about[UNKNOWNS_MAX] = { 0 }, reach[UNKNOWNS_MAX];
  *low = -(rad - *low), *high += rad;
  if (!(*low <= 0 && *high >= 0) || !(*high - *low < INFINITY)) return;
  for (uint32_t v = 0; v < s->space->m; v++) reach[v] = 1;
  search w = s->search;
  for (int upper = 0; upper < 2; upper++) {
    search_begin(&w, x.c, upper ? 1 : -1);
    search_add(&w, about, reach, rad);
    double bound = search_maximum(&w, 0, 1);
    if (upper)
      *high = smaller(*high, bound);
    else
      *low = larger(*low, -bound);
  }
}

static bounds range(const series *s, cell x) {
  bounds b;
  series_range(s, x, &b.lo, &b.hi);
  return b;
}

static double swing(cell u) { return cell_norm(u) - u.deg[0] + TINY; }

/* f([lo, hi]), outward */
static bounds enclose(const series *s, uint32_t op, bounds a, bounds b) {
  double x[2] = { a.lo, a.hi }, y[2] = { b.lo, b.hi }, r[2];
  if (s->num->map(op, 1, r, x, op == AMBIT_OP_ATAN2 ? y : NULL, 0)) return (bounds) { -INFINITY, INFINITY };
  return (bounds) { r[0], r[1] };
}

/* |f(u_0) - y_0| */
static double start_error(const series *s, uint32_t op, double u, double v, double y) {
  bounds f = enclose(s, op, (bounds) { u, u }, (bounds) { v, v });
  return larger(f.hi - y, y - f.lo);
}

static double exp_above(const series *s, double x) {
  return enclose(s, AMBIT_OP_EXP, (bounds) { x, x }, (bounds) { 0, 0 }).hi;
}

/* -- approximations; only as good as plain arithmetic */

static double first(const series *s, cell x) { return x.c[s->space->row[0].at]; }

/* to := a without its radius */
static void centre(const series *s, cell to, cell a) {
  cell_copy(s->space, to, a);
  to.info[RAD] = 0;
}

/* to := c_0 + c_1 v + .. + c_d v^d, v = u - u_0; radii are left out */
static void horner(series *s, cell to, const double *c, cell u) {
  const space *w = s->space;
  cell v = series_scratch(s, 3), x = series_scratch(s, 4);
  centre(s, v, u);
  v.c[w->row[0].at] = 0;
  cell_finish(w, v, 0);
  uint32_t n = v.info[TOP] > 0 ? w->d : 0;
  cell_constant(w, x, c[n], 0);
  for (uint32_t k = n; k-- > 0;) {
    sum_clear(w, &s->sum);
    sum_add(w, &s->sum, 1, x, v);
    sum_take(w, &s->sum, 1, x);
    x.c[w->row[0].at] += c[k];
    cell_finish(w, x, 0);
  }
  centre(s, to, x);
}

/* c_k = f^(k)(u)/k! of a function whose derivatives come back after two: f' = g, g' = sign f */
static void alternate(uint32_t d, double f, double g, double sign, double *c) {
  double factorial = 1;
  for (uint32_t k = 0; k <= d; k++) {
    c[k] = (k % 2 ? g : f) * (k % 4 >= 2 ? sign : 1) / factorial;
    factorial *= k + 1.0;
  }
}

static void expand(uint32_t op, uint32_t d, double u, double *c) {
  double q[3] = { 1 + u * u, 2 * u, 1 };
  switch (op) {
  case AMBIT_OP_SIN: alternate(d, sin(u), cos(u), -1, c); return;
  case AMBIT_OP_COS: alternate(d, cos(u), -sin(u), -1, c); return;
  case AMBIT_OP_SINH: alternate(d, sinh(u), cosh(u), 1, c); return;
  case AMBIT_OP_COSH: alternate(d, cosh(u), sinh(u), 1, c); return;
  case AMBIT_OP_EXP: alternate(d, exp(u), exp(u), 1, c); return;
  case AMBIT_OP_DIV: /* 1/u */
    c[0] = 1 / u;
    for (uint32_t k = 1; k <= d; k++) c[k] = -c[k - 1] / u;
    return;
  case AMBIT_OP_LOG:
    c[0] = log(u);
    for (uint32_t k = 1; k <= d; k++) c[k] = k == 1 ? 1 / u : -c[k - 1] * (k - 1.0) / k / u;
    return;
  case AMBIT_OP_SQRT:
    c[0] = sqrt(u);
    for (uint32_t k = 1; k <= d; k++) c[k] = c[k - 1] * (1.5 - k) / k / u;
    return;
  case AMBIT_OP_TANH: /* y' = s, s = 1 - y^2 = 1 / cosh(u)^2 */
    c[0] = tanh(u);
    for (uint32_t k = 0; k < d; k++) {
      double slope = k ? 0 : 1 / (cosh(u) * cosh(u));
      for (uint32_t i = 0; i <= k && k; i++) slope -= c[i] * c[k - i];
      c[k + 1] = slope / (k + 1.0);
    }
    return;
  default: /* arc tangent: (1 + u^2) y' = 1, order by order */
    c[0] = atan(u);
    for (uint32_t k = 1; k <= d; k++) {
      double left = k == 1;
      for (uint32_t i = 1; i <= 2 && i < k; i++) left -= q[i] * (k - i) * c[k - i];
      c[k] = left / (k * q[0]);
    }
  }
}

/* -- residuals: sum holds what is taken from, or added to, a polynomial; operands without radii */

/* bound over the ray of (a - sum) / s, integrated from 0 to 1 */
static double integrated(series *s, cell a) {
  const space *w = s->space;
  cell left = series_scratch(s, 9);
  double slack = gamma_of(4) * cell_norm(a) + sum_rounding(w, &s->sum) + gamma_of(4) * s->sum.weight;
  for (size_t j = 0; j < w->size; j++) left.c[j] = a.c[j] - s->sum.c[j];
  cell_finish(w, left, 0);
  double total = left.deg[0] + slack + s->sum.rad + s->sum.cut / (w->d + 1.0);
  for (uint32_t j = 1; j <= w->d; j++) total += left.deg[j] / j;
  return total + TINY;
}

/* E y - sign v E u */
static double ray(series *s, cell y, cell u, cell v, double sign) {
  cell ey = series_scratch(s, 7), eu = series_scratch(s, 8);
  cell_euler(s->space, ey, y), cell_euler(s->space, eu, u);
  sum_clear(s->space, &s->sum);
  sum_add(s->space, &s->sum, sign, eu, v);
  return integrated(s, ey);
}

/* q E y - E u, q with a radius */
static double ray_quotient(series *s, cell y, cell u, cell q) {
  cell ey = series_scratch(s, 7), eu = series_scratch(s, 8);
  cell_euler(s->space, ey, y), cell_euler(s->space, eu, u);
  sum_clear(s->space, &s->sum);
  sum_add(s->space, &s->sum, 1, ey, q);
  return integrated(s, eu);
}

/* -- functions: y := f(a) */

static void finish(const series *s, cell to, cell y, double rad) {
  cell_copy(s->space, to, y);
  to.info[RAD] = rad + TINY;
}

/* e = f(u) - y obeys e' = M u' e + R/s with M = [0 1; -1 0]: the norm grows by |R|/s only; [0 1; 1 0]: also by
** e^swing */
static uint32_t waves(series *s, uint32_t op, cell to, cell pair, cell a) {
  int round = op == AMBIT_OP_SIN || op == AMBIT_OP_COS, swapped = op == AMBIT_OP_COS || op == AMBIT_OP_COSH;
  uint32_t odd = round ? AMBIT_OP_SIN : AMBIT_OP_SINH, even = round ? AMBIT_OP_COS : AMBIT_OP_COSH;
  cell u = series_scratch(s, 10), y = series_scratch(s, 5), z = series_scratch(s, 6);
  double c[DEGREE_MAX + 1], u0 = first(s, a), r = cell_rad(a);
  centre(s, u, a);
  expand(odd, s->space->d, u0, c), horner(s, y, c, u);
  expand(even, s->space->d, u0, c), horner(s, z, c, u);
  double error = start_error(s, odd, u0, 0, first(s, y)) + start_error(s, even, u0, 0, first(s, z));
  error += ray(s, y, u, z, 1) + ray(s, z, u, y, round ? -1 : 1);
  if (round)
    error += r;
  else {
    double most = fabs(u0) + swing(u) + r;
    error = error * exp_above(s, swing(u)) + r * exp_above(s, most);
  }
  finish(s, swapped ? pair : to, y, error), finish(s, swapped ? to : pair, z, error);
  return error < INFINITY ? 0 : BAD;
}

static uint32_t exponential(series *s, cell to, cell a) {
  cell u = series_scratch(s, 10), y = series_scratch(s, 5);
  double c[DEGREE_MAX + 1], u0 = first(s, a), r = cell_rad(a);
  centre(s, u, a);
  expand(AMBIT_OP_EXP, s->space->d, u0, c), horner(s, y, c, u);
  double error = start_error(s, AMBIT_OP_EXP, u0, 0, first(s, y)) + ray(s, y, u, y, 1);
  error = error * exp_above(s, swing(u)) + r * exp_above(s, u0 + swing(u) + r);
  finish(s, to, y, error);
  return error < INFINITY ? 0 : BAD;
}

/* u E y = E u + R: y - log u changes by R/(s u) */
static uint32_t logarithm(series *s, cell to, cell a) {
  cell u = series_scratch(s, 10), y = series_scratch(s, 5);
  double c[DEGREE_MAX + 1], u0 = first(s, a), floor = range(s, a).lo;
  if (!(floor > 0)) return AMBIT_F_PARTIAL;
  centre(s, u, a);
  expand(AMBIT_OP_LOG, s->space->d, u0, c), horner(s, y, c, u);
  double error = start_error(s, AMBIT_OP_LOG, u0, 0, first(s, y)) + (ray_quotient(s, y, u, u) + cell_rad(a)) / floor;
  finish(s, to, y, error);
  return error < INFINITY ? 0 : BAD;
}

/* |y - sqrt u| = |y^2 - u| / (y + sqrt u), y > 0 */
static uint32_t square_root(series *s, cell to, cell a) {
  const space *w = s->space;
  cell u = series_scratch(s, 10), y = series_scratch(s, 5), left = series_scratch(s, 9);
  double c[DEGREE_MAX + 1], floor = range(s, a).lo;
  if (!(floor > 0)) return AMBIT_F_PARTIAL;
  centre(s, u, a);
  expand(AMBIT_OP_SQRT, w->d, first(s, a), c), horner(s, y, c, u);
  double root = enclose(s, AMBIT_OP_SQRT, (bounds) { floor, floor }, (bounds) { 0, 0 }).lo;
  double below = -(-range(s, y).lo - root);
  if (!(range(s, y).lo > 0)) return BAD;
  sum_clear(w, &s->sum);
  sum_add(w, &s->sum, 1, y, y);
  sum_take(w, &s->sum, 1, left);
  cell_add(w, left, left, u, -1);
  double error = (cell_norm(left) + cell_rad(left) + cell_rad(a)) / below;
  finish(s, to, y, error);
  return error < INFINITY ? 0 : BAD;
}

/* (1 + u^2) E y = E u + R, 1 + u^2 >= 1 */
static uint32_t arc_tangent(series *s, cell to, cell a) {
  const space *w = s->space;
  cell u = series_scratch(s, 10), y = series_scratch(s, 5), q = series_scratch(s, 6), one = series_scratch(s, 4);
  double c[DEGREE_MAX + 1], u0 = first(s, a);
  centre(s, u, a);
  expand(AMBIT_OP_ATAN, w->d, u0, c), horner(s, y, c, u);
  sum_clear(w, &s->sum);
  sum_add(w, &s->sum, 1, u, u);
  sum_take(w, &s->sum, 1, q);
  cell_constant(w, one, 1, 0);
  cell_add(w, q, q, one, 1);
  double error = start_error(s, AMBIT_OP_ATAN, u0, 0, first(s, y)) + ray_quotient(s, y, u, q) + cell_rad(a);
  finish(s, to, y, error);
  return error < INFINITY ? 0 : BAD;
}

/* to := the range of f over that of a, if its error is not less; f is bounded */
static void saturate(const series *s, uint32_t op, cell to, cell a, double error) {
  bounds r = range(s, a), f = enclose(s, op, r, r);
  double mid = 0.5 * (f.lo + f.hi), rad = larger(f.hi - mid, mid - f.lo);
  if (!(error < rad)) cell_constant(s->space, to, mid, rad + TINY);
}

/* E y = (1 - y^2) E u + R: e = y - tanh u obeys e' = R/s - (y + tanh u) u' e */
static uint32_t tangent(series *s, cell to, cell a) {
  const space *w = s->space;
  cell u = series_scratch(s, 10), y = series_scratch(s, 5), q = series_scratch(s, 6), one = series_scratch(s, 4);
  double c[DEGREE_MAX + 1], u0 = first(s, a), r = cell_rad(a);
  centre(s, u, a);
  expand(AMBIT_OP_TANH, w->d, u0, c), horner(s, y, c, u);
  sum_clear(w, &s->sum);
  sum_add(w, &s->sum, -1, y, y);
  sum_take(w, &s->sum, 1, q);
  cell_constant(w, one, 1, 0);
  cell_add(w, q, q, one, 1);
  double error = start_error(s, AMBIT_OP_TANH, u0, 0, first(s, y)) + ray(s, y, u, q, 1);
  error = error * exp_above(s, (1 + cell_norm(y)) * swing(u)) + r;
  finish(s, to, y, error);
  saturate(s, AMBIT_OP_TANH, to, a, error);
  return cell_rad(to) < INFINITY ? 0 : BAD;
}

/* The angle of (b, a) off the cut: about theta_0 + atan of the tangent in axes turned by theta_0. From
** (a^2 + b^2) E y = b E a - a E b + R. */
static uint32_t angle(series *s, cell to, cell a, cell b) {
  const space *w = s->space;
  double a0 = first(s, a), b0 = first(s, b), c[DEGREE_MAX + 1], size = a0 * a0 + b0 * b0;
  bounds ra = range(s, a), rb = range(s, b);
  if (!(rb.lo > 0 || ra.lo > 0 || ra.hi < 0)) return BAD;
  cell x = series_scratch(s, 5), y = series_scratch(s, 6), t = series_scratch(s, 10), one = series_scratch(s, 4);
  for (size_t j = 0; j < w->size; j++) {
    y.c[j] = (a.c[j] * b0 - b.c[j] * a0) / size;
    x.c[j] = (a.c[j] * a0 + b.c[j] * b0) / size;
  }
  cell_finish(w, x, 0), cell_finish(w, y, 0);
  expand(AMBIT_OP_DIV, w->d, first(s, x), c), horner(s, t, c, x);
  sum_clear(w, &s->sum);
  sum_add(w, &s->sum, 1, y, t);
  sum_take(w, &s->sum, 1, t);
  centre(s, t, t);
  expand(AMBIT_OP_ATAN, w->d, first(s, t), c);
  c[0] += atan2(a0, b0);
  horner(s, y, c, t);
  /* the residual */
  cell ua = series_scratch(s, 10), ub = series_scratch(s, 5), q = series_scratch(s, 3), ex = series_scratch(s, 7);
  centre(s, ua, a), centre(s, ub, b);
  sum_clear(w, &s->sum);
  sum_add(w, &s->sum, 1, ua, ua), sum_add(w, &s->sum, 1, ub, ub);
  sum_take(w, &s->sum, 1, q);
  double floor = range(s, q).lo, ga = larger(larger(ra.lo, -ra.hi), 0), gb = larger(larger(rb.lo, -rb.hi), 0);
  floor = larger(floor, -(-ga * ga - gb * gb) * (1 - 0x1p-50));
  if (!(floor > 0)) return BAD;
  sum_clear(w, &s->sum);
  cell_euler(w, ex, ua);
  sum_add(w, &s->sum, -1, ex, ub);
  cell_euler(w, ex, ub);
  sum_add(w, &s->sum, 1, ex, ua);
  cell_euler(w, ex, y);
  sum_add(w, &s->sum, 1, ex, q);
  cell_constant(w, one, 0, 0);
  double error = start_error(s, AMBIT_OP_ATAN2, a0, b0, first(s, y)) + integrated(s, one) / floor;
  double reach = enclose(s, AMBIT_OP_SQRT, (bounds) { floor, floor }, (bounds) { 0, 0 }).lo;
  reach = -(cell_rad(a) + cell_rad(b) - reach); /* of the segment from the polynomials to the point itself */
  if (!(reach > 0)) return BAD;
  error += (cell_rad(a) + cell_rad(b)) / reach;
  finish(s, to, y, error);
  return error < INFINITY ? 0 : BAD;
}

/* w near 1/q: |w - 1/q| = |q w - 1| / |q| */
uint32_t series_inverse(series *s, cell to, cell a, double floor) {
  const space *w = s->space;
  cell y = series_scratch(s, 5), one = series_scratch(s, 4), left = series_scratch(s, 9);
  double c[DEGREE_MAX + 1];
  bounds r = range(s, a);
  floor = larger(floor, larger(r.lo, -r.hi));
  if (!(floor > 0)) return AMBIT_F_PARTIAL;
  expand(AMBIT_OP_DIV, w->d, first(s, a), c), horner(s, y, c, a);
  sum_clear(w, &s->sum);
  sum_add(w, &s->sum, 1, y, a); /* the radius of a counts here */
  sum_take(w, &s->sum, 1, left);
  cell_constant(w, one, 1, 0);
  cell_add(w, left, left, one, -1);
  double error = (cell_norm(left) + cell_rad(left)) / floor;
  finish(s, to, y, error);
  return error < INFINITY ? 0 : BAD;
}

uint32_t series_function(series *s, uint32_t op, cell to, cell pair, cell a, cell b) {
  if (!(cell_norm(a) + cell_rad(a) < INFINITY)) return BAD;
  switch (op) {
  case AMBIT_OP_SIN:
  case AMBIT_OP_COS:
  case AMBIT_OP_SINH:
  case AMBIT_OP_COSH: return waves(s, op, to, pair, a);
  case AMBIT_OP_EXP: return exponential(s, to, a);
  case AMBIT_OP_LOG: return logarithm(s, to, a);
  case AMBIT_OP_SQRT: return square_root(s, to, a);
  case AMBIT_OP_ATAN: return arc_tangent(s, to, a);
  case AMBIT_OP_TANH: return tangent(s, to, a);
  case AMBIT_OP_ATAN2: return angle(s, to, a, b);
  default: return BAD;
  }
}
