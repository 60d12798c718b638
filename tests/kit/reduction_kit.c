/* reduction_kit.c -- plays the proofs of random models and judges what a strategy decides. */
#include "kit/reduction_kit.h"
#include "kit/conduct.h"
#include "verbs/reduce/reduction.h"
#include "num/random.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { STATES = 4, OUTPUTS = 2, CANDIDATES = 24, TIMES = 3, MESSAGES = 5 };

typedef struct play {
  ambit_sink sink; /* first */
  reduction_kit *kit;
  char name[64];
  uint32_t nx, noutput, n;
  double error[CANDIDATES][OUTPUTS], bound[OUTPUTS];
  bool impossible[CANDIDATES], free[CANDIDATES]; /* free: costs nothing */
  ambit_graph *graph;
  ambit_expr x[STATES], rate[STATES], effect[CANDIDATES], y[OUTPUTS];
  const char *candidate[CANDIDATES];
  uint32_t effect_candidate[CANDIDATES], effect_state[CANDIDATES];
  double time[TIMES], states[TIMES * STATES];
  /* what happens */
  uint32_t stop_proof, stop_progress, proofs, polls, ranked[AMBIT_RANK_COUNT];
  size_t first_count, last_count;
  bool stopped;
  uint8_t last[CANDIDATES], accepted[CANDIDATES], undone[CANDIDATES], cut[CANDIDATES];
  bool last_good; /* the last proof was full, and within the bounds */
  uint64_t digest;
  ambit_reduction_result result;
} play;

static void find(play *p, const char *format, ...) AMBIT_PRINTF(2, 3);
static void find(play *p, const char *format, ...) {
  char message[400];
  va_list arguments;
  if (p->kit->findings++ >= MESSAGES) return;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  p->kit->finding(p->kit->user, p->name, message);
}

static void mix(play *p, uint64_t word) { p->digest = (p->digest ^ word) * 0x100000001b3u; }

/* -- what the strategy is lent */

static bool add_up(const play *p, const uint8_t *cut, double *error) {
  bool within = true;
  for (uint32_t o = 0; o < p->noutput; o++) {
    double sum = 0;
    for (uint32_t k = 0; k < p->n; k++)
      if (cut[k]) sum += p->error[k][o];
    error[o] = fabs(sum);
    within = within && error[o] <= p->bound[o];
  }
  for (uint32_t k = 0; k < p->n; k++) within = within && !(cut[k] && p->impossible[k]);
  return within;
}

static void note(play *p, const char *what) {
  p->kit->judged++;
  p->last_count = p->kit->allocations ? p->kit->allocations() : 0;
  if (p->proofs + p->polls == 0) p->first_count = p->last_count;
  if (p->stopped) find(p, "%s after it was told to stop", what);
}

static ambit_status prove(void *user, uint32_t how, const uint8_t *cut, double *error) {
  play *p = user;
  note(p, "a proof");
  p->proofs++, p->kit->proofs++;
  mix(p, how);
  for (uint32_t k = 0; k < p->n; k++) mix(p, cut[k]), p->last[k] = cut[k] != 0;
  if (how > AMBIT_PROVE_LOWERED) find(p, "a proof of the unknown kind %u", how);
  if (p->proofs == p->stop_proof) {
    p->stopped = true;
    return AMBIT_STOPPED;
  }
  p->last_good = add_up(p, cut, error) && how == AMBIT_PROVE_FULL;
  for (uint32_t k = 0; k < p->n; k++)
    if (cut[k] && p->impossible[k]) return AMBIT_UNABLE;
  return AMBIT_OK;
}

static bool is_cluster(play *p, const ambit_try *t) {
  bool good = t->size >= sizeof *t && t->outcome <= AMBIT_TRY_HALVED && t->ncandidate > 0 && t->ncandidate <= p->n;
  for (uint32_t i = 0; good && i < t->ncandidate; i++) {
    uint32_t k = t->candidate[i];
    good = k < p->n && !p->accepted[k] && !p->undone[k];
    for (uint32_t j = 0; j < i; j++) good = good && t->candidate[j] != k;
  }
  return good && !(t->outcome == AMBIT_TRY_HALVED && t->ncandidate == 1);
}

