/* Cancellation by the plugin `reduction`: the decisions of Algorithm 1 (Mikelsons and Brandt 2009), replayed by a
** plain version of it; proofs of single candidates; the departures that options allow. */
#include "reduction_case.h"

/* -- Algorithm 1, as printed */

typedef struct paper {
  uint32_t list[64 * CASE_CANDIDATES][2], nlist; /* clusters: first and count in `order`; a stack, the next one last */
  uint32_t order[CASE_CANDIDATES];
  uint8_t cut[CASE_CANDIDATES];
  uint32_t proofs, ntry;
  case_decision decision[CASE_TRIES];
} paper;

static void paper_sort(paper *p, uint32_t n, const double *rank) {
  for (uint32_t i = 0; i < n; i++) {
    uint32_t at = i;
    for (; at > 0 && rank[p->order[at - 1]] > rank[i]; at--) p->order[at] = p->order[at - 1];
    p->order[at] = i;
  }
}

static void paper_divide(paper *p, uint32_t n, const double *rank, double factor) {
  uint32_t found[CASE_CANDIDATES][2], count = 0;
  for (uint32_t i = 0; i < n; i++) {
    double r = rank[p->order[i]], first = count ? rank[p->order[found[count - 1][0]]] : 0;
    bool with = count && factor > 1 && (r == first || r <= factor * first);
    if (!with) found[count][0] = i, found[count++][1] = 0;
    found[count - 1][1]++;
  }
  for (uint32_t i = count; i-- > 0;) memcpy(p->list[p->nlist++], found[i], sizeof found[i]);
}

static paper *paper_run(reduction_case *c, const double *rank, double factor) {
  paper *p = calloc(1, sizeof *p);
  paper_sort(p, c->ncandidate, rank);
  paper_divide(p, c->ncandidate, rank, factor);
  while (p->nlist) {
    uint32_t first = p->list[p->nlist - 1][0], n = p->list[--p->nlist][1];
    double error[CASE_OUTPUTS];
    for (uint32_t i = 0; i < n; i++) p->cut[p->order[first + i]] = 1;
    p->proofs++;
    bool good = case_prove(c, AMBIT_PROVE_FULL, p->cut, error) == AMBIT_OK;
    for (uint32_t o = 0; o < c->noutput && good; o++) good = error[o] <= c->bound[o];
    p->decision[p->ntry++] = (case_decision) { good    ? AMBIT_TRY_ACCEPTED
                                               : n > 1 ? AMBIT_TRY_HALVED
                                                       : AMBIT_TRY_UNDONE,
      n, first, 0 };
    if (good) continue;
    for (uint32_t i = 0; i < n; i++) p->cut[p->order[first + i]] = 0;
    if (n == 1) continue;
    const uint32_t second[2] = { first + n / 2, n - n / 2 }, half[2] = { first, n / 2 };
    memcpy(p->list[p->nlist++], second, sizeof second);
    memcpy(p->list[p->nlist++], half, sizeof half);
  }
  return p;
}

/* the plugin decides what the algorithm decides, in the same order, with no more proofs */
static uint32_t assert_as_printed(reduction_case *c, const double *rank, double factor) {
  char text[32];
  snprintf(text, sizeof text, "%g", factor);
  case_set(c, "cluster", text);
  case_must_run(c);
  assert_int_equal(c->result.status, AMBIT_OK);
  uint32_t proofs = c->calls;
  assert_int_equal(proofs, c->result.proofs);
  paper *p = paper_run(c, rank, factor);
  assert_int_equal(c->ntry, p->ntry);
  for (uint32_t i = 0; i < p->ntry; i++) {
    assert_int_equal(c->decision[i].outcome, p->decision[i].outcome);
    assert_int_equal(c->decision[i].n, p->decision[i].n);
    assert_memory_equal(c->all + c->decision[i].first, p->order + p->decision[i].first, p->decision[i].n * 4);
  }
  assert_memory_equal(c->cut, p->cut, c->ncandidate);
  assert_true(proofs <= p->proofs);
  free(p);
  return proofs;
}

/* -- random problems */

static void random_problem(reduction_case *c, double *rank, bool adding) {
  for (uint32_t k = 0; k < c->ncandidate; k++) {
    double size = pow(10, case_between(-6, 0));
    for (uint32_t o = 0; o < c->noutput; o++) {
      double sign = adding || case_choose(2) ? 1 : -1;
      c->error[k][o] = sign * size * case_between(0.2, 5);
    }
    c->impossible[k] = case_choose(20) == 0;
    rank[k] = k && case_choose(4) == 0 ? rank[k - 1] : size * pow(10, case_between(-1, 1));
    if (case_choose(10) == 0) rank[k] = 0;
  }
}

