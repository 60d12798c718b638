/* reduction_case.h -- reductions for tests of the plugin: a model, its candidates and references, and a proof that is
** played by the test. */
#ifndef REDUCTION_CASE_H
#define REDUCTION_CASE_H
#include "verbs/reduce/reduction.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define CASE_STATES 64
#define CASE_CANDIDATES 512
#define CASE_OUTPUTS 4
#define CASE_TRIES 4096
#define CASE_REFERENCES 4

typedef struct case_decision {
  uint32_t outcome, n, first; /* candidates in `all` */
  double error;               /* of output 0; NaN: none */
} case_decision;

typedef struct reduction_case {
  ambit_registry *registry;
  ambit_graph *graph;
  uint32_t nx, noutput, ncandidate, neffect, nreference, noption;
  const char *state[CASE_STATES], *output[CASE_OUTPUTS], *candidate[CASE_CANDIDATES];
  ambit_expr x[CASE_STATES], rate[CASE_STATES], y[CASE_OUTPUTS], effect[CASE_CANDIDATES];
  uint32_t effect_candidate[CASE_CANDIDATES], effect_state[CASE_CANDIDATES];
  double bound[CASE_OUTPUTS];
  ambit_reduction_reference reference[CASE_REFERENCES];
  ambit_option option[16];
  const char *solver;
  ambit_expr data; /* a leaf that references give a value; AMBIT_NO_EXPR: there is none */
  ambit_status (*prove)(void *user, uint32_t how, const uint8_t *cut, double *error); /* NULL: the played one */
  void *of_proof;                                                                     /* for prove */
  /* the played proof: signed errors that add up */
  double error[CASE_CANDIDATES][CASE_OUTPUTS];
  uint8_t impossible[CASE_CANDIDATES]; /* nothing is proved while this one is cut */
  uint32_t stop_at;                    /* the proof of this number (from 1) says STOPPED; 0: none */
  uint32_t stop_progress;              /* likewise progress() */
  uint32_t calls, lowered, polls;
  /* what came of it */
  double rank[AMBIT_RANK_COUNT][CASE_CANDIDATES];
  uint8_t ranked[AMBIT_RANK_COUNT];
  uint32_t ntry, nall;
  case_decision decision[CASE_TRIES];
  uint32_t all[8 * CASE_TRIES];
  uint8_t cut[CASE_CANDIDATES];
  ambit_reduction_result result;
  ambit_failure failure;
} reduction_case;

/* -- the played proof */

static inline ambit_status case_add_up(void *user, uint32_t how, const uint8_t *cut, double *error) {
  reduction_case *c = user;
  for (uint32_t k = 0; k < c->ncandidate; k++)
    if (cut[k] && c->impossible[k]) return AMBIT_UNABLE;
  for (uint32_t o = 0; o < c->noutput; o++) {
    double sum = 0;
    for (uint32_t k = 0; k < c->ncandidate; k++)
      if (cut[k]) sum += c->error[k][o];
    error[o] = fabs(sum) * (how == AMBIT_PROVE_LOWERED ? 1.25 : 1);
  }
  return AMBIT_OK;
}

static inline ambit_status case_prove(void *user, uint32_t how, const uint8_t *cut, double *error) {
  reduction_case *c = user;
  c->calls++;
  c->lowered += how == AMBIT_PROVE_LOWERED;
  if (c->calls == c->stop_at) return AMBIT_STOPPED;
  return c->prove ? c->prove(c->of_proof, how, cut, error) : case_add_up(c, how, cut, error);
}

static inline void case_tried(void *user, const ambit_try *t) {
  reduction_case *c = user;
  assert_true(c->ntry < CASE_TRIES && c->nall + t->ncandidate <= 8 * CASE_TRIES);
  c->decision[c->ntry++] = (case_decision) { t->outcome, t->ncandidate, c->nall, t->error ? t->error[0] : NAN };
  memcpy(c->all + c->nall, t->candidate, t->ncandidate * sizeof *t->candidate);
  c->nall += t->ncandidate;
}

static inline void case_rank(void *user, uint32_t ranking, const double *value) {
  reduction_case *c = user;
  c->ranked[ranking]++;
  memcpy(c->rank[ranking], value, c->ncandidate * sizeof *value);
}

static inline int32_t case_progress(ambit_sink *s, double done, const char *message);

typedef struct case_sink {
  ambit_sink sink; /* first */
  reduction_case *c;
} case_sink;

static inline int32_t case_progress(ambit_sink *s, double done, const char *message) {
  reduction_case *c = ((case_sink *)(void *)s)->c;
  assert_true(done >= 0 && done <= 1 && message && message[0]);
  return ++c->polls == c->stop_progress;
}

/* -- life */

