/* set.c -- moving the set over a step.
**
** With v = (xi, G e + low) the coordinates of a state relative to the centre m, and S any matrix of slopes,
**   x(t+h) = phi(m) + S v = phi(m) + M v + (S - M) v
** for a point matrix M near all S. M v is linear: the set keeps its form. (S - M) v is the effect of nonlinearity, put
** into a box. Since S depends on the state and is proportional to v for small sets, the box is bounded piece by piece
** of the unknowns' cube: (S - M) v is of one sign where it is quadratic, so that the hull over pieces is half as wide
** as one bound for all, and its midpoint moves the centre. Each piece needs the slopes' coefficients over it, but no
** proof of its own: what is beyond the polynomials is bounded over the whole set.
*/
#include "lohner.h"
#include <string.h>

#define ROUNDED 0x1p-30
#define CURVED 0x1p-10 /* share of the set's radius from which on slopes count as varying */

/* -- pieces */

/* How much the slopes of direction j vary over the set, relative to it; what is beyond their orders is no variation. */
static double curvature(const lohner *s, uint32_t j) {
  const double *rad = s->corrected ? s->corrector.guess_rad : s->transfer_rad;
  double most = 0, reach = lohner_reach(s, j);
  for (uint32_t i = 0; i < s->nx; i++) {
    size_t at = (size_t)i * s->ndir + j;
    double varies = (rad[at] - s->slope_excess[at]) * reach;
    /* of a state that is known exactly, too: it is as wide as the step makes it */
    double size = (s->radius[i] > 0 ? s->radius[i] : s->grown[i]) + ROUNDED * s->unit[i];
    if (varies > most * size) most = varies / size;
  }
  return most;
}

/* doubles the number of parts where slopes vary most, as long as it pays; the number of pieces */
static uint32_t choose_cuts(lohner *s) {
  uint32_t pieces = 1;
  double least = CURVED * lohner_share_of_time(s);
  s->wide = 0, s->varies = 0;
  for (uint32_t j = 0; j < s->ndir; j++) {
    double varies = curvature(s, j);
    s->wide |= varies > least;
    s->varies = larger(s->varies, varies);
    if (j < s->nc) s->cuts[j] = 1, s->curvature[j] = varies;
  }
  while (!s->corrected && 2 * pieces <= s->options.pieces) {
    uint32_t worst = s->nc;
    double most = least;
    for (uint32_t j = 0; j < s->nc; j++)
      if (s->curvature[j] / s->cuts[j] > most) most = s->curvature[j] / s->cuts[j], worst = j;
    if (worst == s->nc) break;
    s->cuts[worst] *= 2;
    pieces *= 2;
  }
  return pieces;
}

/* ends are multiples of powers of two: exact */
static void place_pieces(lohner *s) {
  for (uint32_t k = 0; k < s->pieces; k++) {
    uint32_t index = k;
    for (uint32_t j = 0; j < s->nc; j++) {
      double part = 2.0 / s->cuts[j];
      s->piece_from[(size_t)k * s->nc + j] = part * (index % s->cuts[j]) - 1;
      s->piece_to[(size_t)k * s->nc + j] = part * (index % s->cuts[j] + 1) - 1;
      index /= s->cuts[j];
    }
  }
}

void lohner_pieces(lohner *s) {
  size_t entries = (size_t)s->nx * s->ndir, bytes = entries * sizeof(double);
  if (!s->corrected) lohner_transfer(s, s->transfer_mid, s->transfer_rad);
  s->pieces = choose_cuts(s);
  place_pieces(s);
  if (s->pieces == 1) return;
  memcpy(s->whole_mid, s->transfer_mid, bytes);
  memcpy(s->whole_rad, s->transfer_rad, bytes);
  for (uint32_t k = 0; k < s->pieces; k++) {
    double *mid = s->transfer_mid + k * entries, *rad = s->transfer_rad + k * entries;
    uint32_t flags = lohner_box_series(s, s->piece_from + (size_t)k * s->nc, s->piece_to + (size_t)k * s->nc);
    if (!flags)
      lohner_transfer(s, mid, rad);
    else
      memcpy(mid, s->whole_mid, bytes), memcpy(rad, s->whole_rad, bytes);
  }
}

/* -- the move */

