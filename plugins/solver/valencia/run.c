/* run.c -- from step to step, into the sink; and what a run that could not go on has to say. */
#include "valencia.h"
#include "shared/deliver.h"
#include <ambit/code.h>
#include <stdio.h>
#include <string.h>

#define FORGET 0.998 /* per step: how fast a state's size is forgotten */
#define FILLED 1e-9  /* share of what others make of a state, that it counts as at least */
#define NOTHING 1e-200
#define SHARE 0.02 /* of the width, which a step may add */
#define TIGHT 1e-6 /* of the width, where p follows the unknowns by itself */
#define MODEST 0.1 /* and may add if a shorter one would add it all the same */
#define GROW_MAX 2.5
#define SHORT 1e-6 /* of the time span */
#define NOISE 0.8  /* an error that does not shrink with the step is rounding */
#define NOISE_SHARE 16
#define ROUNDING_MAX 100.0
#define FIRST_ORDER                                                                                                    \
  0.6 /* an error that shrinks no faster than the step is not the curve's: shorter steps gain nothing */

/* -- records */

/* the middle curve in powers of (t - t_from): sigma = (t - t_from) / half - 1; everything else is constant in time */
static void find_dense(valencia *s) {
  uint32_t n = s->stages.n + 1;
  interval *c = s->column, factor = point(1), per;
  double one[2] = { 1, 1 }, half[2] = { s->half.lo, s->half.hi }, r[2];
  s->num->map(AMBIT_OP_DIV, 1, r, one, half, 0);
  per = (interval) { r[0], r[1] };
  for (uint32_t i = 0; i < s->nx; i++, factor = point(1)) {
    const double *from = s->curve + (size_t)i * s->terms.n * n;
    double around = s->reach_z[i] + s->over[i];
    for (uint32_t k = n; k < s->terms.n * n; k++) around += fabs(from[k]);
    for (uint32_t m = 0; m < n; m++) c[m] = point(from[m]);
    for (uint32_t k = 0; k < n; k++)
      for (uint32_t m = n - 1; m-- > k;) c[m] = minus(c[m], c[m + 1]);
    for (uint32_t m = 0; m < n; m++, factor = times(factor, per)) {
      interval x = times(c[m], factor);
      double mid = middle(x);
      s->dense_mid[(size_t)i * n + m] = mid;
      s->dense_rad[(size_t)i * n + m] = larger(x.hi - mid, mid - x.lo) + (m ? 0 : around);
    }
  }
}

static int32_t emit(valencia *s, ambit_sink *sink, double t_from) {
  const ambit_problem *p = &s->problem;
  const ambit_set set = { .size = sizeof set,
    .nu = s->nu,
    .nterm = s->terms.n,
    .about = s->set_about,
    .scale = s->set_scale,
    .exponent = s->terms.exponent,
    .coefficient = s->p,
    .rest = s->rest };
  ambit_record r = { .size = sizeof r,
    .kind = AMBIT_REC_STEP,
    .t_from = t_from,
    .t_to = s->t,
    .nx = s->nx,
    .rigorous = 1,
    .lo = s->lo,
    .hi = s->hi,
    .tube_lo = s->tube_lo,
    .tube_hi = s->tube_hi,
    .order = s->stages.n };
  if (p->extras & AMBIT_EXTRA_DENSE) {
    find_dense(s);
    r.ndense = s->stages.n + 1, r.dense_mid = s->dense_mid, r.dense_rad = s->dense_rad;
  }
  if (p->extras & AMBIT_EXTRA_SET && !s->is_cut) r.set = &set; /* else the set is not inside [lo, hi] */
  double done = (s->t - p->time[0]) / (p->time[p->ntime - 1] - p->time[0]);
  return shared_deliver(sink, &r, done);
}

/* -- the hull */

static void find_hull(valencia *s) {
  for (uint32_t i = 0; i < s->nx; i++) {
    double rest = 0;
    for (uint32_t j = 0; j < s->nx; j++) rest += fabs(s->b[(size_t)i * s->nx + j]) * s->w[j];
    interval x = plus(valencia_terms_range(&s->terms, s->nu, s->p + (size_t)i * s->terms.n, 1), within(rest));
    s->rest[i] = rest, s->lo[i] = x.lo, s->hi[i] = x.hi;
  }
}

