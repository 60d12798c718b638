/* processors.h -- how many threads a verb uses when nobody says. */
#ifndef AMBIT_PROCESSORS_H
#define AMBIT_PROCESSORS_H
#include <ambit/status.h>

#define AMBIT_THREADS_MAX 256

/* The environment's AMBIT_THREADS, or the processors that this process may use: its affinity mask and the quota of its
** control groups (cpu.max). INVALID if AMBIT_THREADS is not a whole number from 1 to AMBIT_THREADS_MAX. */
ambit_status ambit_processors_threads(uint32_t *threads, ambit_failure *f);

/* One quota ("150000 100000", "max 100000") in processors, rounded up; 0: no limit, or not one. */
uint32_t ambit_processors_quota(const char *line);
#endif
