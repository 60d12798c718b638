/* solution.c -- the solutions z of A z = -b over all A in [A] and b in [b], as each operator bounds them.
**
** If [A] is regular, and z is sought as z = x - mid with x in the box (shift = box - mid):
**   newton: the hull of all A^-1(-b) wherever it lies (hull.c).
**   krawczyk: -b + (I - A) shift, which holds every solution in shift; and, if it is a part of shift, a solution for
**     each A, b (Brouwer).
**   hansen_sengupta: row i solved for z_i, the others in shift; the same two statements hold for it.
**   auto: a bound of all A^-1(-b) (bound.c), narrowed by rows.
** If not, rows solved for their unknown narrow shift: a quotient by an interval around 0 has two parts, the space
** between which has no solution: a gap (Hansen & Sengupta 1981).
*/
#include "krawczyk.h"
#include <math.h>

#define SWEEPS 8
#define SLOW 0.9 /* less narrowing than this is not worth another sweep */

static const span nothing = { INFINITY, -INFINITY };

/* -- one unknown of one row */

static span quotient(const krawczyk *k, span c, span a) {
  span q;
  krawczyk_map(k, AMBIT_OP_DIV, &q, &c, &a, 1);
  return (span) { -q.hi, -q.lo };
}

/* between lower and upper, relative to mid */
static void note_gap(krawczyk *k, uint32_t i, span lower, span upper) {
  span ends[2] = { { lower.hi, lower.hi }, { upper.lo, upper.lo } };
  krawczyk_map(k, AMBIT_OP_ADD, &ends[0], &k->mid[i], &ends[0], 1);
  krawczyk_map(k, AMBIT_OP_ADD, &ends[1], &k->mid[i], &ends[1], 1);
  if (ends[1].lo - ends[0].hi > k->gap.hi - k->gap.lo) k->gap = (gap) { i, ends[0].hi, ends[1].lo };
}

/* y := y and -c / a for a around 0: both parts of the quotient; 0: empty */
static int meet_parts(krawczyk *k, uint32_t i, span *y, span c, span a) {
  span part[2] = { quotient(k, c, (span) { a.lo, 0 }), quotient(k, c, (span) { 0, a.hi }) }, sum = nothing;
  int some[2] = { 0, 0 };
  for (int s = 0; s < 2; s++) {
    some[s] = part[s].lo <= part[s].hi && box_meet(1, &part[s], y);
    if (some[s]) box_join(1, &sum, &part[s]);
  }
  if (some[0] && some[1]) {
    int below = part[0].lo <= part[1].lo ? 0 : 1;
    if (part[below].hi < part[1 - below].lo) note_gap(k, i, part[below], part[1 - below]);
  }
  *y = sum;
  return sum.lo <= sum.hi;
}

/* y := y and -c / a; 0: empty */
static int meet_quotient(krawczyk *k, uint32_t i, span *y, span c, span a) {
  if (c.lo <= 0 && c.hi >= 0 && a.lo <= 0 && a.hi >= 0) return 1;
  if (a.lo < 0 && a.hi > 0) return meet_parts(k, i, y, c, a);
  span q = quotient(k, c, a);
  if (!(q.lo <= q.hi)) return 0; /* a is 0, c is not */
  return box_meet(1, y, &q);
}

/* -- all of them */

int krawczyk_sweep(krawczyk *k, span *z) {
  for (uint32_t s = 0; s < SWEEPS; s++) {
    box_copy(k->n, k->f, z); /* f has been used */
    for (uint32_t i = 0; i < k->n; i++)
      if (!meet_quotient(k, i, &z[i], krawczyk_row(k, i, z), k->diagonal[i])) return 0;
    if (box_shrinking(k->n, z, k->f) > SLOW) return 1;
  }
  return 1;
}

static void set_krawczyk_image(krawczyk *k) {
  for (uint32_t i = 0; i < k->n; i++) {
    span one = { 1, 1 }, rest, row = krawczyk_row(k, i, k->shift);
    krawczyk_map(k, AMBIT_OP_SUB, &rest, &one, &k->diagonal[i], 1);
    krawczyk_map(k, AMBIT_OP_MUL, &rest, &rest, &k->shift[i], 1);
    krawczyk_map(k, AMBIT_OP_SUB, &k->z[i], &rest, &row, 1);
  }
}

static void set_rows_image(krawczyk *k) {
  for (uint32_t i = 0; i < k->n; i++) k->z[i] = quotient(k, krawczyk_row(k, i, k->shift), k->diagonal[i]);
}

int krawczyk_solve(krawczyk *k) {
  switch (k->options.operation) {
  case OPERATOR_KRAWCZYK: set_krawczyk_image(k); break;
  case OPERATOR_HANSEN_SENGUPTA: set_rows_image(k); break;
  case OPERATOR_NEWTON: krawczyk_hull_solution(k, k->z); break;
  default: krawczyk_bound_solution(k, k->z); break;
  }
  if (k->options.operation == OPERATOR_AUTO && !krawczyk_sweep(k, k->z)) return 0;
  krawczyk_map(k, AMBIT_OP_ADD, k->estimate, k->mid, k->z, k->n);
  return 1;
}
