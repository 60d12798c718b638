/* Stops, limits, nasty ranks and bad requests of the plugin `reduction`; and plugins that claim what was not proved. */
#include "reduction_case.h"

/* -- stops */

static void a_stop_leaves_what_was_accepted(void **state) {
  (void)state;
  double rank[6] = { 1e-5, 1e-4 * 1.01, 1e-3 * 1.1, 0.02, 0.3, 4 };
  for (uint32_t at = 1; at <= 6; at++) {
    reduction_case *c = case_ranked(6, rank);
    c->stop_at = at;
    case_must_run(c);
    assert_int_equal(c->result.status, AMBIT_STOPPED);
    assert_int_equal(c->ntry, at - 1);
    for (uint32_t k = 0; k < 6; k++) assert_int_equal(c->cut[k], k + 1 < at);
    assert_non_null(strstr(c->result.reason, "stopped on request"));
    c->stop_at = 0, c->stop_progress = at;
    case_must_run(c);
    assert_int_equal(c->result.status, AMBIT_STOPPED);
    case_close(c);
  }
}

static void proofs_are_limited(void **state) {
  (void)state;
  double rank[6] = { 1e-5, 1e-4 * 1.01, 1e-3 * 1.1, 0.02, 0.3, 4 };
  reduction_case *c = case_ranked(6, rank);
  case_set(c, "proofs_max", "4");
  case_must_run(c);
  assert_int_equal(c->result.status, AMBIT_STOPPED);
  assert_int_equal(c->calls, 4);
  assert_non_null(strstr(c->result.reason, "raise `proofs_max`"));
  assert_true(c->cut[3] && !c->cut[4]);
  case_set(c, "proofs_max", "6");
  case_must_run(c);
  assert_int_equal(c->result.status, AMBIT_OK);
  case_set(c, "ranking", "exact"); /* its proofs count as well */
  case_must_run(c);
  assert_int_equal(c->result.status, AMBIT_STOPPED);
  assert_int_equal(c->ranked[AMBIT_RANK_EXACT], 1);
  assert_int_equal(c->cut[0], 0);
  case_close(c);
}

/* -- nasty ranks */

static void undefined_effects_come_last(void **state) {
  (void)state;
  double rank[6] = { 5, 0, 1, 0, 2, 3 };
  reduction_case *c = case_ranked(6, rank);
  c->effect[0] = ambit_graph_op(c->graph, AMBIT_OP_LOG, case_times(c, -1, c->x[0]), 0);  /* nowhere on (0, 1] */
  c->effect[4] = ambit_graph_op(c->graph, AMBIT_OP_EXP, case_times(c, 1e4, c->x[0]), 0); /* too large */
  case_set(c, "cluster", "2");
  case_must_run(c);
  assert_int_equal(c->ntry, 4);
  const uint32_t expected[] = { 1, 3, 2, 5, 0, 4 }, sizes[] = { 2, 1, 1, 2 };
  assert_memory_equal(c->all, expected, sizeof expected);
  for (uint32_t i = 0; i < 4; i++) assert_int_equal(c->decision[i].n, sizes[i]);
  assert_true(isinf(c->rank[AMBIT_RANK_RESIDUAL][0]) && isinf(c->rank[AMBIT_RANK_RESIDUAL][4]));
  case_close(c);
}

static void ends_of_the_range(void **state) {
  (void)state;
  double rank[CASE_CANDIDATES] = { 0 };
  reduction_case *c = case_ranked(0, rank);
  case_must_run(c);
  assert_int_equal(c->result.status, AMBIT_OK);
  assert_int_equal(c->calls, 0);
  c->candidate[0] = "one without an effect", c->ncandidate = 1;
  for (uint32_t i = 0; i < 3; i++) {
    case_set(c, "ranking", i == 0 ? "residual" : i == 1 ? "one_step" : "adjoint");
    case_must_run(c);
    assert_true(c->cut[0] && c->calls == 1);
  }
  case_close(c);
  c = case_ranked(CASE_CANDIDATES, rank); /* all 0: one cluster */
  case_must_run(c);
  assert_int_equal(c->calls, 1);
  for (uint32_t k = 0; k < CASE_CANDIDATES; k++) assert_int_equal(c->cut[k], 1);
  for (uint32_t k = 0; k < CASE_CANDIDATES; k++) c->error[k][0] = 2; /* nothing can go */
  case_must_run(c);
  assert_int_equal(c->calls, 2 * CASE_CANDIDATES - 1);
  for (uint32_t k = 0; k < CASE_CANDIDATES; k++) assert_int_equal(c->cut[k], 0);
  case_close(c);
}

/* -- bad requests */

static void assert_refused(reduction_case *c, ambit_status status, const char *part) {
  assert_int_equal(case_run(c), status);
  if (!strstr(c->failure.message, part)) fail_msg("expected `%s`: %s", part, c->failure.message);
}

