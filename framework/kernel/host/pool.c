/* pool.c -- threads that wait for items.
**
** One mutex guards the counters: items are long (microseconds at least), so nobody queues for it. While the workers
** work, the caller waits and asks `meanwhile` from time to time; it takes no items itself, so that however long they
** are, progress and cancel are looked at on time. Workers have the standard floating-point environment and the C
** locale, and signals of the process go to the other threads: Ctrl-C is the main thread's affair.
*/
#include "host/pool.h"
#include "base/meter.h"
#include "num/environment.h"
#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <time.h>

#define STACK_BYTES ((size_t)8 << 20) /* what the main thread usually has; only what is touched costs memory */
#define POLL_NS 20000000L

typedef struct worker {
  ambit_pool *pool;
  uint32_t number;
  pthread_t thread;
} worker;

struct ambit_pool {
  ambit_pool **list, *next; /* the others of the same owner */
  pthread_mutex_t lock;
  pthread_cond_t work, done; /* items to take or closing; the last item is done */
  uint32_t nworker;          /* threads that were started; 0: the caller works */
  worker *workers;
  /* guarded by the lock */
  bool closing, stopping;
  ambit_pool_job job;
  void *user;
  ambit_meter_place place;     /* that waits for the items */
  uint32_t n, next_item, busy; /* items of this run; the next one; workers inside one */
  uint32_t failed_item;        /* least that failed, or n */
  ambit_status failed;
};

/* -- items */

static bool has_work(const ambit_pool *p) { return !p->stopping && p->next_item < p->n && p->failed_item == p->n; }

/* Items are taken in ascending order, so all before the least failed one have been started: what it says is what any
** number of threads would find first. */
static void note_failure(ambit_pool *p, uint32_t item, ambit_status status) {
  if (status == AMBIT_OK || item >= p->failed_item) return;
  p->failed_item = item;
  p->failed = status;
}

/* [lock held on entry and return] */
static void do_item(ambit_pool *p, uint32_t number) {
  uint32_t item = p->next_item++;
  p->busy++;
  pthread_mutex_unlock(&p->lock);
  bool measured = ambit_meter_join(&p->place, "item of a pool");
  ambit_status status = p->job(p->user, item, number);
  if (measured) ambit_meter_part();
  pthread_mutex_lock(&p->lock);
  p->busy--;
  note_failure(p, item, status);
}

/* -- workers */

static void *live(void *argument) {
  const worker *self = argument;
  ambit_pool *p = self->pool;
  ambit_environment_enter();
  pthread_mutex_lock(&p->lock);
  while (!p->closing) {
    if (!has_work(p)) {
      pthread_cond_wait(&p->work, &p->lock);
      continue;
    }
    do_item(p, self->number);
    if (p->busy == 0 && !has_work(p)) pthread_cond_signal(&p->done);
  }
  pthread_mutex_unlock(&p->lock);
  return NULL;
}

/* All but those that a fault raises in the thread itself. */
static void block_signals(sigset_t *previous) {
  static const int own[] = { SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGPROF };
  sigset_t all;
  sigfillset(&all);
  for (size_t i = 0; i < sizeof own / sizeof *own; i++) sigdelset(&all, own[i]);
  pthread_sigmask(SIG_BLOCK, &all, previous);
}

static void start_workers(ambit_pool *p, uint32_t threads) {
  pthread_attr_t attributes;
  sigset_t previous;
  if (pthread_attr_init(&attributes) != 0) return;
  pthread_attr_setstacksize(&attributes, STACK_BYTES);
  block_signals(&previous);
  for (uint32_t i = 0; i < threads; i++) {
    p->workers[i] = (worker) { .pool = p, .number = i };
    if (pthread_create(&p->workers[i].thread, &attributes, live, &p->workers[i]) != 0) break;
    p->nworker++;
  }
  pthread_sigmask(SIG_SETMASK, &previous, NULL);
  pthread_attr_destroy(&attributes);
}

