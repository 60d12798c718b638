/* probe.c -- a Rosenbrock run in doubles. */
#include "verbs/split/probe.h"
#include "verbs/split/approximate.h"
#include <ambit/matrix.h>
#include <math.h>
#include <string.h>

#define TOLERANCE 1e-2
#define FLOOR 1e-3 /* of a state's size: parts that do not matter */
#define NOISE AMBIT_PROBE_NOISE
#define POWERS 8 /* iterations towards the dominant subspace */
#define STEPS_MAX 8192

struct ambit_probe {
  const ambit_problem *p;
  uint32_t nx;
  double *in, *slot;       /* inputs and slots of the right-hand side */
  double *x, *next, *size; /* state; of the step; largest |x| so far */
  double *f0, *f1, *f2, *k1, *k2, *k3, *ft, *jacobian, *w, *v;
  uint32_t *pivot;
  double t, h;
  double *end;    /* [STEPS_MAX] of the steps of the last run that chose its own */
  uint32_t ends;  /* how many of them there are */
  bool repeats;   /* this run takes the same */
  uint64_t work;  /* instructions left */
  uint32_t nkink; /* operations that are not smooth */
  uint32_t *kink; /* [nkink] their instructions */
  uint8_t *side;  /* [nkink] 1: once on one side of the kink, 2: once on the other, 3: both */
  ambit_probe_facts facts;
};

static bool is_kink(uint32_t op) { return op == AMBIT_OP_ABS || op == AMBIT_OP_MIN || op == AMBIT_OP_MAX; }

static bool find_kinks(ambit_probe *b, ambit_arena *arena) {
  const ambit_tape *t = b->p->rhs;
  for (uint32_t i = 0; i < t->ninstr; i++) b->nkink += is_kink(t->op[i]);
  b->kink = ambit_arena_alloc(arena, (b->nkink + 1u) * sizeof *b->kink);
  b->side = ambit_arena_alloc(arena, b->nkink + 1u);
  if (!b->kink || !b->side) return false;
  for (uint32_t i = 0, k = 0; i < t->ninstr; i++)
    if (is_kink(t->op[i])) b->kink[k++] = i;
  return true;
}

/* Which side of each kink the values in the slots are on. */
static void see_kinks(ambit_probe *b) {
  const ambit_tape *t = b->p->rhs;
  for (uint32_t k = 0; k < b->nkink; k++) {
    uint32_t i = b->kink[k];
    double x = b->slot[t->a[i]] - (t->op[i] == AMBIT_OP_ABS ? 0 : b->slot[t->b[i]]);
    b->side[k] |= x < 0 ? 1 : x > 0 ? 2 : 0;
  }
}

uint32_t ambit_probe_kinks(const ambit_probe *b) { return b->nkink; }

uint32_t ambit_probe_kink(const ambit_probe *b) {
  for (uint32_t k = 0; k < b->nkink; k++)
    if (b->side[k] == 3) return b->kink[k];
  return UINT32_MAX;
}

ambit_probe *ambit_probe_make(const ambit_problem *p, ambit_arena *arena) {
  size_t nx = p->nx;
  ambit_probe *b = ambit_arena_alloc(arena, sizeof *b);
  if (!b || !p->rhs) return NULL;
  *b = (ambit_probe) { .p = p, .nx = p->nx };
  b->in = ambit_arena_alloc(arena, (p->rhs->nin + 1u) * sizeof *b->in);
  b->slot = ambit_arena_alloc(arena, p->rhs->nslot * sizeof *b->slot);
  b->pivot = ambit_arena_alloc(arena, nx * sizeof *b->pivot);
  b->end = ambit_arena_alloc(arena, STEPS_MAX * sizeof *b->end);
  double **vector[] = { &b->x, &b->next, &b->size, &b->f0, &b->f1, &b->f2, &b->k1, &b->k2, &b->k3, &b->ft };
  size_t vectors = sizeof vector / sizeof *vector;
  double *room = ambit_arena_alloc(arena, ((vectors + 3) * nx + 2 * nx * nx) * sizeof *room);
  if (!b->in || !b->slot || !b->pivot || !b->end || !room || !find_kinks(b, arena)) return NULL;
  for (size_t i = 0; i < vectors; i++, room += nx) *vector[i] = room;
  b->v = room;
  b->jacobian = room + 3 * nx;
  b->w = b->jacobian + nx * nx;
  return b;
}

