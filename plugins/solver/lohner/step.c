/* step.c -- choosing a step and proving it.
**
** The series are computed once; for each length that is tried only tails are. The truncation error for a length comes
** from the tail with eps = 0, which is what Picard's inclusion converges to; then the inclusion itself is checked with
** eps = GUESS times that, for the centre and for the slopes over the whole set. If it holds, every solution from the
** set exists on the whole step and lies within the polynomials and their excess [Nedialkov, Jackson & Pryce 2001 for
** the high-order form; docs/numerics/lohner.md].
*/
#include "lohner.h"

#define TRIES 200
#define TRIES_OF_PROOF 6
#define GUESS 5.0      /* eps over the tail with eps = 0 */
#define AGAIN 2.0      /* over the last tail */
#define AIM 0.2        /* share of the tolerance that a new length aims at */
#define LOW_WATER 0.02 /* a longer step is worth another tail below this share */
#define GROWTH 3.0
#define SHRINK 0.8
#define TINY 0x1p-1000  /* so that zero is its own proof */
#define SLOPPY 0x1p-10  /* most that the excess of slopes may add to the set in a step, relative, ... */
#define SLOPPY_STEPS 64 /* ... in a run of so many steps; of longer runs less, so that the sum stays bounded */
#define WIDE_SHARE 1e-9 /* of a wide set's radius that truncation may add */

/* -- the length */

/* The step ends at t_next; h is the exact distance or, if that is no double, known with its error. */
static void set_span(lohner *s, double t_next) {
  double above = t_next - s->t, below = -(s->t - t_next);
  s->t_next = t_next;
  s->step = (span) { above, above - below, larger(fabs(above), fabs(below)) };
  s->step.length += s->step.error;
}

/* A step of about `length` > 0 that ends on the instant ahead or leaves room for a step of its own size before it.
** 0: it is none. */
static int plan(lohner *s, double length) {
  double goal = s->problem.time[s->next], ahead = fabs(goal - s->t);
  s->at_instant = length >= ahead;
  if (s->at_instant)
    set_span(s, goal);
  else {
    if (length > 0.5 * ahead) length = 0.5 * ahead;
    set_span(s, goal > s->t ? s->t + length : s->t - length);
  }
  return s->t_next != s->t;
}

/* -- the centre */

static double power(double x, uint32_t n) {
  double r = 1;
  for (uint32_t i = 0; i < n; i++) r *= x;
  return r;
}

/* excess := H tail / (p + 1) for inputs whose tail is |x_p| H^p + eps; 0 if nothing could be computed */
static int centre_excess(lohner *s, const double *eps) {
  uint32_t p = s->options.order;
  double H = s->step.length, top = power(H, p);
  for (uint32_t i = 0; i < s->nx; i++) {
    size_t at = (size_t)i * (p + 1u) + p;
    s->tail_in[i] = (fabs(s->series_mid[at]) + s->series_rad[at]) * top + (eps ? eps[i] : 0);
    if (!(s->tail_in[i] < INFINITY)) return 0;
  }
  if (s->jet->tail(s->centre_jet, p - 1, H, s->tail_in, NULL, s->tail_out, NULL) != AMBIT_OK) return 0;
  for (uint32_t i = 0; i < s->nx; i++) s->excess[i] = H * s->tail_out[i] / (p + 1.0);
  return 1;
}

/* how far state i gets in the step by its first derivatives: its size where it starts from zero */
static double swing(const lohner *s, uint32_t i) {
  const double *mid = s->series_mid + (size_t)i * (s->options.order + 1u);
  double H = s->step.length;
  return H * (fabs(mid[1]) + H * (fabs(mid[2]) + H * fabs(mid[3])));
}

/* what rounding adds to state i in the step: more than its size, where it stays at zero */
static double noise(const lohner *s, uint32_t i) {
  const double *rad = s->series_rad + (size_t)i * (s->options.order + 1u);
  double H = s->step.length;
  return H * (rad[1] + H * (rad[2] + H * rad[3]));
}

/* truncation error over what is allowed, the worst component */
static double truncation(lohner *s) {
  double worst = 0;
  if (!centre_excess(s, NULL)) return INFINITY;
  for (uint32_t i = 0; i < s->nx; i++) {
    double allowed = s->options.tolerance * larger(s->size[i], swing(s, i)) + WIDE_SHARE * s->radius[i];
    if (s->lenient) allowed += noise(s, i);
    double ratio = s->excess[i] / (allowed + TINY);
    if (!(ratio <= worst)) worst = ratio; /* NaN too */
  }
  return worst >= 0 ? worst : INFINITY;
}

