/* pool.h -- the threads behind the service "ambit.pool/1". */
#ifndef AMBIT_HOST_POOL_H
#define AMBIT_HOST_POOL_H
#include <ambit/pool.h>

/* Starts `threads` workers (1: none, the caller does all items). Fewer if the system gives fewer: that is no failure.
** *list is where the pool is noted until it is closed; NULL: nowhere. NOMEM only if there is no memory. */
ambit_status ambit_pool_open(ambit_pool **list, uint32_t threads, ambit_pool **pool);
void ambit_pool_close(ambit_pool *pool); /* NULL is allowed */
ambit_status ambit_pool_run(
    ambit_pool *pool, uint32_t n, ambit_pool_job job, void *user, int32_t (*meanwhile)(void *user));
uint32_t ambit_pool_threads(const ambit_pool *pool); /* that work on items at the same time: at least 1 */
#endif
