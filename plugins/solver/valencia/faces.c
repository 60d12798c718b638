/* faces.c -- the hull of the set, moved face by face: narrower than the set where slopes are wide, at kinks and near
** the end of what a first-order set can carry.
**
** The line y(s) = hi_i + beta s bounds x_i from above if x_i' < beta wherever x_i = y(s) and the other states are in
** the tube: the first solution to cross it would have to cross it faster (Mueller 1926; Walter, Differential and
** Integral Inequalities, ch. II). Only that face of the tube need be looked at, so decay keeps its sign; and a state or
** parameter by which the slope of x_i' has one sign is put to the end that is worst. For every solution of a continuous
** right-hand side.
*/
#include "valencia.h"

static interval face_of(const valencia *s, uint32_t i) { return (interval) { s->tube_lo[i], s->tube_hi[i] }; }

static void put(const valencia *s, uint32_t in, interval x) {
  const ambit_lane *l = &s->symbols.lane;
  l->arithmetic->set(l->ctx, ambit_lane_at(l, l->tape->nconst + in), 1, &x.lo, &x.hi, -1);
}

static interval parameter(const valencia *s, uint32_t k) {
  double reach = s->loose[k];
  for (uint32_t j = 0; j < s->nu; j++) reach += fabs(s->reach[(size_t)k * s->nu + j]);
  return plus(point(s->middle[k]), within(reach));
}

static int run(valencia *s) {
  if (s->problem.uses_time) put(s, s->nx + s->np, plus(s->time, within(magnitude(s->half))));
  return !(ambit_lane_run(&s->symbols.lane) & (AMBIT_F_PARTIAL | AMBIT_F_EMPTY | AMBIT_F_UNBOUNDED));
}

/* 2 half f_i: what the whole step can change */
static interval change_of(const valencia *s, uint32_t i) {
  interval f;
  ambit_lane_get(&s->symbols.lane, i, &f.lo, &f.hi);
  return times(scaled(s->half, 2), f);
}

/* Everything over the box of the tube: x_i' there, and slopes of all slots, for the box's corners too. Whether every
** output has bounded ones does not matter: signs are what is wanted. */
static int survey(valencia *s) {
  const ambit_lane *l = &s->symbols.lane;
  symbols *y = &s->symbols;
  for (uint32_t j = 0; j < s->nx; j++) put(s, j, face_of(s, j));
  for (uint32_t k = 0; k < s->np; k++) put(s, s->nx + k, parameter(s, k));
  if (!run(s)) return 0;
  ambit_lane_slots(l, l->flags, y->lo, y->hi);
  valencia_slopes(s->num, l->tape, s->ndir, y->lo, y->hi, y->slope);
  for (uint32_t i = 0; i < s->nx; i++)
    if (!is_bounded(s->rate[i] = change_of(s, i))) return 0;
  return 1;
}

/* the end of x where a function with such slopes is largest (or smallest) */
static interval worst(interval x, interval slope, int largest) {
  if (slope.lo >= 0) return point(largest ? x.hi : x.lo);
  if (slope.hi <= 0) return point(largest ? x.lo : x.hi);
  return x;
}

/* a bound from above (or below) of the change over the tube with x_i in u */
static int evaluate(valencia *s, uint32_t i, interval u, int upper, interval *change) {
  const interval *slope = s->symbols.slope + (size_t)s->symbols.lane.tape->out[i] * s->ndir;
  int largest = upper == (s->half.hi > 0);
  for (uint32_t j = 0; j < s->nx; j++) put(s, j, worst(j == i ? u : face_of(s, j), slope[j], largest));
  for (uint32_t k = 0; k < s->np; k++) put(s, s->nx + k, worst(parameter(s, k), slope[s->nx + k], largest));
  int known = run(s);
  *change = change_of(s, i);
  return known && is_bounded(*change);
}

/* strictly outside, whatever is rounded */
static interval beyond(interval x) { return plus(x, within(0x1p-50 * magnitude(x) + 0x1p-1000)); }

static int move_face(valencia *s, uint32_t i, int upper, double *at) {
  interval whole = s->rate[i], change;
  interval line = plus(point(*at), hull_of(point(0), beyond(beyond(whole)))), u = meet(line, face_of(s, i));
  if (!(u.lo <= u.hi)) return 0; /* the tube holds the face at its start */
  if (!evaluate(s, i, u, upper, &change)) return 0;
  change = beyond(change);
  *at = upper ? *at + smaller(change.hi, beyond(whole).hi) : -(-*at - larger(change.lo, beyond(whole).lo));
  return 1;
}

int valencia_faces(valencia *s, double *lo, double *hi) {
  if (!survey(s)) return 0;
  for (uint32_t i = 0; i < s->nx; i++)
    if (!move_face(s, i, 0, &lo[i]) || !move_face(s, i, 1, &hi[i])) return 0;
  return 1;
}

static int has_kink(uint32_t op) { return op == AMBIT_OP_ABS || op == AMBIT_OP_MIN || op == AMBIT_OP_MAX; }

int valencia_is_smooth(const ambit_tape *t) {
  for (uint32_t i = 0; i < t->ninstr; i++)
    if (has_kink(t->op[i])) return 0;
  return 1;
}

/* does the tube that was looked at last reach a kink? notes the first one that has a name */
int valencia_at_kink(valencia *s) {
  const ambit_tape *t = s->problem.rhs;
  const double *lo = s->symbols.lo, *hi = s->symbols.hi;
  int met = 0;
  s->kink_name = NULL;
  for (uint32_t i = 0; i < t->ninstr; i++) {
    uint32_t op = t->op[i], a = t->a[i], b = t->b[i];
    int here = op == AMBIT_OP_ABS ? lo[a] < 0 && hi[a] > 0
                                  : (op == AMBIT_OP_MIN || op == AMBIT_OP_MAX) && lo[a] < hi[b] && lo[b] < hi[a];
    if (here && !s->kink_name && t->kink) s->kink_name = t->kink[i];
    met |= here;
  }
  return met;
}
