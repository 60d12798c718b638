/* outward.c -- a few inexact operations against bounds known from exact arithmetic.
**
** Compilers move floating-point operations across a change of the rounding mode if their flags allow it, and there is
** no macro that tells; so the kernel tries before it proves anything.
*/
#include "num/outward.h"
#include "num/interval.h"

typedef struct example {
  uint32_t op;
  double a, b, lo, hi;
} example;

bool ambit_interval_rounds_outward(void) {
  static const example all[] = {
    { AMBIT_OP_ADD, 1, 0x1p-60, 1, 0x1.0000000000001p+0 },
    { AMBIT_OP_SUB, -1, 0x1p-60, -0x1.0000000000001p+0, -1 },
    { AMBIT_OP_MUL, 0x1.0000000000001p+0, 0x1.0000000000001p+0, 0x1.0000000000002p+0, 0x1.0000000000003p+0 },
    { AMBIT_OP_DIV, 1, 3, 0x1.5555555555555p-2, 0x1.5555555555556p-2 },
    { AMBIT_OP_DIV, -1, 3, -0x1.5555555555556p-2, -0x1.5555555555555p-2 },
    { AMBIT_OP_SQRT, 2, 2, 0x1.6a09e667f3bccp+0, 0x1.6a09e667f3bcdp+0 },
  };
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
    volatile double a = all[i].a, b = all[i].b; /* not computed by the compiler */
    ambit_interval r;
    ambit_interval_op(all[i].op, &r, (ambit_interval) { a, a }, (ambit_interval) { b, b });
    if (r.lo != all[i].lo || r.hi != all[i].hi) return false;
  }
  return true;
}
