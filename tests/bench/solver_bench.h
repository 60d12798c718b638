/* solver_bench.h -- what the benches of solvers share: their arguments, and the fastest of several runs. */
#ifndef SOLVER_BENCH_H
#define SOLVER_BENCH_H
#include <ambit/simulate.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BENCH_OPTIONS 16

/* [NAME [OPTION=VALUE ...]]: only the problems of that name, with options of the solver */
typedef struct bench_arguments {
  const char *name; /* NULL: all */
  size_t noption;
  ambit_option option[BENCH_OPTIONS + 1]; /* one more, which a bench may set itself */
} bench_arguments;

static inline bench_arguments bench_read(int argc, char **argv) {
  bench_arguments a = { .name = argc > 1 ? argv[1] : NULL };
  for (int i = 2; i < argc && a.noption < BENCH_OPTIONS; i++) {
    char *equal = strchr(argv[i], '=');
    if (!equal) continue;
    *equal = '\0';
    a.option[a.noption++] = (ambit_option) { argv[i], equal + 1 };
  }
  return a;
}

static inline int bench_wants(const bench_arguments *a, const char *name) {
  return !a->name || strcmp(a->name, name) == 0;
}

/* Least CPU seconds of the run itself; `again` prepares the sink for each. */
static inline double bench_fastest(const char *name, const ambit_simulate_request *q, int repeats,
    void (*again)(ambit_sink *sink), ambit_simulate_result *result) {
  double best = INFINITY;
  for (int i = 0; i < repeats; i++) {
    ambit_failure f = { 0 };
    again(q->sink);
    if (ambit_simulate(q, result, NULL, &f) != AMBIT_OK) {
      fprintf(stderr, "%s: %s\n", name, f.message);
      exit(1);
    }
    best = fmin(best, result->cpu_seconds);
    if (best > 1) break; /* long enough to be measured once */
  }
  return best;
}
#endif
