/* pool.h -- service "ambit.pool/1": threads for work that falls into independent pieces.
**
** How many there are is the user's choice (`threads` of a verb), so results must not depend on it: item i computes the
** same whatever worker it runs on, and what the items give is put together in the order of the items.
*/
#ifndef AMBIT_POOL_H
#define AMBIT_POOL_H
#include "base.h"

#define AMBIT_POOL_SERVICE "ambit.pool/1"

typedef struct ambit_pool ambit_pool;

/* [worker's thread, round-to-nearest] item < n; worker < threads of the pool: an index of memory and contexts that
** nobody else uses at this time. Must not call run() of the same pool. */
typedef ambit_status (*ambit_pool_job)(void *user, uint32_t item, uint32_t worker);

typedef struct ambit_pool_service {
  uint32_t size;
  /* [ctx] starts the workers, fewer if the system gives no more; freed with the host object, or by close.
  ** threads == 1: none, the caller's thread does the items as worker 0 */
  ambit_status (*open)(const ambit_host *h, uint32_t threads, ambit_pool **pool);
  void (*close)(ambit_pool *pool);
  /* [ctx] runs job for all items 0..n-1, started in ascending order, on all workers, while the caller waits; returns
  ** when all that were started are done: AMBIT_OK, or what the first item (by number) that failed said; items behind a
  ** failed one may not have been started. `meanwhile` (or NULL) is called on the caller's thread about every 20 ms, or
  ** after each item if there are no workers; nonzero: no further items are started, and AMBIT_STOPPED is returned. No
  ** allocation. */
  ambit_status (*run)(ambit_pool *pool, uint32_t n, ambit_pool_job job, void *user, int32_t (*meanwhile)(void *user));
} ambit_pool_service;
#endif