void ambit_probe_start(ambit_probe *b, const double *x, const double *parameter, uint64_t work, bool repeats) {
  const ambit_problem *p = b->p;
  memcpy(b->x, x, b->nx * sizeof *x);
  for (uint32_t i = 0; i < b->nx; i++) b->size[i] = fabs(x[i]);
  for (uint32_t i = 0; i < p->np; i++) b->in[b->nx + i] = parameter[i];
  b->t = p->time[0];
  b->h = 0;
  b->repeats = repeats;
  b->work = work;
  b->facts = (ambit_probe_facts) { .reached = b->t };
}

const double *ambit_probe_state(const ambit_probe *b) { return b->x; }
const double *ambit_probe_size(const ambit_probe *b) { return b->size; }
ambit_probe_facts ambit_probe_tell(const ambit_probe *b) { return b->facts; }

/* -- the equations */

static bool rate(ambit_probe *b, double t, const double *x, double *f) {
  const ambit_tape *tape = b->p->rhs;
  if (b->work < tape->ninstr + 1u) return false;
  b->work -= tape->ninstr + 1u;
  memcpy(b->in, x, b->nx * sizeof *x);
  if (b->p->uses_time) b->in[b->nx + b->p->np] = t;
  ambit_approximate(tape, b->in, b->slot);
  see_kinks(b);
  for (uint32_t i = 0; i < b->nx; i++) {
    f[i] = b->slot[tape->out[i]];
    if (!isfinite(x[i]) || !isfinite(f[i])) return false;
  }
  return true;
}

/* in which the fastest state changes by a tenth of its size; at most the time span */
static double quick_time(const ambit_probe *b) {
  double fastest = 0, span = fabs(b->p->time[b->p->ntime - 1] - b->p->time[0]);
  for (uint32_t i = 0; i < b->nx; i++)
    if (b->size[i] > 0) fastest = fmax(fastest, fabs(b->f0[i]) / b->size[i]);
  return fastest > 0 ? fmin(span, 0.1 / fastest) : span;
}

/* Differences one sqrt(epsilon) of the state's size apart, of a state that is zero of what it is soon, in whatever
** units; f0 is the rate at x. */
static bool differentiate(ambit_probe *b) {
  for (uint32_t j = 0; j < b->nx; j++) {
    double size = b->size[j] > 0 ? b->size[j] : fabs(b->f0[j]) * quick_time(b);
    double x = b->x[j], d = 0x1p-26 * (size > 0 ? size : 1);
    b->x[j] = x + d;
    d = b->x[j] - x;
    bool good = d != 0 && rate(b, b->t, b->x, b->f1);
    b->x[j] = x;
    if (!good) return false;
    for (uint32_t i = 0; i < b->nx; i++) b->jacobian[i * b->nx + j] = (b->f1[i] - b->f0[i]) / d;
  }
  memset(b->ft, 0, b->nx * sizeof *b->ft);
  if (!b->p->uses_time) return true;
  double d = 0x1p-26 * fmax(fabs(b->t), fabs(b->p->time[b->p->ntime - 1] - b->p->time[0]));
  if (!rate(b, b->t + d, b->x, b->f1)) return false;
  for (uint32_t i = 0; i < b->nx; i++) b->ft[i] = (b->f1[i] - b->f0[i]) / d;
  return true;
}

/* -- small linear algebra */

/* of row i from column k on: pivots are chosen relative to it, or units of states would choose them */
static double row_size(const double *w, uint32_t n, uint32_t i, uint32_t k) {
  double most = 0;
  for (uint32_t j = k; j < n; j++) most = fmax(most, fabs(w[i * n + j]));
  return most;
}