static inline reduction_case *case_open(void) {
  reduction_case *c = calloc(1, sizeof *c);
  c->registry = ambit_registry_open(NULL);
  c->graph = ambit_graph_open();
  c->solver = "reduction";
  c->data = AMBIT_NO_EXPR;
  return c;
}

static inline void case_close(reduction_case *c) {
  ambit_graph_close(c->graph);
  ambit_registry_close(c->registry);
  free(c);
}

static inline void case_set(reduction_case *c, const char *name, const char *text) {
  for (uint32_t i = 0; i < c->noption; i++)
    if (strcmp(c->option[i].name, name) == 0) {
      c->option[i].text = text;
      return;
    }
  c->option[c->noption++] = (ambit_option) { name, text };
}

static inline ambit_status case_run(reduction_case *c) {
  case_sink sink = { { sizeof(ambit_sink), NULL, case_progress }, c };
  ambit_reduction_request q = { .graph = c->graph,
    .nx = c->nx,
    .state = c->state,
    .symbol = c->x,
    .rate = c->rate,
    .ndata = c->data != AMBIT_NO_EXPR,
    .data = &c->data,
    .noutput = c->noutput,
    .output = c->output,
    .output_expression = c->y,
    .bound = c->bound,
    .ncandidate = c->ncandidate,
    .candidate = c->candidate,
    .neffect = c->neffect,
    .effect = c->effect,
    .effect_candidate = c->effect_candidate,
    .effect_state = c->effect_state,
    .nreference = c->nreference,
    .reference = c->reference,
    .registry = c->registry,
    .solver = c->solver,
    .nsolver_option = c->noption,
    .solver_option = c->option,
    .prove = case_prove,
    .tried = case_tried,
    .rank = case_rank,
    .user = c,
    .sink = &sink.sink };
  c->ntry = c->nall = c->calls = c->lowered = c->polls = 0;
  memset(c->ranked, 0, sizeof c->ranked);
  ambit_failure_clear(&c->failure);
  return ambit_reduction_run(&q, c->cut, &c->result, NULL, &c->failure);
}

static inline void case_must_run(reduction_case *c) {
  if (case_run(c) != AMBIT_OK) fail_msg("%s", c->failure.message);
}

/* -- building */

static inline ambit_expr case_state(reduction_case *c, const char *name) {
  c->state[c->nx] = name;
  c->rate[c->nx] = 0; /* node 0 is the constant 0 */
  return c->x[c->nx++] = ambit_graph_symbol(c->graph, name, "1");
}

static inline void case_output(reduction_case *c, const char *name, ambit_expr y, double bound) {
  c->output[c->noutput] = name;
  c->y[c->noutput] = y;
  c->bound[c->noutput++] = bound;
}

/* adds a term to the rate of a state, as a candidate to be neglected: its effect is minus the term */
static inline uint32_t case_term(reduction_case *c, uint32_t state, ambit_expr term) {
  c->rate[state] = ambit_graph_op(c->graph, AMBIT_OP_ADD, c->rate[state], term);
  c->candidate[c->ncandidate] = "a term";
  c->effect[c->neffect] = ambit_graph_op(c->graph, AMBIT_OP_NEG, term, term);
  c->effect_state[c->neffect] = state;
  c->effect_candidate[c->neffect++] = c->ncandidate;
  return c->ncandidate++;
}

static inline ambit_expr case_number(reduction_case *c, double x) { return ambit_graph_number(c->graph, x); }
static inline ambit_expr case_times(reduction_case *c, double a, ambit_expr x) {
  return ambit_graph_op(c->graph, AMBIT_OP_MUL, case_number(c, a), x);
}

/* a state from 0 to 1 in a second, whose rate candidate k changes by rank[k]: that is its residual */
static inline reduction_case *case_ranked(uint32_t n, const double *rank) {
  static const double times[2] = { 0, 1 };
  reduction_case *c = case_open();
  case_state(c, "x");
  case_output(c, "x", c->x[0], 1);
  for (uint32_t k = 0; k < n; k++) case_term(c, 0, case_number(c, rank[k]));
  c->rate[0] = case_number(c, 1);
  c->reference[0] = (ambit_reduction_reference) { 0, 2, times, times, times };
  c->nreference = 1;
  return c;
}

/* -- random numbers: xorshift64* */

static inline double case_uniform(void) {
  static uint64_t state = 0x9e3779b97f4a7c15u;
  state ^= state >> 12, state ^= state << 25, state ^= state >> 27;
  return (double)((state * 0x2545f4914f6cdd1du) >> 11) * 0x1p-53;
}
static inline double case_between(double lo, double hi) { return lo + case_uniform() * (hi - lo); }
static inline uint32_t case_choose(uint32_t n) { return (uint32_t)(case_uniform() * n); }
#endif
