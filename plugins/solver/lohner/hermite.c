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
#include "lohner.h"
#include <ambit/matrix.h>
#include <string.h>

static size_t at(const lohner *s, uint32_t i, uint32_t j) { return (size_t)i * s->ndir + j; }

/* -- memory */

ambit_status lohner_open_corrector(lohner *s) {
  const ambit_problem *p = &s->problem;
  corrector *c = &s->corrector;
  size_t nx = s->nx, nd = s->ndir;
  uint32_t most = (s->options.slope_order_max + 1) / 2;
  const struct {
    double **array;
    size_t count;
  } list[] = { { &c->weight, most + 1u }, { &c->loose, most + 1u }, { &c->from_mid, nx * nd },
    { &c->from_rad, nx * nd }, { &c->to_mid, nx * nd }, { &c->to_rad, nx * nd }, { &c->error, nx * nd },
    { &c->guess_mid, nx * nd }, { &c->guess_rad, nx * nd }, { &c->inverse, nx * nx }, { &c->work, nx * nx },
    { &c->defect, nx * nx }, { &c->dmid, nd }, { &c->drad, nd }, { &c->added, nx } };
  for (size_t k = 0; k < sizeof list / sizeof *list; k++)
    if (!(*list[k].array = s->host->alloc(s->host, (list[k].count ? list[k].count : 1) * sizeof(double))))
      return s->host->fail(s->host, AMBIT_NOMEM, "lohner: out of memory");
  ambit_status status = s->jet->open(s->host, p->rhs, p->arithmetic, p->actx, most, s->ndir, NULL, &c->end_jet);
  if (status != AMBIT_OK) return status;
  return s->jet->open(s->host, p->rhs, p->arithmetic, p->actx, 2 * most + 1, s->ndir, NULL, &c->tube_jet);
}

void lohner_close_corrector(lohner *s) {
  if (s->corrector.end_jet) s->jet->close(s->corrector.end_jet);
  if (s->corrector.tube_jet) s->jet->close(s->corrector.tube_jet);
}

/* -- derivatives over the end and over the whole step */

static uint32_t solve(lohner *s, ambit_jet *jet, ball time, uint32_t order) {
  for (uint32_t i = 0; i < s->np; i++) lohner_put_parameter(s, jet, i);
  if (s->problem.uses_time) {
    s->jet->put(jet, s->nx + s->np, 0, time.mid, time.rad, NULL, NULL);
    s->jet->put(jet, s->nx + s->np, 1, 1, 0, NULL, NULL);
  }
  return s->jet->solve(jet, s->nx, order);
}

/* the box of all states at the end, with C = the middle of the Taylor slopes of xi as seeds */
static uint32_t solve_end(lohner *s) {
  corrector *c = &s->corrector;
  for (uint32_t i = 0; i < s->nx; i++) {
    ball step = lohner_increment(s, i), box = ball_of(-s->centre[i] - step.mid, s->centre[i] + step.mid);
    box.rad += step.rad;
    for (uint32_t j = 0; j < s->ndir; j++) {
      box.rad += (fabs(c->guess_mid[at(s, i, j)]) + c->guess_rad[at(s, i, j)]) * lohner_reach(s, j);
      c->dmid[j] = j < s->nc ? c->guess_mid[at(s, i, j)] : j - s->nc == i;
    }
    s->jet->put(c->end_jet, i, 0, box.mid, box.rad, c->dmid, s->no_radius);
  }
  return solve(s, c->end_jet, (ball) { s->t_next, 0 }, c->r);
}

/* the tube, with all slopes of the step as seeds */
static uint32_t solve_tube(lohner *s) {
  corrector *c = &s->corrector;
  for (uint32_t i = 0; i < s->nx; i++) {
    ball box = ball_of(-s->tube_lo[i], s->tube_hi[i]);
    for (uint32_t j = 0; j < s->ndir; j++) {
      ball slope = lohner_slope_over_step(s, i, j);
      c->dmid[j] = slope.mid, c->drad[j] = slope.rad;
    }
    s->jet->put(c->tube_jet, i, 0, box.mid, box.rad, c->dmid, c->drad);
  }
  return solve(s, c->tube_jet, ball_of(-smaller(s->t, s->t_next), larger(s->t, s->t_next)), 2 * c->r + 1);
}

/* -- both sides of the formula */

/* weight +- loose: c_i, signed for the end; gamma H^(2r+1) */
static double choose_weights(lohner *s, double sign) {
  corrector *c = &s->corrector;
  double high = 1, low = -1, gamma = s->step.length;
  for (uint32_t i = 0; i <= c->r; i++) {
    ball b = ball_of(low, high);
    c->weight[i] = i % 2 ? sign * b.mid : b.mid;
    c->loose[i] = b.rad;
    high = high * (double)(c->r - i) / (double)(2 * c->r - i);
    low = low * (double)(c->r - i) / (double)(2 * c->r - i);
  }
  for (uint32_t i = 1; i <= c->r; i++) gamma *= s->step.length * s->step.length * (double)i / (double)(c->r + i);
  return gamma;
}

