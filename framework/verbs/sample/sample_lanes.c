/* sample_lanes.c -- steps of all lanes, as long as the worst one allows. */
#include "verbs/sample/sample_lanes.h"
#include <ambit/arena.h>
#include "verbs/sample/batch.h"
#include "verbs/sample/sample_tableau.h"
#include <math.h>
#include <string.h>

#define SAFETY 0.9
#define SHRINK_MOST 0.333
#define GROW_MOST 6.0
#define REJECTS_MOST 30  /* in a row */
#define STABLE_UP_TO 6.1 /* h times an eigenvalue on the negative axis (Hairer, Norsett & Wanner, II.10) */
#define STIFF_STEPS 15   /* at that limit, with no more than CALM others in a row between them */
#define CALM_STEPS 6
#define FEW_STEPS 5000   /* still to go: then stiffness is no matter */
#define SHORTEST 0x1p-48 /* part of |t| and of the whole span */

struct ambit_lanes {
  const ambit_problem *problem;
  ambit_arena *arena;
  ambit_batch *batch, **jump; /* jump [njump] */
  size_t width;
  double *in;              /* [nin][n] states of a stage, parameters, time */
  double *x, *new_x;       /* [nx][n] */
  double *last;            /* [nx][n] the last stage's states, for the test of stiffness */
  double *k[AMBIT_STAGES]; /* [nx][n] */
  double *new_k;           /* [nx][n] rate at new_x */
  double *upper;           /* [nx][n] scratch */
  double *zero;            /* [nx][n] of them */
  double *error;           /* [n] of the step tried, 1 is allowed */
};

/* -- life */

static bool allocate(ambit_lanes *l) {
  const ambit_tape *t = l->problem->rhs;
  size_t state = l->problem->nx * l->width;
  double **const array[] = { &l->x, &l->new_x, &l->last, &l->new_k, &l->upper, &l->zero };
  for (size_t i = 0; i < sizeof array / sizeof *array; i++)
    if (!(*array[i] = ambit_arena_alloc(l->arena, state * sizeof(double)))) return false;
  for (size_t s = 0; s < AMBIT_STAGES; s++)
    if (!(l->k[s] = ambit_arena_alloc(l->arena, state * sizeof(double)))) return false;
  l->in = ambit_arena_alloc(l->arena, (t->nin * l->width + 1) * sizeof(double));
  l->error = ambit_arena_alloc(l->arena, l->width * sizeof(double));
  return l->in && l->error;
}

ambit_status ambit_lanes_open(const ambit_problem *p, const ambit_arithmetic *arithmetic, void *ctx, size_t width,
    ambit_lanes **lanes, ambit_failure *f) {
  *lanes = NULL;
  ambit_arena *arena = ambit_arena_open();
  ambit_lanes *l = arena ? ambit_arena_alloc(arena, sizeof *l) : NULL;
  if (!l) {
    ambit_arena_close(arena);
    return ambit_no_memory(f);
  }
  *l = (ambit_lanes) { .problem = p, .arena = arena, .width = width };
  ambit_status status = allocate(l) ? AMBIT_OK : ambit_no_memory(f);
  if (status == AMBIT_OK) status = ambit_batch_open(p->rhs, arithmetic, ctx, &l->batch, f);
  l->jump = ambit_arena_alloc(arena, (p->njump + 1) * sizeof *l->jump);
  if (!l->jump && status == AMBIT_OK) status = ambit_no_memory(f);
  for (uint32_t i = 0; i < p->njump && status == AMBIT_OK; i++)
    status = ambit_batch_open(p->jump[i], arithmetic, ctx, &l->jump[i], f);
  if (status == AMBIT_OK)
    *lanes = l;
  else
    ambit_lanes_close(l);
  return status;
}

const ambit_work *ambit_lanes_work(const ambit_lanes *lanes) { return ambit_batch_work(lanes->batch); }

void ambit_lanes_close(ambit_lanes *l) {
  if (!l) return;
  ambit_batch_close(l->batch);
  for (uint32_t i = 0; l->jump && i < l->problem->njump; i++) ambit_batch_close(l->jump[i]);
  ambit_arena_close(l->arena);
}

/* -- one step */

typedef struct stepper {
  ambit_lanes *l;
  const ambit_lanes_run *run;
  size_t n, nstate; /* lanes, nx * n */
  double t, h;
  uint32_t jumped; /* jumps that are done */
} stepper;