/* A state that is zero, or next to it, counts as a small share of what the others make of it in the time in which some
** state changes by its own size, or two exchange theirs: states are compared by derivatives only, whatever their
** units. */
static void fill_magnitudes(valencia *s, double t) {
  stages *g = &s->stages;
  double *x = s->scratch, time = INFINITY, least = INFINITY;
  for (uint32_t i = 0; i < s->nx; i++) x[i] = 0.5 * s->lo[i] + 0.5 * s->hi[i];
  int known = valencia_point(s, x, s->middle, t, g->right, g->jacobian), more = known;
  for (uint32_t i = 0; i < s->nx && known; i++) {
    if (s->magnitude[i] > NOTHING) time = smaller(time, s->magnitude[i] / fabs(g->right[i]));
    for (uint32_t j = 0; j <= i; j++) {
      double there = fabs(g->jacobian[(size_t)i * s->ndir + j]), back = fabs(g->jacobian[(size_t)j * s->ndir + i]);
      time = smaller(time, 1 / sqrt(there * back));
    }
  }
  for (uint32_t sweep = 0; sweep < s->nx && more && time < INFINITY; sweep++) {
    more = 0;
    for (uint32_t i = 0; i < s->nx; i++) {
      double sum = 0;
      for (uint32_t j = 0; j < s->nx; j++)
        sum += FILLED * time * fabs(g->jacobian[(size_t)i * s->ndir + j]) * s->magnitude[j];
      if (!(sum > s->magnitude[i] && sum < INFINITY)) continue;
      more |= s->magnitude[i] <= NOTHING;
      s->magnitude[i] = sum;
    }
  }
  for (uint32_t i = 0; i < s->nx; i++)
    if (s->magnitude[i] > NOTHING) least = smaller(least, s->magnitude[i]);
  for (uint32_t i = 0; i < s->nx; i++)
    if (s->magnitude[i] <= NOTHING) s->magnitude[i] = least < INFINITY ? FILLED * least : NOTHING;
}

static void note_magnitudes(valencia *s, double t, double forget) {
  for (uint32_t i = 0; i < s->nx; i++) {
    double now = larger(fabs(s->lo[i]), fabs(s->hi[i]));
    s->magnitude[i] = larger(larger(forget * s->magnitude[i], now < INFINITY ? now : 0), NOTHING);
  }
  fill_magnitudes(s, t);
}

/* -- steps */

/* A share of the span as well: no other rule ends a run whose steps shrink without end. */
static double least_step(const valencia *s) {
  const double *time = s->problem.time;
  double end = time[s->problem.ntime - 1], least = ambit_least_step(s->options.step_min, s->t, time[0], end);
  return s->options.step_min > 0 ? least : larger(least, 0x1p-43 * fabs(end - time[0]));
}

/* the interval of time [t, t + h], or up to the next instant; a step that is too short for the clock is its least
** one */
static void set_times(valencia *s, double h) {
  double end = s->problem.time[s->next], left = end - s->t, sign = left < 0 ? -1 : 1;
  h = smaller(smaller(h, s->options.step_max), fabs(left));
  if (h < fabs(left) && 2 * h > fabs(left)) h = 0.5 * fabs(left);
  s->t_next = s->t + sign * h;
  if (s->t_next == s->t) s->t_next = nextafter(s->t, end);
  s->at_instant = h >= fabs(left) || (left < 0 ? s->t_next <= end : s->t_next >= end);
  if (s->at_instant) s->t_next = end;
  interval from = point(s->t), to = point(s->t_next);
  s->h = fabs(s->t_next - s->t);
  s->half = scaled(minus(to, from), 0.5), s->time = scaled(plus(from, to), 0.5);
}

static double size_of(const valencia *s, uint32_t i) {
  return larger(s->magnitude[i], larger(fabs(s->tube_lo[i]), fabs(s->tube_hi[i])));
}