static bool factor(ambit_probe *b, double hd) {
  uint32_t n = b->nx;
  double *w = b->w;
  for (uint32_t i = 0; i < n * n; i++) w[i] = (i % (n + 1) == 0) - hd * b->jacobian[i];
  for (uint32_t k = 0; k < n; k++) {
    uint32_t best = k;
    double share = fabs(w[k * n + k]) / row_size(w, n, k, k);
    for (uint32_t i = k + 1; i < n && !(share >= 0.5); i++) {
      double other = fabs(w[i * n + k]) / row_size(w, n, i, k);
      if (!(other <= share)) best = i, share = other;
    }
    b->pivot[k] = best;
    if (!(fabs(w[best * n + k]) > 0)) return false;
    if (best != k) ambit_matrix_swap(n, w + (size_t)k * n, w + (size_t)best * n);
    for (uint32_t i = k + 1; i < n; i++) {
      double l = w[i * n + k] /= w[k * n + k];
      for (uint32_t j = k + 1; l != 0 && j < n; j++) w[i * n + j] -= l * w[k * n + j];
    }
  }
  return true;
}

static double dot(uint32_t n, const double *a, const double *b) {
  double s = 0;
  for (uint32_t i = 0; i < n; i++) s += a[i] * b[i];
  return s;
}

/* y := J x / scale; returns the norm of J x */
static double apply(const ambit_probe *b, const double *x, double *y) {
  for (uint32_t i = 0; i < b->nx; i++) y[i] = dot(b->nx, b->jacobian + (size_t)i * b->nx, x);
  return sqrt(dot(b->nx, y, y));
}

/* -Re of the fastest decaying and |Im| of the dominant eigenvalues of the Jacobian; 0 if there are none */
static void find_modes(ambit_probe *b, double *decay, double *swing) {
  uint32_t n = b->nx;
  double *v = b->v, *u = v + n, *w = v + 2 * n, norm = 0;
  *decay = *swing = 0;
  for (uint32_t i = 0; i < n; i++) v[i] = 1 + 0.1 * (double)(i % 7);
  for (int k = 0; k < POWERS; k++) {
    norm = apply(b, v, u);
    if (!(norm > 0) || !isfinite(norm)) return;
    for (uint32_t i = 0; i < n; i++) v[i] = u[i] / norm;
  }
  norm = apply(b, v, u);
  if (!(norm > 0) || !isfinite(norm)) return;
  for (uint32_t i = 0; i < n; i++) u[i] /= norm; /* J v = norm u, J u = w */
  double second = apply(b, u, w);
  if (!(second > 0) || !isfinite(second)) return;
  double vv = dot(n, v, v), vu = dot(n, v, u), uu = dot(n, u, u), vw = dot(n, v, w), uw = dot(n, u, w);
  double det = vv * uu - vu * vu;
  if (det < 1e-12 * vv * uu) { /* u is parallel to v: one real eigenvalue */
    *decay = fmax(0, -norm * vu / vv);
    return;
  }
  double a = (vv * uw - vu * vw) / det, c = (uu * vw - vu * uw) / det * norm; /* w = a u + (c / norm) v */
  double discriminant = a * a / 4 + c;
  if (discriminant >= 0)
    *decay = fmax(0, sqrt(discriminant) - a / 2);
  else {
    *decay = fmax(0, -a / 2);
    *swing = sqrt(-discriminant);
  }
}

/* -- steps */