ambit_status ambit_pool_open(ambit_pool **list, uint32_t threads, ambit_pool **pool) {
  *pool = NULL;
  ambit_pool *p = calloc(1, sizeof *p);
  if (!p) return AMBIT_NOMEM;
  p->workers = calloc(threads ? threads : 1, sizeof *p->workers);
  if (!p->workers) {
    free(p);
    return AMBIT_NOMEM;
  }
  pthread_condattr_t clock;
  pthread_condattr_init(&clock);
  pthread_condattr_setclock(&clock, CLOCK_MONOTONIC);
  pthread_mutex_init(&p->lock, NULL);
  pthread_cond_init(&p->work, NULL);
  pthread_cond_init(&p->done, &clock);
  pthread_condattr_destroy(&clock);
  if (threads > 1) start_workers(p, threads);
  if (list) {
    p->list = list;
    p->next = *list;
    *list = p;
  }
  *pool = p;
  return AMBIT_OK;
}

static void leave_list(ambit_pool *p) {
  if (!p->list) return;
  ambit_pool **at = p->list;
  while (*at != p) at = &(*at)->next;
  *at = p->next;
}

void ambit_pool_close(ambit_pool *p) {
  if (!p) return;
  pthread_mutex_lock(&p->lock);
  p->closing = true;
  pthread_cond_broadcast(&p->work);
  pthread_mutex_unlock(&p->lock);
  for (uint32_t i = 0; i < p->nworker; i++) pthread_join(p->workers[i].thread, NULL);
  leave_list(p);
  pthread_cond_destroy(&p->work);
  pthread_cond_destroy(&p->done);
  pthread_mutex_destroy(&p->lock);
  free(p->workers);
  free(p);
}

uint32_t ambit_pool_threads(const ambit_pool *p) { return p->nworker ? p->nworker : 1; }

/* -- a run */

static struct timespec soon(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  t.tv_nsec += POLL_NS;
  if (t.tv_nsec >= 1000000000L) {
    t.tv_nsec -= 1000000000L;
    t.tv_sec++;
  }
  return t;
}

/* [lock held on entry and return] */
static void ask(ambit_pool *p, int32_t (*meanwhile)(void *user)) {
  if (!meanwhile || p->stopping) return;
  pthread_mutex_unlock(&p->lock);
  bool stop = meanwhile(p->user) != 0;
  pthread_mutex_lock(&p->lock);
  p->stopping = p->stopping || stop;
}

static void wait_for_workers(ambit_pool *p, int32_t (*meanwhile)(void *user)) {
  pthread_cond_broadcast(&p->work);
  struct timespec until = soon();
  while (p->busy || has_work(p)) {
    if (!meanwhile || p->stopping) {
      pthread_cond_wait(&p->done, &p->lock);
    } else if (pthread_cond_timedwait(&p->done, &p->lock, &until) == ETIMEDOUT) {
      ask(p, meanwhile);
      until = soon();
    }
  }
}

static void work_here(ambit_pool *p, int32_t (*meanwhile)(void *user)) {
  while (has_work(p)) {
    do_item(p, 0);
    ask(p, meanwhile);
  }
}

ambit_status ambit_pool_run(
    ambit_pool *p, uint32_t n, ambit_pool_job job, void *user, int32_t (*meanwhile)(void *user)) {
  ambit_environment before = ambit_environment_enter();
  pthread_mutex_lock(&p->lock);
  p->job = job;
  p->user = user;
  p->place = ambit_meter_here();
  p->n = p->failed_item = n;
  p->next_item = 0;
  p->stopping = false;
  p->failed = AMBIT_OK;
  if (p->nworker) {
    ambit_meter_enter(AMBIT_FRAME_THREAD, "waiting for threads");
    wait_for_workers(p, meanwhile);
    ambit_meter_leave();
  } else {
    work_here(p, meanwhile);
  }
  ambit_status status = p->stopping ? AMBIT_STOPPED : p->failed;
  p->n = p->next_item = p->failed_item = 0; /* nothing to do until the next run */
  pthread_mutex_unlock(&p->lock);
  ambit_environment_leave(before);
  return status;
}
