/* lohner.c -- how tight and how fast the integrator is, on the problems that other validated integrators were measured with.
**
** Prints one table: widths and CPU seconds reached in this run, beside what CAPD 5, VNODE-LP and kv reach (measured side by side
** on two shared Zen 4 cores; reference digits: quadruple-precision Taylor series and Gragg-Bulirsch-Stoer, the Lorenz digits at
** t = 1 are those of the VNODE-LP report). Needs AMBIT_PATH to find the plugins.
** lohner [NAME [OPTION=VALUE ...]]: only the problem of that name, with options of the solver.
*/
#define _POSIX_C_SOURCE 200809L
#include "model/simulate.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define STATES 4
#define INSTANTS 16
#define REPEATS 5

typedef ambit_expr expr;

/* -- problems */

typedef struct model {
  ambit_graph *graph;
  ambit_failure failure;
  const char *name[STATES];
  expr state[STATES], rate[STATES], initial[STATES];
  ambit_system system;
} model;

static expr add(model *m, expr a, expr b) { return ambit_graph_op(m->graph, AMBIT_OP_ADD, a, b); }
static expr sub(model *m, expr a, expr b) { return ambit_graph_op(m->graph, AMBIT_OP_SUB, a, b); }
static expr mul(model *m, expr a, expr b) { return ambit_graph_op(m->graph, AMBIT_OP_MUL, a, b); }
static expr divide(model *m, expr a, expr b) { return ambit_graph_op(m->graph, AMBIT_OP_DIV, a, b); }
static expr sine(model *m, expr a) { return ambit_graph_op(m->graph, AMBIT_OP_SIN, a, a); }
static expr cosine(model *m, expr a) { return ambit_graph_op(m->graph, AMBIT_OP_COS, a, a); }
static expr square(model *m, expr a) { return ambit_graph_op(m->graph, AMBIT_OP_SQR, a, a); }
static expr number(model *m, double x) { return ambit_graph_number(m->graph, x); }
static expr decimal(model *m, const char *text) { return ambit_graph_decimal(m->graph, text, &m->failure); }

static void open_model(model *m, size_t nx, const char *const *name) {
  *m = (model) { .graph = ambit_graph_open() };
  for (size_t i = 0; i < nx; i++) {
    m->name[i] = name[i];
    m->state[i] = ambit_graph_symbol(m->graph, name[i], "1");
  }
  static const char *const unit[STATES] = { "1", "1", "1", "1" };
  m->system = (ambit_system) { m->graph, nx, m->name, unit, m->state, m->rate };
}

/* Relative angles and velocities; ValEncIA-IVP paper (Rauh, Auer & Hofer 2006), equations 23 to 25, solved for the accelerations. */
static void double_pendulum(model *m, const char *spread) {
  static const char *const name[] = { "psi1", "psi2", "psi1'", "psi2'" };
  open_model(m, 4, name);
  const expr *x = m->state;
  expr g = decimal(m, "9.81"), two = number(m, 2), s = sine(m, x[1]), c = cosine(m, x[1]);
  expr outer = square(m, add(m, x[2], x[3])), inner = square(m, x[2]);
  /* [2 c; c 1] (phi1'', phi2'') = (r1, r2), c the cosine of the relative angle */
  expr r1 = sub(m, mul(m, s, outer), mul(m, mul(m, two, g), sine(m, x[0])));
  expr r2 = sub(m, mul(m, sub(m, number(m, 0), g), sine(m, add(m, x[0], x[1]))), mul(m, s, inner));
  expr determinant = add(m, number(m, 1), square(m, s)); /* 2 - c^2 */
  expr a1 = divide(m, sub(m, r1, mul(m, c, r2)), determinant);
  expr a2 = divide(m, sub(m, mul(m, two, r2), mul(m, c, r1)), determinant);
  m->rate[0] = x[2], m->rate[1] = x[3], m->rate[2] = a1, m->rate[3] = sub(m, a2, a1);
  expr pi = ambit_graph_pi(m->graph);
  m->initial[0] = divide(m, mul(m, number(m, 3), pi), number(m, 4));
  if (spread) {
    expr factor = ambit_graph_unknown(m->graph, "spread", (ambit_interval) { -1, 1 });
    m->initial[0] = mul(m, m->initial[0], add(m, number(m, 1), mul(m, decimal(m, spread), factor)));
  }
  m->initial[1] = divide(m, mul(m, number(m, -11), pi), number(m, 20));
  m->initial[2] = decimal(m, "0.43"), m->initial[3] = decimal(m, "0.67");
}

