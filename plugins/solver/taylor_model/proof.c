/* proof.c -- over a step and a sub-range of the unknowns: how solutions move, and how far they get from the
** polynomials.
**
** 1. Picard's inclusion for the box of the sub-range and its slopes (docs/numerics/series.md): every solution from the
**    box exists on the step, and differences of two of them are J times those at the start.
** 2. y(t) = sum X_k t^k starts where a solution phi does. |phi - y| <= u, u' = A u + |y' - f(y)|, u(0) = 0, as long as
**    both lie where |Df| <= A: near the tube of the box, pad wide. u(h) <= exp(A h) local; if that is less than the
**    pad, they never leave. (Comparison theorem: Walter, Differential and Integral Inequalities.)
*/
#include "flow.h"
#include <string.h>

#define ATTEMPTS 6
#define MOST_GROWTH 5.0   /* norm of |Df| h: a shorter step is better */
#define BALANCING 12      /* rounds that find the units for it */
#define SLOPES_ALLOW 0.01 /* of a remainder, that slopes may add to it by what is beyond their order */
#define TERMS 40          /* of the exponential; after them each is less than 5/41 of the one before */

/* -- the box and its slopes */

/* hull of the boxes of a group's sub-ranges, and the largest remainder */
static void find_box(worker *w, const piece *p, uint32_t group) {
  flow *f = w->flow;
  uint32_t nx = f->nx, nb = nx + f->np;
  for (uint32_t i = 0; i < nb; i++) {
    double lo = -INFINITY, hi = -INFINITY, rest = 0; /* lo negated */
    for (uint32_t n = 0; n < f->ns; n++) {
      if (f->group[(size_t)p->level * f->ns + n] != group) continue;
      size_t at = (size_t)n * nb + i;
      lo = larger(lo, p->rad[at] - p->mid[at]), hi = larger(hi, p->mid[at] + p->rad[at]);
      if (i < nx) rest = larger(rest, zonotope_at(&w->shape, p->zonotope, n).sum[i]);
    }
    double mid = w->group_mid[i] = 0.5 * (hi - lo);
    w->group_rad[i] = larger(hi - mid, mid + lo);
    if (i < nx) w->group_rest[i] = rest;
  }
}

static uint32_t solve_box(worker *w, const piece *p) {
  flow *f = w->flow;
  uint32_t nx = f->nx, nb = nx + f->np, q = f->options.slope_order;
  memset(w->seed, 0, nx * sizeof(double));
  for (uint32_t i = 0; i < nb; i++) {
    if (i < nx) w->seed[i] = 1;
    f->jet->put(w->box, i, 0, w->group_mid[i], w->group_rad[i], w->seed, w->zero);
    if (i < nx) w->seed[i] = 0;
  }
  if (f->problem.uses_time) {
    f->jet->put(w->box, nb, 0, p->t, 0, NULL, NULL);
    f->jet->put(w->box, nb, 1, 1, 0, NULL, NULL);
  }
  uint32_t flags = f->jet->solve(w->box, nx, q);
  for (uint32_t i = 0; i < nx && !flags; i++)
    for (uint32_t k = 0; k <= q; k++) {
      size_t at = (size_t)i * (q + 1u) + k;
      f->jet->get(w->box, f->problem.rhs->nconst + i, k, &w->box_mid[at], &w->box_rad[at], w->slope_mid + at * nx,
          w->slope_rad + at * nx);
    }
  return flags;
}