/* of the set at the end of the step, about: the error so far, and while p is linear in the unknowns, what these make of
** it; a polynomial of higher degree follows them, and is worth keeping tight */
static double width_of(const valencia *s, uint32_t i) {
  uint32_t n = s->stages.n + 1;
  double most = s->reach_z[i];
  double share = s->terms.n <= 1 + s->nu ? 1 : TIGHT;
  for (uint32_t k = 1; k < s->terms.n; k++) {
    double end = 0;
    for (uint32_t m = 0; m < n; m++) end += s->curve[((size_t)i * s->terms.n + k) * n + m];
    most += share * fabs(end);
  }
  return 2 * most;
}

/* The worst of the errors that the step added, in units of what is allowed. A set that is wide makes errors in
** proportion to the step, so only a share of that width bounds the step. */
static double excess(const valencia *s) {
  double most = 0;
  for (uint32_t i = 0; i < s->nx; i++) {
    double allowed = (s->options.tolerance + 0x1p-48) * size_of(s, i) + NOISE_SHARE * magnitude(s->half) * s->noise[i];
    most = larger_or_nan(most, smaller(s->error[i], s->steerable[i] + s->rounding[i]) / allowed);
    most = larger_or_nan(most, s->error[i] / (allowed + SHARE * width_of(s, i)));
  }
  return most;
}

/* is the error small beside what is uncertain anyway, or the step as short as is reasonable? */
static int is_modest(const valencia *s) {
  const ambit_problem *p = &s->problem;
  if (s->h <= SHORT * fabs(p->time[p->ntime - 1] - p->time[0])) return 1;
  for (uint32_t i = 0; i < s->nx; i++)
    if (!(s->error[i] <= MODEST * width_of(s, i) + 16 * s->options.tolerance * size_of(s, i))) return 0;
  return 1;
}

static double factor_for(const valencia *s, double excess) {
  double f = 0.9 * pow(larger(excess, 1e-30), -1.0 / (s->stages.n + 1.0));
  return smaller(larger(f, 0.3), GROW_MAX);
}

/* no step of h: the clock moves no less than by the last one, or less than it may */
static int is_too_short(valencia *s, double h, double last) {
  set_times(s, h);
  if (!(s->h < last)) return 1;
  /* an instant may be closer than the least step */
  return s->h < least_step(s) && (!s->at_instant || h < least_step(s));
}

/* The last step, of argument h: if it was proved, only with a larger error than wanted, it is the one to take. */
static enum why settle(valencia *s, double h, enum why why) {
  if (why == WHY_NOTHING) set_times(s, h), s->guess = s->h;
  return why;
}

static enum why try_steps(valencia *s) {
  double h = larger(s->guess, least_step(s)), tried = h, last = INFINITY, over_before = INFINITY,
         rate_before = INFINITY;
  enum why why = WHY_NO_CONTAIN;
  for (;;) {
    if (is_too_short(s, h, last)) return settle(s, tried, why);
    tried = h;
    ambit_work_try(s->counted);
    s->cut = last == INFINITY && s->at_instant;
    h = last = s->h, s->kink_name = NULL;
    why = valencia_curve(s) ? valencia_verify(s) : WHY_CURVE;
    if (why != WHY_NOTHING) {
      h *= why == WHY_DOMAIN ? 0.25 : 0.5;
      continue;
    }
    double over = excess(s), rate = over / s->h;
    if (over <= 1 && rate > FIRST_ORDER * rate_before) { /* the longer step before was as good, per second */
      s->rate_known = rate, s->guess = 2 * s->h;
      return WHY_NOTHING;
    }
    if (over <= 1) {
      s->guess = s->h * larger(factor_for(s, over), over < 0.5 ? 1.2 : 1.02);
      return WHY_NOTHING;
    }
    if (over < ROUNDING_MAX && over > NOISE * over_before) { /* a shorter step would not be better */
      s->guess = s->h;
      return WHY_NOTHING;
    }
    if (is_modest(s) && (rate > FIRST_ORDER * rate_before || rate <= 2 * s->rate_known)) {
      if (rate > FIRST_ORDER * rate_before) s->rate_known = rate;
      s->guess = 1.2 * s->h;
      return WHY_NOTHING;
    }
    over_before = over, rate_before = rate;
    h *= smaller(factor_for(s, over), 0.5);
  }
}

