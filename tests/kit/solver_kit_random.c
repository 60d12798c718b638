/* solver_kit_random.c -- see solver_kit_random.h. */
#include "kit/solver_kit_random.h"
#include "kit/solver_kit_implicit.h"
#include "num/random.h"
#include "num/interval.h"
#include <math.h>
#include <stdio.h>

enum { DECAY, TURN, TURNED, FORCED, LOGISTIC, DRIFT, BELL, KINDS };
enum { ALONE, LINEAR, PRODUCT, SINE, COUPLES };

/* -- choice */

static double within(ambit_random *random, double lo, double hi) {
  return ambit_random_in(random, (ambit_interval) { lo, hi });
}

static uint32_t one_of(ambit_random *random, uint32_t n) {
  return (uint32_t)fmin(floor(within(random, 0, n)), n - 1.0);
}

/* few bits, so that sums and products of data are exact */
static double coarse(ambit_random *random, double lo, double hi) { return floor(64 * within(random, lo, hi)) / 64; }

static void choose_block(ambit_random *random, kit_random_system *r, size_t i) {
  static const uint32_t kinds[] = { DECAY, TURN, FORCED, LOGISTIC, DRIFT, BELL };
  kit_block *b = &r->block[i];
  bool second = i > 0 && r->block[i - 1].kind == TURN;
  b->kind = second ? (uint32_t)TURNED : kinds[one_of(random, i + 1 < r->nx ? 6 : 5)];
  if (b->kind == TURN && i + 1 == r->nx) b->kind = DECAY;
  b->start = b->kind == LOGISTIC ? coarse(random, 0.25, 0.75) : coarse(random, 0.5, 1.5);
  b->rate = second ? r->block[i - 1].rate : coarse(random, -1, 1) + 0x1p-7;
  b->couple = i == 0 ? (uint32_t)ALONE : one_of(random, COUPLES);
  b->a = i ? one_of(random, (uint32_t)i) : 0, b->b = i ? one_of(random, (uint32_t)i) : 0;
  b->weight = coarse(random, 0.125, 0.5);
  b->start_datum = b->rate_datum = -1;
}

/* one datum more, in a start or a rate that is still a number; false: it is none */
static bool add_datum(ambit_random *random, kit_random_system *r, bool in_rate) {
  kit_problem *p = &r->problem;
  uint32_t j = p->nu;
  kit_block *b = &r->block[one_of(random, (uint32_t)r->nx)];
  double radius = ldexp(1, -7 - (int)one_of(random, 12)), mid = 0;
  if (in_rate && b->kind != TURN && b->kind != TURNED && b->rate_datum < 0)
    b->rate_datum = (int32_t)j, mid = b->rate;
  else if (!in_rate && b->start_datum < 0)
    b->start_datum = (int32_t)j, mid = b->start;
  else
    return false;
  p->u_lo[j] = mid - radius, p->u_hi[j] = mid + radius;
  p->nu++;
  return true;
}

void kit_random_make(kit_random_system *r, uint64_t seed, size_t item) {
  static const double start[] = { 0, -1, 0.5 };
  ambit_random random = { seed * 0x9e3779b97f4a7c15u + item + 1 };
  *r = (kit_random_system) { .nx = 1 + item % KIT_STATES };
  r->stages = r->nx > 1 ? item % 3 : item % 2;
  bool backwards = item % 2;
  kit_problem *p = &r->problem;
  for (size_t i = 0; i < r->nx; i++) choose_block(&random, r, i);
  for (size_t i = 0; i < 1 + (item / 2) % KIT_DATA; i++)
    for (int tries = 0; tries < 16 && !add_datum(&random, r, (item + i) % 2); tries++) {}
  if (p->nu == 0) add_datum(&random, r, false);
  r->t0 = start[one_of(&random, 3)];
  double length = within(&random, 0.5, 1.25) * (backwards ? -1 : 1);
  p->ntime = 3;
  p->time[0] = r->t0, p->time[1] = r->t0 + 0.4 * length, p->time[2] = r->t0 + length;
  p->ends = p->widest = INFINITY;
  p->random = r;
  snprintf(r->name, sizeof r->name, "random system %zu (%zu states, %u data%s)", item, r->nx, p->nu,
      backwards ? ", backwards" : "");
  p->name = r->name;
}