/* excess, dexcess of the guesses eps, deps */
static int find_excess(worker *w) {
  flow *f = w->flow;
  uint32_t nx = f->nx, q = f->options.slope_order;
  double H = w->step.length, top = 1;
  for (uint32_t k = 0; k < q; k++) top *= H;
  memset(w->tail_in, 0, f->problem.rhs->nin * sizeof(double));
  memset(w->dtail_in, 0, (size_t)f->problem.rhs->nin * nx * sizeof(double));
  for (uint32_t i = 0; i < nx; i++) {
    size_t at = (size_t)i * (q + 1u) + q;
    w->tail_in[i] = (fabs(w->box_mid[at]) + w->box_rad[at]) * top + w->eps[i];
    if (!(w->tail_in[i] < INFINITY)) return 0;
    for (uint32_t j = 0; j < nx; j++) {
      size_t to = (size_t)i * nx + j, from = at * nx + j;
      w->dtail_in[to] = (fabs(w->slope_mid[from]) + w->slope_rad[from]) * top + w->deps[to];
      if (!(w->dtail_in[to] < INFINITY)) return 0;
    }
  }
  if (f->jet->tail(w->box, q - 1, H, w->tail_in, w->dtail_in, w->tail_out, w->dtail_out) != AMBIT_OK) return 0;
  for (uint32_t i = 0; i < nx; i++) w->excess[i] = H * w->tail_out[i] / (q + 1.0);
  for (uint32_t k = 0; k < nx * nx; k++) w->dexcess[k] = H * w->dtail_out[k] / (q + 1.0);
  return 1;
}

/* Guesses are multiples of what the last ones gave, and more and more of the largest in units of the states. */
static void guess(worker *w, const double *unit, int attempt) {
  static const double share[ATTEMPTS] = { 0, 1e-9, 1e-6, 1e-4, 1e-2, 0.1 };
  uint32_t nx = w->flow->nx;
  double most = 0, dmost = 0, times = attempt ? 2 : 5;
  for (uint32_t i = 0; i < nx; i++) {
    most = larger(most, w->excess[i] / unit[i]);
    for (uint32_t j = 0; j < nx; j++) dmost = larger(dmost, w->dexcess[(size_t)i * nx + j] * unit[j] / unit[i]);
  }
  for (uint32_t i = 0; i < nx; i++) {
    w->eps[i] = times * w->excess[i] + share[attempt] * most * unit[i] + TINY;
    for (uint32_t j = 0; j < nx; j++) {
      size_t at = (size_t)i * nx + j;
      w->deps[at] = times * w->dexcess[at] + share[attempt] * dmost * unit[i] / unit[j] + TINY;
    }
  }
}

static int is_within(size_t n, const double *a, const double *b) {
  for (size_t k = 0; k < n; k++)
    if (!(a[k] <= b[k])) return 0;
  return 1;
}

static int holds(worker *w) {
  size_t nx = w->flow->nx;
  return find_excess(w) && is_within(nx, w->excess, w->eps) && is_within(nx * nx, w->dexcess, w->deps);
}

/* neighbours are alike: what held for the last group, somewhat larger */
static int prove_alike(worker *w) {
  uint32_t nx = w->flow->nx;
  for (uint32_t i = 0; i < nx; i++) w->eps[i] = 4 * w->excess[i] + TINY;
  for (uint32_t k = 0; k < nx * nx; k++) w->deps[k] = 4 * w->dexcess[k] + TINY;
  return holds(w);
}

/* guesses from what eps = 0 gives */
static int try_guesses(worker *w, const double *unit) {
  size_t nx = w->flow->nx;
  memset(w->eps, 0, nx * sizeof(double));
  memset(w->deps, 0, nx * nx * sizeof(double));
  if (!find_excess(w)) return 0;
  for (int i = 0; i < ATTEMPTS; i++) {
    guess(w, unit, i);
    if (holds(w)) return 1;
  }
  return 0;
}

/* In units of what states make of each other; then in their own, which may differ by more. */
static int prove_box(worker *w) { return try_guesses(w, w->unit) || try_guesses(w, w->size); }

/* (m +- r) h + (a +- b) */
static void horner(const span *t, double *m, double *r, double a, double b) {
  double high = *m * t->h + a, low = (-*m) * t->h - a;
  *r = *r * t->length + fabs(*m) * t->error + b;
  *m = 0.5 * (high - low);
  *r += larger(high - *m, *m + low);
}

