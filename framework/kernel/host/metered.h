/* metered.h -- what the host lends while a scene is profiled: the same tables with a look at the clock around each
** function (base/meter.h). Results are the same to the bit. */
#ifndef AMBIT_METERED_H
#define AMBIT_METERED_H
#include <ambit/arena.h>
#include <ambit/arithmetic.h>

/* A copy of the service that measures, or the service itself where it is not one of the kernel's. */
const void *ambit_metered_service(const char *id, const void *service);
/* A copy of a completed arithmetic whose run[] measures, under its name; NULL: out of memory. */
const ambit_arithmetic *ambit_metered_arithmetic(ambit_arena *arena, const ambit_arithmetic *plain, const char *name);
#endif
