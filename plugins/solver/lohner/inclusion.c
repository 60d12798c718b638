/* inclusion.c -- Picard's inclusion: every solution from the set exists on the whole step, and lies within the
** polynomials and their excess.
**
** The truncation error for a length comes from the tail with eps = 0, which is what Picard's inclusion converges to;
** then the inclusion itself is checked with eps = GUESS times that, for the midpoint and for the slopes over the whole
** set [Nedialkov, Jackson & Pryce 2001 for the high-order form; docs/numerics/lohner.md, a step, 1 to 3].
*/
#include "flow.h"

#define TRIES 6
#define KINDS_OF_GUESSES 3
#define GUESS 5.0      /* eps over the tail with eps = 0 */
#define AGAIN 2.0      /* over the last tail */
#define TINY 0x1p-1000 /* so that zero is its own proof */

static double power(double x, uint32_t n) {
  double r = 1;
  for (uint32_t i = 0; i < n; i++) r *= x;
  return r;
}

static int within(size_t n, const double *a, const double *b) {
  for (size_t k = 0; k < n; k++)
    if (!(a[k] <= b[k])) return 0;
  return 1;
}

/* The first guess is a multiple of what eps = 0 gave, the next ones of what the last guess gave: as in the power
** method, they come to fit how states feed each other, whatever units these are measured in (a force of 1e-8 N and a
** wheel speed of 50 rad/s in one loop). Where that is not enough, because components are zero whose own derivatives
** vanish at this order, more and more of the largest is added: they learn from the others, even from far ones. Where
** states are of very different size (angles and their rates of 1 kHz) that is far too much for some: what none of these
** guesses proves is tried once more with floors in units of each state, direction by direction. eps [nx x n], a column
** for each direction.
*/
static void guess_plainly(int attempt, size_t n, const double *excess, double *eps) {
  for (size_t k = 0; k < n; k++) eps[k] = (attempt ? AGAIN : GUESS) * excess[k] + TINY;
}

static void guess(int attempt, size_t n, const double *excess, double *eps) {
  static const double share[TRIES] = { 0, 1e-6, 1e-4, 1e-2, 0.1, 1 };
  double largest = 0;
  for (size_t k = 0; k < n; k++) largest = larger(largest, excess[k]);
  double floor = attempt ? share[attempt] * largest + TINY : TINY;
  for (size_t k = 0; k < n; k++) eps[k] = (attempt ? AGAIN : GUESS) * excess[k] + floor;
}

static void guess_in_units(size_t nx, const double *unit, int attempt, size_t n, const double *excess, double *eps) {
  static const double share[TRIES] = { 0, 1e-9, 1e-6, 1e-4, 1e-2, 0.1 };
  for (size_t j = 0; j < n; j++) {
    double largest = 0;
    for (size_t i = 0; i < nx; i++)
      if (unit[i] > 0) largest = larger(largest, excess[i * n + j] / unit[i]);
    for (size_t i = 0; i < nx; i++) {
      double floor = share[attempt] * largest * unit[i] + TINY;
      eps[i * n + j] = (attempt ? AGAIN : GUESS) * excess[i * n + j] + floor;
    }
  }
}

/* attempts in turn: without floors, with floors, with floors in units */
static void next_guess(size_t nx, const double *unit, int attempt, size_t n, const double *excess, double *eps) {
  int again = attempt % TRIES;
  if (attempt < TRIES)
    guess_plainly(again, nx * n, excess, eps);
  else if (attempt < 2 * TRIES)
    guess(again, nx * n, excess, eps);
  else
    guess_in_units(nx, unit, again, n, excess, eps);
}

/* -- the midpoint */

/* excess := H tail / (p + 1) for inputs whose tail is |x_p| H^p + eps; 0 if nothing could be computed */
int flow_centre_excess(const field *f, flow *phi, const double *eps) {
  uint32_t p = phi->p;
  double H = phi->step.length, top = power(H, p);
  for (uint32_t i = 0; i < f->nx; i++) {
    balls last = balls_at(phi->centre, (size_t)i * (p + 1u) + p);
    phi->tail_in[i] = (fabs(*last.mid) + *last.rad) * top + (eps ? eps[i] : 0);
    if (!(phi->tail_in[i] < INFINITY)) return 0;
  }
  if (f->jet->tail(phi->centre_jet, p - 1, H, phi->tail_in, NULL, phi->tail_out, NULL) != AMBIT_OK) return 0;
  for (uint32_t i = 0; i < f->nx; i++) phi->excess[i] = H * phi->tail_out[i] / (p + 1.0);
  return 1;
}

static int centre_is_proved(const field *f, flow *phi, const double *unit) {
  for (int i = 0; i < KINDS_OF_GUESSES * TRIES; i++) {
    if (i && i % TRIES == 0 && !flow_centre_excess(f, phi, NULL)) return 0;
    next_guess(f->nx, unit, i, 1, phi->excess, phi->eps);
    if (!flow_centre_excess(f, phi, phi->eps)) continue;
    if (within(f->nx, phi->excess, phi->eps)) return 1;
  }
  return 0;
}

/* -- the slopes over the box of the whole set */

/* value and slope excesses from guesses; NULL: zero */
static int slope_excess(const field *f, flow *phi, const double *eps, const double *slope_eps) {
  uint32_t q = phi->q, n = f->ndir;
  double H = phi->step.length, top = power(H, q);
  for (uint32_t i = 0; i < f->nx; i++) {
    double mid, rad;
    f->jet->get(phi->box_jet, f->problem.rhs->nconst + i, q, &mid, &rad, NULL, NULL);
    phi->tail_in[i] = (fabs(mid) + rad) * top + (eps ? eps[i] : 0);
    if (!(phi->tail_in[i] < INFINITY)) return 0;
    balls last = balls_at(phi->slope, ((size_t)i * (q + 1u) + q) * n);
    double *in = phi->dtail_in + (size_t)i * n;
    for (uint32_t j = 0; j < n; j++) {
      double slope = (fabs(last.mid[j]) + last.rad[j]) * top;
      in[j] = slope + (slope_eps ? slope_eps[(size_t)i * n + j] : 0);
      if (!(in[j] < INFINITY)) return 0; /* NaN too */
    }
  }
  if (f->jet->tail(phi->box_jet, q - 1, H, phi->tail_in, phi->dtail_in, phi->tail_out, phi->dtail_out) != AMBIT_OK)
    return 0;
  for (uint32_t i = 0; i < f->nx; i++) phi->box_excess[i] = H * phi->tail_out[i] / (q + 1.0);
  for (size_t k = 0; k < (size_t)f->nx * n; k++) phi->slope_excess[k] = H * phi->dtail_out[k] / (q + 1.0);
  return 1;
}

static int slopes_are_proved(const field *f, flow *phi, const double *unit) {
  size_t entries = (size_t)f->nx * f->ndir;
  for (int i = 0; i < KINDS_OF_GUESSES * TRIES; i++) {
    if (i % TRIES == 0 && !slope_excess(f, phi, NULL, NULL)) return 0;
    next_guess(f->nx, unit, i, 1, phi->box_excess, phi->eps);
    next_guess(f->nx, unit, i, f->ndir, phi->slope_excess, phi->slope_eps);
    if (!slope_excess(f, phi, phi->eps, phi->slope_eps)) continue;
    if (within(f->nx, phi->box_excess, phi->eps) && within(entries, phi->slope_excess, phi->slope_eps)) return 1;
  }
  return 0;
}

int flow_is_proved(const field *f, flow *phi, const double *unit) {
  return centre_is_proved(f, phi, unit) && slopes_are_proved(f, phi, unit);
}
