/* lohner.c -- how tight and how fast the integrator is, on the problems that other validated integrators were measured
** with.
**
** Prints widths, times and CPU seconds reached in this run, beside what is required and what CAPD 5, VNODE-LP and kv
** reach (measured side by side on two shared Zen 4 cores). That the enclosures hold is shown by
** tests/plugins/test_solver_lohner_figures.c. Needs AMBIT_PATH to find the plugins. lohner [NAME [OPTION=VALUE ...]]:
** only the problem of that name, with options of the solver: "lohner P6l step_max=1e-4" makes a million steps in each
** run and shows that they need no more memory than the first.
*/
#define _POSIX_C_SOURCE 200809L
#include "../tests/kit/reference_models.h"
#include "solver_bench.h"
#include <sys/resource.h>

#define STATES 16
#define INSTANTS 16
#define REPEATS 5
#define RECORDS_UNWATCHED 8192 /* asking the system for memory in use takes as long as a tenth of a step */

typedef struct problem {
  const char *name, *what, *peers;
  void (*build)(model *m);
  double until, at, widest; /* required: proved until; widths at the instant `at` no more than `widest` in any state */
  size_t ntime;
  double time[INSTANTS];
} problem;

static const problem problems[] = {
  { "P1", "double pendulum, first angle +-1 %", "CAPD ends at .603, kv at .618 to .684, VNODE at .538 to .566",
      model_wide_double_pendulum, 0.69, 0.4, 0.451, 12,
      { 0, 0.1, 0.2, 0.3, 0.4, 0.42, 0.5, 0.504, 0.6, 0.62, 0.69, 1 } },
  { "P2", "double pendulum from a point", "CAPD 1.2e-8 in .83 s, VNODE 2e-8 in 1.38 s, kv 1.9e-10 in 18 s",
      model_point_double_pendulum, 10, 10, 2e-10, 4, { 0, 1, 5, 10 } },
  { "P2l", "the same for longer", "kv under 1e-3 beyond 27", model_point_double_pendulum, 29, 0, INFINITY, 2,
      { 0, 32 } },
  { "P3", "Lorenz", "CAPD 5.9e-4 in .124 s, VNODE 1.2e-3 in .38 s, kv 8.1e-5 in 2.2 s", model_lorenz, 20, 20, 1e-4, 4,
      { 0, 1, 10, 20 } },
  { "P3l", "the same for longer", "kv under 1e-3 until 23.5", model_lorenz, 24, 0, INFINITY, 2, { 0, 26 } },
  { "P4", "Van der Pol, mu = 1, a box", "CAPD ends at 2.4, VNODE at 2.3, kv at 3.29", model_van_der_pol_box, 7, 1, 1, 5,
      { 0, 1, 2, 3, 7 } },
  { "P4p", "Van der Pol, mu = 1, from (2, 0)", "not measured", model_van_der_pol, 20, 20, 1e-11, 3, { 0, 10, 20 } },
  { "P6", "pendulum", "CAPD 3.3e-12 in .054 s, VNODE 4e-12 in .126 s, kv 8.5e-13 in 2.2 s", model_pendulum, 100, 100,
      3.3e-12, 2, { 0, 100 } },
  { "P6l", "x'' = -x", "CAPD 4e-14 in 1.2 ms", model_oscillator, 100, 100, 1e-12, 2, { 0, 100 } },
  { "P5l", "x' = -1000 (x - cos t)", "CAPD to t = 2000 in 11.6 s", model_stiff_line, 20, 20, 1e-12, 2, { 0, 20 } },
  { "P5v", "Van der Pol, mu = 20, from (2, 0)", "not measured", model_stiff_van_der_pol, 40, 40, 1e-8, 3,
      { 0, 20, 40 } },
  { "rod", "heat in a rod, 16 states", "not measured", model_rod, 20, 20, 1e-12, 2, { 0, 20 } },
  { "escape", "x' = x^2 from 1, escapes at t = 1", "not measured", model_escape, 0.999, 0, INFINITY, 2, { 0, 2 } },
};

/* -- a run */