/* With errors that only add up, each candidate that is left fails on top of what is cut: nothing more can go. */
static void assert_maximal(reduction_case *c) {
  for (uint32_t k = 0; k < c->ncandidate; k++) {
    double error[CASE_OUTPUTS];
    if (c->cut[k]) continue;
    c->cut[k] = 1;
    ambit_status status = case_prove(c, AMBIT_PROVE_FULL, c->cut, error);
    bool within = status == AMBIT_OK;
    for (uint32_t o = 0; o < c->noutput; o++) within = within && error[o] <= c->bound[o];
    assert_false(within);
    c->cut[k] = 0;
  }
}

static void decisions_are_the_algorithms(void **state) {
  (void)state;
  static const double factors[] = { 1, 10, 100, INFINITY, 1.5 };
  double rank[CASE_CANDIDATES];
  uint32_t saved = 0;
  for (int round = 0; round < 150; round++) {
    uint32_t n = 1 + case_choose(60);
    bool adding = round % 2 == 0;
    for (uint32_t k = 0; k < n; k++) rank[k] = 0;
    reduction_case *c = case_ranked(n, rank);
    random_problem(c, rank, adding);
    for (uint32_t k = 0; k < n; k++) c->effect[k] = case_number(c, rank[k]);
    case_output(c, "2 x", case_times(c, 2, c->x[0]), 0.3);
    random_problem(c, rank, adding); /* now for both outputs */
    for (uint32_t k = 0; k < n; k++) c->effect[k] = case_number(c, rank[k]);
    case_must_run(c);
    for (uint32_t k = 0; k < n; k++) assert_true(fabs(c->rank[AMBIT_RANK_RESIDUAL][k] - rank[k]) <= 1e-15 * rank[k]);
    uint32_t one_by_one = assert_as_printed(c, c->rank[AMBIT_RANK_RESIDUAL], 1);
    assert_int_equal(one_by_one, n);
    if (adding) assert_maximal(c);
    for (size_t i = 1; i < sizeof factors / sizeof *factors; i++) {
      saved += assert_as_printed(c, c->rank[AMBIT_RANK_RESIDUAL], factors[i]) < n;
      if (adding) assert_maximal(c);
    }
    case_close(c);
  }
  assert_true(saved > 200); /* of 600: clusters pay */
}

/* 200 small effects and 5 great ones: a dozen proofs instead of 205 */
static void clusters_save_proofs(void **state) {
  (void)state;
  double rank[205];
  for (uint32_t k = 0; k < 205; k++) rank[k] = k % 41 == 7 ? 10 : 1e-4 * (1 + k % 5);
  reduction_case *c = case_ranked(205, rank);
  for (uint32_t k = 0; k < 205; k++) c->error[k][0] = rank[k];
  assert_int_equal(assert_as_printed(c, rank, 1), 205);
  uint32_t clustered = assert_as_printed(c, rank, 10);
  assert_true(clustered <= 12);
  case_close(c);
}

/* A cluster of 8 with one blamed, the last: 8 fail, 4 pass, the other 4 are known to fail, and so on. */
static void a_known_failure_is_not_proved_again(void **state) {
  (void)state;
  double rank[8] = { 1, 1, 1, 1, 1, 1, 1, 1 };
  reduction_case *c = case_ranked(8, rank);
  c->error[7][0] = 2;
  case_must_run(c);
  assert_int_equal(c->calls, 4); /* 8, 4, 2, 1 */
  assert_int_equal(c->ntry, 7);
  for (uint32_t i = 0; i < c->ntry; i++) assert_true(c->decision[i].error == (c->decision[i].outcome ? 2 : 0));
  assert_int_equal(c->decision[6].outcome, AMBIT_TRY_UNDONE);
  case_close(c);
}

/* -- each candidate alone */