static void accept(play *p, const ambit_try *t) {
  uint8_t cut[CANDIDATES];
  memcpy(cut, p->accepted, sizeof cut);
  for (uint32_t i = 0; i < t->ncandidate; i++) cut[t->candidate[i]] = 1;
  if (!p->last_good || memcmp(cut, p->last, p->n) != 0)
    find(p, "it accepts %u candidates that were not proved just before", t->ncandidate);
  memcpy(p->accepted, cut, sizeof cut);
}

static void tried(void *user, const ambit_try *t) {
  play *p = user;
  p->kit->judged++;
  mix(p, t->outcome), mix(p, t->ncandidate);
  if (p->stopped) find(p, "a decision after it was told to stop");
  if (!is_cluster(p, t)) {
    find(
        p, "a decision %u about %u candidates that are none, decided already, or one twice", t->outcome, t->ncandidate);
    return;
  }
  for (uint32_t i = 0; i < t->ncandidate; i++) mix(p, t->candidate[i]);
  if (t->outcome == AMBIT_TRY_ACCEPTED) accept(p, t);
  for (uint32_t i = 0; t->outcome == AMBIT_TRY_UNDONE && i < t->ncandidate; i++) p->undone[t->candidate[i]] = 1;
}

static void rank(void *user, uint32_t ranking, const double *value) {
  play *p = user;
  p->kit->judged++;
  if (ranking >= AMBIT_RANK_COUNT) {
    find(p, "a ranking of the unknown kind %u", ranking);
    return;
  }
  if (p->ranked[ranking]++) find(p, "ranking %u is told twice", ranking);
  for (uint32_t k = 0; k < p->n; k++)
    if (!(value[k] >= 0)) find(p, "ranking %u of candidate %u is %g", ranking, k, value[k]);
}

static int32_t progress(ambit_sink *s, double done, const char *message) {
  play *p = (play *)(void *)s;
  (void)message;
  note(p, "progress");
  if (!(done >= 0 && done <= 1)) find(p, "progress %g", done);
  if (++p->polls == p->stop_progress) p->stopped = true;
  return p->stopped;
}

/* -- random models */

static void make(play *p, reduction_kit *kit, size_t item) {
  static const char *const names[] = { "a term" };
  ambit_random random = { kit->seed * 0x9e3779b97f4a7c15u + item + 1 };
  const ambit_interval unit = { -1, 1 };
  *p = (play) {
    .kit = kit, .nx = 1 + (uint32_t)(item % STATES), .noutput = 1 + item % OUTPUTS, .graph = ambit_graph_open()
  };
  p->n = 1 + (uint32_t)(ambit_random_bits(&random) % CANDIDATES);
  if (item % 6 == 0) p->n = CANDIDATES;
  snprintf(p->name, sizeof p->name, "model %zu (%u candidates, %u states)", item, p->n, p->nx);
  static const char *const state[STATES] = { "a", "b", "c", "d" };
  for (uint32_t i = 0; i < p->nx; i++)
    p->x[i] = ambit_graph_symbol(p->graph, state[i], "1"), p->rate[i] = ambit_graph_number(p->graph, 1);
  for (uint32_t o = 0; o < p->noutput; o++) p->y[o] = p->x[o % p->nx], p->bound[o] = 0.5;
  for (uint32_t k = 0; k < p->n; k++) {
    uint64_t bits = ambit_random_bits(&random);
    p->impossible[k] = item % 3 && bits % 7 == 0, p->free[k] = !p->impossible[k] && bits % 5 == 0;
    for (uint32_t o = 0; o < p->noutput; o++) p->error[k][o] = p->free[k] ? 0 : ambit_random_in(&random, unit) * 0.4;
    double size = ambit_random_in(&random, unit);
    uint32_t i = (uint32_t)(bits >> 32) % p->nx;
    ambit_expr term = ambit_graph_op(p->graph, AMBIT_OP_MUL, ambit_graph_number(p->graph, size), p->x[k % p->nx]);
    p->rate[i] = ambit_graph_op(p->graph, AMBIT_OP_ADD, p->rate[i], term);
    p->effect[k] = ambit_graph_op(p->graph, AMBIT_OP_NEG, term, term);
    p->effect_state[k] = i, p->effect_candidate[k] = k, p->candidate[k] = names[0];
  }
  for (uint32_t t = 0; t < TIMES; t++) {
    p->time[t] = t;
    for (uint32_t i = 0; i < p->nx; i++) p->states[t * p->nx + i] = t + 0.25 * i;
  }
}

