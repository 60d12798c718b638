/* elementary.h -- "ambit.elementary/1": elementary functions at a point, correctly rounded outward.
**
** The kernel's own functions (framework/kernel/num) are fast for ordinary arguments. The rest, in practice sines of
** huge angles, goes to the plugin service/elementary.so, which the kernel loads at the first such argument.
*/
#ifndef AMBIT_ELEMENTARY_SERVICE_H
#define AMBIT_ELEMENTARY_SERVICE_H
#include "tape.h"

#define AMBIT_ELEMENTARY_SERVICE "ambit.elementary/1"

typedef struct ambit_elementary_service {
  uint32_t size;
  /* [any] op: AMBIT_OP_EXP .. AMBIT_OP_TANH; (x, y) finite in its domain, y only for ATAN2, the angle of the point
  ** (y, x). [*lo, *hi] is the tightest enclosure by doubles, lo == hi if the value is one. Called in
  ** round-to-nearest. */
  void (*point)(uint32_t op, double x, double y, double *lo, double *hi);
} ambit_elementary_service;
#endif
