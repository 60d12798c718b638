/* step.c -- choosing the length of a step.
**
** The series are computed once; for each length that is tried only tails are (inclusion.c). A length serves if the
** excess of the midpoint and of the slopes stays within what tolerances allow, and both are proved
** [docs/numerics/lohner.md, a step, 4 and 5].
*/
#include "control.h"

#define TRIES 200
#define AIM 0.2        /* share of the tolerance that a new length aims at */
#define LOW_WATER 0.02 /* a longer step is worth another tail below this share */
#define GROWTH 3.0
#define SHRINK 0.8
#define SMALL_PART 0x1p-40 /* of the time span: a step that is first looked for is at least as long */
#define SLOPES_LIMIT 0.5   /* slopes limit the step to this share of what the centre allows: raise their order */
#define SLOPES_ALLOW 1.5   /* lower it */
#define BEND 0.3
#define TINY 0x1p-1000 /* as guesses of excess are at least (inclusion.c) */
#define GUESSES_OF_NOTHING 0x1p20
#define SLOPPY 0x1p-10  /* most that the excess of slopes may add to the set in a step, relative, ... */
#define NEAT 0x1p-13    /* the same where data would lose little else, because slopes hardly vary over the set */
#define WIDE_SHARE 1e-9 /* of a wide set's radius that truncation may add */
#define SHORT 0x1p-10   /* of the time span: the least first guess of a step */

int control_open(const field *f, control *c) {
  size_t nx = f->nx;
  sizes *z = &c->sizes;
  const request list[] = { { &z->size, nx }, { &z->unit, nx }, { &z->grown, nx }, { &z->limit, nx },
    { &z->euler, nx * (nx + 2) } };
  c->counted = ambit_work_open(f->host);
  return field_allocate(f->host, sizeof list / sizeof *list, list);
}

void control_start(const field *f, const set *x, control *c) {
  const double *time = f->problem.time;
  for (uint32_t i = 0; i < f->nx; i++) c->sizes.size[i] = larger(fabs(x->lo[i]), fabs(x->hi[i]));
  c->sizes.lenient = LENIENT_NOT;
  pace_start(&c->pace, x->t);
  c->next = 1;
  c->slope_order = f->options.slope_order;
  c->longest = INFINITY;
  /* an instant that is asked for close to the start says nothing about steps */
  c->guess = smaller(larger(fabs(time[1] - time[0]), SHORT * field_span(f)), f->options.step_max);
}

/* -- the length */

/* The step ends at t_next; h is the exact distance or, if that is no double, known with its error. */
static void end_at(flow *phi, double t_next) {
  double above = t_next - phi->t, below = -(phi->t - t_next);
  phi->t_next = t_next;
  phi->step = (span) { above, above - below, larger(fabs(above), fabs(below)) };
  phi->step.length += phi->step.error;
}

/* A step of about `length` > 0 that ends on the instant ahead or leaves room for a step of its own size before it.
** 0: it is none. */
static int plan(const field *f, double length, control *c, flow *phi) {
  double goal = f->problem.time[c->next], ahead = fabs(goal - phi->t);
  c->at_instant = length >= ahead;
  if (c->at_instant)
    end_at(phi, goal);
  else {
    if (length > 0.5 * ahead) length = 0.5 * ahead;
    end_at(phi, goal > phi->t ? phi->t + length : phi->t - length);
  }
  return phi->t_next != phi->t;
}

/* -- the midpoint */

/* truncation error over what is allowed, the worst component */
static double truncation(const field *f, const set *x, const sizes *z, flow *phi) {
  double worst = 0;
  if (!flow_centre_excess(f, phi, NULL)) return INFINITY;
  for (uint32_t i = 0; i < f->nx; i++) {
    double allowed = f->options.tolerance * z->unit[i] + WIDE_SHARE * x->radius[i];
    if (z->lenient) allowed += sizes_noise(phi, i);
    double ratio = phi->excess[i] / (allowed + TINY);
    if (!(ratio <= worst)) worst = ratio; /* NaN too */
  }
  return worst >= 0 ? worst : INFINITY;
}

/* -- the slopes */