/* A step that was cut at an instant says nothing against the length that was asked for. */
static enum why find_step(valencia *s) {
  double asked = s->guess;
  s->cut = 0;
  enum why why = try_steps(s);
  if (why == WHY_NOTHING && s->cut) s->guess = larger(s->guess, asked);
  return why;
}

static int is_good(const valencia *s, uint32_t i) {
  int narrow = s->options.width_max == 0 || s->hi[i] - s->lo[i] <= s->limit[i];
  return narrow && s->lo[i] > -INFINITY && s->hi[i] < INFINITY && s->tube_lo[i] > -INFINITY &&
         s->tube_hi[i] < INFINITY && s->tube_lo[i] <= s->tube_hi[i];
}

static int explodes(valencia *s) {
  ambit_explosion e = AMBIT_EXPLOSION_START;
  for (uint32_t i = 0; i < s->nx; i++) {
    double linear = 0;
    for (uint32_t k = 0; k < s->terms.n; k++) linear += fabs(s->p[(size_t)i * s->terms.n + k]);
    ambit_explosion_note(&e, i, s->hi[i] - s->lo[i], linear, &s->limit[i]);
  }
  s->blamed = e.worst;
  return ambit_explodes(&e);
}

#define ROUNDING 1e-8 /* of the state: narrower sets are a matter of it */
#define CLEARLY 0.8
#define BY_FAR 0.15 /* by volume */

/* Is the box of the faces clearly narrower than the set's hull: in every state, or as a whole (a state may be
** constant)? Of smooth equations the mean state must gain that much: a small gain in each of many is not worth
** forgetting how the set depends on the unknowns. */
static int is_far_narrower(const valencia *s) {
  int narrower = 1;
  double volume = 1;
  for (uint32_t i = 0; i < s->nx; i++) {
    double hull = s->hi[i] - s->lo[i], box = s->face_hi[i] - s->face_lo[i];
    narrower = narrower && box < CLEARLY * hull;
    volume *= box < hull ? box / hull : 1;
  }
  return narrower || volume < (s->kink ? BY_FAR : pow(CLEARLY, (double)s->nx));
}

/* The set begins anew as the box of the faces, and forgets how it depended on the unknowns. */
static void begin_anew(valencia *s) {
  memset(s->p, 0, s->nx * s->terms.n * sizeof *s->p);
  for (uint32_t i = 0; i < s->nx; i++) {
    double mid = middle((interval) { s->face_lo[i], s->face_hi[i] });
    s->p[(size_t)i * s->terms.n] = mid;
    s->w[i] = larger(s->face_hi[i] - mid, mid - s->face_lo[i]);
    for (uint32_t j = 0; j < s->nx; j++) s->b[(size_t)i * s->nx + j] = i == j;
  }
  find_hull(s);
}

/* Both boxes hold, and so does their intersection, from which the faces go on. A record shows it at kinks only: such a
** record has no set (emit). */
static void meet_faces(valencia *s) {
  for (uint32_t i = 0; i < s->nx; i++) {
    interval x = meet((interval) { s->lo[i], s->hi[i] }, (interval) { s->face_lo[i], s->face_hi[i] });
    s->face_lo[i] = x.lo, s->face_hi[i] = x.hi;
  }
  int anew = is_far_narrower(s);
  if (s->kink) memcpy(s->lo, s->face_lo, s->nx * sizeof *s->lo), memcpy(s->hi, s->face_hi, s->nx * sizeof *s->hi);
  if (anew) begin_anew(s);
  s->is_cut = s->kink;
}

/* Is the set more than rounding? Faces gain nothing before. */
static int is_wide(const valencia *s) {
  for (uint32_t i = 0; i < s->nx; i++)
    if (s->hi[i] - s->lo[i] > ROUNDING * s->magnitude[i]) return 1;
  return 0;
}

