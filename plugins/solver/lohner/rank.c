/* rank.c -- whether the invariants' slopes keep the rank that they have at the start: no proof, only a hint in the
** reason of a run that could not go on. Elimination with pivots that are largest, less what they are uncertain by,
** beside the largest entry of their row at the start, so that units of rows do not matter.
*/
#include "lohner.h"

#define LOST 1e-2 /* of what a row's pivot was at the start */

static size_t at(const lohner *s, size_t r, size_t j) { return r * s->nx + j; }

/* the largest entry of each row of slopes by states, as the row's unit */
static void choose_units(lohner *s) {
  constraint *c = &s->constraint;
  for (size_t r = 0; r < c->k; r++) {
    double most = 0;
    for (size_t j = 0; j < s->nx; j++) most = larger(most, fabs(c->slope_mid[r * s->ndir + s->nc + j]));
    c->largest[r] = most > 0 ? most : 1;
  }
}

static void take_slopes(lohner *s) {
  constraint *c = &s->constraint;
  for (size_t r = 0; r < c->k; r++) {
    for (size_t j = 0; j < s->nx; j++) {
      size_t from = r * s->ndir + s->nc + j;
      c->pivot_mid[at(s, r, j)] = c->slope_mid[from] / c->largest[r];
      c->pivot_rad[at(s, r, j)] = c->slope_rad[from] / c->largest[r];
    }
    c->done[r] = 0;
  }
}

/* the largest pivot that is left, less what it is uncertain by; its place */
static double next_pivot(const lohner *s, size_t *row, size_t *column) {
  const constraint *c = &s->constraint;
  double most = -INFINITY;
  for (size_t r = 0; r < c->k; r++)
    for (size_t j = 0; j < s->nx && c->done[r] == 0; j++) {
      double sure = fabs(c->pivot_mid[at(s, r, j)]) - c->pivot_rad[at(s, r, j)];
      if (sure > most) most = sure, *row = r, *column = j;
    }
  return most;
}

static void eliminate(lohner *s, size_t row, size_t column) {
  constraint *c = &s->constraint;
  c->done[row] = 1;
  double pivot = c->pivot_mid[at(s, row, column)], loose = c->pivot_rad[at(s, row, column)];
  for (size_t r = 0; r < c->k; r++) {
    double x = c->pivot_mid[at(s, r, column)] / pivot;
    double rad = (c->pivot_rad[at(s, r, column)] + fabs(x) * loose) / (fabs(pivot) - loose);
    for (size_t j = 0; j < s->nx && c->done[r] == 0; j++) {
      double y = c->pivot_mid[at(s, row, j)], y_rad = c->pivot_rad[at(s, row, j)];
      c->pivot_mid[at(s, r, j)] -= x * y;
      c->pivot_rad[at(s, r, j)] += fabs(x) * y_rad + rad * (fabs(y) + y_rad);
    }
  }
}

void lohner_note_rank(lohner *s) {
  constraint *c = &s->constraint;
  size_t row = 0, column = 0;
  if (c->k == 0 || !lohner_linearise(s, s->t, 1)) return;
  choose_units(s);
  take_slopes(s);
  for (size_t n = 0; n < c->k; n++) {
    double pivot = next_pivot(s, &row, &column);
    if (!(pivot > 0x1p-40)) return; /* a constraint that says nothing new from the start on */
    c->least[n] = pivot;
    eliminate(s, row, column);
  }
}

int lohner_loses_rank(lohner *s) {
  constraint *c = &s->constraint;
  size_t row = 0, column = 0;
  if (c->k == 0 || !lohner_linearise(s, s->t, 1)) return 0;
  take_slopes(s);
  for (size_t n = 0; n < c->k && c->least[n] > 0; n++) {
    double pivot = next_pivot(s, &row, &column);
    c->blamed = (uint32_t)row;
    if (!(pivot > LOST * c->least[n])) return 1;
    eliminate(s, row, column);
  }
  return 0;
}
