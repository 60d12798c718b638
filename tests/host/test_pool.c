/* test_pool.c -- threads that work on items: all of them, each once, in order; outcomes that do not depend on how many
** threads there are; stopping, the floating-point environment, signals, and systems that give no threads. */
#include "host/pool.h"
#include "verbs/run/processors.h"
#include "host/services.h"
#include "num/environment.h"
#include <ambit/rounding.h>
#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <cmocka.h>

#define ITEMS 500

static const ambit_pool_service *service(const ambit_scope *scope) {
  const ambit_pool_service *s = scope->host.service(&scope->host, AMBIT_POOL_SERVICE);
  assert_non_null(s);
  assert_int_equal(s->size, sizeof *s);
  return s;
}

static ambit_scope *lease_open(void) {
  ambit_scope *scope;
  assert_int_equal(ambit_scope_open(&scope, NULL, NULL), AMBIT_OK);
  return scope;
}

static void sleep_ms(long ms) {
  struct timespec t = { ms / 1000, ms % 1000 * 1000000 };
  nanosleep(&t, NULL);
}

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* -- items */

typedef struct tally {
  uint32_t threads;
  _Atomic uint32_t times[ITEMS], order[ITEMS], started;
  _Atomic uint32_t inside[8], shared; /* by worker; 1 where two threads used one worker's index */
  double sum[8];                      /* memory of each worker: plain, as contexts are */
  uint32_t fail_from, polls, stop_at;
} tally;

static ambit_status count(void *user, uint32_t item, uint32_t number) {
  tally *t = user;
  assert_true(number < t->threads);
  if (atomic_fetch_add(&t->inside[number], 1) != 0) atomic_store(&t->shared, 1);
  atomic_fetch_add(&t->times[item], 1);
  atomic_store(&t->order[item], atomic_fetch_add(&t->started, 1));
  t->sum[number] += item;
  atomic_fetch_sub(&t->inside[number], 1);
  return AMBIT_OK;
}

static void does_every_item_once(void **state) {
  (void)state;
  for (uint32_t threads = 0; threads <= 8; threads++) {
    ambit_scope *scope = lease_open();
    const ambit_pool_service *s = service(scope);
    ambit_pool *pool;
    assert_int_equal(s->open(&scope->host, threads, &pool), AMBIT_OK);
    tally *t = calloc(1, sizeof *t);
    t->threads = threads ? threads : 1;
    for (uint32_t round = 1; round <= 20; round++) {
      assert_int_equal(s->run(pool, ITEMS, count, t, NULL), AMBIT_OK);
      for (uint32_t i = 0; i < ITEMS; i++) assert_int_equal(t->times[i], round);
    }
    assert_int_equal(s->run(pool, 0, count, t, NULL), AMBIT_OK);
    double sum = 0;
    for (uint32_t i = 0; i < 8; i++) sum += t->sum[i];
    assert_true(sum == 20.0 * ITEMS * (ITEMS - 1) / 2);
    assert_int_equal(t->shared, 0);
    free(t);
    s->close(pool);
    ambit_scope_close(scope);
  }
}

static ambit_status step_in_order(void *user, uint32_t item, uint32_t number) {
  (void)number;
  tally *t = user;
  t->order[item] = t->started++;
  return AMBIT_OK;
}

static void starts_items_in_order(void **state) {
  (void)state;
  ambit_pool *pool;
  tally *t = calloc(1, sizeof *t);
  assert_int_equal(ambit_pool_open(NULL, 1, &pool), AMBIT_OK);
  assert_int_equal(ambit_pool_threads(pool), 1);
  assert_int_equal(ambit_pool_run(pool, ITEMS, step_in_order, t, NULL), AMBIT_OK);
  for (uint32_t i = 0; i < ITEMS; i++) assert_int_equal(t->order[i], i);
  ambit_pool_close(pool);
  free(t);
}

/* -- failures: of items 7, 8, 9 ... each says something else; the first by number counts, although it is the last in
** time */

static ambit_status fail_late(void *user, uint32_t item, uint32_t number) {
  (void)number;
  const tally *t = user;
  if (item < t->fail_from) return AMBIT_OK;
  if (item == t->fail_from) sleep_ms(20);
  return item == t->fail_from ? AMBIT_DOMAIN : AMBIT_UNABLE;
}

