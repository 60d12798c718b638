/* meter.h -- service "ambit.meter/1": telling `ambit profile` which opcode, or which part of a plugin's work, the time
** goes into. Lent only while a scene is profiled: else service() gives NULL, and a plugin loses one comparison.
*/
#ifndef AMBIT_METER_SERVICE_H
#define AMBIT_METER_SERVICE_H
#include "base.h"

#define AMBIT_METER_SERVICE "ambit.meter/1"

typedef struct ambit_meter_service {
  uint32_t size;
  /* [any] a named part of the work begins, inside what is being measured; it ends with leave(). Parts nest. */
  void (*enter)(const char *name);
  void (*leave)(void);
  /* [any] from now on the time goes to this opcode (AMBIT_OP_*; AMBIT_OP_COUNT: to arithmetic that is no instruction
  ** of a tape), until the next call or the end of the part. One look at a clock, some 30 ns: for loops over
  ** instructions that take much longer, or over runs of them */
  void (*operation)(uint32_t op);
} ambit_meter_service;
#endif