static void single_proofs_rank(void **state) {
  (void)state;
  double rank[4] = { 1, 1, 1, 1 };
  reduction_case *c = case_ranked(4, rank);
  case_output(c, "z", c->x[0], 0.1);
  const double error[4][2] = { { 0.5, 0.01 }, { 0.1, 0.04 }, { -0.2, 0 }, { 0, 0 } };
  for (uint32_t k = 0; k < 4; k++) memcpy(c->error[k], error[k], sizeof error[k]);
  c->impossible[3] = 1;
  c->nreference = 0; /* not needed */
  case_set(c, "ranking", "exact");
  case_set(c, "lowered_order", "true");
  case_must_run(c);
  const double relative[3] = { 0.5, 0.4, 0.2 };
  for (uint32_t k = 0; k < 3; k++) {
    assert_true(fabs(c->rank[AMBIT_RANK_EXACT][k] - relative[k]) < 1e-15);
    assert_true(fabs(c->rank[AMBIT_RANK_LOWERED][k] - 1.25 * relative[k]) < 1e-15);
  }
  assert_true(isinf(c->rank[AMBIT_RANK_EXACT][3]) && isinf(c->rank[AMBIT_RANK_LOWERED][3]));
  assert_int_equal(c->lowered, 4);
  assert_int_equal(c->result.lowered, 4);
  assert_true(c->cut[0] && c->cut[1] && c->cut[2] && !c->cut[3]);
  case_set(c, "ranking", "lowered_order");
  case_set(c, "lowered_order", "false");
  case_must_run(c);
  assert_int_equal(c->ranked[AMBIT_RANK_EXACT], 0);
  assert_int_equal(c->calls, 4 + 2); /* { 2, 1, 0 }, { 3 } */
  case_close(c);
}

/* -- departures from the algorithm */

/* six that fit, and four that each exceed the bound 20 times: these are tried once, together */
static void what_is_hopeless_is_not_halved(void **state) {
  (void)state;
  double rank[10];
  for (uint32_t k = 0; k < 10; k++) rank[k] = 1;
  reduction_case *c = case_ranked(10, rank);
  for (uint32_t k = 0; k < 10; k++) c->error[k][0] = k % 5 < 3 ? 0.01 : 20 + k;
  case_set(c, "ranking", "exact"), case_set(c, "give_up", "10");
  case_must_run(c);
  assert_int_equal(c->calls, 10 + 2);
  assert_int_equal(c->ntry, 2);
  assert_true(c->decision[1].outcome == AMBIT_TRY_UNDONE && c->decision[1].n == 4);
  for (uint32_t k = 0; k < 10; k++) assert_int_equal(c->cut[k], k % 5 < 3);
  case_set(c, "give_up", "23.5"); /* one of them is below that: halved, but not the half without it */
  case_must_run(c);
  assert_int_equal(c->decision[1].outcome, AMBIT_TRY_HALVED);
  assert_int_equal(c->calls, 10 + 2 + 3 + 1);
  c->error[3][0] = 20, c->error[4][0] = -20.01; /* great ones that balance each other go together */
  c->error[8][0] = 20, c->error[9][0] = -20.01;
  case_set(c, "give_up", "10");
  case_must_run(c);
  for (uint32_t k = 0; k < 10; k++) assert_int_equal(c->cut[k], 1);
  c->noption = 0; /* along references the adjoint is asked */
  case_set(c, "give_up", "2");
  case_must_run(c);
  assert_int_equal(c->ranked[AMBIT_RANK_ADJOINT], 1);
  case_close(c);
}

/* effects 0.1 to 0.4 add up to the bound: one proof for four of them, then what is left of the bound */
static void predicted_clusters_fill_the_bounds(void **state) {
  (void)state;
  double rank[6] = { 0.4, 0.3, 0.2, 0.1, 0.7, 30 };
  reduction_case *c = case_ranked(6, rank);
  for (uint32_t k = 0; k < 6; k++) c->error[k][0] = rank[k] * 0.99;
  case_set(c, "ranking", "adjoint"), case_set(c, "strategy", "predicted"), case_set(c, "give_up", "10");
  case_must_run(c);
  assert_int_equal(c->ntry, 3);
  assert_true(c->decision[0].outcome == AMBIT_TRY_ACCEPTED && c->decision[0].n == 4);
  assert_true(c->decision[1].n == 1 && c->all[c->decision[1].first] == 4);
  assert_true(c->decision[2].outcome == AMBIT_TRY_UNDONE && c->all[c->decision[2].first] == 5);
  for (uint32_t k = 0; k < 6; k++) c->error[k][0] *= 0.1; /* less than predicted: there is room for one more */
  case_must_run(c);
  assert_int_equal(c->decision[1].outcome, AMBIT_TRY_ACCEPTED);
  case_close(c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(decisions_are_the_algorithms),
    cmocka_unit_test(clusters_save_proofs),
    cmocka_unit_test(a_known_failure_is_not_proved_again),
    cmocka_unit_test(single_proofs_rank),
    cmocka_unit_test(what_is_hopeless_is_not_halved),
    cmocka_unit_test(predicted_clusters_fill_the_bounds),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
