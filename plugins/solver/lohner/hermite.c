/* hermite.c -- the interval Hermite-Obreschkoff formula as corrector of the slopes at the end of a step.
**
** For every smooth function d on the step, componentwise and with d_i the Taylor coefficients of order i,
**   sum_{i<=r} (-1)^i c_i h^i d_i(t+h) = sum_{i<=r} c_i h^i d_i(t) + gamma h^(2r+1) d_(2r+1)(tau),
**   c_i = r! (2r-i)! / ((2r)! (r-i)!), |gamma| = r!^2 / (2r)!
** [Hermite; Obreschkoff 1940; Nedialkov 1999, for intervals]. Here d = x - m is the distance of any solution of the set
** to the one from its midpoint. With d(t) = s v (series.c) and d_i(t+h) in D F_i (C xi + y), C any matrix and y what
** the Taylor slopes leave of d(t+h), everything is linear in v and y: with A about the inverse of Q, the matrix of y,
**   y = A ((P - Q_xi) xi + P_z (G e + low) + E) + (I - A Q) y.
** The Taylor slopes are the predictor that y on the right hand is taken from; where the formula is contracting, it does
** not matter that they are coarse. Proof: docs/numerics/lohner.md.
*/
#include "set.h"
#include <ambit/matrix.h>
#include <string.h>

static size_t at(const field *f, uint32_t i, uint32_t j) { return (size_t)i * f->ndir + j; }

/* -- memory */

ambit_status corrector_open(const field *f, corrector *c) {
  const ambit_problem *p = &f->problem;
  size_t nx = f->nx, nd = f->ndir;
  uint32_t most = (f->options.slope_order_max + 1) / 2;
  const request list[] = { { &c->weight, most + 1u }, { &c->loose, most + 1u }, { &c->from.mid, nx * nd },
    { &c->from.rad, nx * nd }, { &c->to.mid, nx * nd }, { &c->to.rad, nx * nd }, { &c->error, nx * nd },
    { &c->guess.mid, nx * nd }, { &c->guess.rad, nx * nd }, { &c->inverse, nx * nx }, { &c->work, nx * nx },
    { &c->defect, nx * nx }, { &c->d.mid, nd }, { &c->d.rad, nd }, { &c->added, nx } };
  if (!field_allocate(f->host, sizeof list / sizeof *list, list)) return field_no_memory(f->host);
  ambit_status status = f->jet->open(f->host, p->rhs, p->arithmetic, p->actx, most, f->ndir, NULL, &c->end_jet);
  if (status != AMBIT_OK) return status;
  return f->jet->open(f->host, p->rhs, p->arithmetic, p->actx, 2 * most + 1, f->ndir, NULL, &c->tube_jet);
}

void corrector_close(const field *f, corrector *c) {
  if (c->end_jet) f->jet->close(c->end_jet);
  if (c->tube_jet) f->jet->close(c->tube_jet);
}

/* -- derivatives over the end and over the whole step */

static uint32_t solve(const field *f, ambit_jet *jet, ball time, uint32_t order) {
  for (uint32_t i = 0; i < f->np; i++) flow_put_parameter(f, f->whole, jet, i);
  if (f->problem.uses_time) {
    f->jet->put(jet, f->nx + f->np, 0, time.mid, time.rad, NULL, NULL);
    f->jet->put(jet, f->nx + f->np, 1, 1, 0, NULL, NULL);
  }
  return f->jet->solve(jet, f->nx, order);
}

/* the box of all states at the end, with C = the middle of the Taylor slopes of xi as seeds */
static uint32_t solve_end(const field *f, const set *x, const flow *phi, corrector *c) {
  for (uint32_t i = 0; i < f->nx; i++) {
    balls guess = balls_at(c->guess, at(f, i, 0));
    ball step = flow_increment(phi, i), box = ball_of(-x->centre[i] - step.mid, x->centre[i] + step.mid);
    box.rad += step.rad;
    for (uint32_t j = 0; j < f->ndir; j++) {
      box.rad += (fabs(guess.mid[j]) + guess.rad[j]) * set_reach(f, x, j);
      c->d.mid[j] = j < f->nc ? guess.mid[j] : j - f->nc == i;
    }
    f->jet->put(c->end_jet, i, 0, box.mid, box.rad, c->d.mid, NULL);
  }
  return solve(f, c->end_jet, (ball) { phi->t_next, 0 }, c->r);
}

/* the tube, with all slopes of the step as seeds */
static uint32_t solve_tube(const field *f, const flow *phi, corrector *c) {
  for (uint32_t i = 0; i < f->nx; i++) {
    ball box = ball_of(-phi->tube_lo[i], phi->tube_hi[i]);
    for (uint32_t j = 0; j < f->ndir; j++) {
      ball slope = flow_slope_over_step(f, phi, i, j);
      c->d.mid[j] = slope.mid, c->d.rad[j] = slope.rad;
    }
    f->jet->put(c->tube_jet, i, 0, box.mid, box.rad, c->d.mid, c->d.rad);
  }
  ball time = ball_of(-smaller(phi->t, phi->t_next), larger(phi->t, phi->t_next));
  return solve(f, c->tube_jet, time, 2 * c->r + 1);
}

/* -- both sides of the formula */

/* weight +- loose: c_i, signed for the end; gamma H^(2r+1) */
static double choose_weights(const flow *phi, double sign, corrector *c) {
  double high = 1, low = -1, H = phi->step.length, gamma = H;
  for (uint32_t i = 0; i <= c->r; i++) {
    ball b = ball_of(low, high);
    c->weight[i] = i % 2 ? sign * b.mid : b.mid;
    c->loose[i] = b.rad;
    high = high * (double)(c->r - i) / (double)(2 * c->r - i);
    low = low * (double)(c->r - i) / (double)(2 * c->r - i);
  }
  for (uint32_t i = 1; i <= c->r; i++) gamma *= H * H * (double)i / (double)(c->r + i);
  return gamma;
}

