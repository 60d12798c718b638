/* contract.c -- the part of the set on which the invariants vanish.
**
** Let 0 = g + S v, v = (xi, z + low), z = G e, for each state on the manifold (invariant.c). Then for ANY matrix P
**   x = m + low + C xi + z - P (g + S v)
**     = (m - P g) + (I - P S_z) low + (C - P S_xi) xi + (I - P S_z) z,
** which is of the set's own form again, with the same xi and e, up to a box for what S and g are uncertain by. So
** nothing needs to be inverted rigorously and a rank need not be known; P only decides how good the result is. The
** best, in the sense of least squares, is that of Kalman's filter, here for sets: P = Q J^T (J Q J^T + R)^-1, J the
** midpoint of S_z, Q = G G^T plus the same of those columns of C that are not along the manifold, R the squares of what
** S and g are uncertain by [Alamo, Bravo & Camacho, Automatica 41 (2005), zonotopes cut with strips; Combastel,
** Automatica 55 (2015)]. It does not depend on units, leaves alone what invariants know worse than the set does, and
** ignores rows that say nothing new. Proof: docs/numerics/lohner.md.
*/
#include "constraint.h"
#include <string.h>

#define STRETCH 8         /* how far off the manifold, beside what is not known about that, before it pays */
#define WORTH 0.02        /* least share of a state's mean square that must go */
#define CURVED 4          /* a slope is more than curvature if it is larger than this times its radius */
#define ALONG 0.01        /* share of its terms that is left of the slope of a column along the manifold */
#define DEPENDENT 0x1p-40 /* of a row's mean square that is left when others are known */
#define PASSES 3          /* each with the smaller set of the one before */

/* -- whether there is such a part */

/* |g| is larger than S v can be: for no state of the set do they cancel */
static int is_apart(const field *f, const set *x, const constraint *c, uint32_t r) {
  double reach = c->varies[r];
  for (uint32_t j = 0; j < f->ndir; j++) reach += fabs(c->slope.mid[(size_t)r * f->ndir + j]) * set_reach(f, x, j);
  return fabs(c->value[r]) > reach;
}

static int is_met(const field *f, const set *x, constraint *c) {
  for (uint32_t r = 0; r < c->k; r++)
    if (is_apart(f, x, c, r)) {
      c->blamed = r;
      return 0;
    }
  return 1;
}

/* -- the gain; approximate */

/* Column j leads away from the manifold: in some row what is left of its slope is more than the set's curvature, and
** more than cancellation leaves of a column along it. To shorten a column by the little that it is off would trade it
** for many generators. */
static int leads_away(const field *f, const set *x, const constraint *c, uint32_t j) {
  for (uint32_t r = 0; r < c->k; r++) {
    const double *slope = c->slope.mid + (size_t)r * f->ndir;
    double whole = 0, left = fabs(slope[j]);
    for (uint32_t i = 0; i < f->nx; i++) whole += fabs(slope[f->nc + i] * x->column[(size_t)i * f->nc + j]);
    if (left > CURVED * c->slope.rad[(size_t)r * f->ndir + j] && left > ALONG * whole) return 1;
  }
  return 0;
}

/* away := columns that lead away, 0 for others; outward := J away */
static void find_outward(const field *f, const set *x, constraint *c) {
  size_t nx = f->nx, nc = f->nc;
  for (size_t j = 0; j < nc; j++) {
    double takes = leads_away(f, x, c, (uint32_t)j);
    for (size_t i = 0; i < nx; i++) c->away[i * nc + j] = takes * x->column[i * nc + j];
  }
  for (size_t r = 0; r < c->k; r++)
    for (size_t j = 0; j < nc; j++) {
      double sum = 0;
      for (size_t i = 0; i < nx; i++) sum += c->slope.mid[r * f->ndir + nc + i] * c->away[i * nc + j];
      c->outward[r * nc + j] = sum;
    }
}

