// hinge.cpp -- a C++ program that hosts Ambit: a hinge that turns freely with a mass on an arm. From 0.5 rad at 1 rad/s it is at
// 1.5 rad after 1 s.
#include <ambit/dynamics.h>
#include <ambit/simulate.h>
#include <cstdio>

static ambit_record last;
static double lo[2], hi[2];

static int32_t emit(ambit_sink *, const ambit_record *r) {
  last = *r;
  for (int i = 0; i < 2; i++) lo[i] = r->lo[i], hi[i] = r->hi[i];
  return 0;
}

static int32_t progress(ambit_sink *, double, const char *) { return 0; }

struct Host {
  ambit_failure f = {};
  ambit_graph *g = ambit_graph_open();
  ambit_registry *r = ambit_registry_open(nullptr);
  ambit_arena *arena = ambit_arena_open();
  ambit_mechanism *m = ambit_mechanism_open(g, "hinge");

  ~Host() {
    ambit_mechanism_close(m);
    ambit_arena_close(arena);
    ambit_registry_close(r);
    ambit_graph_close(g);
  }

  // Adds an element whose first frame is `at`; its next one is returned.
  ambit_frame add(const char *type, const ambit_expr *const *param, ambit_frame at) {
    const ambit_element *element = nullptr;
    const ambit_frame connection[] = { at, AMBIT_NOWHERE, AMBIT_NOWHERE };
    if (ambit_registry_element(r, type, &element, &f) != AMBIT_OK) return AMBIT_NOWHERE;
    ambit_part_spec spec = { element, type, type, "hinge.cpp", param, connection, nullptr };
    uint32_t part = 0;
    return ambit_mechanism_add(m, &spec, &part, &f) == AMBIT_OK ? ambit_frame { part, 1 } : AMBIT_NOWHERE;
  }

  bool build(ambit_system *system) {
    const ambit_expr zero = ambit_graph_number(g, 0), one = ambit_graph_number(g, 1);
    const ambit_expr axis[] = { zero, zero, one }, offset[] = { one, zero, zero };
    const ambit_expr *const hinge[] = { axis, nullptr }, *const arm[] = { offset, nullptr, nullptr }, *const mass[] = { &one };
    ambit_frame tip = add("rigid_link", arm, add("revolute", hinge, AMBIT_WORLD));
    add("point_mass", mass, tip);
    return f.status == AMBIT_OK && ambit_constrained_system(m, AMBIT_FORM_AUTO, arena, system, &f) == AMBIT_OK;
  }
};

int main() {
  Host host;
  ambit_system system = {};
  ambit_simulate_result result = {};
  ambit_sink sink = { sizeof sink, emit, progress };
  const double time[] = { 0, 1 };
  if (!host.build(&system)) return std::fprintf(stderr, "%s\n", host.f.message), 1;
  const ambit_expr initial[] = { ambit_graph_unknown(host.g, "angle", ambit_interval { 0.49, 0.51 }),
    ambit_graph_number(host.g, 1) };
  ambit_simulate_request q = {};
  q.system = &system;
  q.registry = host.r;
  q.solver = "lohner";
  q.initial = initial;
  q.ntime = 2;
  q.time = time;
  q.sink = &sink;
  if (ambit_simulate(&q, &result, nullptr, &host.f) != AMBIT_OK) return std::fprintf(stderr, "%s\n", host.f.message), 1;
  std::printf("%s: %s in [%.17g, %.17g] at %g s\n", ambit_status_name(result.status), system.name[0], lo[0], hi[0], last.t_to);
  const bool right = lo[0] <= 1.49 && lo[0] > 1.48 && hi[0] >= 1.51 && hi[0] < 1.52;
  return result.status == AMBIT_OK && result.rigorous && right ? 0 : 1;
}
