/* stiff.c -- how far, how tight and how fast the stiff integrator is, on published stiff problems.
**
** Prints times, widths relative to each state and CPU seconds reached in this run, beside what is required. That the
** enclosures hold the reference solutions is shown by tests/plugins/test_solver_stiff_figures.c; here a miss of the
** digits below is reported too. Needs AMBIT_PATH to find the plugins. stiff [NAME [OPTION=VALUE ...]]: only the problem
** of that name, with options of the solver.
*/
#define _POSIX_C_SOURCE 200809L
#include "../tests/kit/stiff_models.h"
#include "solver_bench.h"

#define REPEATS 3
#define STATES 24

typedef struct problem {
  const char *name, *what;
  void (*build)(model *m);
  double from, to, seconds, width; /* required: complete within these CPU seconds and this relative width */
  double digits[STATES];           /* at the end; 0: not known */
} problem;

static void van_der_pol_1e3(model *m) { model_relaxation(m, "1000"); }
static void van_der_pol_1e4(model *m) { model_relaxation(m, "10000"); }
static void van_der_pol_1e5(model *m) { model_relaxation(m, "100000"); }
static void van_der_pol_eps6(model *m) { model_scaled_relaxation(m, "1e-6"); }
static void van_der_pol_eps10(model *m) { model_scaled_relaxation(m, "1e-10"); }
static void robertson_one_percent(model *m) { model_spread_robertson(m, "0.01"); }
static void robertson_small_spread(model *m) { model_spread_robertson(m, "1e-5"); }

static void robertson_ten_percent(model *m) { model_spread_robertson(m, "0.1"); }

/* x(0) in 2 +- radius */
static void van_der_pol_set(model *m, const char *radius) {
  model_relaxation(m, "1000");
  expr xi = ambit_graph_unknown(m->graph, "xi", (ambit_interval) { -1, 1 });
  m->initial[0] = add(m, number(m, 2), term(m, radius, xi));
}

static void van_der_pol_1e_10(model *m) { van_der_pol_set(m, "1e-10"); }
static void van_der_pol_3e_8(model *m) { van_der_pol_set(m, "3e-8"); }

static const problem problems[] = {
  { "vdp3", "Van der Pol, mu = 1000", van_der_pol_1e3, 0, 2000, 0.3, 2e-8,
      { 1.7061677321704650, -8.9280970102481655e-4 } },
  { "vdp6", "Van der Pol, eps = 1e-6", van_der_pol_eps6, 0, 2, 0.3, 2e-8,
      { 1.7061677321704650, -0.89280970102481655 } },
  { "vdp4", "Van der Pol, mu = 1e4, a period", van_der_pol_1e4, 0, 16200, 1, 1e-4, { 0 } },
  { "vdp5", "Van der Pol, mu = 1e5, a period", van_der_pol_1e5, 0, 161500, INFINITY, 1e-5, { 0 } },
  { "vdp10", "Van der Pol, eps = 1e-10, a period", van_der_pol_eps10, 0, 1.615, INFINITY, 1e-2, { 0 } },
  { "cosine", "y' = -1000 (y - cos t)", model_stiff_cosine, 0, 2000, 0.1, 1e-9, { 0 } },
  { "rober9", "Robertson to 1e9", model_point_robertson, 0, 1e9, 0.1, 1e-4, { 0 } },
  { "rober11", "Robertson to 1e11", model_point_robertson, 0, 1e11, 1, 1e-4,
      { 2.0833401497012942e-08, 8.3333607703347834e-14, 0.99999997916651517 } },
  { "rober1", "Robertson, all rates +-1 %, to 1e4", robertson_one_percent, 0, 1e4, INFINITY, 0.1, { 0 } },
  { "rober0", "Robertson, all rates +-1e-5, to 1e4", robertson_small_spread, 0, 1e4, INFINITY, INFINITY, { 0 } },
  { "rober10", "Robertson, all rates +-10 %, to 1e4", robertson_ten_percent, 0, 1e4, INFINITY, INFINITY, { 0 } },
  { "vdp3r", "Van der Pol, x(0) = 2 +- 1e-10", van_der_pol_1e_10, 0, 2000, INFINITY, INFINITY, { 0 } },
  { "vdp3s", "Van der Pol, x(0) = 2 +- 3e-8", van_der_pol_3e_8, 0, 2000, INFINITY, INFINITY, { 0 } },
  { "hires", "HIRES", model_hires, 0, 321.8122, 0.3, 1e-8,
      { 7.371312573325667807277e-04, 1.442485726316184658188e-04, 5.888729740967575007484e-05,
          1.175651343283149145506e-03, 2.386356198831330468821e-03, 6.238968252742795786648e-03,
          2.849998395185768657930e-03, 2.850001604814231342070e-03 } },
  { "orego", "OREGO", model_oregonator, 0, 360, 0.3, 1e-8,
      { 1.0008148703185227163, 1228.1785215498879837, 132.05549428465082877 } },
  { "heat", "heat equation, 24 states", model_heat, 0, 1, INFINITY, INFINITY, { 0 } },
  { "escape", "x' = x^2 from 1, escapes at t = 1", model_escape, 0, 2, INFINITY, INFINITY, { 0 } },
  { "pendulum", "pendulum to 100", model_pendulum, 0, 100, INFINITY, INFINITY, { 0 } },
  { "lorenz", "Lorenz to 10", model_lorenz, 0, 10, INFINITY, INFINITY, { 0 } },
  { "double", "double pendulum to 5", model_point_double_pendulum, 0, 5, INFINITY, INFINITY, { 0 } },
};

