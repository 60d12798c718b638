/* May atan2 cross its cut over a box? It jumps between points (x, y) of x < 0 with y < 0 and with y >= 0. All boxes
** with corners of small integers, each against its own points. */
#include "graph/hull.h"
#include "kit/tape_builder.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define MOST 2

static bool jumps(ambit_interval y, ambit_interval x) {
  bool below = false, above = false;
  for (double v = y.lo; v <= y.hi; v += 0.5)
    for (double u = x.lo; u <= x.hi; u += 0.5) below |= u < 0 && v < 0, above |= u < 0 && v >= 0;
  return below && above;
}

static void jumps_are_seen(void **unused) {
  (void)unused;
  tape_builder t;
  tape_begin(&t);
  uint32_t one = tape_constant(&t, 1, 1), y = tape_input(&t, AMBIT_DEGREE_ANY), x = tape_input(&t, AMBIT_DEGREE_ANY);
  tape_op(&t, AMBIT_OP_ATAN2, y, tape_op(&t, AMBIT_OP_MUL, x, one));
  const ambit_tape *tape = tape_seal(&t, AMBIT_NO_SLOT);
  ambit_interval in[2], slot[TAPE_ROOM];
  for (in[0].lo = -MOST; in[0].lo <= MOST; in[0].lo++)
    for (in[0].hi = in[0].lo; in[0].hi <= MOST; in[0].hi++)
      for (in[1].lo = -MOST; in[1].lo <= MOST; in[1].lo++)
        for (in[1].hi = in[1].lo; in[1].hi <= MOST; in[1].hi++) {
          ambit_hull(tape, in, slot);
          assert_int_equal(ambit_hull_jumps(tape, slot), jumps(in[0], in[1]));
        }
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(jumps_are_seen) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
