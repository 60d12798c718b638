/* scene.h -- what the tests of the verbs share: a registry that also finds the test plugins, and a small system. */
#ifndef AMBIT_TEST_SCENE_H
#define AMBIT_TEST_SCENE_H
#include <ambit/simulate.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SCENE_STATES 4

typedef struct scene {
  ambit_graph *graph;
  ambit_registry *registry;
  char note[256]; /* the last one */
  const char *name[SCENE_STATES], *unit[SCENE_STATES];
  ambit_expr state[SCENE_STATES], rate[SCENE_STATES], initial[SCENE_STATES];
  ambit_system system;
} scene;

static inline void scene_keep_note(void *user, const char *line) {
  snprintf(((scene *)user)->note, sizeof((scene *)user)->note, "%s", line);
}

/* Search path: the test plugins, then the build's. */
static inline scene *scene_open(void) {
  scene *s = calloc(1, sizeof *s);
  s->graph = ambit_graph_open();
  s->registry = ambit_registry_open(AMBIT_BROKEN_DIR);
  ambit_registry_set_note(s->registry, scene_keep_note, s);
  s->system = (ambit_system) {
    .graph = s->graph, .nx = 0, .name = s->name, .unit = s->unit, .state = s->state, .rate = s->rate
  };
  return s;
}

static inline void scene_close(scene *s) {
  ambit_graph_close(s->graph);
  ambit_registry_close(s->registry);
  free(s);
}

/* A state at rest; set rate[] and initial[] of the returned index as wanted. */
static inline size_t scene_state(scene *s, const char *name, ambit_expr initial) {
  size_t i = s->system.nx++;
  s->name[i] = name;
  s->unit[i] = "1";
  s->state[i] = ambit_graph_symbol(s->graph, name, "1");
  s->rate[i] = ambit_graph_number(s->graph, 0);
  s->initial[i] = initial;
  return i;
}

static inline ambit_expr scene_unknown(scene *s, const char *name, double lo, double hi) {
  return ambit_graph_unknown(s->graph, name, (ambit_interval) { lo, hi });
}

static inline ambit_simulate_request scene_request(
    const scene *s, const char *solver, size_t ntime, const double *time) {
  return (ambit_simulate_request) {
    .system = &s->system, .registry = s->registry, .solver = solver, .initial = s->initial, .ntime = ntime, .time = time
  };
}
#endif
