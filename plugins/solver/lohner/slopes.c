/* slopes.c -- slopes at the end of a step, over the set and over parts of it.
**
** With v = (xi, z + low) the coordinates of a state relative to the midpoint m, and S any matrix of slopes,
**   x(t+h) = phi(m) + S v = phi(m) + M v + (S - M) v
** for a point matrix M near all S. M v is linear: the set keeps its form. (S - M) v is the effect of nonlinearity, put
** into a box. Since S depends on the state and is proportional to v for small sets, the box is bounded piece by piece
** of the unknowns' cube: (S - M) v is of one sign where it is quadratic, so that the hull over pieces is half as wide
** as one bound for all, and its midpoint moves the centre. Each piece needs the slopes' coefficients over it, but no
** proof of its own: what is beyond the polynomials is bounded over the whole set.
*/
#include "control.h"
#include <string.h>

#define ROUNDED 0x1p-30
#define CURVED 0x1p-10 /* share of the set's radius from which on slopes count as varying */

ambit_status slopes_open(const field *f, slopes *S) {
  size_t entries = (size_t)f->nx * f->ndir, m = f->options.pieces, nc = f->nc;
  double *from, *to;
  const request list[] = { { &S->piece.mid, m * entries }, { &S->piece.rad, m * entries }, { &S->whole.mid, entries },
    { &S->whole.rad, entries }, { &S->matrix, entries }, { &S->curvature, nc }, { &S->added, f->nx }, { &from, m * nc },
    { &to, m * nc } };
  S->cuts = f->host->alloc(f->host, (nc ? nc : 1) * sizeof *S->cuts);
  if (!S->cuts || !field_allocate(f->host, sizeof list / sizeof *list, list)) return field_no_memory(f->host);
  for (size_t k = 0; k < m; k++) S->pieces.part[k] = (part) { from + k * nc, to + k * nc };
  return f->options.formula == FORMULA_TAYLOR ? AMBIT_OK : corrector_open(f, &S->corrector);
}

void slopes_close(const field *f, slopes *S) { corrector_close(f, &S->corrector); }

/* -- pieces */

/* How much the slopes of direction j vary over the set, relative to it; what is beyond their orders is no variation. */
static double curvature(const field *f, const set *x, const flow *phi, const slopes *S, const sizes *z, uint32_t j) {
  double most = 0, reach = set_reach(f, x, j);
  for (uint32_t i = 0; i < f->nx; i++) {
    size_t at = (size_t)i * f->ndir + j;
    double varies = (S->taylor[at] - phi->slope_excess[at]) * reach;
    /* of a state that is known exactly, too: it is as wide as the step makes it */
    double size = (x->radius[i] > 0 ? x->radius[i] : z->grown[i]) + ROUNDED * z->unit[i];
    if (varies > most * size) most = varies / size;
  }
  return most;
}

/* how much slopes vary, ... */
static void find_curvature(const field *f, const set *x, const flow *phi, const sizes *z, double least, slopes *S) {
  S->wide = 0, S->varies = 0;
  for (uint32_t j = 0; j < f->ndir; j++) {
    double varies = curvature(f, x, phi, S, z, j);
    S->wide |= varies > least;
    S->varies = larger(S->varies, varies);
    if (j < f->nc) S->cuts[j] = 1, S->curvature[j] = varies;
  }
}

/* ... and twice the number of parts where they vary most, as long as it pays */
static uint32_t choose_cuts(const field *f, double least, slopes *S) {
  uint32_t pieces = 1;
  while (!S->corrected && 2 * pieces <= f->options.pieces) {
    uint32_t worst = f->nc;
    double most = least;
    for (uint32_t j = 0; j < f->nc; j++)
      if (S->curvature[j] / S->cuts[j] > most) most = S->curvature[j] / S->cuts[j], worst = j;
    if (worst == f->nc) break;
    S->cuts[worst] *= 2;
    pieces *= 2;
  }
  return pieces;
}