/* -- equations */

static ambit_expr op(kit_model *m, uint32_t code, ambit_expr a, ambit_expr b) {
  return ambit_graph_op(m->graph, code, a, b);
}
static ambit_expr times(kit_model *m, ambit_expr a, ambit_expr b) { return op(m, AMBIT_OP_MUL, a, b); }
static ambit_expr plus(kit_model *m, ambit_expr a, ambit_expr b) { return op(m, AMBIT_OP_ADD, a, b); }
static ambit_expr number(kit_model *m, double x) { return ambit_graph_number(m->graph, x); }

static ambit_expr shift(kit_model *m, const kit_block *b, const ambit_expr *x) {
  switch (b->couple) {
  case LINEAR: return times(m, number(m, b->weight), x[b->a]);
  case PRODUCT: return times(m, number(m, b->weight), times(m, x[b->a], x[b->b]));
  case SINE: return times(m, number(m, b->weight), op(m, AMBIT_OP_SIN, x[b->a], x[b->a]));
  default: return number(m, 0);
  }
}

/* dx: the derivatives of the states */
static ambit_expr shift_rate(kit_model *m, const kit_block *b, const ambit_expr *dx) {
  const ambit_expr *x = m->state;
  ambit_expr w = number(m, b->weight);
  switch (b->couple) {
  case LINEAR: return times(m, w, dx[b->a]);
  case PRODUCT: return times(m, w, plus(m, times(m, dx[b->a], x[b->b]), times(m, x[b->a], dx[b->b])));
  case SINE: return times(m, w, times(m, op(m, AMBIT_OP_COS, x[b->a], x[b->a]), dx[b->a]));
  default: return number(m, 0);
  }
}

/* y' of block i */
static ambit_expr own_rate(kit_model *m, const kit_random_system *r, size_t i, const ambit_expr *y, ambit_expr k) {
  ambit_expr t = ambit_graph_time(m->graph);
  switch (r->block[i].kind) {
  case DECAY: return op(m, AMBIT_OP_NEG, times(m, k, y[i]), times(m, k, y[i]));
  case TURN: return times(m, k, y[i + 1]);
  case TURNED: return op(m, AMBIT_OP_NEG, times(m, k, y[i - 1]), times(m, k, y[i - 1]));
  case FORCED: return times(m, k, op(m, AMBIT_OP_COS, t, t));
  case LOGISTIC: return times(m, k, times(m, y[i], op(m, AMBIT_OP_SUB, number(m, 1), y[i])));
  case DRIFT: return k;
  default: return times(m, times(m, number(m, 2), k), times(m, t, y[i]));
  }
}

void kit_random_build(kit_model *m, const kit_random_system *r) {
  static const char *const name[KIT_STATES] = { "a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l" };
  ambit_expr y[KIT_STATES], f[KIT_STATES], residual[KIT_STATES];
  m->nx = r->nx, m->ndatum = r->problem.nu;
  for (uint32_t j = 0; j < r->problem.nu; j++)
    m->datum[j] = ambit_graph_unknown(m->graph, "u", (ambit_interval) { r->problem.u_lo[j], r->problem.u_hi[j] });
  for (size_t i = 0; i < r->nx; i++) {
    m->name[i] = name[i], m->unit[i] = "1";
    m->state[i] = ambit_graph_symbol(m->graph, name[i], "1");
  }
  for (size_t i = 0; i < r->nx; i++) {
    const kit_block *b = &r->block[i];
    ambit_expr start = b->start_datum < 0 ? number(m, b->start) : m->datum[b->start_datum];
    m->initial[i] = plus(m, start, shift(m, b, m->initial));
    y[i] = op(m, AMBIT_OP_SUB, m->state[i], shift(m, b, m->state));
  }
  if (r->stages) kit_form_open(m, r->stages);
  for (size_t i = 0; i < r->nx; i++) {
    const kit_block *b = &r->block[i];
    ambit_expr k = b->rate_datum < 0 ? number(m, b->rate) : m->datum[b->rate_datum];
    m->rate[i] = plus(m, own_rate(m, r, i, y, k), shift_rate(m, b, m->rate));
    if (r->stages == 0) continue;
    f[i] = plus(m, own_rate(m, r, i, y, k), shift_rate(m, b, m->form.unknown));
    residual[i] = op(m, AMBIT_OP_SUB, m->form.unknown[i], f[i]);
  }
  if (r->stages) kit_form_close(m, residual, f);
}