static int within(size_t n, const double *a, const double *b) {
  for (size_t k = 0; k < n; k++)
    if (!(a[k] <= b[k])) return 0;
  return 1;
}

/* The first guess is a multiple of what eps = 0 gave, the next ones of what the last guess gave, and more and more
** of the largest: a component whose own derivatives vanish at this order learns from the others, even from far ones.
** eps [nx x n], a column for each direction. Where states are of very different size (angles and their rates of 1 kHz)
** that is far too much for some: what none of these guesses proves is tried once more with floors in units of each
** state, direction by direction. */
static void guess(int attempt, size_t n, const double *excess, double *eps) {
  static const double share[TRIES_OF_PROOF] = { 0, 1e-6, 1e-4, 1e-2, 0.1, 1 };
  double largest = 0;
  for (size_t k = 0; k < n; k++) largest = larger(largest, excess[k]);
  double floor = attempt ? share[attempt] * largest + TINY : TINY;
  for (size_t k = 0; k < n; k++) eps[k] = (attempt ? AGAIN : GUESS) * excess[k] + floor;
}

static double unit_of(const lohner *s, uint32_t i) { return larger(s->size[i], swing(s, i)); }

static void guess_in_units(const lohner *s, int attempt, size_t n, const double *excess, double *eps) {
  static const double share[TRIES_OF_PROOF] = { 0, 1e-9, 1e-6, 1e-4, 1e-2, 0.1 };
  for (size_t j = 0; j < n; j++) {
    double largest = 0;
    for (uint32_t i = 0; i < s->nx; i++)
      if (unit_of(s, i) > 0) largest = larger(largest, excess[i * n + j] / unit_of(s, i));
    for (uint32_t i = 0; i < s->nx; i++) {
      double floor = share[attempt] * largest * unit_of(s, i) + TINY;
      eps[i * n + j] = (attempt ? AGAIN : GUESS) * excess[i * n + j] + floor;
    }
  }
}

/* attempts in turn, without and with units */
static void next_guess(const lohner *s, int attempt, size_t n, const double *excess, double *eps) {
  if (attempt < TRIES_OF_PROOF)
    guess(attempt, s->nx * n, excess, eps);
  else
    guess_in_units(s, attempt - TRIES_OF_PROOF, n, excess, eps);
}

static int centre_is_proved(lohner *s) {
  double *eps = s->added; /* free until the set moves */
  for (int i = 0; i < 2 * TRIES_OF_PROOF; i++) {
    if (i == TRIES_OF_PROOF && !centre_excess(s, NULL)) return 0;
    next_guess(s, i, 1, s->excess, eps);
    if (!centre_excess(s, eps)) continue;
    if (within(s->nx, s->excess, eps)) return 1;
  }
  return 0;
}

/* -- the slopes over the box of the whole set */

/* value and slope excesses from guesses; NULL: zero */
static int slope_excess(lohner *s, const double *eps, const double *deps) {
  uint32_t q = s->options.slope_order, n = s->ndir;
  double H = s->step.length, top = power(H, q);
  for (uint32_t i = 0; i < s->nx; i++) {
    double mid, rad;
    s->jet->get(s->box_jet, s->problem.rhs->nconst + i, q, &mid, &rad, NULL, NULL);
    s->tail_in[i] = (fabs(mid) + rad) * top + (eps ? eps[i] : 0);
    if (!(s->tail_in[i] < INFINITY)) return 0;
    size_t at = ((size_t)i * (q + 1u) + q) * n;
    for (uint32_t j = 0; j < n; j++) {
      double slope = (fabs(s->slope_mid[at + j]) + s->slope_rad[at + j]) * top;
      s->dtail_in[(size_t)i * n + j] = slope + (deps ? deps[(size_t)i * n + j] : 0);
      if (!(s->dtail_in[(size_t)i * n + j] < INFINITY)) return 0; /* NaN too */
    }
  }
  if (s->jet->tail(s->box_jet, q - 1, H, s->tail_in, s->dtail_in, s->tail_out, s->dtail_out) != AMBIT_OK) return 0;
  for (uint32_t i = 0; i < s->nx; i++) s->box_excess[i] = H * s->tail_out[i] / (q + 1.0);
  for (size_t k = 0; k < (size_t)s->nx * n; k++) s->slope_excess[k] = H * s->dtail_out[k] / (q + 1.0);
  return 1;
}