static void run(play *p) {
  static const char *const name[STATES] = { "a", "b", "c", "d" };
  reduction_kit *k = p->kit;
  const ambit_reduction_reference reference = { 0, TIMES, p->time, p->states, p->states };
  ambit_failure f = { 0 };
  p->sink = (ambit_sink) { sizeof p->sink, NULL, progress };
  ambit_reduction_request q = { .graph = p->graph,
    .nx = p->nx,
    .state = name,
    .symbol = p->x,
    .rate = p->rate,
    .noutput = p->noutput,
    .output = name,
    .output_expression = p->y,
    .bound = p->bound,
    .ncandidate = p->n,
    .candidate = p->candidate,
    .neffect = p->n,
    .effect = p->effect,
    .effect_candidate = p->effect_candidate,
    .effect_state = p->effect_state,
    .nreference = 1,
    .reference = &reference,
    .registry = k->registry,
    .solver = k->name,
    .nsolver_option = k->noption,
    .solver_option = k->option,
    .prove = prove,
    .tried = tried,
    .rank = rank,
    .user = p,
    .sink = &p->sink };
  unsigned floating = conduct_floating();
  if (ambit_reduction_run(&q, p->cut, &p->result, NULL, &f) != AMBIT_OK) {
    find(p, "it cannot start: %s", f.message);
    p->result.status = AMBIT_INVALID;
  }
  if (conduct_floating() != floating) find(p, "it changes the rounding mode");
  k->runs++, k->judged++;
}

static void judge(play *p) {
  double error[OUTPUTS];
  uint32_t open = 0;
  p->kit->judged += 4 + p->n;
  if (p->result.status != AMBIT_OK) find(p, "status %d: %s", p->result.status, p->result.reason);
  for (uint32_t k = 0; k < p->n; k++) open += !p->accepted[k] && !p->undone[k];
  if (open) find(p, "%u of %u candidates were not decided", open, p->n);
  for (uint32_t k = 0; k < p->n; k++)
    if ((p->cut[k] != 0) != (p->accepted[k] != 0)) find(p, "candidate %u is cut, or accepted, not both", k);
  if (!add_up(p, p->cut, error)) find(p, "the reduced model is off by %g, or cannot be proved", error[0]);
  for (uint32_t k = 0; k < p->n; k++)
    if (p->free[k] && !p->cut[k]) find(p, "candidate %u costs nothing, and is not cut", k);
  if (p->polls == 0) find(p, "no progress");
  if (p->last_count != p->first_count) find(p, "%zu allocations between two proofs", p->last_count - p->first_count);
}

static void judge_stop(play *p, const char *by) {
  p->kit->judged += 2;
  if (p->stopped && p->result.status != AMBIT_STOPPED) find(p, "stopped by %s: status %d", by, p->result.status);
  if (memcmp(p->cut, p->accepted, p->n) != 0) find(p, "stopped by %s: what was accepted does not stand", by);
}

static void play_model(reduction_kit *k, size_t item) {
  play p;
  make(&p, k, item);
  run(&p);
  judge(&p);
  uint32_t proofs = p.proofs, polls = p.polls;
  uint64_t digest = p.digest;
  ambit_graph_close(p.graph);
  make(&p, k, item);
  run(&p);
  if (p.digest != digest) find(&p, "another result the second time");
  ambit_graph_close(p.graph);
  for (uint32_t stop = 1; stop <= 3; stop += 2) {
    make(&p, k, item);
    p.stop_proof = stop <= proofs ? stop : proofs;
    run(&p);
    judge_stop(&p, "a proof");
    ambit_graph_close(p.graph);
    make(&p, k, item);
    p.stop_progress = stop <= polls ? stop : polls;
    run(&p);
    judge_stop(&p, "progress");
    ambit_graph_close(p.graph);
  }
}

size_t reduction_kit_run(reduction_kit *k, size_t models) {
  for (size_t i = 0; i < models && k->findings == 0; i++) play_model(k, i);
  return k->findings;
}