/* k := what the batch makes of the states that lie in l->in; NaN where it is not defined */
static void run_batch(stepper *s, ambit_batch *batch, double t, double *k) {
  ambit_lanes *l = s->l;
  const ambit_problem *p = l->problem;
  double *time = l->in + (p->nx + (size_t)p->np) * s->n;
  for (size_t lane = 0; lane < s->n && p->uses_time; lane++) time[lane] = t;
  ambit_batch_run(batch, s->n, l->in, l->in, NULL, k, l->upper);
  for (size_t i = 0; i < s->nstate; i++)
    k[i] = k[i] == l->upper[i] ? k[i] : k[i] < l->upper[i] ? 0.5 * (k[i] + l->upper[i]) : NAN;
}

static void rates(stepper *s, double t, double *k) { run_batch(s, s->l->batch, t, k); }

static void rates_at(stepper *s, double t, const double *x, double *k) {
  memcpy(s->l->in, x, s->nstate * sizeof *x);
  rates(s, t, k);
}

/* out := x + h sum_j weight_j k_j, j < count; x NULL: the sum alone. Four terms at a time: it waits for memory. */
static void combine(const stepper *s, const double *x, size_t count, const double *weight, double *restrict out) {
  const double *k[AMBIT_STAGES + 3], *zero = s->l->zero;
  double w[AMBIT_STAGES + 3];
  size_t terms = 0;
  for (size_t j = 0; j < count; j++)
    if (weight[j] != 0) k[terms] = s->l->k[j], w[terms++] = weight[j];
  for (; terms == 0 || terms % 4; terms++) k[terms] = zero, w[terms] = 0;
  for (size_t j = 0; j < terms; j += 4) {
    const double *a = k[j], *b = k[j + 1], *c = k[j + 2], *d = k[j + 3], *before = j ? out : zero;
    double wa = w[j], wb = w[j + 1], wc = w[j + 2], wd = w[j + 3];
    for (size_t i = 0; i < s->nstate; i++) out[i] = before[i] + ((wa * a[i] + wb * b[i]) + (wc * c[i] + wd * d[i]));
  }
  for (size_t i = 0; i < s->nstate && x; i++) out[i] = x[i] + s->h * out[i];
}

/* k[0] is the rate at x. */
static void try_step(stepper *s) {
  ambit_lanes *l = s->l;
  for (size_t stage = 1; stage < AMBIT_STAGES; stage++) {
    combine(s, l->x, stage, ambit_stage_weight[stage], l->in);
    if (stage == AMBIT_STAGES - 1) memcpy(l->last, l->in, s->nstate * sizeof *l->in);
    rates(s, s->t + ambit_stage_time[stage] * s->h, l->k[stage]);
  }
  combine(s, l->x, AMBIT_STAGES, ambit_step_weight, l->new_x);
}

static double scale(const stepper *s, size_t i) {
  const ambit_lanes_run *run = s->run;
  return run->absolute + run->relative * fmax(fabs(s->l->x[i]), fabs(s->l->new_x[i]));
}

/* Error of the step in each lane (inf: it has no value there); returns the largest of those that are not lost. */
static double find_errors(stepper *s) {
  ambit_lanes *l = s->l;
  size_t n = s->n, nx = l->problem->nx;
  double *fifth = l->upper, *third = l->in, worst = 0;
  combine(s, NULL, AMBIT_STAGES, ambit_error_weight_5, fifth);
  combine(s, NULL, AMBIT_STAGES, ambit_error_weight_3, third);
  for (size_t lane = 0; lane < n; lane++) {
    double five = 0, three = 0, finite = 0;
    for (size_t i = lane; i < nx * n; i += n) {
      double by = scale(s, i), a = fifth[i] / by, b = third[i] / by;
      five += a * a, three += b * b, finite += l->new_x[i] - l->new_x[i];
    }
    double both = five + 0.01 * three;
    l->error[lane] = both > 0 ? fabs(s->h) * five / sqrt(both * (double)nx) : 0;
    if (!(finite == 0) || !(l->error[lane] < INFINITY) || both != both) l->error[lane] = INFINITY;
    if (!s->run->lost[lane]) worst = fmax(worst, l->error[lane]);
  }
  return worst;
}

/* Largest h |lambda| that the last two stages, both at the end of the step, show. */
static double find_stiffness(const stepper *s) {
  const ambit_lanes *l = s->l;
  double largest = 0;
  for (size_t lane = 0; lane < s->n; lane++) {
    double rate = 0, state = 0;
    if (s->run->lost[lane]) continue;
    for (size_t i = lane; i < s->nstate; i += s->n) {
      double a = l->new_k[i] - l->k[AMBIT_STAGES - 1][i], b = l->new_x[i] - l->last[i];
      rate += a * a, state += b * b;
    }
    if (state > 0) largest = fmax(largest, fabs(s->h) * sqrt(rate / state));
  }
  return largest;
}

