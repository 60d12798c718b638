/* faces.c -- the hull of the set, moved face by face: for steps over kinks, where slopes are wide.
**
** The line y(s) = hi_i + beta s bounds x_i from above if x_i' < beta wherever x_i = y(s) and the other states are in
** the tube: the first solution to cross it would have to cross it faster (Mueller 1926; Walter, Differential and
** Integral Inequalities, ch. II). Only that face of the tube need be looked at, so decay keeps its sign: this is
** where a componentwise monotone right-hand side is evaluated at its ends. For every solution of a continuous
** right-hand side.
*/
#include "valencia.h"

static interval face_of(const valencia *s, uint32_t i) { return (interval) { s->tube_lo[i], s->tube_hi[i] }; }

static void put(const valencia *s, uint32_t in, interval x) {
  const ambit_lane *l = &s->symbols.lane;
  l->arithmetic->set(l->ctx, ambit_lane_at(l, l->tape->nconst + in), 1, &x.lo, &x.hi, -1);
}

/* 2 half f_i over the tube with x_i in u: what the whole step can change */
static int evaluate(valencia *s, uint32_t i, interval u, interval *change) {
  const ambit_lane *l = &s->symbols.lane;
  for (uint32_t j = 0; j < s->nx; j++) put(s, j, j == i ? u : face_of(s, j));
  for (uint32_t k = 0; k < s->np; k++) {
    double reach = s->loose[k];
    for (uint32_t j = 0; j < s->nu; j++) reach += fabs(s->reach[(size_t)k * s->nu + j]);
    put(s, s->nx + k, plus(point(s->middle[k]), within(reach)));
  }
  if (s->problem.uses_time) put(s, s->nx + s->np, plus(s->time, within(magnitude(s->half))));
  uint32_t flags = ambit_lane_run(&s->symbols.lane);
  interval f;
  ambit_lane_get(l, i, &f.lo, &f.hi);
  *change = times(scaled(s->half, 2), f);
  return !(flags & (AMBIT_F_PARTIAL | AMBIT_F_EMPTY | AMBIT_F_UNBOUNDED)) && is_bounded(*change);
}

/* strictly outside, whatever is rounded */
static interval beyond(interval x) { return plus(x, within(0x1p-50 * magnitude(x) + 0x1p-1000)); }

static int move_face(valencia *s, uint32_t i, interval whole, int upper, double *at) {
  interval line = plus(point(*at), hull_of(point(0), beyond(beyond(whole)))), u = meet(line, face_of(s, i)), change;
  if (!(u.lo <= u.hi)) { /* no solution is near any such line */
    *at = upper ? plus(point(*at), whole).hi : plus(point(*at), whole).lo;
    return 1;
  }
  if (!evaluate(s, i, u, &change)) return 0;
  change = beyond(change);
  *at = upper ? *at + smaller(change.hi, beyond(whole).hi) : -(-*at - larger(change.lo, beyond(whole).lo));
  return 1;
}

int valencia_faces(valencia *s, double *lo, double *hi) {
  for (uint32_t i = 0; i < s->nx; i++) {
    interval whole;
    if (!evaluate(s, i, face_of(s, i), &whole)) return 0;
    if (!move_face(s, i, whole, 0, &lo[i]) || !move_face(s, i, whole, 1, &hi[i])) return 0;
  }
  return 1;
}

/* does the tube that was looked at last reach a kink? */
int valencia_at_kink(const valencia *s) {
  const ambit_tape *t = s->problem.rhs;
  const double *lo = s->symbols.lo, *hi = s->symbols.hi;
  for (uint32_t i = 0; i < t->ninstr; i++) {
    uint32_t op = t->op[i], a = t->a[i], b = t->b[i];
    if (op == AMBIT_OP_ABS && lo[a] < 0 && hi[a] > 0) return 1;
    if ((op == AMBIT_OP_MIN || op == AMBIT_OP_MAX) && lo[a] < hi[b] && lo[b] < hi[a]) return 1;
  }
  return 0;
}
