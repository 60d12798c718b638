/* test_allocations.c -- no solver allocates between its first and its last record. Malloc is counted
** (tests/kit/allocations.c); a solver that allocates on purpose shows that the count works. */
#include "kit/allocations.h"
#include "verbs/scene.h"
#include <setjmp.h>
#include <stdarg.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cmocka.h>

typedef struct counter {
  ambit_sink sink; /* first */
  size_t first, last, records;
} counter;

static int32_t emit(ambit_sink *s, const ambit_record *r) {
  counter *c = (counter *)(void *)s;
  (void)r;
  c->last = ambit_allocation_count();
  if (c->records++ == 0) c->first = c->last;
  return 0;
}

static int32_t progress(ambit_sink *s, double done, const char *message) {
  (void)s, (void)done, (void)message;
  return 0;
}

/* Simulates a pendulum of uncertain start and length; returns allocations between the first and the last record. */
static size_t allocations(const char *solver, const ambit_option *option, size_t *records) {
  static const double time[] = { 0, 0.25, 0.5, 0.75, 1 };
  scene *s = scene_open();
  ambit_graph *g = s->graph;
  counter c = { .sink = { sizeof(ambit_sink), emit, progress } };
  ambit_expr ratio = scene_unknown(s, "g/l", 9.8, 9.82);
  size_t angle = scene_state(s, "angle", scene_unknown(s, "angle0", 1, 1.01)),
         rate = scene_state(s, "rate", ambit_graph_number(g, 0));
  s->rate[angle] = s->state[rate];
  s->rate[rate] = ambit_graph_op(
      g, AMBIT_OP_NEG, ambit_graph_op(g, AMBIT_OP_MUL, ratio, ambit_graph_op(g, AMBIT_OP_SIN, s->state[angle], 0)), 0);
  ambit_simulate_request q = scene_request(s, solver, 5, time);
  q.sink = &c.sink;
  q.nsolver_option = option ? 1 : 0;
  q.solver_option = option;
  ambit_simulate_result result;
  ambit_failure f = { 0 };
  if (ambit_simulate(&q, &result, NULL, &f) != AMBIT_OK || result.status != AMBIT_OK)
    fail_msg("%s%s", f.message, result.reason);
  scene_close(s);
  *records = c.records;
  return c.last - c.first;
}

static void counts(void **state) {
  (void)state;
  size_t before = ambit_allocation_count();
  void *volatile p = malloc(10);
  p = realloc(p, 20);
  free(p);
  p = aligned_alloc(64, 64);
  free(p);
  p = calloc(2, 2);
  free(p);
  assert_int_equal(ambit_allocation_count() - before, 4);
}

#ifdef AMBIT_COUNT_ALLOCATIONS
/* libambit itself aborts */
static void finds_an_allocation(void **state) {
  static const ambit_option allocate = { "does", "allocate" };
  (void)state;
  fflush(NULL);
  pid_t child = fork();
  if (child == 0) {
    size_t records;
    close(STDERR_FILENO);
    signal(SIGABRT, SIG_DFL);
    allocations("mock", &allocate, &records);
    _exit(0);
  }
  int how;
  assert_int_equal(waitpid(child, &how, 0), child);
  assert_true(WIFSIGNALED(how) && WTERMSIG(how) == SIGABRT);
}
#else
static void finds_an_allocation(void **state) {
  static const ambit_option allocate = { "does", "allocate" };
  size_t records;
  (void)state;
  assert_true(allocations("mock", &allocate, &records) > 0);
}
#endif

static void no_solver_allocates(void **state) {
  static const char *const solver[] = { "mock", "gsl", "lohner" };
  (void)state;
  for (size_t i = 0; i < sizeof solver / sizeof *solver; i++) {
    size_t records, n = allocations(solver[i], NULL, &records);
    assert_true(records >= 4);
    if (n) fail_msg("solver %s: %zu allocations", solver[i], n);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(counts),
    cmocka_unit_test(finds_an_allocation),
    cmocka_unit_test(no_solver_allocates),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
