/* rank.c -- whether the invariants' slopes keep the rank that they have at the start: no proof, only a hint in the
** reason of a run that could not go on. Elimination with pivots that are largest, less what they are uncertain by,
** beside the largest entry of their row at the start, so that units of rows do not matter.
*/
#include "constraint.h"

#define LOST 1e-2 /* of what a row's pivot was at the start */

static size_t at(const field *f, size_t r, size_t j) { return r * f->nx + j; }

/* the largest entry of each row of slopes by states, as the row's unit */
static void choose_units(const field *f, constraint *c) {
  for (size_t r = 0; r < c->k; r++) {
    double most = 0;
    for (size_t j = 0; j < f->nx; j++) most = larger(most, fabs(c->slope.mid[r * f->ndir + f->nc + j]));
    c->largest[r] = most > 0 ? most : 1;
  }
}

static void take_slopes(const field *f, constraint *c) {
  for (size_t r = 0; r < c->k; r++) {
    for (size_t j = 0; j < f->nx; j++) {
      size_t from = r * f->ndir + f->nc + j;
      c->pivot.mid[at(f, r, j)] = c->slope.mid[from] / c->largest[r];
      c->pivot.rad[at(f, r, j)] = c->slope.rad[from] / c->largest[r];
    }
    c->done[r] = 0;
  }
}

/* the largest pivot that is left, less what it is uncertain by; its place */
static double next_pivot(const field *f, const constraint *c, size_t *row, size_t *column) {
  double most = -INFINITY;
  for (size_t r = 0; r < c->k; r++)
    for (size_t j = 0; j < f->nx && c->done[r] == 0; j++) {
      double sure = fabs(c->pivot.mid[at(f, r, j)]) - c->pivot.rad[at(f, r, j)];
      if (sure > most) most = sure, *row = r, *column = j;
    }
  return most;
}

static void eliminate(const field *f, constraint *c, size_t row, size_t column) {
  c->done[row] = 1;
  double pivot = c->pivot.mid[at(f, row, column)], loose = c->pivot.rad[at(f, row, column)];
  for (size_t r = 0; r < c->k; r++) {
    double x = c->pivot.mid[at(f, r, column)] / pivot;
    double rad = (c->pivot.rad[at(f, r, column)] + fabs(x) * loose) / (fabs(pivot) - loose);
    for (size_t j = 0; j < f->nx && c->done[r] == 0; j++) {
      double y = c->pivot.mid[at(f, row, j)], y_rad = c->pivot.rad[at(f, row, j)];
      c->pivot.mid[at(f, r, j)] -= x * y;
      c->pivot.rad[at(f, r, j)] += fabs(x) * y_rad + rad * (fabs(y) + y_rad);
    }
  }
}

void constraint_note_rank(const field *f, const set *x, constraint *c) {
  size_t row = 0, column = 0;
  if (c->k == 0 || !constraint_linearise(f, x, NULL, c)) return;
  choose_units(f, c);
  take_slopes(f, c);
  for (size_t n = 0; n < c->k; n++) {
    double pivot = next_pivot(f, c, &row, &column);
    if (!(pivot > 0x1p-40)) return; /* a constraint that says nothing new from the start on */
    c->least[n] = pivot;
    eliminate(f, c, row, column);
  }
}

int constraint_loses_rank(const field *f, const set *x, constraint *c) {
  size_t row = 0, column = 0;
  if (c->k == 0 || !constraint_linearise(f, x, NULL, c)) return 0;
  take_slopes(f, c);
  for (size_t n = 0; n < c->k && c->least[n] > 0; n++) {
    double pivot = next_pivot(f, c, &row, &column);
    c->blamed = (uint32_t)row;
    if (!(pivot > LOST * c->least[n])) return 1;
    eliminate(f, c, row, column);
  }
  return 0;
}