/* The error of the step in units of what is tolerated; negative: it could not be made. */
static double try_step(ambit_probe *b, double h) {
  const double d = 1 / (2 + sqrt(2)), e = 6 + sqrt(2);
  uint32_t n = b->nx;
  if (!factor(b, h * d)) return -1;
  for (uint32_t i = 0; i < n; i++) b->k1[i] = b->f0[i] + h * d * b->ft[i];
  ambit_matrix_solve(b->nx, b->w, b->pivot, 1, b->k1);
  for (uint32_t i = 0; i < n; i++) b->next[i] = b->x[i] + 0.5 * h * b->k1[i];
  if (!rate(b, b->t + 0.5 * h, b->next, b->f1)) return -1;
  for (uint32_t i = 0; i < n; i++) b->k2[i] = b->f1[i] - b->k1[i];
  ambit_matrix_solve(b->nx, b->w, b->pivot, 1, b->k2);
  for (uint32_t i = 0; i < n; i++) {
    b->k2[i] += b->k1[i];
    b->next[i] = b->x[i] + h * b->k2[i];
  }
  if (!rate(b, b->t + h, b->next, b->f2)) return -1;
  for (uint32_t i = 0; i < n; i++)
    b->k3[i] = b->f2[i] - e * (b->k2[i] - b->f1[i]) - 2 * (b->k1[i] - b->f0[i]) + h * d * b->ft[i];
  ambit_matrix_solve(b->nx, b->w, b->pivot, 1, b->k3);
  double worst = 0, most = 0;
  for (uint32_t i = 0; i < n; i++) most = fmax(most, fabs(b->next[i]));
  for (uint32_t i = 0; i < n; i++) {
    double size = fmax(fmax(fabs(b->x[i]), fabs(b->next[i])), fmax(FLOOR * b->size[i], NOISE * most));
    if (size > 0) worst = fmax(worst, fabs(h / 6 * (b->k1[i] - 2 * b->k2[i] + b->k3[i])) / (TOLERANCE * size));
  }
  return isfinite(worst) ? worst : -1;
}

static void take(ambit_probe *b, double t, double decay, double swing) {
  double h = fabs(t - b->t);
  memcpy(b->x, b->next, b->nx * sizeof *b->x);
  for (uint32_t i = 0; i < b->nx; i++) b->size[i] = fmax(b->size[i], fabs(b->x[i]));
  b->t = b->facts.reached = t;
  if (!b->repeats) b->end[b->facts.steps] = t;
  b->facts.steps++;
  if (!b->repeats) b->ends = b->facts.steps;
  b->facts.decay += h * decay;
  b->facts.swing += h * swing;
}

/* Tries steps of its own until one is good enough; its end, or NaN if there is none. */
static double choose(ambit_probe *b, double end) {
  double direction = end < b->t ? -1 : 1;
  if (b->h == 0) b->h = quick_time(b);
  for (;;) {
    double left = fabs(end - b->t), h = b->h < 0.9 * left ? b->h : left; /* no sliver remains */
    if (!(h > 0x1p-50 * fabs(b->t))) return NAN;
    double error = try_step(b, direction * h);
    if (error < 0 && b->work < b->p->rhs->ninstr + 1u) return NAN;
    double grown = h * (error < 0 ? 0.25 : error > 0 ? fmin(5, fmax(0.2, 0.8 / cbrt(error))) : 5);
    if (error < 0 || error > 1) {
      b->h = grown;
      continue;
    }
    if (h >= b->h || grown < b->h) b->h = grown;
    return h == left ? end : b->t + direction * h;
  }
}

/* One step, not beyond `end`; false: none. */
static bool step(ambit_probe *b, double end) {
  double decay, swing;
  if (!rate(b, b->t, b->x, b->f0) || !differentiate(b)) return false;
  find_modes(b, &decay, &swing);
  if (end < b->t) decay = 0; /* backwards, what decays grows; the fastest growth is not looked for */
  double t = b->repeats ? b->end[b->facts.steps] : choose(b, end);
  if (isnan(t) || (b->repeats && try_step(b, t - b->t) < 0)) return false;
  take(b, t, decay, swing);
  return true;
}

bool ambit_probe_advance(ambit_probe *b, double t) {
  uint32_t most = b->repeats ? b->ends : STEPS_MAX;
  while (b->t != t && b->facts.steps < most)
    if (!step(b, t)) return false;
  return b->t == t;
}