/* -- the first step: such that an explicit Euler step of it is good, and the eighth power of the second derivative
** (Hairer, Norsett & Wanner, II.4) */

static double norm(const stepper *s, size_t lane, const double *x, const double *minus) {
  const ambit_lanes *l = s->l;
  double sum = 0;
  for (size_t i = lane; i < s->nstate; i += s->n) {
    double v = (x[i] - (minus ? minus[i] : 0)) / (s->run->absolute + s->run->relative * fabs(l->x[i]));
    sum += v * v;
  }
  return sqrt(sum / l->problem->nx);
}

static double first_step(stepper *s, double span) {
  ambit_lanes *l = s->l;
  double shortest = fabs(span);
  for (size_t lane = 0; lane < s->n; lane++) {
    double x = norm(s, lane, l->x, NULL), k = norm(s, lane, l->k[0], NULL);
    double h = x > 1e-5 && k > 1e-5 ? 0.01 * x / k : 1e-6;
    if (h < shortest) shortest = h;
  }
  s->h = copysign(shortest, span);
  combine(s, l->x, 1, (const double[]) { 1 }, l->new_x);
  rates_at(s, s->t + s->h, l->new_x, l->new_k);
  double steepest = 0;
  for (size_t lane = 0; lane < s->n; lane++) {
    double bend = norm(s, lane, l->new_k, l->k[0]) / shortest, k = norm(s, lane, l->k[0], NULL);
    steepest = fmax(steepest, fmax(bend, k));
  }
  double longer = steepest > 1e-15 ? pow(0.01 / steepest, 1.0 / 8) : 1e-3 * fabs(span);
  return copysign(fmin(fmin(100 * shortest, longer), fabs(span)), span);
}

/* -- lanes that are lost compute along with a good one, so that they cost no time in odd numbers */

static size_t find_good(const stepper *s) {
  for (size_t lane = 0; lane < s->n; lane++)
    if (!s->run->lost[lane]) return lane;
  return s->n;
}

static void follow(const stepper *s, size_t lane, size_t good) {
  ambit_lanes *l = s->l;
  for (size_t i = 0; i < l->problem->nx; i++) {
    l->x[i * s->n + lane] = l->x[i * s->n + good];
    l->k[0][i * s->n + lane] = l->k[0][i * s->n + good];
  }
  for (size_t i = l->problem->nx; i < l->problem->rhs->nin; i++) l->in[i * s->n + lane] = l->in[i * s->n + good];
}

/* Drops the lanes whose error is above the limit. */
static void drop(stepper *s, double limit) {
  for (size_t lane = 0; lane < s->n; lane++)
    if (!s->run->lost[lane] && !(s->l->error[lane] <= limit)) s->run->lost[lane] = true;
  size_t good = find_good(s);
  for (size_t lane = 0; lane < s->n && good < s->n; lane++)
    if (s->run->lost[lane]) follow(s, lane, good);
}

/* -- the run */

/* k[0] at the states of now; lanes where it, or they, are no numbers are lost */
static void begin(stepper *s) {
  ambit_lanes *l = s->l;
  rates_at(s, s->t, l->x, l->k[0]);
  for (size_t lane = 0; lane < s->n; lane++) {
    double odd = 0;
    for (size_t i = lane; i < s->nstate; i += s->n) odd += l->k[0][i] - l->k[0][i] + (l->x[i] - l->x[i]);
    l->error[lane] = odd == 0 ? 0 : INFINITY;
  }
  drop(s, 1);
}

static double jump_at(const stepper *s) {
  const ambit_problem *p = s->l->problem;
  return s->jumped < p->njump_time ? p->jump_time[s->jumped] : INFINITY;
}

/* All jumps of this instant. */
static void jump(stepper *s) {
  ambit_lanes *l = s->l;
  const ambit_problem *p = l->problem;
  if (jump_at(s) != s->t) return;
  for (; jump_at(s) == s->t; s->jumped++) {
    memcpy(l->in, l->x, s->nstate * sizeof *l->x);
    run_batch(s, l->jump[p->jump_number[s->jumped]], s->t, l->x);
  }
  begin(s);
}

static void start(stepper *s) {
  ambit_lanes *l = s->l;
  const ambit_problem *p = l->problem;
  memcpy(l->x, s->run->x0, s->nstate * sizeof *l->x);
  if (p->np) memcpy(l->in + s->nstate, s->run->p, p->np * s->n * sizeof *l->in);
  begin(s);
  jump(s);
}