static double inner(size_t n, const double *a, const double *b) {
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

/* spread := J G and outward, each row in a unit in which it reaches 1, so that squares neither overflow nor underflow.
** Returns how far the set reaches off the manifold at most, over what is not known about that; *many: by how much sums
** of small generators reach farther than their mean square says, as what varies counts as one generator. */
static double measure(const field *f, const set *x, constraint *c, double *many) {
  size_t pitch = x->history.pitch, nc = f->nc;
  double most = 0;
  *many = 1;
  history_spread(&x->history, c->k, c->slope.mid + nc, f->ndir, c->spread);
  find_outward(f, x, c);
  for (size_t r = 0; r < c->k; r++) {
    double reach = 0, square = 0, *spread = c->spread + r * pitch, *outward = c->outward + r * nc;
    for (size_t a = 0; a < pitch; a++) reach += fabs(spread[a]);
    double sum = reach;
    for (size_t j = 0; j < nc; j++) reach += fabs(outward[j]);
    c->unit[r] = reach > 0 && 1 / reach < INFINITY ? 1 / reach : 0;
    for (size_t a = 0; a < pitch; a++) spread[a] *= c->unit[r], square += spread[a] * spread[a];
    for (size_t j = 0; j < nc; j++) outward[j] *= c->unit[r];
    if (square > 0) *many = larger(*many, (sum * c->unit[r]) * (sum * c->unit[r]) / square);
    if (reach > most * c->varies[r]) most = reach / c->varies[r];
  }
  return most;
}

/* before := diagonal of Q, cross := J Q, normal := J Q J^T + R, rows in their units */
static void correlate(const field *f, const set *x, constraint *c, double many) {
  size_t k = c->k, nx = f->nx, nc = f->nc, pitch = x->history.pitch;
  history_correlate(&x->history, c->k, c->spread, c->cross, c->before);
  for (size_t i = 0; i < nx; i++) {
    const double *away = c->away + i * nc;
    c->before[i] = many * c->before[i] + inner(nc, away, away);
    for (size_t r = 0; r < k; r++)
      c->cross[r * nx + i] = many * c->cross[r * nx + i] + inner(nc, c->outward + r * nc, away);
  }
  for (size_t r = 0; r < k; r++) {
    for (size_t q = 0; q <= r; q++)
      c->normal[r * k + q] = c->normal[q * k + r] = many * inner(pitch, c->spread + r * pitch, c->spread + q * pitch) +
                                                    inner(nc, c->outward + r * nc, c->outward + q * nc);
    double unknown = c->unit[r] * c->varies[r];
    c->normal[r * k + r] += unknown * unknown;
  }
}

/* the row that is left with the largest share of its mean square; k: all depend on those that are done */
static size_t next_row(const constraint *c) {
  size_t best = c->k;
  double most = DEPENDENT;
  for (size_t r = 0; r < c->k; r++) {
    double share = c->normal[r * c->k + r] / c->whole[r];
    if (c->done[r] == 0 && share > most && share < INFINITY) most = share, best = r;
  }
  return best;
}

/* row r of the system normal gain = cross taken out of all others */
static void eliminate(constraint *c, size_t nx, size_t r) {
  size_t k = c->k;
  const double *row = c->normal + r * k;
  for (size_t q = 0; q < k; q++) {
    double factor = c->normal[q * k + r] / row[r];
    if (q == r || factor == 0) continue;
    for (size_t j = 0; j < k; j++) c->normal[q * k + j] -= factor * row[j];
    for (size_t i = 0; i < nx; i++) c->gain[q * nx + i] -= factor * c->gain[r * nx + i];
  }
  c->done[r] = 1;
}

/* gain := units normal^-1 cross by Gauss and Jordan; rows that depend on others get none. Destroys normal. */
static void find_gain(const field *f, constraint *c) {
  size_t k = c->k, nx = f->nx;
  memcpy(c->gain, c->cross, k * nx * sizeof(double));
  for (size_t r = 0; r < k; r++) c->whole[r] = c->normal[r * k + r], c->done[r] = 0;
  for (size_t r; (r = next_row(c)) < k;) eliminate(c, nx, r);
  for (size_t r = 0; r < k; r++)
    for (size_t i = 0; i < nx; i++)
      c->gain[r * nx + i] = c->done[r] != 0 ? c->unit[r] * (c->gain[r * nx + i] / c->normal[r * k + r]) : 0;
}

/* the largest share of a state's mean square that goes; not above 0 if anything is not finite */
static double worth(const field *f, const constraint *c) {
  double most = 0;
  for (size_t i = 0; i < f->nx; i++) {
    double gone = 0;
    for (size_t r = 0; r < c->k; r++)
      if (c->unit[r] > 0) gone += c->gain[r * f->nx + i] * (c->cross[r * f->nx + i] / c->unit[r]);
    if (!(fabs(gone) < INFINITY)) return 0;
    if (c->before[i] > 0) most = larger(most, gone / c->before[i]);
  }
  return most;
}

/* -- the move, rigorous for any gain */

/* from - P_i s, P_i row i of P and s a column of slopes: *near it, and a bound of how far from it */
static double move_entry(
    const field *f, const constraint *c, uint32_t i, double from, const double *slope, double *near) {
  double above = from, below = -from;
  for (uint32_t r = 0; r < c->k; r++) {
    double p = c->gain[(size_t)r * f->nx + i], x = slope[(size_t)r * f->ndir];
    above += (-p) * x;
    below += p * x;
  }
  *near = 0.5 * (above - below);
  return larger(above - *near, *near + below);
}

static void move_row(const field *f, set *x, constraint *c, uint32_t i) {
  double away = 0, entry;
  ball shift = { 0, 0 };
  for (uint32_t r = 0; r < c->k; r++) {
    double p = c->gain[(size_t)r * f->nx + i];
    shift = ball_add(shift, ball_of(p * c->value[r], (-p) * c->value[r]));
    shift.rad += fabs(p) * c->varies[r];
  }
  for (uint32_t j = 0; j < f->nx; j++) {
    away += move_entry(f, c, i, i == j, c->slope.mid + f->nc + j, &entry) * set_reach(f, x, f->nc + j);
    c->move[(size_t)i * f->nx + j] = entry;
    if (x->low[j] != 0) shift = ball_add(shift, ball_of((-entry) * x->low[j], entry * x->low[j]));
  }
  for (uint32_t j = 0; j < f->nc; j++) {
    double *column = x->column + (size_t)i * f->nc + j;
    away += move_entry(f, c, i, *column, c->slope.mid + j, &entry);
    *column = entry;
  }
  set_shift(x, i, 0, shift);
  x->box[i] += away;
}

static void move(const field *f, set *x, constraint *c) {
  for (uint32_t i = 0; i < f->nx; i++) move_row(f, x, c, i);
  set_settle(f, x, c->move, f->nx);
}

/* -- both */

/* the row that moved state i most */
static uint32_t strongest(const field *f, const constraint *c, uint32_t i) {
  uint32_t best = 0;
  double most = 0;
  for (uint32_t r = 0; r < c->k; r++) {
    double moved = c->unit[r] > 0 ? fabs(c->gain[(size_t)r * f->nx + i]) / c->unit[r] : 0;
    if (moved > most) most = moved, best = r;
  }
  return best;
}

/* The hull may get wider in one state for the sake of others: both hulls hold. 0: they do not meet. */
static int meet_hull(const field *f, set *x, constraint *c) {
  double *lo = x->new_centre, *hi = x->new_low; /* free until the set moves */
  memcpy(lo, x->lo, f->nx * sizeof(double));
  memcpy(hi, x->hi, f->nx * sizeof(double));
  set_hull(f, x);
  for (uint32_t i = 0; i < f->nx; i++) {
    x->lo[i] = larger_or_nan(lo[i], x->lo[i]);
    x->hi[i] = hi[i] < x->hi[i] ? hi[i] : x->hi[i];
    if (x->lo[i] > x->hi[i]) {
      c->blamed = strongest(f, c, i);
      return 0;
    }
  }
  return 1;
}

int constraint_cut(const field *f, set *x, const pieces *pieces, constraint *c) {
  if (c->k == 0) return 1;
  for (int pass = 0; pass < PASSES; pass++) {
    if (!constraint_linearise(f, x, pieces, c)) return 1;
    if (!is_met(f, x, c)) return 0;
    double many;
    if (!(measure(f, x, c, &many) > STRETCH)) return 1;
    correlate(f, x, c, many);
    find_gain(f, c);
    if (!(worth(f, c) > WORTH)) return 1;
    move(f, x, c);
    if (!meet_hull(f, x, c)) return 0;
  }
  return 1;
}
