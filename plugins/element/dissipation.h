/* dissipation.h -- checks of what takes energy away.
**
** A coefficient of damping or friction that is certainly negative is refused: such an element would feed energy into
** the mechanism, which nobody means by the word; joint_torque and force_law say it if it is meant. A stiffness may be
** negative: a spring over its dead centre, a buckled strip or a magnet has one, and energy is kept.
*/
#ifndef AMBIT_DISSIPATION_H
#define AMBIT_DISSIPATION_H
#include <ambit/spatial.h>

static inline ambit_status dissipation_check(ambit_build *b, const ambit_expr *e, uint32_t n, const char *name) {
  double lo, hi;
  for (uint32_t i = 0; e && i < n; i++) {
    b->range(b, e[i], &lo, &hi);
    if (hi < 0)
      return b->fail(b, AMBIT_INVALID,
          "`%s` is negative (%g): it would feed energy in; expected 0 or more, or write the law as a function", name,
          hi);
  }
  return AMBIT_OK;
}
#endif
