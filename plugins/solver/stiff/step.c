/* step.c -- a step: its length, its polynomial, and the proof piece by piece. Round-to-nearest.
**
** The length follows the size of the last Chebyshev coefficients. A polynomial that cannot be proved is tried with
** twice as many pieces, then with half the length.
*/
#include "stiff.h"
#include <string.h>

#define REJECTIONS 100 /* in a row */
#define ACCEPT 30.0    /* last coefficients over the tolerance */
#define GROWTH 2.0
#define CAREFUL 1.15 /* growth of the next steps after a proof failed */
#define CAREFUL_STEPS 4
#define SHRINK_NEWTON 0.3
#define IMPROVEMENTS 2
#define HIGHEST 4       /* level: 64 pieces */
#define MOST_RATE 1e150 /* over a piece: frames are compared by squares */

/* -- lengths */

static double direction(const stiff *s) { return s->problem.time[s->problem.ntime - 1] < s->problem.time[0] ? -1 : 1; }

/* a step of about `length`, to the instant ahead or leaving as much before it; 0: it is none */
static int plan(stiff *s, double length) {
  double goal = s->problem.time[s->next], ahead = fabs(goal - s->t);
  length = fmin(length, s->options.step_max);
  s->at_instant = length >= ahead;
  if (!s->at_instant && length > 0.5 * ahead) length = 0.5 * ahead;
  s->t_next = s->at_instant ? goal : s->t + direction(s) * length;
  s->h = two_sum(s->t_next, -s->t);
  double least = s->options.step_min > 0 ? s->options.step_min : 0x1p-48 * fabs(s->t);
  return s->h.hi != 0 && (s->at_instant || fabs(s->h.hi) >= least);
}

/* -- the proof */

static AMBIT_WORKER enum why prove_up(stiff *s, uint32_t j, uint32_t m) { return prove_piece(s, j, m); }

static enum why prove(stiff *s, uint32_t j, uint32_t m) {
  ambit_rounding nearest = ambit_round_up();
  enum why why = prove_up(s, j, m);
  ambit_rounding_restore(nearest);
  return why;
}

/* three times the carried set, as a guess of the tube */
static void guess_box(stiff *s) {
  const carried *c = &s->carried;
  for (uint32_t i = 0; i < s->n; i++) {
    double sum = fabs(s->gap[i]) + s->gap_error[i];
    for (uint32_t k = 0; k < s->n; k++) sum += fabs(c->B[i * s->n + k]) * c->w[c->block[k]];
    s->box[i] = i < s->nx ? 3 * sum : sum * (1 + 0x1p-20);
  }
}

static void add_to_tube(stiff *s, int first) {
  for (uint32_t i = 0; i < s->nx; i++) {
    double lo, hi;
    poly_range(&s->P[i], &lo, &hi);
    double radius = s->spread ? (s->radius[i] + spread_reach(s, i)) * (1 + 0x1p-40) : s->radius[i];
    lo = nextafter(lo - radius, -INFINITY), hi = nextafter(hi + radius, INFINITY);
    s->tube_lo[i] = first ? lo : fmin(s->tube_lo[i], lo);
    s->tube_hi[i] = first ? hi : fmax(s->tube_hi[i], hi);
  }
}

static void cut(stiff *s, uint32_t j) {
  pieces_cut(s, s->level, j);
  if (s->spread) spread_cut(s, pieces_table(s, s->level, j));
}

static enum why piece(stiff *s, uint32_t j, uint32_t m) {
  cut(s, j);
  evaluate_gap(s);
  guess_box(s);
  if (!evaluate_slopes(s, j, m) || !evaluate_defect(s, j, m)) return WHY_UNDEFINED;
  if (s->choice)
    natural_frame(s, s->choice);
  else if (!frame_choose(s, j))
    return WHY_SPLIT;
  memset(s->shift, 0, s->n * sizeof *s->shift);
  for (int i = 0; s->frame.split.slow > 0 && i < IMPROVEMENTS; i++) {
    improve_piece(s);
    if (!evaluate_defect(s, j, m)) return WHY_UNDEFINED;
  }
  evaluate_gap(s);
  enum why why = prove(s, j, m);
  if (why != WHY_NOTHING) return why;
  evaluate_end(s);
  add_to_tube(s, j == 0);
  if (s->problem.extras & AMBIT_EXTRA_DENSE) dense_piece(s, j);
  return WHY_NOTHING;
}

static void keep(stiff *s) {
  s->saved = s->carried;
  if (s->spread) spread_keep(s, 0);
  memcpy(s->saved_end, s->end, s->n * sizeof *s->end);
  memcpy(s->saved_error, s->end_error, s->n * sizeof *s->end_error);
}

static void bring_back(stiff *s) {
  s->carried = s->saved;
  if (s->spread) spread_keep(s, 1);
  memcpy(s->end, s->saved_end, s->n * sizeof *s->end);
  memcpy(s->end_error, s->saved_error, s->n * sizeof *s->end_error);
}

#define HANDED_ON 2