/* What the excess of slopes, added[i], adds to the set, over what is allowed: little beside the set, or beside what the
** step makes of it (a component that starts as a point grows by its first two derivatives). One
** that starts from zero and feels others by its third derivative only has none of these (see `fill`). The worst
** component. */
static double slope_error(const field *f, const set *x, const flow *phi, double varies, const double *added, sizes *z) {
  double worst = 0, share = flow_share_of_time(f, phi);
  share *= f->nc == 0 ? SLOPPY : smaller(SLOPPY, larger(NEAT, varies));
  sizes_choose_grown(f, x, phi, z);
  double nothing = TINY; /* what guesses of TINY for the slopes make of the set, beside a state that is zero */
  for (uint32_t j = 0; j < f->ndir; j++) nothing += GUESSES_OF_NOTHING * TINY * set_reach(f, x, j);
  for (uint32_t i = 0; i < f->nx; i++) {
    double allowed = f->options.tolerance * (z->lenient ? z->unit[i] : z->size[i]);
    if (z->lenient) allowed += sizes_noise(phi, i);
    double ratio = added[i] / (share * z->grown[i] + allowed + nothing);
    if (!(ratio <= worst)) worst = ratio; /* NaN too */
  }
  return worst >= 0 ? worst : INFINITY;
}

static double taylor_slope_error(const field *f, const set *x, const flow *phi, slopes *S, sizes *z) {
  for (uint32_t i = 0; i < f->nx; i++) {
    S->added[i] = 0;
    for (uint32_t j = 0; j < f->ndir; j++)
      S->added[i] += phi->slope_excess[(size_t)i * f->ndir + j] * set_reach(f, x, j);
  }
  return slope_error(f, x, phi, S->varies, S->added, z);
}

/* slopes at the end of the step by one of the formulas; sets `corrected` */
static double find_slopes(const field *f, const set *x, sizes *z, slopes *S, flow *phi) {
  uint32_t formula = f->options.formula;
  double ratio = formula == FORMULA_HERMITE_OBRESCHKOFF ? INFINITY : taylor_slope_error(f, x, phi, S, z);
  S->corrected = 0;
  flow_tube(f, x, phi);
  if (ratio <= 1 || formula == FORMULA_TAYLOR) return ratio;
  if (formula == FORMULA_AUTO && (S->wide || phi->q < f->options.slope_order_max)) return ratio;
  if (!corrector_find(f, x, phi, &S->corrector, S->piece)) return INFINITY;
  S->corrected = 1;
  return slope_error(f, x, phi, S->varies, S->corrector.added, z);
}

/* -- both */

/* the next length to try for a ratio of error to what is allowed that goes like its power order + 1 */
static double rescaled(const flow *phi, double ratio, uint32_t order) {
  double factor = ratio > 0 ? pow(AIM / ratio, 1.0 / (order + 1.0)) : GROWTH;
  if (!(factor > 0.1)) factor = 0.1;
  return phi->step.length * smaller(factor, GROWTH);
}

/* An automatic order of the slopes follows the step that the midpoint's series allows; not over wide sets, for which
** long steps do not pay: what slopes vary by grows with them. */
static void adapt_slope_order(const options *o, uint32_t q, double by_centre, double by_slopes, control *c) {
  if (by_slopes < SLOPES_LIMIT * by_centre && q < o->slope_order_max) c->slope_order++;
  if (by_slopes > SLOPES_ALLOW * by_centre && q > o->slope_order) c->slope_order--;
}

/* Over wide sets: what slopes vary by at the end of the step, over what they would if that grew with time only, less
** one. It goes about like the length of the step; as long as it is small, several steps lose no more than one. */
static double bend(const field *f, const set *x, const sizes *z, const flow *phi) {
  uint32_t n = f->ndir, q = phi->q;
  double whole = 0, first = 0;
  for (uint32_t i = 0; i < f->nx; i++)
    for (uint32_t j = 0; j < n; j++) {
      const double *rad = phi->slope.rad + (size_t)i * (q + 1u) * n + j;
      double sum = 0, weight = set_reach(f, x, j) / (z->unit[i] + TINY);
      for (uint32_t k = q; k > 0; k--) sum = (sum + rad[(size_t)k * n]) * phi->step.length;
      whole += sum * weight;
      first += rad[n] * phi->step.length * weight;
    }
  return first > 0 ? whole / first - 1 : 0; /* 0: slopes are constant but for rounding */
}

/* a length that was tried */
typedef struct trial {
  double length;             /* that was looked for */
  int cut_short;             /* by an instant */
  double ratio, slope_ratio; /* errors of the midpoint and of slopes, over what is allowed */
} trial;