/* J at the end of the step; the most that J z is during the step. 0: what slopes lack beyond order q would swell the
** remainder; a shorter step is better. */
static int transfer(worker *w, uint32_t n) {
  uint32_t nx = w->flow->nx, q = w->flow->options.slope_order;
  for (uint32_t i = 0; i < nx; i++) {
    double reach = 0, added = 0;
    for (uint32_t j = 0; j < nx; j++) {
      size_t entry = (size_t)i * nx + j, row = (size_t)i * (q + 1u);
      const double *a = w->slope_mid + row * nx + j, *b = w->slope_rad + row * nx + j;
      double m = a[(size_t)q * nx], r = b[(size_t)q * nx], most = fabs(m) + r;
      for (uint32_t k = q; k-- > 0;) {
        horner(&w->step, &m, &r, a[(size_t)k * nx], b[(size_t)k * nx]);
        most = most * w->step.length + (fabs(a[(size_t)k * nx]) + b[(size_t)k * nx]);
      }
      w->transfer_mid[(size_t)n * nx * nx + entry] = m;
      w->transfer_rad[(size_t)n * nx * nx + entry] = r + w->dexcess[entry];
      reach += (most + w->dexcess[entry]) * w->group_rest[j];
      added += w->dexcess[entry] * w->group_rest[j];
    }
    w->reach[(size_t)n * nx + i] = reach;
    if (!(added <= SLOPES_ALLOW * reach + w->flow->options.tolerance * w->size[i])) return 0;
  }
  return 1;
}

/* -- the tube of the box */

/* With s in [0, 1] the first three terms are a parabola, which lies within its Bernstein coefficients c0, c0 + c1/2,
** c0 + c1 + c2 [Farouki, CAGD 29 (2012)]; the rest by magnitudes. */
static void find_tube(worker *w) {
  uint32_t nx = w->flow->nx, q = w->flow->options.slope_order;
  double H = w->step.length, h = w->step.h < 0 ? -H : H;
  for (uint32_t i = 0; i < nx; i++) {
    const double *m = w->box_mid + (size_t)i * (q + 1u), *r = w->box_rad + (size_t)i * (q + 1u);
    double rest = 0;
    for (uint32_t k = q; k > 2; k--) rest = (rest + (fabs(m[k]) + r[k])) * H;
    rest = rest * H * H + fabs(m[2]) * H * H * 0x1p-50; /* and for the rounding of H^2 below */
    double first = r[0], second = r[0] + 0.5 * H * r[1], third = r[0] + H * (r[1] + H * r[2]);
    double high = larger(m[0] + first, larger(m[0] + 0.5 * h * m[1] + second, m[0] + h * m[1] + H * H * m[2] + third));
    double low =
        larger(first - m[0], larger((-0.5 * h) * m[1] - m[0] + second, (-h) * m[1] + (H * H) * (-m[2]) - m[0] + third));
    rest += w->excess[i];
    high += rest, low += rest;
    w->near_mid[i] = 0.5 * (high - low);
    w->near_rad[i] = larger(high - w->near_mid[i], w->near_mid[i] + low);
    w->tube_lo[i] = smaller(w->tube_lo[i], -low);
    w->tube_hi[i] = larger(w->tube_hi[i], high);
  }
}

/* -- the distance from the polynomials */

/* Positive weights in which the row-sum norm of A >= 0 is near its spectral radius, by the power method on A and its
** norm times the identity: states in their own units may differ by any factor. Returns the norm. */
static double balance(worker *w) {
  uint32_t nx = w->flow->nx;
  double *weight = w->weight, *image = w->scratch, norm = 0;
  memcpy(weight, w->size, nx * sizeof *weight);
  for (int round = 0; round <= BALANCING; round++) {
    double most = 0;
    norm = 0;
    for (uint32_t i = 0; i < nx; i++) {
      image[i] = 0;
      for (uint32_t j = 0; j < nx; j++) image[i] += w->A[(size_t)i * nx + j] * weight[j];
      norm = larger(norm, image[i] / weight[i]);
    }
    if (norm <= 1 || round == BALANCING) return norm;
    for (uint32_t i = 0; i < nx; i++) most = larger(most, (image[i] + 0.25 * norm * weight[i]) / weight[i]);
    for (uint32_t i = 0; i < nx; i++) weight[i] = (image[i] + 0.25 * norm * weight[i]) / most;
  }
  return norm;
}