/* Directions are compared in units of how far a state moves, or how uncertain it is, or what such an error of another
** one makes of it before the fastest rate takes it back: the speed of an overdamped mass that turns has no size of its
** own. */
static void widen_scale(stiff *s) {
  const carried *c = &s->carried;
  uint32_t nx = s->nx;
  const double *J = s->q.J + (size_t)(s->q.N / 2) * nx * nx;
  square power;
  double next[N_MAX];
  memcpy(power, J, (size_t)nx * nx * sizeof *J);
  double rate = matrix_radius(nx, power);
  for (uint32_t i = 0; i < s->nx; i++)
    for (uint32_t k = 0; k < s->n; k++) s->q.scale[i] += fabs(c->B[i * s->n + k]) * c->w[c->block[k]];
  for (int sweep = 0; rate > 0 && sweep < HANDED_ON; sweep++) {
    for (uint32_t i = 0; i < nx; i++) {
      next[i] = 0;
      for (uint32_t k = 0; k < nx; k++) next[i] += 1e-2 * fabs(J[i * nx + k]) * s->q.scale[k] / rate;
    }
    for (uint32_t i = 0; i < nx; i++) s->q.scale[i] = fmax(s->q.scale[i], next[i] < INFINITY ? next[i] : 0);
  }
}

/* judged in the middle of the step */
static void choose_frame(stiff *s, uint32_t m) {
  cut(s, m / 2);
  memset(s->gap, 0, s->n * sizeof *s->gap);
  memset(s->gap_error, 0, s->n * sizeof *s->gap_error);
  guess_box(s);
  if (evaluate_slopes(s, m / 2, m)) natural_choose(s, m / 2, m);
}

static int too_fast(const stiff *s, uint32_t m) {
  double most = 0;
  for (size_t i = 0; i < (size_t)(m + 1) * s->n * s->n; i++) most = fmax(most, fabs(s->rate[i]));
  return most > MOST_RATE;
}

static enum why prove_pieces(stiff *s) {
  uint32_t m = 4u << s->level;
  s->half = (dd) { s->h.hi / (2.0 * m), s->h.lo / (2.0 * m) };
  evaluate_rates(s, m);
  if (too_fast(s, m)) return WHY_FAST;
  if (s->problem.extras & AMBIT_EXTRA_DENSE) dense_start(s);
  if (s->spread) choose_frame(s, m);
  for (uint32_t j = 0; j < m; j++) {
    enum why why = piece(s, j, m);
    if (why != WHY_NOTHING) return why;
  }
  return WHY_NOTHING;
}

static enum why prove_step(stiff *s) {
  enum why why = WHY_NOTHING;
  uint32_t least = s->frame.split.slow > 0; /* eight pieces where errors are moved along, four where all decay */
  uint32_t first = s->level > least ? s->level - 1 : least;
  keep(s);
  widen_scale(s);
  for (s->level = first; s->level <= HIGHEST; s->level++) {
    why = prove_pieces(s);
    if (why == WHY_NOTHING) return why;
    bring_back(s);
    if (why == WHY_FAST) return why;
  }
  s->level = HIGHEST;
  return why;
}

/* -- the step */

/* Where the next polynomial starts: where this one's pieces ended, but in fast directions where the collocation ended:
** what those differ by would be a transient that a long step cannot follow. The proof adds any difference. */
static void place_start(stiff *s) {
  collocation *q = &s->q;
  const carried *c = &s->carried;
  uint32_t n = s->n, slow = n - c->fast;
  long double x[N_MAX];
  double gap[N_MAX] = { 0 }, z[N_MAX];
  square inverse;
  collocation_value(q, 1, x);
  if (s->spread) spread_place(s);
  for (uint32_t i = 0; i < s->nx; i++) {
    q->x[i] = dd_long(s->end[i]);
    s->below[i] = dd_sub(s->end[i], dd_of(q->x[i])).hi;
    gap[i] = (double)(x[i] - q->x[i]);
  }
  if (c->fast == 0 || !matrix_inverse(n, c->B, inverse)) return;
  matrix_multiply(n, n, 1, inverse, gap, z);
  for (uint32_t i = 0; i < s->nx; i++)
    for (uint32_t k = slow; k < n; k++) q->x[i] += c->B[i * n + k] * z[k];
}

static double rescaled(const stiff *s) {
  return 0.9 * pow(s->options.tolerance / fmax(s->q.error, 1e-22), 1.0 / s->q.N);
}

/* where the first step fails, states without size are given one before it is made shorter */
static int solve(stiff *s) {
  const ambit_problem *p = &s->problem;
  int good = collocation_solve(&s->q, s->t, s->h.hi);
  if (!good && s->t == p->time[0] && !s->looked_ahead) {
    collocation_look_ahead(&s->q, s->t, s->h.hi, p->time[p->ntime - 1]);
    s->looked_ahead = 1;
    good = collocation_solve(&s->q, s->t, s->h.hi);
  }
  return good && (!s->spread || spread_solve(s));
}

enum why step_make(stiff *s) {
  double length = s->guess;
  for (int i = 0; i < REJECTIONS; i++) {
    if (!plan(s, length)) return WHY_SHORT;
    ambit_work_try(s->counted);
    double h = fabs(s->h.hi);
    if (!solve(s)) {
      s->last_why = WHY_NEWTON;
      length = SHRINK_NEWTON * h;
      continue;
    }
    double factor = rescaled(s);
    if (s->q.error > ACCEPT * s->options.tolerance) {
      s->last_why = WHY_ROUGH;
      length = fmax(0.2, fmin(factor, 0.8)) * h;
      continue;
    }
    enum why why = prove_step(s);
    if (why == WHY_NOTHING) {
      place_start(s);
      collocation_outgrow(&s->q);
      factor = fmax(0.5, fmin(factor, s->careful ? CAREFUL : GROWTH));
      s->careful -= s->careful > 0;
      s->guess = fmax(factor * h, s->at_instant && !s->careful ? s->guess : 0);
      return WHY_NOTHING;
    }
    if (why == WHY_FAST) return why; /* shorter steps would never get there */
    s->last_why = why;
    s->careful = CAREFUL_STEPS;
    length = 0.5 * h;
  }
  return WHY_SHORT;
}