static void reports_the_first_failure(void **state) {
  (void)state;
  for (uint32_t threads = 1; threads <= 4; threads++) {
    ambit_pool *pool;
    tally t = { .fail_from = 7 };
    assert_int_equal(ambit_pool_open(NULL, threads, &pool), AMBIT_OK);
    for (int round = 0; round < 5; round++)
      assert_int_equal(ambit_pool_run(pool, ITEMS, fail_late, &t, NULL), AMBIT_DOMAIN);
    t.fail_from = ITEMS;
    assert_int_equal(ambit_pool_run(pool, ITEMS, fail_late, &t, NULL), AMBIT_OK); /* forgotten by the next run */
    ambit_pool_close(pool);
  }
}

/* -- stopping */

static ambit_status take_long(void *user, uint32_t item, uint32_t number) {
  tally *t = user;
  (void)item, (void)number;
  atomic_fetch_add(&t->started, 1);
  sleep_ms(100);
  return AMBIT_OK;
}

static int32_t poll_and_stop(void *user) {
  tally *t = user;
  return ++t->polls >= t->stop_at;
}

static void polls_while_items_are_long(void **state) {
  (void)state;
  ambit_pool *pool;
  tally t = { .stop_at = UINT32_MAX };
  assert_int_equal(ambit_pool_open(NULL, 2, &pool), AMBIT_OK);
  assert_int_equal(ambit_pool_threads(pool), 2);
  assert_int_equal(ambit_pool_run(pool, 4, take_long, &t, poll_and_stop), AMBIT_OK);
  assert_int_equal(t.started, 4);
  assert_true(t.polls >= 3); /* in 200 ms; a busy machine may be slow, but not 50 times */
  ambit_pool_close(pool);
}

static void stops_when_asked(void **state) {
  (void)state;
  for (uint32_t threads = 1; threads <= 3; threads++) {
    ambit_pool *pool;
    tally t = { .stop_at = 1 };
    assert_int_equal(ambit_pool_open(NULL, threads, &pool), AMBIT_OK);
    assert_int_equal(ambit_pool_run(pool, ITEMS, take_long, &t, poll_and_stop), AMBIT_STOPPED);
    assert_true(t.started < ITEMS / 10);
    assert_int_equal(t.polls, 1); /* not asked again */
    t.stop_at = UINT32_MAX;
    uint32_t before = t.started;
    assert_int_equal(ambit_pool_run(pool, 2, take_long, &t, poll_and_stop), AMBIT_OK); /* and goes on */
    assert_int_equal(t.started, before + 2);
    ambit_pool_close(pool);
  }
}

/* -- the environment of an item */

static ambit_status look_around(void *user, uint32_t item, uint32_t number) {
  (void)item, (void)number;
  pthread_t caller = *(pthread_t *)user;
  if (!ambit_environment_is_standard()) return AMBIT_BROKEN;
  if (pthread_equal(caller, pthread_self())) return AMBIT_OK;
  sigset_t blocked;
  pthread_sigmask(SIG_SETMASK, NULL, &blocked);
  return sigismember(&blocked, SIGINT) && sigismember(&blocked, SIGTERM) && !sigismember(&blocked, SIGSEGV)
             ? AMBIT_OK
             : AMBIT_BROKEN;
}

static void items_round_to_nearest(void **state) {
  (void)state;
  pthread_t self = pthread_self();
  for (uint32_t threads = 1; threads <= 3; threads++) {
    ambit_pool *pool;
    ambit_rounding before = ambit_round_up(); /* a caller in another mode, whose threads would inherit it */
    assert_int_equal(ambit_pool_open(NULL, threads, &pool), AMBIT_OK);
    ambit_status status = ambit_pool_run(pool, 50, look_around, &self, NULL);
    volatile double one = 1, tiny = 0x1p-60;
    assert_true(one + tiny > 1); /* the caller gets its mode back */
    ambit_rounding_restore(before);
    assert_int_equal(status, AMBIT_OK);
    ambit_pool_close(pool);
  }
  sigset_t blocked;
  pthread_sigmask(SIG_SETMASK, NULL, &blocked);
  assert_false(sigismember(&blocked, SIGINT)); /* the caller still hears Ctrl-C */
}

/* -- where threads are scarce */

static uint32_t granted = UINT32_MAX; /* threads that the system still gives */

/* In place of the C library's: what `ulimit -u` does, which does not stop root. */
int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *), void *argument) {
  typedef int create(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);
  create *original;
  void *found = dlsym(RTLD_NEXT, "pthread_create");
  memcpy(&original, &found, sizeof original);
  if (granted == 0) return EAGAIN;
  granted--;
  return original(thread, attributes, start, argument);
}

