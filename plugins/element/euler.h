/* euler.h -- three rotations one after the other about axes of the moving frame, in one of the usual orders. */
#ifndef AMBIT_EULER_H
#define AMBIT_EULER_H
#include "stages.h"

#define EULER_PARAM                                                                                                    \
  {                                                                                                                    \
    "order", "1", "zyx|xyz|zxz|zyz", "zyx",                                                                            \
        "axes of the three rotations, each in the frame that the ones before have reached"                             \
  }

/* Three stages for coordinates first, first + 1 and first + 2; `param`: number of the parameter above. */
static inline void euler_push(ambit_build *b, stages *s, uint32_t param, uint32_t first) {
  static const int axis[][3] = { { 2, 1, 0 }, { 0, 1, 2 }, { 2, 0, 2 }, { 2, 1, 2 } };
  double order, same;
  b->range(b, *b->param(b, param), &order, &same);
  for (uint32_t i = 0; i < 3; i++) stages_push(s, stage_turn(b, stages_direction(b, axis[(int)order][i]), first + i));
}
#endif