static void plan_next(const field *f, const set *x, const slopes *S, const flow *phi, const trial *done, control *c) {
  double by_centre = rescaled(phi, done->ratio, phi->p), by_slopes = rescaled(phi, done->slope_ratio, phi->q);
  if (!done->cut_short) adapt_slope_order(&f->options, phi->q, by_centre, S->wide ? INFINITY : by_slopes, c);
  double bends = S->wide ? bend(f, x, &c->sizes, phi) : 0;
  if (bends > 0) by_slopes = smaller(by_slopes, phi->step.length * smaller(BEND / bends, GROWTH));
  c->guess = smaller(by_centre, by_slopes);
  if (done->cut_short) c->guess = larger(done->length, c->guess);
  c->longest = larger(c->guess, by_slopes);
}

/* 1: no step is short enough, because some state that is zero, and stays so for its first derivatives, has no size */
static int has_no_size(const field *f, const set *x, const sizes *z, const flow *phi) {
  for (uint32_t i = 0; i < f->nx; i++)
    if (z->unit[i] == 0 && x->radius[i] == 0 && phi->excess[i] > 0) return 1;
  return 0;
}

static enum why search(const field *f, const set *x, double least, control *c, slopes *S, flow *phi) {
  sizes *z = &c->sizes;
  double before = INFINITY, most = smaller(c->longest, f->options.step_max);
  trial now = { .length = smaller(larger(c->guess, least), most) };
  for (int i = 0; i < TRIES; i++) {
    if (!plan(f, now.length, c, phi) || (phi->step.length < least && !c->at_instant)) return WHY_NO_STEP;
    ambit_work_try(c->counted);
    sizes_choose_unit(f, phi, z);
    now.ratio = truncation(f, x, z, phi);
    if (z->lenient == LENIENT_NOT && now.ratio < INFINITY && has_no_size(f, x, z, phi)) return WHY_NO_STEP;
    if (now.ratio > 1) { /* never again as long: an infinite ratio would otherwise shrink and grow in turn */
      most = smaller(most, SHRINK * phi->step.length);
      now.length = smaller(rescaled(phi, now.ratio, phi->p), most);
      continue;
    }
    now.cut_short = c->at_instant || phi->step.length < 0.99 * now.length;
    if (now.ratio < LOW_WATER && !now.cut_short && now.length < most) {
      now.length = now.ratio > 0 ? smaller(rescaled(phi, now.ratio, phi->p), most) : most;
      continue;
    }
    if (!flow_is_proved(f, phi, z->unit))
      most = now.length = SHRINK * phi->step.length;
    else if ((now.slope_ratio = find_slopes(f, x, z, S, phi)) <= 1) {
      plan_next(f, x, S, phi, &now, c);
      return WHY_NOTHING;
    } else { /* near: sizes shrink faster than errors */
      if (z->lenient == LENIENT_NEAR && now.slope_ratio > before) return WHY_NO_STEP;
      before = now.slope_ratio;
      most = now.length = smaller(SHRINK * phi->step.length, rescaled(phi, now.slope_ratio, phi->q));
    }
  }
  return WHY_NO_STEP;
}

double control_least_step(const field *f, double t) {
  return ambit_least_step(f->options.step_min, t, f->problem.time[0], field_end(f));
}

/* A step of at least `least`, with as much leniency as it needs. */
static enum why search_with_leniency(
    const field *f, const set *x, enum leniency from, double least, control *c, slopes *S, flow *phi) {
  for (enum leniency now = from; now <= LENIENT_FAR; now++) {
    c->sizes.lenient = now;
    if (search(f, x, least, c, S, phi) == WHY_NOTHING) {
      if (now != LENIENT_FAR || !sizes_are_filled(f, &c->sizes)) c->sizes.lenient = LENIENT_NOT;
      return WHY_NOTHING;
    }
  }
  return WHY_NO_STEP;
}

/* Leniency is for states that have no size of their own yet: relative to what they are, steps from rest are nearly as
** short as one likes. So a step that is no small part of the run is looked for first, with any leniency, and only then
** a shorter one. */
enum why control_find_step(const field *f, const set *x, control *c, slopes *S, flow *phi) {
  phi->t = x->t;
  phi->q = c->slope_order;
  uint32_t centre = flow_centre_series(f, x, phi), box = flow_box_series(f, x, f->whole, phi);
  if (centre || box) return centre ? WHY_CENTRE : WHY_BOX;
  double least = control_least_step(f, x->t);
  double first = f->options.step_min > 0 ? least : larger(least, SMALL_PART * field_span(f));
  enum why why = search_with_leniency(f, x, c->sizes.lenient, first, c, S, phi);
  if (why == WHY_NOTHING || first == least) return why;
  return search_with_leniency(f, x, LENIENT_NOT, least, c, S, phi);
}