static void does_with_fewer_threads(void **state) {
  (void)state;
  for (uint32_t some = 0; some < 4; some++) {
    ambit_pool *pool;
    tally *t = calloc(1, sizeof *t);
    t->threads = some ? some : 1;
    granted = some;
    assert_int_equal(ambit_pool_open(NULL, 4, &pool), AMBIT_OK);
    granted = UINT32_MAX;
    assert_int_equal(ambit_pool_threads(pool), t->threads);
    assert_int_equal(ambit_pool_run(pool, ITEMS, count, t, NULL), AMBIT_OK);
    assert_int_equal(t->started, ITEMS);
    ambit_pool_close(pool);
    free(t);
  }
}

static void closes_with_its_host(void **state) {
  (void)state;
  ambit_scope *scope = lease_open();
  const ambit_pool_service *s = service(scope);
  ambit_pool *pool[3];
  for (int i = 0; i < 3; i++) assert_int_equal(s->open(&scope->host, 3, &pool[i]), AMBIT_OK);
  s->close(pool[1]);
  s->close(NULL);
  ambit_scope_close(scope); /* joins the other two: sanitizers would see what is left */
}

/* Idle workers sleep: no CPU time. */
static void sleeps_between_runs(void **state) {
  (void)state;
  ambit_pool *pool;
  tally t = { .stop_at = UINT32_MAX, .threads = 8 };
  assert_int_equal(ambit_pool_open(NULL, 4, &pool), AMBIT_OK);
  assert_int_equal(ambit_pool_run(pool, 4, count, &t, NULL), AMBIT_OK);
  clock_t before = clock();
  sleep_ms(200);
  assert_true(clock() - before < CLOCKS_PER_SEC / 20);
  ambit_pool_close(pool);
}

/* -- how many */

static void counts_processors(void **state) {
  (void)state;
  uint32_t n = 0;
  ambit_failure f = { 0 };
  unsetenv("AMBIT_THREADS");
  assert_int_equal(ambit_processors_threads(&n, &f), AMBIT_OK);
  assert_true(n >= 1 && n <= AMBIT_THREADS_MAX);
  setenv("AMBIT_THREADS", "3", 1);
  assert_int_equal(ambit_processors_threads(&n, &f), AMBIT_OK);
  assert_int_equal(n, 3);
  static const char *const bad[] = { "0", "-1", "two", "1.5", "257", "3 ", "99999999999999999999" };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    ambit_failure why = { 0 };
    setenv("AMBIT_THREADS", bad[i], 1);
    assert_int_equal(ambit_processors_threads(&n, &why), AMBIT_INVALID);
    assert_non_null(strstr(why.message, "AMBIT_THREADS"));
    assert_non_null(strstr(why.message, bad[i]));
  }
  unsetenv("AMBIT_THREADS");
  assert_int_equal(ambit_processors_quota("max 100000\n"), 0);
  assert_int_equal(ambit_processors_quota("200000 100000\n"), 2);
  assert_int_equal(ambit_processors_quota("150000 100000\n"), 2);
  assert_int_equal(ambit_processors_quota("10000 100000\n"), 1);
  assert_int_equal(ambit_processors_quota("100000\n"), 0);
  assert_int_equal(ambit_processors_quota("9999999999 1"), AMBIT_THREADS_MAX);
  assert_int_equal(ambit_processors_quota(""), 0);
}

/* Not a measurement, only a bound that notices a pool that sleeps where it should wake. */
static void wakes_quickly(void **state) {
  (void)state;
  ambit_pool *pool;
  tally t = { .threads = 8 };
  assert_int_equal(ambit_pool_open(NULL, 2, &pool), AMBIT_OK);
  double before = now();
  for (int round = 0; round < 200; round++) assert_int_equal(ambit_pool_run(pool, 2, count, &t, NULL), AMBIT_OK);
  assert_true(now() - before < 2);
  ambit_pool_close(pool);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(does_every_item_once),
    cmocka_unit_test(starts_items_in_order),
    cmocka_unit_test(reports_the_first_failure),
    cmocka_unit_test(polls_while_items_are_long),
    cmocka_unit_test(stops_when_asked),
    cmocka_unit_test(items_round_to_nearest),
    cmocka_unit_test(does_with_fewer_threads),
    cmocka_unit_test(closes_with_its_host),
    cmocka_unit_test(sleeps_between_runs),
    cmocka_unit_test(counts_processors),
    cmocka_unit_test(wakes_quickly),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