/* side := sum_i weight_i h^i times the slopes of order i of every state */
static void combine(const field *f, span h, const ambit_jet *jet, const corrector *c, balls side) {
  balls d = c->d;
  for (uint32_t i = 0; i < f->nx; i++)
    for (uint32_t k = c->r + 1; k-- > 0;) {
      double m, r, w = c->weight[k], loose = c->loose[k];
      balls sums = balls_at(side, at(f, i, 0));
      f->jet->get(jet, f->problem.rhs->nconst + i, k, &m, &r, d.mid, d.rad);
      for (uint32_t j = 0; j < f->ndir; j++) {
        ball term = ball_of((-w) * d.mid[j], w * d.mid[j]), sum = { sums.mid[j], sums.rad[j] };
        term.rad += loose * fabs(d.mid[j]) + (fabs(w) + loose) * d.rad[j];
        if (k < c->r) term = ball_horner(sum, h, term);
        sums.mid[j] = term.mid, sums.rad[j] = term.rad;
      }
    }
}

static void bound_error(const field *f, double gamma, corrector *c) {
  for (uint32_t i = 0; i < f->nx; i++) {
    double m, r;
    f->jet->get(c->tube_jet, f->problem.rhs->nconst + i, 2 * c->r + 1, &m, &r, c->d.mid, c->d.rad);
    for (uint32_t j = 0; j < f->ndir; j++) c->error[at(f, i, j)] = gamma * (fabs(c->d.mid[j]) + c->d.rad[j]);
  }
}

/* -- the linear system */

/* inverse := about that of the middle of Q; a matrix of NaN if it is singular */
static void invert(const field *f, corrector *c) {
  uint32_t n = f->nx;
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t j = 0; j < n; j++) c->work[(size_t)i * n + j] = c->to.mid[at(f, i, f->nc + j)];
  if (ambit_matrix_invert(n, c->work, c->inverse)) return;
  for (size_t k = 0; k < (size_t)n * n; k++) c->inverse[k] = NAN;
}

/* defect := |I - A Q| */
static void bound_defect(const field *f, corrector *c) {
  uint32_t n = f->nx;
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t j = 0; j < n; j++) {
      double above = -(i == j), below = i == j, rad = 0;
      for (uint32_t k = 0; k < n; k++) {
        double a = c->inverse[(size_t)i * n + k], q = c->to.mid[at(f, k, f->nc + j)];
        above += a * q;
        below += (-a) * q;
        rad += fabs(a) * c->to.rad[at(f, k, f->nc + j)];
      }
      c->defect[(size_t)i * n + j] = larger_or_nan(above, below) + rad;
    }
}

/* entry (i, j) of C + A (P - Q_xi), or of A P_z, and what E and the defect add to it */
static ball solution(const field *f, const corrector *c, uint32_t i, uint32_t j, double *rest) {
  int datum = j < f->nc;
  double above = datum ? c->guess.mid[at(f, i, j)] : 0, below = -above, rad = 0;
  *rest = 0;
  for (uint32_t k = 0; k < f->nx; k++) {
    size_t kj = at(f, k, j);
    double a = c->inverse[(size_t)i * f->nx + k], y = c->guess.rad[kj] + (datum ? 0 : fabs(c->guess.mid[kj]));
    above += a * c->from.mid[kj];
    below += (-a) * c->from.mid[kj];
    rad += fabs(a) * c->from.rad[kj];
    if (datum) {
      above += (-a) * c->to.mid[kj];
      below += a * c->to.mid[kj];
      rad += fabs(a) * c->to.rad[kj];
    }
    *rest += fabs(a) * c->error[kj] + c->defect[(size_t)i * f->nx + k] * y;
  }
  ball b = ball_of(below, above);
  return (ball) { b.mid, b.rad + rad + *rest };
}

/* What curvature leaves of a slope in any formula is no matter to one that is asked for. */
static double curved(const field *f, const flow *phi, const corrector *c, uint32_t i, uint32_t j) {
  if (f->options.formula != FORMULA_HERMITE_OBRESCHKOFF) return 0;
  return c->guess.rad[at(f, i, j)] - phi->slope_excess[at(f, i, j)];
}

int corrector_find(const field *f, const set *x, const flow *phi, corrector *c, balls S) {
  c->r = (phi->q + 1) / 2;
  flow_slopes_at_end(f, phi, c->guess);
  if (solve_end(f, x, phi, c) || solve_tube(f, phi, c)) return 0;
  choose_weights(phi, 1, c);
  combine(f, phi->step, phi->box_jet, c, c->from);
  bound_error(f, choose_weights(phi, -1, c), c);
  combine(f, phi->step, c->end_jet, c, c->to);
  invert(f, c);
  bound_defect(f, c);
  for (uint32_t i = 0; i < f->nx; i++) {
    c->added[i] = 0;
    for (uint32_t j = 0; j < f->ndir; j++) {
      double rest;
      ball b = solution(f, c, i, j, &rest);
      S.mid[at(f, i, j)] = b.mid, S.rad[at(f, i, j)] = b.rad;
      c->added[i] += larger(rest - curved(f, phi, c, i, j), 0) * set_reach(f, x, j);
      if (!(b.rad < INFINITY)) return 0; /* NaN too */
    }
  }
  return 1;
}