static void bad_requests_are_refused(void **state) {
  (void)state;
  static const double times[2] = { 0, 1 }, descending[2] = { 1, 0 }, holes[2] = { 0, NAN };
  double rank[2] = { 1, 2 };
  reduction_case *c = case_ranked(2, rank);
  c->bound[0] = 0;
  assert_refused(c, AMBIT_INVALID, "bound of output `x` must be greater than 0");
  c->bound[0] = NAN;
  assert_refused(c, AMBIT_INVALID, "bound of output `x` must be greater than 0");
  c->bound[0] = 1;
  c->reference[0].time = descending;
  assert_refused(c, AMBIT_INVALID, "do not ascend");
  c->reference[0] = (ambit_reduction_reference) { 0, 2, times, holes, times };
  assert_refused(c, AMBIT_INVALID, "not finite");
  c->reference[0] = (ambit_reduction_reference) { 0, 0, times, times, times };
  assert_refused(c, AMBIT_INVALID, "has no times");
  c->reference[0].ntime = 1, c->reference[0].x = times;
  case_set(c, "ranking", "adjoint");
  assert_refused(c, AMBIT_INVALID, "single points");
  c->nreference = 0;
  assert_refused(c, AMBIT_INVALID, "no reference solutions");
  c->reference[0].ntime = 2, c->nreference = 1;
  c->effect_state[1] = 7;
  assert_refused(c, AMBIT_INVALID, "effect 2 changes the rate of state 8, but there are 1");
  c->effect_state[1] = 0, c->effect_candidate[1] = 2;
  assert_refused(c, AMBIT_INVALID, "effect 2 is of candidate 3, but there are 2");
  c->effect_candidate[1] = 1;
  c->effect[1] = ambit_graph_symbol(c->graph, "stranger", "1");
  assert_refused(c, AMBIT_INVALID, "stranger");
  c->effect[1] = 0;
  case_set(c, "cluster", "0.5");
  assert_refused(c, AMBIT_INVALID, "`cluster` must be 1 or greater");
  case_set(c, "cluster", "10"), case_set(c, "proofs_max", "0");
  assert_refused(c, AMBIT_INVALID, "`proofs_max` must be 1 or greater");
  case_set(c, "proofs_max", "10"), case_set(c, "ends", "0");
  assert_refused(c, AMBIT_INVALID, "`ends` must be between");
  case_set(c, "ends", "4"), case_set(c, "give_up", "0.5");
  assert_refused(c, AMBIT_INVALID, "`give_up` must be 1 or greater");
  case_set(c, "give_up", "10"), case_set(c, "strategy", "predicted"), case_set(c, "ranking", "residual");
  assert_refused(c, AMBIT_INVALID, "needs a `ranking` relative to the bounds");
  c->solver = "krawczyk";
  assert_refused(c, AMBIT_INVALID, "solver `krawczyk` finds roots; it does not choose");
  c->solver = "lohner";
  assert_refused(c, AMBIT_INVALID, "what does: `reduction`");
  c->solver = "reductoin";
  c->ncandidate = 0;
  assert_true(case_run(c) != AMBIT_OK);
  assert_non_null(strstr(c->failure.message, "reduction"));
  case_close(c);
}

/* -- a plugin that lies: nothing unproved gets through */

static void unproved_cuts_are_noticed(void **state) {
  (void)state;
  static const char *const word[] = { "unproved", "over", "more", "other", "lowered", "twice", "beyond", "nothing",
    "repeated" };
  double rank[3] = { 1, 2, 3 };
  reduction_case *c = case_ranked(3, rank);
  const ambit_plugin *plugin;
  if (ambit_registry_load_file(c->registry, REDUCTION_LIAR, &plugin, &c->failure) != AMBIT_OK)
    fail_msg("%s", c->failure.message);
  c->solver = "liar";
  c->error[0][0] = 0.25, c->error[1][0] = 2;
  for (size_t i = 0; i < sizeof word / sizeof *word; i++) {
    case_set(c, "lie", word[i]);
    case_must_run(c);
    assert_int_equal(c->result.status, AMBIT_BROKEN);
    assert_non_null(strstr(c->result.reason, "solver `liar` is broken: it gave"));
    assert_true(!c->cut[1] && !c->cut[2]);
    if (i == 8) assert_int_equal(c->cut[0], 0);
  }
  case_set(c, "lie", "none");
  case_must_run(c);
  assert_int_equal(c->result.status, AMBIT_OK);
  assert_true(c->cut[0] && !c->cut[1] && c->decision[0].error == 0.25); /* the kernel's, not the plugin's */
  case_close(c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_stop_leaves_what_was_accepted),
    cmocka_unit_test(proofs_are_limited),
    cmocka_unit_test(undefined_effects_come_last),
    cmocka_unit_test(ends_of_the_range),
    cmocka_unit_test(bad_requests_are_refused),
    cmocka_unit_test(unproved_cuts_are_noticed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