static int slopes_are_proved(lohner *s) {
  size_t entries = (size_t)s->nx * s->ndir;
  for (int i = 0; i < 2 * TRIES_OF_PROOF; i++) {
    if (i % TRIES_OF_PROOF == 0 && !slope_excess(s, NULL, NULL)) return 0;
    next_guess(s, i, 1, s->box_excess, s->added);
    next_guess(s, i, s->ndir, s->slope_excess, s->slope_guess);
    if (!slope_excess(s, s->added, s->slope_guess)) continue;
    if (within(s->nx, s->box_excess, s->added) && within(entries, s->slope_excess, s->slope_guess)) return 1;
  }
  return 0;
}

/* What the excess of slopes adds to the set is small beside the set, or beside what the step makes of it: a
** component that starts as a point grows by its first two derivatives. One that starts from zero and feels others by
** its third derivative only has neither; before the run ends for that, its swing counts as its size (`lenient`). */
static int slopes_are_sharp(const lohner *s) {
  uint32_t n = s->ndir, q = s->options.slope_order;
  const double *time = s->problem.time;
  double H = s->step.length, span = fabs(time[s->problem.ntime - 1] - time[0]);
  double share = SLOPPY * smaller(1, SLOPPY_STEPS * H / span);
  for (uint32_t i = 0; i < s->nx; i++) {
    const double *slope = s->slope_mid + (size_t)i * (q + 1u) * n;
    double added = 0, grown = s->radius[i];
    for (uint32_t j = 0; j < n; j++) {
      added += s->slope_excess[(size_t)i * n + j] * lohner_reach(s, j);
      grown += H * (fabs(slope[n + j]) + H * fabs(slope[2u * n + j])) * lohner_reach(s, j);
    }
    double allowed = s->options.tolerance * (s->lenient ? larger(s->size[i], swing(s, i)) : s->size[i]);
    if (s->lenient) allowed += noise(s, i);
    if (!(added <= share * grown + allowed + TINY)) return 0;
  }
  return 1;
}

/* -- both */

/* the next length to try for a ratio of error to tolerance that goes like its power p + 1 */
static double rescaled(const lohner *s, double ratio) {
  double factor = ratio > 0 ? pow(AIM / ratio, 1.0 / (s->options.order + 1.0)) : GROWTH;
  if (!(factor > 0.1)) factor = 0.1;
  return s->step.length * smaller(factor, GROWTH);
}

static enum why search(lohner *s) {
  double most = s->options.step_max, length = smaller(larger(s->guess, s->options.step_min), most);
  for (int i = 0; i < TRIES; i++) {
    if (!plan(s, length) || (s->step.length < s->options.step_min && !s->at_instant)) return WHY_NO_STEP;
    double ratio = truncation(s);
    if (ratio > 1) { /* never again as long: an infinite ratio would otherwise shrink and grow in turn */
      most = smaller(most, SHRINK * s->step.length);
      length = smaller(rescaled(s, ratio), most);
      continue;
    }
    int cut_short = s->at_instant || s->step.length < 0.99 * length;
    if (ratio < LOW_WATER && !cut_short && length < most) {
      length = ratio > 0 ? smaller(rescaled(s, ratio), most) : most;
      continue;
    }
    if (centre_is_proved(s) && slopes_are_proved(s) && slopes_are_sharp(s)) {
      s->guess = cut_short ? larger(length, rescaled(s, ratio)) : rescaled(s, ratio);
      return WHY_NOTHING;
    }
    most = length = SHRINK * s->step.length;
  }
  return WHY_NO_STEP;
}

enum why lohner_find_step(lohner *s) {
  if (lohner_centre_series(s)) return WHY_CENTRE;
  for (uint32_t j = 0; j < s->nc; j++) s->piece_from[j] = -1, s->piece_to[j] = 1;
  if (lohner_box_series(s, s->piece_from, s->piece_to)) return WHY_BOX;
  s->lenient = 0;
  if (search(s) == WHY_NOTHING) return WHY_NOTHING;
  s->lenient = 1;
  return search(s);
}
