/* clock.h -- CPU time of this process, over all its threads. */
#ifndef AMBIT_CLOCK_H
#define AMBIT_CLOCK_H
#include <time.h>

static inline double ambit_clock_cpu(void) { /* s */
  struct timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}
#endif
