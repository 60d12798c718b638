/* width.h -- when an enclosure has grown so wide that a run should end, in whatever units its states are: inline, for
** solvers.
**
** A state may be AMBIT_WIDTH times as wide as it has been large to first order: its midpoint, and how far it moves with
** the data. What a linear flow makes of the data is no reason to stop; what errors add to it is. Nothing is learnt from
** a set that is mostly the latter: midpoints of an exploding set are not to be trusted. A set explodes when all states
** do: one that starts at zero may be nothing to first order for a while.
*/
#ifndef AMBIT_WIDTH_H
#define AMBIT_WIDTH_H
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
#endif