typedef struct watcher {
  ambit_sink sink; /* first */
  size_t nx;
  double lo[STATES], hi[STATES];
} watcher;

static int32_t watch(ambit_sink *sink, const ambit_record *r) {
  watcher *w = (watcher *)(void *)sink;
  w->nx = r->nx;
  memcpy(w->lo, r->lo, r->nx * sizeof(double));
  memcpy(w->hi, r->hi, r->nx * sizeof(double));
  return 0;
}

static void report(const problem *p, const watcher *w, const ambit_simulate_result *result, double seconds) {
  double widest = 0;
  int misses = 0;
  for (size_t i = 0; i < w->nx; i++) {
    widest = fmax(widest, (w->hi[i] - w->lo[i]) / fmax(fabs(w->lo[i]), fabs(w->hi[i])));
    double slack = 1e-15 * fabs(p->digits[i]);
    misses += result->t_reached == p->to && p->digits[i] != 0 &&
              (w->lo[i] > p->digits[i] + slack || w->hi[i] < p->digits[i] - slack);
  }
  int demanded = p->seconds < INFINITY || p->width < INFINITY;
  int reached = result->t_reached == p->to && seconds <= p->seconds && widest <= p->width;
  printf("%-9s %-36s t = %-12.9g %5u steps %9.4f s (required %g)  relative width %.2g (%g)  %s%s\n", p->name, p->what,
      result->t_reached, result->steps, seconds, p->seconds, widest, p->width,
      !demanded ? "measured"
      : reached ? "reached"
                : "MISSED",
      misses ? " DIGITS MISSED" : "");
  if (result->reason[0]) printf("          ended: %s\n", result->reason);
}

static void again(ambit_sink *sink) { ((watcher *)(void *)sink)->nx = 0; }

static void run(const problem *p, const bench_arguments *arguments, ambit_registry *registry) {
  model m;
  p->build(&m);
  const double time[] = { p->from, p->to };
  watcher w = { .sink = { sizeof(ambit_sink), watch, NULL } };
  const ambit_simulate_request q = { .system = &m.system,
    .registry = registry,
    .solver = "stiff",
    .nsolver_option = arguments->noption,
    .solver_option = arguments->option,
    .initial = m.initial,
    .ntime = 2,
    .time = time,
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