static void wide_double_pendulum(model *m) { double_pendulum(m, "0.01"); }
static void point_double_pendulum(model *m) { double_pendulum(m, NULL); }

static void lorenz(model *m) {
  static const char *const name[] = { "x", "y", "z" };
  open_model(m, 3, name);
  const expr *x = m->state;
  m->rate[0] = mul(m, number(m, 10), sub(m, x[1], x[0]));
  m->rate[1] = sub(m, mul(m, x[0], sub(m, number(m, 28), x[2])), x[1]);
  m->rate[2] = sub(m, mul(m, x[0], x[1]), mul(m, decimal(m, "8/3"), x[2]));
  m->initial[0] = number(m, 15), m->initial[1] = number(m, 15), m->initial[2] = number(m, 36);
}

static void pendulum(model *m) {
  static const char *const name[] = { "phi", "phi'" };
  open_model(m, 2, name);
  m->rate[0] = m->state[1], m->rate[1] = sub(m, number(m, 0), sine(m, m->state[0]));
  m->initial[0] = number(m, 1), m->initial[1] = number(m, 0);
}

static void oscillator(model *m) {
  static const char *const name[] = { "x", "x'" };
  open_model(m, 2, name);
  m->rate[0] = m->state[1], m->rate[1] = sub(m, number(m, 0), m->state[0]);
  m->initial[0] = number(m, 1), m->initial[1] = number(m, 0);
}

static void van_der_pol(model *m) {
  static const char *const name[] = { "x", "x'" };
  open_model(m, 2, name);
  const expr *x = m->state;
  m->rate[0] = x[1], m->rate[1] = sub(m, mul(m, sub(m, number(m, 1), square(m, x[0])), x[1]), x[0]);
  m->initial[0] = number(m, 2), m->initial[1] = number(m, 0);
}

static void van_der_pol_box(model *m) {
  van_der_pol(m);
  m->initial[0] = ambit_graph_unknown(m->graph, "x0", (ambit_interval) { 1.25, 1.55 });
  m->initial[1] = ambit_graph_unknown(m->graph, "v0", (ambit_interval) { 2.35, 2.45 });
}

static void escape(model *m) {
  static const char *const name[] = { "x" };
  open_model(m, 1, name);
  m->rate[0] = square(m, m->state[0]);
  m->initial[0] = number(m, 1);
}

typedef struct problem {
  const char *name, *what, *peers;
  void (*build)(model *m);
  size_t ntime;
  double time[INSTANTS];
} problem;

static const problem problems[] = {
  { "P1", "double pendulum, first angle +-1 %", "CAPD ends at .603, kv at .618 to .684, VNODE at .538 to .566", wide_double_pendulum, 12,
      { 0, 0.1, 0.2, 0.3, 0.4, 0.42, 0.5, 0.504, 0.6, 0.62, 0.69, 1 } },
  { "P2", "double pendulum from a point", "t = 10: CAPD 1.2e-8 in .83 s, VNODE 2e-8 in 1.38 s, kv 1.9e-10 in 18 s", point_double_pendulum,
      4, { 0, 1, 5, 10 } },
  { "P3", "Lorenz", "t = 20: CAPD 5.9e-4 in .124 s, VNODE 1.2e-3 in .38 s, kv 8.1e-5 in 2.2 s", lorenz, 4, { 0, 1, 10, 20 } },
  { "P4", "Van der Pol, mu = 1, a box", "CAPD ends at 2.4, VNODE at 2.3, kv at 3.29", van_der_pol_box, 5, { 0, 1, 2, 3, 7 } },
  { "P4p", "Van der Pol, mu = 1, from (2, 0)", "-", van_der_pol, 3, { 0, 10, 20 } },
  { "P6", "pendulum", "t = 100: CAPD 3.3e-12 in .054 s, VNODE 4e-12 in .126 s, kv 8.5e-13 in 2.2 s", pendulum, 2, { 0, 100 } },
  { "P6l", "x'' = -x", "t = 100: CAPD 4e-14 in 1.2 ms", oscillator, 2, { 0, 100 } },
  { "esc", "x' = x^2 from 1, escapes at t = 1", "-", escape, 2, { 0, 2 } },
};