/* ends are multiples of powers of two: exact */
static void place_pieces(uint32_t nc, const uint32_t *cuts, pieces *all) {
  for (uint32_t k = 0; k < all->count; k++) {
    uint32_t index = k;
    for (uint32_t j = 0; j < nc; j++) {
      double part = 2.0 / cuts[j];
      all->part[k].from[j] = part * (index % cuts[j]) - 1;
      all->part[k].to[j] = part * (index % cuts[j] + 1) - 1;
      index /= cuts[j];
    }
  }
}

/* S over each piece; where the series fail, that over the whole set */
static void expand_pieces(const field *f, const set *x, flow *phi, slopes *S) {
  size_t entries = (size_t)f->nx * f->ndir, bytes = entries * sizeof(double);
  memcpy(S->whole.mid, S->piece.mid, bytes);
  memcpy(S->whole.rad, S->piece.rad, bytes);
  for (uint32_t k = 0; k < S->pieces.count; k++) {
    balls piece = balls_at(S->piece, k * entries);
    if (!flow_box_series(f, x, S->pieces.part[k], phi))
      flow_slopes_at_end(f, phi, piece);
    else
      memcpy(piece.mid, S->whole.mid, bytes), memcpy(piece.rad, S->whole.rad, bytes);
  }
}

/* M := midpoints of the hull of all pieces' slopes */
static void choose_matrix(const field *f, slopes *S) {
  size_t entries = (size_t)f->nx * f->ndir;
  for (size_t a = 0; a < entries; a++) {
    double low = -INFINITY, high = -INFINITY;
    for (uint32_t k = 0; k < S->pieces.count; k++) {
      double mid = S->piece.mid[k * entries + a], rad = S->piece.rad[k * entries + a];
      low = larger_or_nan(low, rad - mid);
      high = larger_or_nan(high, mid + rad);
    }
    S->matrix[a] = S->pieces.count == 1 ? S->piece.mid[a] : 0.5 * (high - low);
  }
}

void slopes_choose(const field *f, const set *x, const sizes *z, flow *phi, slopes *S) {
  double least = CURVED * flow_share_of_time(f, phi);
  if (!S->corrected) flow_slopes_at_end(f, phi, S->piece);
  S->taylor = S->corrected ? S->corrector.guess.rad : S->piece.rad;
  find_curvature(f, x, phi, z, least, S);
  S->pieces.count = choose_cuts(f, least, S);
  place_pieces(f->nc, S->cuts, &S->pieces);
  if (S->pieces.count > 1) expand_pieces(f, x, phi, S);
  choose_matrix(f, S);
}

/* -- what M leaves */

void slopes_beyond(const field *f, const set *x, balls row, const double *M, part of, double *low, double *high) {
  *low = *high = 0;
  for (uint32_t j = 0; j < f->ndir; j++) {
    double above = (row.mid[j] - M[j]) + row.rad[j],
           below = (M[j] - row.mid[j]) + row.rad[j]; /* S - M in [-below, above] */
    if (j >= f->nc) {
      double most = larger(above, below) * (x->rest[j - f->nc] + fabs(x->low[j - f->nc]));
      *low += most, *high += most;
      continue;
    }
    double a = of.from[j], b = of.to[j];
    *high += larger(larger(above * a, above * b), larger(below * -a, below * -b));
    *low += larger(larger(above * -a, above * -b), larger(below * a, below * b));
  }
}

ball slopes_nonlinear(const field *f, const set *x, const slopes *S, uint32_t i) {
  double low = -INFINITY, high = -INFINITY;
  size_t row = (size_t)i * f->ndir;
  for (uint32_t k = 0; k < S->pieces.count; k++) {
    double l, h;
    balls slope = balls_at(S->piece, (size_t)k * f->nx * f->ndir + row);
    slopes_beyond(f, x, slope, S->matrix + row, S->pieces.part[k], &l, &h);
    low = larger_or_nan(low, l), high = larger_or_nan(high, h);
  }
  return ball_of(low, high);
}
