/* The plugin `reduction` on a ladder of 50 stages whose every summand may go; a proof is played by integrating the
** reduced model (classical Runge-Kutta), so that errors interact as they do: what each strategy costs in proofs. */
#include "reduction_case.h"

#define STAGES 50
#define KINDS 5 /* summands of each stage: from before, its own, from behind, leak, cubic leak */
#define NODES 201
#define STEP 0.25

typedef struct ladder {
  reduction_case *c;
  char name[STAGES][8];
  double weight[STAGES][KINDS];
  double *x, *time; /* [NODES x STAGES] */
  uint32_t candidate[STAGES][KINDS];
} ladder;

static double value(const double *x, uint32_t i, uint32_t kind) {
  switch (kind) {
  case 0: return i ? x[i - 1] : 1;
  case 1: return x[i];
  case 2: return i + 1 < STAGES ? x[i + 1] : 0;
  case 3: return x[i];
  default: return x[i] * x[i] * x[i];
  }
}

static void rates(const ladder *l, const uint8_t *cut, const double *x, double *f) {
  for (uint32_t i = 0; i < STAGES; i++) {
    f[i] = 0;
    for (uint32_t k = 0; k < KINDS; k++)
      if (!cut[l->candidate[i][k]]) f[i] += l->weight[i][k] * value(x, i, k);
  }
}

/* the reference with nothing cut, else the greatest error of the output over its times */
static double integrate(const ladder *l, const uint8_t *cut, double *keep) {
  double x[STAGES] = { 0 }, at[STAGES], f[4][STAGES], worst = 0;
  static const double part[4] = { 0, 0.5, 0.5, 1 };
  for (uint32_t j = 0; j < NODES; j++) {
    if (keep) memcpy(keep + j * STAGES, x, sizeof x);
    double error = fabs(x[9] - l->x[j * STAGES + 9]);
    worst = isfinite(error) ? fmax(worst, error) : INFINITY;
    for (int n = 0; n < 2; n++) {
      for (int s = 0; s < 4; s++) {
        for (uint32_t i = 0; i < STAGES; i++) at[i] = x[i] + (s ? part[s] * STEP * f[s - 1][i] : 0);
        rates(l, cut, at, f[s]);
      }
      for (uint32_t i = 0; i < STAGES; i++) x[i] += STEP / 6 * (f[0][i] + 2 * f[1][i] + 2 * f[2][i] + f[3][i]);
    }
  }
  return worst;
}

static ambit_status prove(void *user, uint32_t how, const uint8_t *cut, double *error) {
  ladder *l = user;
  (void)how;
  error[0] = integrate(l, cut, NULL);
  return isfinite(error[0]) ? AMBIT_OK : AMBIT_UNABLE;
}

static ladder *make(void) {
  ladder *l = calloc(1, sizeof *l);
  reduction_case *c = l->c = case_open();
  for (uint32_t i = 0; i < STAGES; i++) {
    snprintf(l->name[i], sizeof l->name[i], "u%u", i);
    case_state(c, l->name[i]);
  }
  const double leak = 1e-5;
  for (uint32_t i = 0; i < STAGES; i++)
    for (uint32_t k = 0; k < KINDS; k++) {
      static const double weight[KINDS] = { 1, -2, 1, -1, -1 };
      double size = k < 3 ? 1 : leak * pow(10, 0.06 * ((7 * i + 13 * k) % STAGES));
      ambit_expr e = k == 0   ? i ? c->x[i - 1] : case_number(c, 1)
                       : k == 2 ? i + 1 < STAGES ? c->x[i + 1] : 0
                     : k == 4 ? ambit_graph_pown(c->graph, c->x[i], 3)
                              : c->x[i];
      l->weight[i][k] = weight[k] * size;
      l->candidate[i][k] = case_term(c, i, case_times(c, l->weight[i][k], e));
    }
  case_output(c, "u9", c->x[9], 0.02);
  l->x = calloc(NODES * STAGES, sizeof *l->x), l->time = calloc(NODES, sizeof *l->time);
  const uint8_t none[CASE_CANDIDATES] = { 0 };
  for (uint32_t j = 0; j < NODES; j++) l->time[j] = 2 * STEP * j;
  double *x = calloc(NODES * STAGES, sizeof *x);
  integrate(l, none, x);
  memcpy(l->x, x, NODES * STAGES * sizeof *x);
  free(x);
  c->reference[0] = (ambit_reduction_reference) { 0, NODES, l->time, l->x, l->time };
  c->nreference = 1;
  c->prove = prove, c->of_proof = l;
  return l;
}

static void dispose(ladder *l) {
  case_close(l->c);
  free(l->x), free(l->time), free(l);
}

static uint32_t proofs_with(
    ladder *l, const char *ranking, const char *cluster, const char *strategy, const char *give_up, uint32_t *cuts) {
  reduction_case *c = l->c;
  c->noption = 0;
  case_set(c, "ranking", ranking), case_set(c, "cluster", cluster);
  case_set(c, "strategy", strategy), case_set(c, "give_up", give_up);
  case_must_run(c);
  *cuts = 0;
  for (uint32_t k = 0; k < c->ncandidate; k++) *cuts += c->cut[k];
  assert_true(integrate(l, c->cut, NULL) <= c->bound[0]);
  return c->result.proofs;
}

static void clusters_save_proofs_and_cut_as_much(void **state) {
  static const char *const ranking[] = { "residual", "one_step", "adjoint" };
  (void)state;
  ladder *l = make();
  uint32_t cuts, alone, by_residual, by_adjoint;
  for (int i = 0; i < 3; i++) {
    assert_int_equal(proofs_with(l, ranking[i], "1", "clusters", "inf", &alone), STAGES * KINDS);
    assert_true(proofs_with(l, ranking[i], "10", "clusters", "inf", &cuts) < STAGES * KINDS * 3 / 4);
    assert_true(cuts >= alone);
    assert_true(cuts > 3 * STAGES);
    *(i ? &by_adjoint : &by_residual) = proofs_with(l, ranking[i], "10", "clusters", "10", &cuts);
    assert_true(cuts >= alone);
  }
  assert_true(5 * by_adjoint <= STAGES * KINDS && by_adjoint < by_residual);
  uint32_t predicted = proofs_with(l, "adjoint", "10", "predicted", "10", &cuts);
  assert_true(10 * predicted <= STAGES * KINDS && cuts >= alone);
  dispose(l);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(clusters_save_proofs_and_cut_as_much),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