/* M := midpoints of the hull of all pieces' slopes */
static void choose_matrix(lohner *s) {
  size_t entries = (size_t)s->nx * s->ndir;
  for (size_t a = 0; a < entries; a++) {
    double low = -INFINITY, high = -INFINITY;
    for (uint32_t k = 0; k < s->pieces; k++) {
      double mid = s->transfer_mid[k * entries + a], rad = s->transfer_rad[k * entries + a];
      low = larger_or_nan(low, rad - mid);
      high = larger_or_nan(high, mid + rad);
    }
    s->matrix[a] = s->pieces == 1 ? s->transfer_mid[a] : 0.5 * (high - low);
  }
}

void lohner_beyond(const lohner *s, const double *mid, const double *rad, const double *matrix, const double *from,
    const double *to, double *low, double *high) {
  *low = *high = 0;
  for (uint32_t j = 0; j < s->ndir; j++) {
    double above = (mid[j] - matrix[j]) + rad[j], below = (matrix[j] - mid[j]) + rad[j]; /* S - M in [-below, above] */
    if (j >= s->nc) {
      double most = larger(above, below) * (s->rest[j - s->nc] + fabs(s->low[j - s->nc]));
      *low += most, *high += most;
      continue;
    }
    double a = from[j], b = to[j];
    *high += larger(larger(above * a, above * b), larger(below * -a, below * -b));
    *low += larger(larger(above * -a, above * -b), larger(below * a, below * b));
  }
}

static ball nonlinear(const lohner *s, uint32_t i) {
  double low = -INFINITY, high = -INFINITY;
  for (uint32_t k = 0; k < s->pieces; k++) {
    double l, h;
    size_t row = (size_t)i * s->ndir, at = (size_t)k * s->nx * s->ndir + row;
    lohner_beyond(s, s->transfer_mid + at, s->transfer_rad + at, s->matrix + row, s->piece_from + (size_t)k * s->nc,
        s->piece_to + (size_t)k * s->nc, &l, &h);
    low = larger_or_nan(low, l), high = larger_or_nan(high, h);
  }
  return ball_of(low, high);
}

void lohner_shift(const lohner *s, uint32_t i, double step, ball shift, double *centre, double *low, double *rest) {
  double sum;
  shift = ball_add(shift, ball_two_sum(s->centre[i], step, &sum));
  ball left = ball_two_sum(sum, shift.mid, centre);
  *low = left.mid;
  *rest = left.rad + shift.rad;
}

/* What is not in the new midpoint of state i goes to added[i]. */
static void move_centre(lohner *s, uint32_t i) {
  const double *row = s->matrix + (size_t)i * s->ndir + s->nc;
  ball shift = nonlinear(s, i), step = lohner_increment(s, i);
  for (uint32_t j = 0; j < s->nx; j++)
    if (s->low[j] != 0) shift = ball_add(shift, ball_of((-row[j]) * s->low[j], row[j] * s->low[j]));
  lohner_shift(s, i, step.mid, shift, &s->new_centre[i], &s->new_low[i], &s->added[i]);
  s->added[i] += step.rad;
}

void lohner_move(lohner *s) {
  choose_matrix(s);
  for (uint32_t i = 0; i < s->nx; i++) move_centre(s, i);
  memcpy(s->centre, s->new_centre, s->nx * sizeof(double));
  memcpy(s->low, s->new_low, s->nx * sizeof(double));
  for (uint32_t i = 0; i < s->nx && s->nc; i++)
    memcpy(s->column + (size_t)i * s->nc, s->matrix + (size_t)i * s->ndir, s->nc * sizeof(double));
  history_multiply(&s->history, s->matrix + s->nc, s->ndir, s->rest, s->added);
  history_push(&s->history, s->added);
}

void lohner_hull(lohner *s) {
  history_sum(&s->history, s->rest);
  for (uint32_t i = 0; i < s->nx; i++) {
    double radius = s->rest[i];
    for (uint32_t j = 0; j < s->nc; j++) radius += fabs(s->column[(size_t)i * s->nc + j]);
    s->lo[i] = -((radius - s->low[i]) - s->centre[i]);
    s->hi[i] = s->centre[i] + (s->low[i] + radius);
    s->radius[i] = radius + fabs(s->low[i]);
  }
}
