/* ends.h -- when a run should end, in whatever units its states and its time are: inline, for solvers.
**
** A state may be AMBIT_WIDTH times as wide as it has been large to first order: its midpoint, and how far it moves with
** the data. What a linear flow makes of the data is no reason to stop; what errors add to it is. Nothing is learnt from
** a set that is mostly the latter: midpoints of an exploding set are not to be trusted. A set explodes when all states
** do: one that starts at zero may be nothing to first order for a while.
*/
#ifndef AMBIT_ENDS_H
#define AMBIT_ENDS_H
#include <math.h>
#include <stdint.h>

#define AMBIT_WIDTH 10
#define AMBIT_WIDTH_LEAST 0x1p-900 /* states so small, or at zero, are moved by rounding alone */

typedef struct ambit_explosion {
  int all, some;
  uint32_t worst; /* the state that is widest beside its limit */
  double most;
} ambit_explosion;

#define AMBIT_EXPLOSION_START ((ambit_explosion) { .all = 1 })

/* State i is `width` wide now, and `first_order` large; *limit: of its width, 0 before the first call. */
static inline void ambit_explosion_note(
    ambit_explosion *e, uint32_t i, double width, double first_order, double *limit) {
  if (width <= 4 * first_order && AMBIT_WIDTH * first_order > *limit) *limit = AMBIT_WIDTH * first_order;
  int over = *limit > AMBIT_WIDTH_LEAST && !(width <= *limit);
  if (over && !(width / *limit <= e->most)) e->most = width / *limit, e->worst = i;
  e->some |= over;
  e->all &= over || width == 0;
}

static inline int ambit_explodes(const ambit_explosion *e) { return e->some && e->all; }

/* The shortest step that is tried at t, in a run over [from, to]: as given, or (given 0) 2^-40 of the time that has
** passed, and four units in the last place of t. Not a share of the span: a pendulum swings as fast if it is followed
** for 1e9 s. */
static inline double ambit_least_step(double given, double t, double from, double to) {
  return given > 0 ? given : fmax(fmax(0x1p-40 * fabs(t - from), 0x1p-50 * fabs(t)), 0x1p-200 * fabs(to - from));
}
#endif