/* The step is good: x, t and k[0] move on. */
static void accept(stepper *s, double to) {
  ambit_lanes *l = s->l;
  double *x = l->x, *k = l->k[0];
  l->x = l->new_x, l->new_x = x;
  l->k[0] = l->new_k, l->new_k = k;
  s->t = to;
}

typedef struct pace {
  double next;    /* length of the step to be tried, had no instant been in the way */
  double good;    /* of the last accepted one */
  size_t rejects; /* in a row */
  size_t stiff, calm;
} pace;

/* The step failed: a shorter one, or fewer lanes. */
static void reject(stepper *s, pace *p, double worst, double span) {
  double shortest = SHORTEST * fmax(fabs(s->t), fabs(span)), by = pow(worst, -1.0 / 8);
  p->next = s->h * (isfinite(worst) ? fmax(SHRINK_MOST, SAFETY * by) : 0.1);
  if (++p->rejects < REJECTS_MOST && fabs(p->next) > shortest) return;
  drop(s, 1);
  p->rejects = 0;
  p->next = p->good;
}

static bool is_stiff(stepper *s, pace *p) {
  if (find_stiffness(s) > STABLE_UP_TO) {
    p->calm = 0;
    return ++p->stiff >= STIFF_STEPS;
  }
  if (++p->calm >= CALM_STEPS) p->stiff = 0;
  return false;
}

/* The end of the step to be tried, another double than now. Far from 0 these are few: the step is what lies between
** them, else states would go another way than time. */
static double aim(stepper *s, pace *p, double to, double span) {
  if (s->run->longest > 0 && fabs(p->next) > s->run->longest) p->next = copysign(s->run->longest, span);
  double t = s->t + p->next;
  if (fabs(p->next) * 1.01 >= fabs(to - s->t)) t = to;
  if (t == s->t) t = nextafter(t, to);
  s->h = t - s->t;
  return t;
}

/* From one instant to the next. */
static ambit_lanes_outcome advance(stepper *s, pace *p, double to, double span, size_t *steps) {
  while (s->t != to && find_good(s) < s->n) {
    if (s->run->pause && s->run->pause(s->run->user)) return AMBIT_LANES_STOPPED;
    double t = aim(s, p, to, span);
    bool lands = t == to;
    try_step(s);
    double worst = find_errors(s);
    if (!(worst <= 1)) {
      reject(s, p, worst, span);
      continue;
    }
    double grow = worst > 0 ? SAFETY * pow(worst, -1.0 / 8) : GROW_MOST;
    rates_at(s, t, s->l->new_x, s->l->new_k);
    bool stiff = is_stiff(s, p);
    double longer = s->h * fmin(GROW_MOST, fmax(SHRINK_MOST, p->rejects ? fmin(grow, 1) : grow));
    p->next = lands && fabs(longer) < fabs(p->next) ? p->next : longer;
    p->good = s->h, p->rejects = 0;
    accept(s, t);
    ++*steps;
    if (stiff && fabs(span) * (1 - fabs((s->t - s->l->problem->time[0]) / span)) > FEW_STEPS * fabs(p->good))
      return AMBIT_LANES_STIFF;
  }
  return AMBIT_LANES_DONE;
}

ambit_lanes_outcome ambit_lanes_integrate(ambit_lanes *l, const ambit_lanes_run *run, size_t *steps) {
  const ambit_problem *p = l->problem;
  stepper s = { .l = l, .run = run, .n = run->n, .nstate = p->nx * run->n, .t = p->time[0] };
  double span = p->time[p->ntime - 1] - p->time[0];
  ambit_lanes_outcome outcome = AMBIT_LANES_DONE;
  *steps = 0;
  start(&s);
  pace pace = { .next = first_step(&s, span) };
  pace.good = pace.next;
  for (uint32_t k = 1; k < p->ntime && outcome == AMBIT_LANES_DONE && find_good(&s) < s.n; k++) {
    while (jump_at(&s) < p->time[k] && outcome == AMBIT_LANES_DONE && find_good(&s) < s.n) {
      outcome = advance(&s, &pace, jump_at(&s), span, steps);
      if (outcome == AMBIT_LANES_DONE && find_good(&s) < s.n) jump(&s);
    }
    if (outcome == AMBIT_LANES_DONE) outcome = advance(&s, &pace, p->time[k], span, steps);
    if (outcome == AMBIT_LANES_DONE) run->take(run->user, k, s.n, l->x, run->lost);
    if (outcome == AMBIT_LANES_DONE && find_good(&s) < s.n) jump(&s);
  }
  for (size_t lane = 0; lane < s.n && outcome != AMBIT_LANES_DONE; lane++) run->lost[lane] = true;
  return outcome;
}
