/* valencia.c -- how far, how tight and how fast valencia is, beside what is required of it and what the ValEncIA-IVP
** paper (Rauh, Auer & Hofer 2006) and other validated integrators reach.
**
** Prints widths, times and CPU seconds reached in this run. That the enclosures hold is shown by
** tests/plugins/test_solver_valencia*.c. Needs AMBIT_PATH to find the plugins. valencia [NAME [OPTION=VALUE ...]]: only
** the problems of that name, with options of the solver.
*/
#define _POSIX_C_SOURCE 200809L
#include "../tests/kit/reference_models.h"
#include "solver_bench.h"

#define STATES 4
#define INSTANTS 16
#define REPEATS 3

/* x' = -1000 (x - cos t), the stiff linear problem */
static void build_stiff(model *m) {
  static const char *const name[] = { "x" };
  model_open(m, 1, name);
  expr gap = sub(m, m->state[0], cosine(m, ambit_graph_time(m->graph)));
  m->rate[0] = mul(m, number(m, -1000), gap);
  m->initial[0] = number(m, 2);
}

/* a mass that falls on a spring and leaves it again: x'' = 100 max(0, -x) - 1 */
static void build_contact(model *m) {
  static const char *const name[] = { "x", "v" };
  model_open(m, 2, name);
  expr depth = ambit_graph_op(m->graph, AMBIT_OP_MAX, number(m, 0), sub(m, number(m, 0), m->state[0]));
  m->rate[0] = m->state[1];
  m->rate[1] = sub(m, mul(m, number(m, 100), depth), number(m, 1));
  m->initial[0] = number(m, 1), m->initial[1] = number(m, 0);
}

typedef struct problem {
  const char *name, *what, *others;
  void (*build)(model *m);
  const char *arithmetic, *order; /* of the arithmetic, or NULL */
  /* required: proved until; narrower than `widest` at the instant `at` (0: nowhere); in so many seconds of CPU time */
  double until, at, widest, seconds;
  size_t ntime;
  double time[INSTANTS];
} problem;

static const problem problems[] = {
  { "P1", "double pendulum, first angle +-1 %, to 0.5; true widths .0865 .1085 .1983 .6149",
      "ValEncIA-IVP 94 s, COSY VI hours, CAPD .023 s (1.018 wide)", model_wide_double_pendulum, "taylor_model", "10",
      0.5, 0.5, 0.63, 1, 4, { 0, 0.4, 0.5 } },
  { "P1", "the same to 1.2; true widths at 1: .0128 .1229 .6294 1.0191",
      "break-down (width 10): VNODE .52, COSY VI .63, ValEncIA-IVP > 1.0", model_wide_double_pendulum, "taylor_model",
      "10", 1, 1, 10, INFINITY, 4, { 0, 0.5, 1, 1.2 } },
  { "P1i", "the same, intervals", "ValEncIA-IVP (mean-value rule) .5705", model_wide_double_pendulum, "interval", NULL,
      0.5, 0.4, 1, INFINITY, 6, { 0, 0.4, 0.5, 0.6, 0.7, 1 } },
  { "P1a", "the same, affine", "not measured", model_wide_double_pendulum, "affine", NULL, 0.45, 0.4, 1, INFINITY, 6,
      { 0, 0.4, 0.5, 0.6, 0.7, 1 } },
  { "P2", "double pendulum from a point", "CAPD 1.2e-8 in .83 s", model_point_double_pendulum, "interval", NULL, 10, 0,
      INFINITY, INFINITY, 3, { 0, 1, 10 } },
  { "P6", "pendulum", "CAPD 3.3e-12 in .054 s", model_pendulum, "interval", NULL, 100, 0, INFINITY, INFINITY, 2,
      { 0, 100 } },
  { "P6l", "x'' = -x", "CAPD 4e-14 in 1.2 ms", model_oscillator, "interval", NULL, 100, 0, INFINITY, INFINITY, 2,
      { 0, 100 } },
  { "stiff", "x' = -1000 (x - cos t)", "CAPD 11.6 s", build_stiff, "interval", NULL, 2000, 2000, 1e-9, INFINITY, 2,
      { 0, 2000 } },
  { "contact", "x'' = 100 max(0, -x) - 1 from x = 1", "Taylor methods stop at the kink", build_contact, "interval",
      NULL, 10, 10, 1e-3, INFINITY, 2, { 0, 10 } },
  { "escape", "x' = x^2 from 1, escapes at t = 1", "not measured", model_escape, "interval", NULL, 0.999, 0, INFINITY,
      INFINITY, 2, { 0, 2 } },
};

/* -- a run */

typedef struct watcher {
  ambit_sink sink; /* first */
  const problem *p;
  size_t next, nx;
  double lo[INSTANTS][STATES], hi[INSTANTS][STATES];
} watcher;

static int32_t watch(ambit_sink *sink, const ambit_record *r) {
  watcher *w = (watcher *)(void *)sink;
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
  int reached =
      result->t_reached >= p->until && widest <= p->widest && (p->at == 0 || widest > 0) && seconds <= p->seconds;
  printf(
      "### %s: %s (%s%s%s)\n\n", p->name, p->what, p->arithmetic, p->order ? ", order " : "", p->order ? p->order : "");
  printf("- required: until t = %g; at t = %g no wider than %g; in %g s: %s. Others: %s\n", p->until, p->at, p->widest,
      p->seconds, reached ? "reached" : "MISSED", p->others);
  printf("- until t = %.9g in %u steps, %.2f ms of CPU time, %.1f us a step\n", result->t_reached, result->steps,
      1e3 * seconds, 1e6 * seconds / result->steps);
  if (result->reason[0]) printf("- ended: %s\n", result->reason);
  for (size_t k = 1; k < w->next; k++) {
    printf("- widths at t = %g:", p->time[k]);
    for (size_t i = 0; i < w->nx; i++) printf(" %.4g", w->hi[k][i] - w->lo[k][i]);
    printf("\n");
  }
  printf("\n");
}

static void again(ambit_sink *sink) { ((watcher *)(void *)sink)->next = 1; }

static void run(const problem *p, const bench_arguments *arguments, ambit_registry *registry) {
  model m;
  p->build(&m);
  watcher w = { .sink = { sizeof(ambit_sink), watch, NULL }, .p = p, .nx = m.system.nx };
  ambit_option order = { "order", p->order };
  size_t ntime = p->ntime;
  while (p->time[ntime - 1] == 0) ntime--;
  const ambit_simulate_request q = { .system = &m.system,
    .registry = registry,
    .solver = "valencia",
    .arithmetic = p->arithmetic,
    .narithmetic_option = p->order != NULL,
    .arithmetic_option = &order,
    .nsolver_option = arguments->noption,
    .solver_option = arguments->option,
    .initial = m.initial,
    .ntime = ntime,
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
