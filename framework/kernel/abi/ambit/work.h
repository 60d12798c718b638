/* work.h -- service "ambit.work/1": counting what a run does, so that two runs can be compared without a clock.
**
** Counts are exact and the same on every machine that computes the same results: an operation is one instruction of a
** tape in one lane, whatever the width of vectors. Who loops over a tape adds to a record of its own once per pass,
** never once per instruction, so that counting costs nothing. The kernel counts for its own services, and for
** ambit_lane (block.h); a plugin counts only where it runs a tape by itself.
*/
#ifndef AMBIT_WORK_H
#define AMBIT_WORK_H
#include "base.h"

#define AMBIT_WORK_SERVICE "ambit.work/1"

/* X(name, what it counts) */
#define AMBIT_WORKS(X)                                                                                                 \
  X(evaluations, "runs of a tape in values, times lanes")                                                              \
  X(orders, "runs of a tape for one order of power series")                                                            \
  X(gradients, "gradients read from a value")                                                                          \
  X(tails, "bounds of what is beyond the highest order")                                                               \
  X(contractions, "runs of a tape forward and backward over a box")                                                    \
  X(operations, "instructions done, times lanes; of series: coefficients and slopes of results, one by one")           \
  X(coefficients, "coefficients and slopes of series that were computed")                                              \
  X(skipped, "those that were not, being zero for the degree in time of their slot")                                   \
  X(series, "power series that were opened")                                                                           \
  X(products, "products of matrices")                                                                                  \
  X(tried, "steps, or boxes, that were tried")                                                                         \
  X(allocations, "pieces of memory taken from the kernel")                                                             \
  X(allocated, "bytes of them")                                                                                        \
  X(allocations_run, "of them between the start and the end of the run itself")

typedef struct ambit_work {
#define AMBIT_X(name, what) uint64_t name;
  AMBIT_WORKS(AMBIT_X)
#undef AMBIT_X
} ambit_work;

typedef struct ambit_work_service {
  uint32_t size;
  /* [ctx] a record of zeros, one for each object that counts; the memory is the host object's, and the sum of all
  ** records is reported when it is closed. NULL: out of memory */
  ambit_work *(*open)(const ambit_host *h);
} ambit_work_service;

/* NULL where an older kernel does not count, or memory is short: then nothing is counted. */
static inline ambit_work *ambit_work_open(const ambit_host *h) {
  const void *lent = h->service ? h->service(h, AMBIT_WORK_SERVICE) : NULL;
  const ambit_work_service *service = (const ambit_work_service *)lent;
  return service ? service->open(h) : NULL;
}

/* One run of a tape of `ninstr` instructions in values. */
static inline void ambit_work_evaluate(ambit_work *work, uint32_t ninstr, size_t lanes) {
  if (!work) return;
  work->evaluations += lanes;
  work->operations += (uint64_t)ninstr * lanes;
}

/* a step, or a box, that is tried */
static inline void ambit_work_try(ambit_work *work) {
  if (work) work->tried++;
}

static inline void ambit_work_multiply(ambit_work *work) {
  if (work) work->products++;
}

static inline void ambit_work_add(ambit_work *to, const ambit_work *from) {
#define AMBIT_X(name, what) to->name += from->name;
  AMBIT_WORKS(AMBIT_X)
#undef AMBIT_X
}
#endif