typedef struct watcher {
  ambit_sink sink; /* first */
  const problem *p;
  size_t next, nx;
  double lo[INSTANTS][STATES], hi[INSTANTS][STATES], below, over; /* last time under 1e-3; under 10 */
  uint32_t records;
  long first_kb, last_kb; /* memory at the first and at one of the last records */
} watcher;

static long memory(void) {
  struct rusage usage;
  return getrusage(RUSAGE_SELF, &usage) == 0 ? usage.ru_maxrss : 0;
}

static int32_t watch(ambit_sink *sink, const ambit_record *r) {
  watcher *w = (watcher *)(void *)sink;
  double widest = 0;
  for (size_t i = 0; i < r->nx; i++) widest = fmax(widest, r->hi[i] - r->lo[i]);
  if (widest < 1e-3) w->below = r->t_to;
  if (widest < 10) w->over = r->t_to;
  if (w->records++ % RECORDS_UNWATCHED == 0) w->last_kb = memory();
  if (!w->first_kb) w->first_kb = w->last_kb;
  if (w->next >= w->p->ntime || r->t_to != w->p->time[w->next]) return 0;
  memcpy(w->lo[w->next], r->lo, r->nx * sizeof(double));
  memcpy(w->hi[w->next], r->hi, r->nx * sizeof(double));
  w->next++;
  return 0;
}

static double widest_at(const watcher *w, double t) {
  double most = 0;
  for (size_t k = 1; k < w->next; k++)
    for (size_t i = 0; i < w->nx && w->p->time[k] == t; i++) most = fmax(most, w->hi[k][i] - w->lo[k][i]);
  return most;
}

static void report(const watcher *w, const ambit_simulate_result *result, double seconds) {
  const problem *p = w->p;
  double widest = widest_at(w, p->at);
  int reached = w->over >= p->until && widest <= p->widest && (p->at == 0 || widest > 0);
  printf("### %s: %s\n\n", p->name, p->what);
  printf("- required: until t = %g; at t = %g no wider than %g: %s. Peers: %s\n", p->until, p->at, p->widest,
      reached ? "reached" : "MISSED", p->peers);
  printf("- until t = %.9g in %u steps, %.2f ms of CPU time, %.1f us a step; narrower than 1e-3 until t = %.4g, than "
         "10 until %.4g; "
         "%ld kB more at the end\n",
      result->t_reached, result->steps, 1e3 * seconds, 1e6 * seconds / result->steps, w->below, w->over,
      w->last_kb - w->first_kb);
  if (result->reason[0]) printf("- ended: %s\n", result->reason);
  for (size_t k = 1; k < w->next; k++) {
    printf("- widths at t = %g:", p->time[k]);
    for (size_t i = 0; i < w->nx; i++) printf(" %.4g", w->hi[k][i] - w->lo[k][i]);
    printf("\n");
  }
  printf("\n");
}

static void again(ambit_sink *sink) {
  watcher *w = (watcher *)(void *)sink;
  *w = (watcher) { .sink = w->sink, .p = w->p, .next = 1, .nx = w->nx };
}

static void run(const problem *p, const bench_arguments *arguments, ambit_registry *registry) {
  model m;
  p->build(&m);
  watcher w = { .sink = { sizeof(ambit_sink), watch, NULL }, .p = p, .nx = m.system.nx };
  const ambit_simulate_request q = { .system = &m.system,
    .registry = registry,
    .solver = "lohner",
    .nsolver_option = arguments->noption,
    .solver_option = arguments->option,
    .initial = m.initial,
    .ntime = p->ntime,
    .time = p->time,
    .sink = &w.sink };
  ambit_simulate_result result = { 0 };
  double best = bench_fastest(p->name, &q, REPEATS, again, &result);
  report(&w, &result, best);
  model_close(&m);
}

int main(int argc, char **argv) {
  bench_arguments arguments = bench_read(argc, argv);
  ambit_registry *registry = ambit_registry_open(NULL);
  for (size_t i = 0; i < sizeof problems / sizeof *problems; i++)
    if (bench_wants(&arguments, problems[i].name)) run(&problems[i], &arguments, registry);
  ambit_registry_close(registry);
  return 0;
}