/* -- a run */

typedef struct watcher {
  ambit_sink sink; /* first */
  const problem *p;
  size_t next, nx;
  double at[INSTANTS], lo[INSTANTS][STATES], hi[INSTANTS][STATES], below; /* below: last time under 1e-3 */
} watcher;

static int32_t watch(ambit_sink *sink, const ambit_record *r) {
  watcher *w = (watcher *)(void *)sink;
  double widest = 0;
  for (size_t i = 0; i < r->nx; i++) widest = fmax(widest, r->hi[i] - r->lo[i]);
  if (widest < 1e-3) w->below = r->t_to;
  if (w->next >= w->p->ntime || r->t_to != w->p->time[w->next]) return 0;
  memcpy(w->lo[w->next], r->lo, r->nx * sizeof(double));
  memcpy(w->hi[w->next], r->hi, r->nx * sizeof(double));
  w->next++;
  return 0;
}

static void run(const problem *p, size_t noption, const ambit_option *option, ambit_registry *registry) {
  model m;
  p->build(&m);
  watcher w = { 0 };
  ambit_simulate_result result = { 0 };
  double best = INFINITY;
  for (int i = 0; i < REPEATS; i++) {
    w = (watcher) { .sink = { sizeof(ambit_sink), watch, NULL }, .p = p, .next = 1 };
    const ambit_simulate_request q = { .system = &m.system, .registry = registry, .solver = "lohner", .nsolver_option = noption,
      .solver_option = option, .initial = m.initial, .ntime = p->ntime, .time = p->time, .sink = &w.sink };
    if (ambit_simulate(&q, &result, NULL, &m.failure) != AMBIT_OK) {
      fprintf(stderr, "%s: %s\n", p->name, m.failure.message);
      exit(1);
    }
    best = fmin(best, result.cpu_seconds);
  }
  printf("%s  %s\n    peers: %s\n", p->name, p->what, p->peers);
  printf("    to t = %.6g in %u steps, %.2f ms, %.1f us a step; width under 1e-3 until %.4g%s%s\n", result.t_reached, result.steps,
      1e3 * best, 1e6 * best / result.steps, w.below, result.reason[0] ? "\n    ended: " : "", result.reason);
  for (size_t k = 1; k < w.next; k++) {
    printf("    t = %-6g widths", p->time[k]);
    for (size_t i = 0; i < m.system.nx; i++) printf(" %.4g", w.hi[k][i] - w.lo[k][i]);
    printf("\n");
  }
  ambit_graph_close(m.graph);
}

int main(int argc, char **argv) {
  ambit_option option[16];
  size_t noption = 0;
  for (int i = 2; i < argc && noption < 16; i++) {
    char *equal = strchr(argv[i], '=');
    if (!equal) continue;
    *equal = '\0';
    option[noption++] = (ambit_option) { argv[i], equal + 1 };
  }
  ambit_registry *registry = ambit_registry_open(NULL);
  for (size_t i = 0; i < sizeof problems / sizeof *problems; i++)
    if (argc < 2 || strcmp(argv[1], problems[i].name) == 0) run(&problems[i], noption, option, registry);
  ambit_registry_close(registry);
  return 0;
}
