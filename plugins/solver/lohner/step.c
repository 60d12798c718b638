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
#define KINDS_OF_GUESSES 3
#define GUESS 5.0      /* eps over the tail with eps = 0 */
#define AGAIN 2.0      /* over the last tail */
#define AIM 0.2        /* share of the tolerance that a new length aims at */
#define LOW_WATER 0.02 /* a longer step is worth another tail below this share */
#define GROWTH 3.0
#define SHRINK 0.8
#define SMALL_PART 0x1p-40 /* of the time span: a step that is first looked for is at least as long */
#define SLOPES_LIMIT 0.5   /* slopes limit the step to this share of what the centre allows: raise their order */
#define SLOPES_ALLOW 1.5   /* lower it */
#define BEND 0.3
#define TINY 0x1p-1000 /* so that zero is its own proof */
#define GUESSES_OF_NOTHING 0x1p20
#define SLOPPY 0x1p-10  /* most that the excess of slopes may add to the set in a step, relative, ... */
#define NEAT 0x1p-13    /* the same where data would lose little else, because slopes hardly vary over the set */
#define MANY_STEPS 64   /* ... in a run of so many steps; of longer runs less, so that the sum stays bounded */
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

/* truncation error over what is allowed, the worst component */
static double truncation(lohner *s) {
  double worst = 0;
  if (!centre_excess(s, NULL)) return INFINITY;
  for (uint32_t i = 0; i < s->nx; i++) {
    double allowed = s->options.tolerance * s->unit[i] + WIDE_SHARE * s->radius[i];
    if (s->lenient) allowed += lohner_noise(s, i);
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
  static const double share[TRIES_OF_PROOF] = { 0, 1e-6, 1e-4, 1e-2, 0.1, 1 };
  double largest = 0;
  for (size_t k = 0; k < n; k++) largest = larger(largest, excess[k]);
  double floor = attempt ? share[attempt] * largest + TINY : TINY;
  for (size_t k = 0; k < n; k++) eps[k] = (attempt ? AGAIN : GUESS) * excess[k] + floor;
}

static void guess_in_units(const lohner *s, int attempt, size_t n, const double *excess, double *eps) {
  static const double share[TRIES_OF_PROOF] = { 0, 1e-9, 1e-6, 1e-4, 1e-2, 0.1 };
  for (size_t j = 0; j < n; j++) {
    double largest = 0;
    for (uint32_t i = 0; i < s->nx; i++)
      if (s->unit[i] > 0) largest = larger(largest, excess[i * n + j] / s->unit[i]);
    for (uint32_t i = 0; i < s->nx; i++) {
      double floor = share[attempt] * largest * s->unit[i] + TINY;
      eps[i * n + j] = (attempt ? AGAIN : GUESS) * excess[i * n + j] + floor;
    }
  }
}

/* attempts in turn: without floors, with floors, with floors in units */
static void next_guess(const lohner *s, int attempt, size_t n, const double *excess, double *eps) {
  int again = attempt % TRIES_OF_PROOF;
  if (attempt < TRIES_OF_PROOF)
    guess_plainly(again, s->nx * n, excess, eps);
  else if (attempt < 2 * TRIES_OF_PROOF)
    guess(again, s->nx * n, excess, eps);
  else
    guess_in_units(s, again, n, excess, eps);
}

static int centre_is_proved(lohner *s) {
  double *eps = s->added; /* free until the set moves */
  for (int i = 0; i < KINDS_OF_GUESSES * TRIES_OF_PROOF; i++) {
    if (i && i % TRIES_OF_PROOF == 0 && !centre_excess(s, NULL)) return 0;
    next_guess(s, i, 1, s->excess, eps);
    if (!centre_excess(s, eps)) continue;
    if (within(s->nx, s->excess, eps)) return 1;
  }
  return 0;
}

/* -- the slopes over the box of the whole set */

/* value and slope excesses from guesses; NULL: zero */
static int slope_excess(lohner *s, const double *eps, const double *deps) {
  uint32_t q = s->slope_order, n = s->ndir;
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
  for (int i = 0; i < KINDS_OF_GUESSES * TRIES_OF_PROOF; i++) {
    if (i % TRIES_OF_PROOF == 0 && !slope_excess(s, NULL, NULL)) return 0;
    next_guess(s, i, 1, s->box_excess, s->added);
    next_guess(s, i, s->ndir, s->slope_excess, s->slope_guess);
    if (!slope_excess(s, s->added, s->slope_guess)) continue;
    if (within(s->nx, s->box_excess, s->added) && within(entries, s->slope_excess, s->slope_guess)) return 1;
  }
  return 0;
}

double lohner_share_of_time(const lohner *s) {
  const double *time = s->problem.time;
  return smaller(1, MANY_STEPS * s->step.length / fabs(time[s->problem.ntime - 1] - time[0]));
}

/* What the excess of slopes, added[i], adds to the set, over what is allowed: little beside the set, or beside what the
** step makes of it (a component that starts as a point grows by its first two derivatives). One
** that starts from zero and feels others by its third derivative only has none of these (see `fill`). The worst
** component. */
static double slope_error(lohner *s, const double *added) {
  double worst = 0, share = lohner_share_of_time(s);
  share *= s->nc == 0 ? SLOPPY : smaller(SLOPPY, larger(NEAT, s->varies));
  lohner_choose_grown(s);
  double nothing = TINY; /* what guesses of TINY for the slopes make of the set, beside a state that is zero */
  for (uint32_t j = 0; j < s->ndir; j++) nothing += GUESSES_OF_NOTHING * TINY * lohner_reach(s, j);
  for (uint32_t i = 0; i < s->nx; i++) {
    double allowed = s->options.tolerance * (s->lenient ? s->unit[i] : s->size[i]);
    if (s->lenient) allowed += lohner_noise(s, i);
    double ratio = added[i] / (share * s->grown[i] + allowed + nothing);
    if (!(ratio <= worst)) worst = ratio; /* NaN too */
  }
  return worst >= 0 ? worst : INFINITY;
}

static double taylor_slope_error(lohner *s) {
  for (uint32_t i = 0; i < s->nx; i++) {
    s->added[i] = 0;
    for (uint32_t j = 0; j < s->ndir; j++) s->added[i] += s->slope_excess[(size_t)i * s->ndir + j] * lohner_reach(s, j);
  }
  return slope_error(s, s->added);
}

/* slopes at the end of the step by one of the formulas; sets `corrected` */
static double find_slopes(lohner *s) {
  uint32_t formula = s->options.formula;
  double ratio = formula == FORMULA_HERMITE_OBRESCHKOFF ? INFINITY : taylor_slope_error(s);
  s->corrected = 0;
  lohner_tube(s);
  if (ratio <= 1 || formula == FORMULA_TAYLOR) return ratio;
  if (formula == FORMULA_AUTO && (s->wide || s->slope_order < s->options.slope_order_max)) return ratio;
  if (!lohner_correct(s)) return INFINITY;
  s->corrected = 1;
  return slope_error(s, s->corrector.added);
}

/* -- both */

/* the next length to try for a ratio of error to what is allowed that goes like its power order + 1 */
static double rescaled(const lohner *s, double ratio, uint32_t order) {
  double factor = ratio > 0 ? pow(AIM / ratio, 1.0 / (order + 1.0)) : GROWTH;
  if (!(factor > 0.1)) factor = 0.1;
  return s->step.length * smaller(factor, GROWTH);
}

/* An automatic order of the slopes follows the step that the midpoint's series allows; not over wide sets, for which
** long steps do not pay: what slopes vary by grows with them. */
static void adapt_slope_order(lohner *s, double by_centre, double by_slopes) {
  const options *o = &s->options;
  if (s->wide) by_slopes = INFINITY;
  if (by_slopes < SLOPES_LIMIT * by_centre && s->slope_order < o->slope_order_max) s->next_slope_order++;
  if (by_slopes > SLOPES_ALLOW * by_centre && s->slope_order > o->slope_order) s->next_slope_order--;
}

/* Over wide sets: what slopes vary by at the end of the step, over what they would if that grew with time only, less
** one. It goes about like the length of the step; as long as it is small, several steps lose no more than one. */
static double bend(const lohner *s) {
  uint32_t n = s->ndir, q = s->slope_order;
  double whole = 0, first = 0;
  for (uint32_t i = 0; i < s->nx; i++)
    for (uint32_t j = 0; j < n; j++) {
      const double *rad = s->slope_rad + (size_t)i * (q + 1u) * n + j;
      double sum = 0, weight = lohner_reach(s, j) / (s->unit[i] + TINY);
      for (uint32_t k = q; k > 0; k--) sum = (sum + rad[(size_t)k * n]) * s->step.length;
      whole += sum * weight;
      first += rad[n] * s->step.length * weight;
    }
  return first > 0 ? whole / first - 1 : 0; /* 0: slopes are constant but for rounding */
}

static void plan_next(lohner *s, int cut_short, double length, double ratio, double slope_ratio) {
  double by_centre = rescaled(s, ratio, s->options.order), by_slopes = rescaled(s, slope_ratio, s->slope_order);
  if (!cut_short) adapt_slope_order(s, by_centre, by_slopes);
  double bends = s->wide ? bend(s) : 0;
  if (bends > 0) by_slopes = smaller(by_slopes, s->step.length * smaller(BEND / bends, GROWTH));
  s->guess = smaller(by_centre, by_slopes);
  if (cut_short) s->guess = larger(length, s->guess);
  s->longest = larger(s->guess, by_slopes);
}

/* 1: no step is short enough, because some state that is zero, and stays so for its first derivatives, has no size */
static int has_no_size(const lohner *s) {
  for (uint32_t i = 0; i < s->nx; i++)
    if (s->unit[i] == 0 && s->radius[i] == 0 && s->excess[i] > 0) return 1;
  return 0;
}

static enum why search(lohner *s, double least) {
  double before = INFINITY, most = smaller(s->longest, s->options.step_max);
  double length = smaller(larger(s->guess, least), most);
  for (int i = 0; i < TRIES; i++) {
    if (!plan(s, length) || (s->step.length < least && !s->at_instant)) return WHY_NO_STEP;
    ambit_work_try(s->counted);
    lohner_choose_units(s);
    double ratio = truncation(s), slope_ratio;
    if (s->lenient == LENIENT_NOT && ratio < INFINITY && has_no_size(s)) return WHY_NO_STEP;
    if (ratio > 1) { /* never again as long: an infinite ratio would otherwise shrink and grow in turn */
      most = smaller(most, SHRINK * s->step.length);
      length = smaller(rescaled(s, ratio, s->options.order), most);
      continue;
    }
    int cut_short = s->at_instant || s->step.length < 0.99 * length;
    if (ratio < LOW_WATER && !cut_short && length < most) {
      length = ratio > 0 ? smaller(rescaled(s, ratio, s->options.order), most) : most;
      continue;
    }
    if (!centre_is_proved(s) || !slopes_are_proved(s))
      most = length = SHRINK * s->step.length;
    else if ((slope_ratio = find_slopes(s)) <= 1) {
      plan_next(s, cut_short, length, ratio, slope_ratio);
      return WHY_NOTHING;
    } else {
      if (s->lenient == LENIENT_NEAR && slope_ratio > before) return WHY_NO_STEP; /* sizes shrink faster than errors */
      before = slope_ratio;
      most = length = smaller(SHRINK * s->step.length, rescaled(s, slope_ratio, s->slope_order));
    }
  }
  return WHY_NO_STEP;
}

double lohner_least_step(const lohner *s) {
  const double *time = s->problem.time;
  return ambit_least_step(s->options.step_min, s->t, time[0], time[s->problem.ntime - 1]);
}

/* A step of at least `least`, with as much leniency as it needs. */
static enum why search_with_leniency(lohner *s, enum leniency from, double least) {
  for (enum leniency now = from; now <= LENIENT_FAR; now++) {
    s->lenient = now;
    if (search(s, least) == WHY_NOTHING) {
      if (now != LENIENT_FAR || !lohner_is_filled(s)) s->lenient = LENIENT_NOT;
      return WHY_NOTHING;
    }
  }
  return WHY_NO_STEP;
}

/* Leniency is for states that have no size of their own yet: relative to what they are, steps from rest are nearly as
** short as one likes. So a step that is no small part of the run is looked for first, with any leniency, and only then
** a shorter one. */
enum why lohner_find_step(lohner *s) {
  s->slope_order = s->next_slope_order;
  uint32_t centre = lohner_centre_series(s), box = lohner_box_series(s, s->all_from, s->all_to);
  if (centre || box) return centre ? WHY_CENTRE : WHY_BOX;
  const double *time = s->problem.time;
  double least = lohner_least_step(s), span = fabs(time[s->problem.ntime - 1] - time[0]);
  double first = s->options.step_min > 0 ? least : larger(least, SMALL_PART * span);
  enum why why = search_with_leniency(s, s->lenient, first);
  if (why == WHY_NOTHING || first == least) return why;
  return search_with_leniency(s, LENIENT_NOT, least);
}