/* -- the solution */

static ambit_interval point(double x) { return (ambit_interval) { x, x }; }

static ambit_interval apply(uint32_t code, ambit_interval a) {
  ambit_interval z;
  ambit_interval_op(code, &z, a, a);
  return z;
}

static ambit_interval start_of(const kit_block *b, const double *u) {
  return point(b->start_datum < 0 ? b->start : u[b->start_datum]);
}

/* y of block i */
static ambit_interval solve(const kit_random_system *r, size_t i, double t, const double *u) {
  const kit_block *b = &r->block[i];
  ambit_interval y0 = start_of(b, u), k = point(b->rate_datum < 0 ? b->rate : u[b->rate_datum]);
  ambit_interval since = ambit_interval_sub(point(t), point(r->t0)), angle = ambit_interval_mul(k, since);
  ambit_interval sine = apply(AMBIT_OP_SIN, angle), cosine = apply(AMBIT_OP_COS, angle);
  switch (b->kind) {
  case DECAY: return ambit_interval_mul(y0, apply(AMBIT_OP_EXP, apply(AMBIT_OP_NEG, angle)));
  case TURN: return ambit_interval_add(ambit_interval_mul(y0, cosine), ambit_interval_mul(start_of(b + 1, u), sine));
  case TURNED: return ambit_interval_sub(ambit_interval_mul(y0, cosine), ambit_interval_mul(start_of(b - 1, u), sine));
  case FORCED: {
    ambit_interval change = ambit_interval_sub(apply(AMBIT_OP_SIN, point(t)), apply(AMBIT_OP_SIN, point(r->t0)));
    return ambit_interval_add(y0, ambit_interval_mul(k, change));
  }
  case LOGISTIC: {
    ambit_interval ratio = ambit_interval_sub(ambit_interval_div(point(1), y0), point(1));
    ratio = ambit_interval_mul(ratio, apply(AMBIT_OP_EXP, apply(AMBIT_OP_NEG, angle)));
    return ambit_interval_div(point(1), ambit_interval_add(point(1), ratio));
  }
  case DRIFT: return ambit_interval_add(y0, angle);
  default: {
    ambit_interval squares = ambit_interval_sub(apply(AMBIT_OP_SQR, point(t)), apply(AMBIT_OP_SQR, point(r->t0)));
    return ambit_interval_mul(y0, apply(AMBIT_OP_EXP, ambit_interval_mul(k, squares)));
  }
  }
}

void kit_random_truth(const kit_random_system *r, double t, const double *u, ambit_interval *x) {
  for (size_t i = 0; i < r->nx; i++) {
    const kit_block *b = &r->block[i];
    ambit_interval phi = point(0), w = point(b->weight);
    if (b->couple == LINEAR) phi = ambit_interval_mul(w, x[b->a]);
    if (b->couple == PRODUCT) phi = ambit_interval_mul(w, ambit_interval_mul(x[b->a], x[b->b]));
    if (b->couple == SINE) phi = ambit_interval_mul(w, apply(AMBIT_OP_SIN, x[b->a]));
    x[i] = ambit_interval_add(solve(r, i, t, u), phi);
  }
}