/* A := |Df| H over the tube, pad wider; 0: not bounded, or too large */
static int find_growth(worker *w, const piece *p, const double *pad) {
  flow *f = w->flow;
  uint32_t nx = f->nx, nb = nx + f->np;
  memset(w->seed, 0, nx * sizeof(double));
  for (uint32_t i = 0; i < nb; i++) {
    if (i < nx) w->seed[i] = 1;
    if (i < nx)
      f->jet->put(w->near, i, 0, w->near_mid[i], w->near_rad[i] + pad[i], w->seed, w->zero);
    else
      f->jet->put(w->near, i, 0, w->group_mid[i], w->group_rad[i], w->seed, w->zero);
    if (i < nx) w->seed[i] = 0;
  }
  if (f->problem.uses_time) {
    double mid = 0.5 * (p->t + w->t_next);
    double rad = larger(larger(mid - p->t, mid - w->t_next), larger(p->t - mid, w->t_next - mid));
    f->jet->put(w->near, nb, 0, mid, rad, NULL, NULL);
  }
  if (f->jet->advance(w->near, 0)) return 0;
  for (uint32_t i = 0; i < nx; i++) {
    double mid, rad, *A = w->A + (size_t)i * nx;
    f->jet->get(w->near, f->problem.rhs->out[i], 0, &mid, &rad, w->seed, A);
    for (uint32_t j = 0; j < nx; j++) {
      A[j] = (fabs(w->seed[j]) + A[j]) * w->step.length;
      if (!(A[j] < INFINITY)) return 0;
    }
  }
  return balance(w) <= MOST_GROWTH;
}

/* apart := exp(A) local, from above. Terms v_q = A^q local / q!; behind the last, their norms, the largest entry over
** its weight, fall faster than a geometric series of ratio norm / (TERMS + 1) < 1/2, so their sum is less than the
** last one's norm. */
static void exponentiate(worker *w, double *apart) {
  uint32_t nx = w->flow->nx;
  double *v = w->scratch, *u = v + nx, last = 0;
  for (uint32_t i = 0; i < nx; i++) apart[i] = v[i] = w->local[i];
  for (uint32_t q = 1; q <= TERMS; q++) {
    for (uint32_t i = 0; i < nx; i++) {
      u[i] = 0;
      for (uint32_t j = 0; j < nx; j++) u[i] += w->A[(size_t)i * nx + j] * v[j];
      u[i] /= q;
    }
    for (uint32_t i = 0; i < nx; i++) apart[i] += v[i] = u[i];
  }
  for (uint32_t i = 0; i < nx; i++) last = larger(last, v[i] / w->weight[i]);
  for (uint32_t i = 0; i < nx; i++) apart[i] += last * w->weight[i];
}

static int find_distance(worker *w, const piece *p, uint32_t n) {
  uint32_t nx = w->flow->nx;
  double *apart = w->apart + (size_t)n * nx, *pad = w->scratch + 2 * (size_t)nx;
  for (uint32_t i = 0; i < nx; i++) pad[i] = larger(p->pad[i], 2 * w->local[i]) + TINY;
  for (int k = 0; k < ATTEMPTS; k++) {
    if (!find_growth(w, p, pad)) return 0;
    exponentiate(w, apart);
    int inside = 1;
    for (uint32_t i = 0; i < nx; i++) inside &= apart[i] < pad[i];
    if (inside) return 1;
    for (uint32_t i = 0; i < nx; i++) pad[i] = 4 * apart[i] + TINY;
  }
  return 0;
}

int flow_prove(worker *w, piece *p, uint32_t n) {
  w->order_too_low = 0;
  find_box(w, p, n);
  if (solve_box(w, p) || (!(n && prove_alike(w)) && !prove_box(w))) return 0;
  find_tube(w);
  w->order_too_low = !transfer(w, n);
  return !w->order_too_low && find_distance(w, p, n);
}