static enum why advance(valencia *s) {
  enum why why = find_step(s);
  if (why != WHY_NOTHING) return why;
  if (!s->has_faces) memcpy(s->face_lo, s->lo, s->nx * sizeof *s->lo), memcpy(s->face_hi, s->hi, s->nx * sizeof *s->hi);
  valencia_move(s);
  find_hull(s);
  s->is_cut = 0;
  s->has_faces = (s->kink || (s->is_smooth && is_wide(s))) && valencia_faces(s, s->face_lo, s->face_hi);
  if (s->has_faces) meet_faces(s);
  note_magnitudes(s, s->t_next, FORGET);
  if (s->options.width_max == 0 && explodes(s)) return WHY_WIDE;
  for (uint32_t i = 0; i < s->nx; i++) {
    s->blamed = i;
    if (!is_good(s, i)) return WHY_WIDE;
  }
  s->t = s->t_next;
  s->next += (uint32_t)s->at_instant;
  return WHY_NOTHING;
}

static void begin(valencia *s) {
  const ambit_problem *p = &s->problem;
  memcpy(s->p, s->start_p, s->nx * s->terms.n * sizeof *s->p);
  memcpy(s->w, s->start_w, s->nx * sizeof *s->w);
  for (uint32_t k = 0; k < s->nx * s->nx; k++) s->b[k] = k % (s->nx + 1) == 0;
  s->t = p->time[0], s->next = 1, s->has_faces = s->is_cut = 0, s->is_smooth = valencia_is_smooth(p->rhs),
  s->rate_known = 0;
  s->guess = smaller(larger(0.01 * fabs(p->time[p->ntime - 1] - p->time[0]), least_step(s)), s->options.step_max);
  find_hull(s);
  memset(s->magnitude, 0, s->nx * sizeof *s->magnitude);
  note_magnitudes(s, s->t, 0);
  for (uint32_t i = 0; i < s->nx; i++) s->scale[i] = exp2(2 + ceil(log2(smaller(s->magnitude[i], 0x1p900))));
  for (uint32_t i = 0; i < s->nx; i++)
    s->limit[i] = s->options.width_max * larger(1, larger(fabs(s->lo[i]), fabs(s->hi[i])));
  if (s->options.width_max == 0) explodes(s); /* the first step may be the one that is too wide */
}

static AMBIT_WORKER enum why work(valencia *s, ambit_sink *sink) {
  begin(s);
  while (s->next < s->problem.ntime) {
    double t_from = s->t;
    enum why why = advance(s);
    if (why != WHY_NOTHING) return why;
    if (emit(s, sink, t_from)) return WHY_STOPPED;
  }
  return WHY_NOTHING;
}

/* -- reasons */

static double widest(const valencia *s) {
  double most = 0;
  for (uint32_t i = 0; i < s->nx; i++) most = larger(most, s->hi[i] - s->lo[i]);
  return most;
}

static void say_kink(const valencia *s, size_t room, char *text) {
  text[0] = '\0';
  if (s->kink_name) snprintf(text, room, ", on the kink of %s", s->kink_name);
}

static ambit_status explain(const valencia *s, enum why why) {
  const ambit_host *h = s->host;
  char kink[256];
  say_kink(s, sizeof kink, kink);
  switch (why) {
  case WHY_NOTHING: return AMBIT_OK;
  case WHY_STOPPED: return AMBIT_STOPPED;
  case WHY_DOMAIN:
  case WHY_CURVE:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_UNDEFINED,
        "at t = %.9g s the right-hand side could not be bounded over the enclosure, which is up to %.3g wide%s, "
        "however "
        "short the step; split the initial set, or end before it",
        s->t, widest(s), kink);
  case WHY_WIDE:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_WIDTH,
        "the enclosure of `%s` grew wider than %.4g in the step from t = %.9g s%s; split the initial set, take the "
        "arithmetic taylor_model with a higher order, or allow more by `width_max`",
        s->problem.name[s->blamed], s->limit[s->blamed], s->t, kink);
  default:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_STEP,
        "at t = %.9g s no error bound of a step of at least %.3g s maps into itself, with an enclosure up to %.3g "
        "wide%s; split the initial set, lower `step_min` or raise `tolerance`",
        s->t, least_step(s), widest(s), kink);
  }
}

ambit_status valencia_run(void *self, ambit_sink *sink) {
  ambit_rounding outside = ambit_round_up();
  enum why why = work(self, sink);
  ambit_rounding_restore(outside);
  return explain(self, why);
}