/* mid +- rad := sum_i weight_i h^i times the slopes of order i of every state */
static void combine(lohner *s, const ambit_jet *jet, double *mid, double *rad) {
  corrector *c = &s->corrector;
  for (uint32_t i = 0; i < s->nx; i++)
    for (uint32_t k = c->r + 1; k-- > 0;) {
      double m, r;
      s->jet->get(jet, s->problem.rhs->nconst + i, k, &m, &r, c->dmid, c->drad);
      for (uint32_t j = 0; j < s->ndir; j++) {
        double w = c->weight[k], d = c->dmid[j];
        ball term = ball_of((-w) * d, w * d), sum = { mid[at(s, i, j)], rad[at(s, i, j)] };
        term.rad += c->loose[k] * fabs(d) + (fabs(w) + c->loose[k]) * c->drad[j];
        if (k < c->r) term = ball_horner(sum, s->step, term);
        mid[at(s, i, j)] = term.mid, rad[at(s, i, j)] = term.rad;
      }
    }
}

static void bound_error(lohner *s, double gamma) {
  corrector *c = &s->corrector;
  for (uint32_t i = 0; i < s->nx; i++) {
    double m, r;
    s->jet->get(c->tube_jet, s->problem.rhs->nconst + i, 2 * c->r + 1, &m, &r, c->dmid, c->drad);
    for (uint32_t j = 0; j < s->ndir; j++) c->error[at(s, i, j)] = gamma * (fabs(c->dmid[j]) + c->drad[j]);
  }
}

/* -- the linear system */

/* inverse := about that of the middle of Q; a matrix of NaN if it is singular */
static void invert(lohner *s) {
  corrector *c = &s->corrector;
  uint32_t n = s->nx;
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t j = 0; j < n; j++) c->work[(size_t)i * n + j] = c->to_mid[at(s, i, s->nc + j)];
  if (ambit_matrix_invert(n, c->work, c->inverse)) return;
  for (size_t k = 0; k < (size_t)n * n; k++) c->inverse[k] = NAN;
}

/* defect := |I - A Q| */
static void bound_defect(lohner *s) {
  corrector *c = &s->corrector;
  uint32_t n = s->nx;
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t j = 0; j < n; j++) {
      double above = -(i == j), below = i == j, rad = 0;
      for (uint32_t k = 0; k < n; k++) {
        double a = c->inverse[(size_t)i * n + k], q = c->to_mid[at(s, k, s->nc + j)];
        above += a * q;
        below += (-a) * q;
        rad += fabs(a) * c->to_rad[at(s, k, s->nc + j)];
      }
      c->defect[(size_t)i * n + j] = larger_or_nan(above, below) + rad;
    }
}

/* entry (i, j) of C + A (P - Q_xi), or of A P_z, and what E and the defect add to it */
static ball solution(const lohner *s, uint32_t i, uint32_t j, double *rest) {
  const corrector *c = &s->corrector;
  int datum = j < s->nc;
  double above = datum ? c->guess_mid[at(s, i, j)] : 0, below = -above, rad = 0;
  *rest = 0;
  for (uint32_t k = 0; k < s->nx; k++) {
    size_t kj = at(s, k, j);
    double a = c->inverse[(size_t)i * s->nx + k], y = c->guess_rad[kj] + (datum ? 0 : fabs(c->guess_mid[kj]));
    above += a * c->from_mid[kj];
    below += (-a) * c->from_mid[kj];
    rad += fabs(a) * c->from_rad[kj];
    if (datum) {
      above += (-a) * c->to_mid[kj];
      below += a * c->to_mid[kj];
      rad += fabs(a) * c->to_rad[kj];
    }
    *rest += fabs(a) * c->error[kj] + c->defect[(size_t)i * s->nx + k] * y;
  }
  ball b = ball_of(below, above);
  return (ball) { b.mid, b.rad + rad + *rest };
}

/* What curvature leaves of a slope in any formula is no matter to one that is asked for. */
static double curved(const lohner *s, uint32_t i, uint32_t j) {
  if (s->options.formula != FORMULA_HERMITE_OBRESCHKOFF) return 0;
  return s->corrector.guess_rad[at(s, i, j)] - s->slope_excess[at(s, i, j)];
}

int lohner_correct(lohner *s) {
  corrector *c = &s->corrector;
  c->r = (s->slope_order + 1) / 2;
  lohner_transfer(s, c->guess_mid, c->guess_rad);
  if (solve_end(s) || solve_tube(s)) return 0;
  choose_weights(s, 1);
  combine(s, s->box_jet, c->from_mid, c->from_rad);
  bound_error(s, choose_weights(s, -1));
  combine(s, c->end_jet, c->to_mid, c->to_rad);
  invert(s);
  bound_defect(s);
  for (uint32_t i = 0; i < s->nx; i++) {
    c->added[i] = 0;
    for (uint32_t j = 0; j < s->ndir; j++) {
      double rest;
      ball b = solution(s, i, j, &rest);
      s->transfer_mid[at(s, i, j)] = b.mid, s->transfer_rad[at(s, i, j)] = b.rad;
      c->added[i] += larger(rest - curved(s, i, j), 0) * lohner_reach(s, j);
      if (!(b.rad < INFINITY)) return 0; /* NaN too */
    }
  }
  return 1;
}
