/* dynamics.c -- what equations of motion cost: N-link chains in both forms (seconds to build, operations), and forward
** dynamics of two arms (time per evaluation: batches of 64, one at a time).
*/
#include "../tests/kit/robot_models.h"
#include "verbs/sample/batch.h"
#include "graph/tape.h"
#include "mechanics/forward.h"
#include "plugin.h"

#define JOINTS_MAX 300
#define LANES 64
#define PASSES 400

typedef struct written {
  size_t n, operations;
  double seconds;
  ambit_forward forward;
} written;

/* operations 0: the form does not fit */
static written write_form(robot *r, uint32_t form, ambit_arena *arena) {
  written w = { 0 };
  ambit_failure f = { 0 };
  double start = bench_now();
  ambit_status status = ambit_forward_build(r->mechanism, form, true, arena, &w.forward, &f);
  w.seconds = 1e-9 * (bench_now() - start);
  if (status == AMBIT_OK) {
    w.n = w.forward.variables.n;
    w.operations = ambit_graph_size(r->graph, w.n, w.forward.du);
  } else
    fprintf(stderr, "%s\n", f.message);
  return w;
}

static void chain_row(int n, int spatial) {
  static const uint32_t forms[] = { AMBIT_FORM_ARTICULATED, AMBIT_FORM_MASS_MATRIX };
  printf("| %s | %d |", spatial ? "space" : "plane", n);
  for (int k = 0; k < 2; k++) {
    if (k == 1 && n > 16) {
      printf(" | |");
      continue;
    }
    ambit_arena *arena = ambit_arena_open();
    robot r = robot_chain(n, spatial);
    written w = write_form(&r, forms[k], arena);
    printf(" %.4f | %zu |", w.seconds, w.operations);
    robot_close(&r);
    ambit_arena_close(arena);
  }
  printf("\n");
  fflush(stdout);
}

static void chains(void) {
  static const int links[] = { 1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 32, 100, 200, JOINTS_MAX };
  printf("## Chains\n\n| chain | N | articulated, s | operations | mass matrix, s | operations "
         "|\n|---|---|---|---|---|---|\n");
  for (int spatial = 0; spatial < 2; spatial++)
    for (size_t i = 0; i < sizeof links / sizeof *links; i++) chain_row(links[i], spatial);
  printf("\n");
}

/* -- evaluation */

static double batch_seconds(const bench_arithmetic *b, const ambit_tape *t) {
  size_t in = (size_t)t->nin * LANES, out = (size_t)t->nout * LANES;
  double *x = malloc(in * sizeof *x), *lo = malloc(out * sizeof *lo), *hi = malloc(out * sizeof *hi), best = 1e18;
  ambit_batch *batch = NULL;
  if (!x || !lo || !hi || ambit_batch_open(t, &b->full, b->ctx, &batch, NULL) != AMBIT_OK) exit(1);
  for (size_t i = 0; i < in; i++) x[i] = (double)(i % 97) / 50 - 1;
  for (int pass = 0; pass < PASSES; pass++) {
    double start = bench_now();
    ambit_batch_run(batch, LANES, x, x, NULL, lo, hi);
    double each = (bench_now() - start) / LANES;
    if (each < best) best = each;
  }
  ambit_batch_close(batch);
  free(x), free(lo), free(hi);
  return 1e-9 * best;
}

static double single_seconds(const bench_arithmetic *b, const ambit_tape *t) {
  ambit_block *block = NULL;
  double best = 1e18;
  if (ambit_block_open(t, &b->full, b->ctx, 1, &block, NULL) != AMBIT_OK) exit(1);
  for (int pass = 0; pass < 20 * PASSES; pass++) {
    double start = bench_now();
    for (uint32_t i = 0; i < t->nin; i++) {
      double x = (double)((i + (uint32_t)pass) % 97) / 50 - 1;
      ambit_block_set(block, i, 0, (ambit_interval) { x, x }, -1);
    }
    ambit_block_run(block);
    for (uint32_t i = 0; i < t->nout; i++) ambit_block_get(block, i, 0);
    double each = bench_now() - start;
    if (each < best) best = each;
  }
  ambit_block_close(block);
  return 1e-9 * best;
}

static void arm_rows(
    robot r, const char *name, const bench_arithmetic *arithmetic, const char *const *arithmetic_name) {
  static const struct {
    uint32_t form;
    const char *name;
  } forms[] = { { AMBIT_FORM_MASS_MATRIX, "mass matrix" }, { AMBIT_FORM_ARTICULATED, "articulated" } };
  for (int k = 0; k < 2; k++) {
    ambit_arena *arena = ambit_arena_open();
    written w = write_form(&r, forms[k].form, arena);
    ambit_expr in[3 * ROBOT_JOINTS];
    const ambit_variables *v = &w.forward.variables;
    for (size_t i = 0; i < w.n; i++)
      in[i] = v->coordinate[i].q, in[w.n + i] = v->u[i], in[2 * w.n + i] = w.forward.force[i];
    const ambit_tape *t = NULL;
    ambit_failure f = { 0 };
    if (ambit_tape_seal(r.graph, arena, w.n, w.forward.du, 3 * w.n, in, 0, 0, &t, &f) != AMBIT_OK) {
      fprintf(stderr, "%s\n", f.message);
      exit(1);
    }
    for (int a = 0; a < 2; a++)
      printf("| %s | %s | %.4f | %u | %s | %.2f | %.2f |\n", name, forms[k].name, w.seconds, t->ninstr,
          arithmetic_name[a], 1e6 * batch_seconds(&arithmetic[a], t), 1e6 * single_seconds(&arithmetic[a], t));
    ambit_arena_close(arena);
  }
  robot_close(&r);
}

int main(void) {
  static const char *const name[] = { "real", "interval" };
  ambit_registry *registry = ambit_registry_open(NULL);
  bench_arithmetic arithmetic[] = { bench_open(registry, name[0], AMBIT_ARITHMETIC),
    bench_open(registry, name[1], AMBIT_ARITHMETIC) };
  chains();
  printf(
      "## Forward dynamics\n\nRequired of the UR5: 1.3 us in `real` and 8 us in `interval` in batches of 64, 4 us in "
      "`real` for a single one.\n\n| arm | form | built in s | operations | arithmetic | us, batch | us, single "
      "|\n|---|---|---|---|---|---|---|\n");
  arm_rows(robot_ur5(), "UR5", arithmetic, name);
  arm_rows(robot_puma560(), "Puma 560", arithmetic, name);
  bench_close(&arithmetic[0]), bench_close(&arithmetic[1]);
  ambit_registry_close(registry);
  return 0;
}
