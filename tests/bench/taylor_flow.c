/* taylor_flow.c -- how far, how tight and how fast the Taylor-model integrator carries wide uncertain data.
**
** Prints widths, times and CPU seconds reached in this run with their ratios to what is required (1 or less: reached),
** and what CAPD 5, VNODE-LP and kv reach. "True" widths are those of 20001 sampled solutions. That the enclosures hold
** is shown by tests/plugins/test_solver_taylor_model*.c. Needs AMBIT_PATH to find the plugins.
** taylor_flow [NAME [OPTION=VALUE ...]]: only the problem of that name, with options of the solver.
*/
#define _POSIX_C_SOURCE 200809L
#include "../tests/kit/reference_models.h"
#include "solver_bench.h"

#define STATES 4
#define REPEATS 5

typedef struct problem {
  const char *name, *what, *peers;
  void (*build)(model *m);
  double until, end, seconds;  /* required: proved until, in so much CPU time; the run goes to `end` */
  double share, width[STATES]; /* and at the end no wider than share times these */
  const char *pieces;
} problem;

static void pendulum_wide(model *m) { model_double_pendulum(m, "0.1"); }

static void escape_wide(model *m) {
  model_escape(m);
  m->initial[0] = ambit_graph_unknown(m->graph, "x0", (ambit_interval) { 0.99, 1.01 });
}

static const char *const p1_peers = "CAPD 2.4 s in 32 hand-made pieces at 1.1 times true; no splitting: .603";
static const problem problems[] = {
  { "P1-1", "double pendulum, first angle +-1 %, to t = 1, one piece", p1_peers, model_wide_double_pendulum, 1, 1, 0.02,
      1.01, { .0128, .1229, .6294, 1.0191 }, "1" },
  { "P1-3", "the same to t = 3", "nobody", model_wide_double_pendulum, 3, 3, 0.05, 0, { 0 }, "1" },
  { "P1-5", "to t = 5, split where necessary", "nobody", model_wide_double_pendulum, 5, 5, 0.4, 0, { 0 }, "0" },
  { "P1-7", "to t = 7", "nobody", model_wide_double_pendulum, 7, 7, 3, 0, { 0 }, "0" },
  { "P1-wide", "first angle +-10 %, to t = 1", "nobody", pendulum_wide, 1, 1, 0.1, 0, { 0 }, "0" },
  { "P4", "Van der Pol, mu = 1, box [1.25, 1.55] x [2.35, 2.45], to t = 7", "CAPD 2.4, VNODE 2.3, kv 3.29",
      model_van_der_pol_box, 7, 7, 0.5, 1.1, { .10419, .43596 }, "0" },
  { "escape", "x' = x^2 from 1, escapes at t = 1", "", model_escape, 0.999, 2, 1, 0, { 0 }, "0" },
  { "escape-wide", "x' = x^2 from 1 +-1 %, escapes from t = 1/1.01 on", "", escape_wide, 0.96, 2, 3, 0, { 0 }, "0" },
};

typedef struct watcher {
  ambit_sink sink; /* first */
  size_t nx;
  double lo[STATES], hi[STATES];
} watcher;

static int32_t watch(ambit_sink *sink, const ambit_record *r) {
  watcher *w = (watcher *)(void *)sink;
  memcpy(w->lo, r->lo, r->nx * sizeof(double));
  memcpy(w->hi, r->hi, r->nx * sizeof(double));
  return 0;
}

static void report(const problem *p, const watcher *w, const ambit_simulate_result *result, double seconds) {
  double ratio = seconds / p->seconds;
  printf("### %s: %s\n\n", p->name, p->what);
  printf("- until t = %.9g in %u records, %.2f ms of CPU time: %.2f times what is allowed%s\n", result->t_reached,
      result->steps, 1e3 * seconds, ratio, ratio <= 1 && result->t_reached >= p->until ? "" : ": MISSED");
  if (p->peers[0]) printf("- peers: %s\n", p->peers);
  if (result->reason[0]) printf("- ended: %s\n", result->reason);
  printf("- widths at the end:");
  for (size_t i = 0; i < w->nx; i++) printf(" %.5g", w->hi[i] - w->lo[i]);
  for (size_t i = 0; i < w->nx && p->share > 0; i++)
    printf("%s%.4f%s", i ? ", " : "; times true (", (w->hi[i] - w->lo[i]) / p->width[i], i + 1 == w->nx ? ")" : "");
  printf("\n\n");
}

static void again(ambit_sink *sink) {
  watcher *w = (watcher *)(void *)sink;
  memset(w->lo, 0, sizeof w->lo);
  memset(w->hi, 0, sizeof w->hi);
}

static void run(const problem *p, bench_arguments *arguments, ambit_registry *registry) {
  model m;
  p->build(&m);
  watcher w = { .sink = { sizeof(ambit_sink), watch, NULL }, .nx = m.system.nx };
  const double time[] = { 0, p->end };
  arguments->option[arguments->noption] = (ambit_option) { "pieces_max", p->pieces };
  const ambit_simulate_request q = { .system = &m.system,
    .registry = registry,
    .solver = "taylor_model",
    .nsolver_option = arguments->noption + 1,
    .solver_option = arguments->option,
    .initial = m.initial,
    .ntime = 2,
    .time = time,
    .threads = 1,
    .sink = &w.sink };
  ambit_simulate_result result = { 0 };
  double best = bench_fastest(p->name, &q, REPEATS, again, &result);
  report(p, &w, &result, best);
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
