/* reduction_mutant.c -- strategies of model reduction with one fault: in what they decide, in what they have proved, in
** how they stop, or in their conduct. */
#include "kit/mutants/mutant_conduct.h"
#include "kit/mutants/solver_mutant.h"
#include <ambit/reduction.h>
#include <math.h>

enum { CANDIDATES = 512 };

typedef struct liar {
  ambit_sink sink; /* first */
  ambit_sink *outer;
  const ambit_host *host;
  ambit_reduction own;
  const ambit_reduction *theirs;
  uint32_t tries, proofs, accepted, list[CANDIDATES];
  uint8_t cut[CANDIDATES];
  double value[CANDIDATES];
  int32_t stopped;
  void *inner;
} liar;

typedef struct selection {
  const char *name;
  void (*conduct)(void);
  ambit_strategy base;
  uint64_t runs;
} selection;

static selection *chosen;

static bool is(const char *name) { return strcmp(chosen->name, name) == 0; }

/* -- proofs */

static ambit_status prove(void *user, uint32_t how, const uint8_t *cut, double *error) {
  liar *l = user;
  const ambit_reduction *r = l->theirs;
  uint32_t n = r->ncandidate;
  l->proofs++;
  memcpy(l->cut, cut, n);
  if (is("proves nothing and believes that all is well")) {
    memset(error, 0, r->noutput * sizeof *error);
    return AMBIT_OK;
  }
  if (is("every third proof is left out") && l->proofs % 3 == 0) {
    memset(error, 0, r->noutput * sizeof *error);
    return AMBIT_OK;
  }
  if (is("proofs of lowered order accept")) how = AMBIT_PROVE_LOWERED;
  if (is("proofs of an unknown kind")) how = 9;
  if (is("the last candidate is left out of proofs")) l->cut[n - 1] = 0;
  if (is("the first candidate is left out of proofs")) l->cut[0] = 0;
  if (is("proofs of the empty cut")) memset(l->cut, 0, n);
  if (is("proofs of one candidate more")) l->cut[l->proofs % n] = 1;
  if (is("allocates at each proof")) conduct_allocates();
  ambit_status status = r->prove(r->user, how, l->cut, error);
  if (is("every proof is believed") || (is("what cannot be proved is taken for proved") && status == AMBIT_UNABLE)) {
    memset(error, 0, r->noutput * sizeof *error);
    return AMBIT_OK;
  }
  if (is("looks at the first output only"))
    for (uint32_t o = 1; o < r->noutput; o++) error[o] = 0;
  if (is("bounds taken 10 % too large"))
    for (uint32_t o = 0; o < r->noutput; o++) error[o] /= 1.1;
  if (is("no proof is believed")) error[0] = INFINITY;
  if (status == AMBIT_STOPPED) l->stopped = 1;
  if (is("a stopped proof is a failed one") && status == AMBIT_STOPPED) return AMBIT_UNABLE;
  if (is("a stopped proof is a good one") && status == AMBIT_STOPPED) {
    memset(error, 0, r->noutput * sizeof *error);
    return AMBIT_OK;
  }
  return status;
}

/* -- decisions */

static void tried(void *user, const ambit_try *t) {
  liar *l = user;
  const ambit_reduction *r = l->theirs;
  ambit_try own = *t;
  l->tries++;
  memcpy(l->list, t->candidate, t->ncandidate * sizeof *l->list);
  own.candidate = l->list;
  bool accepted = t->outcome == AMBIT_TRY_ACCEPTED;
  if (accepted) l->accepted++;
  if (is("undone candidates are accepted") && t->outcome == AMBIT_TRY_UNDONE) own.outcome = AMBIT_TRY_ACCEPTED;
  if (is("halved clusters are accepted") && t->outcome == AMBIT_TRY_HALVED) own.outcome = AMBIT_TRY_ACCEPTED;
  if (is("halved clusters are undone") && t->outcome == AMBIT_TRY_HALVED) own.outcome = AMBIT_TRY_UNDONE;
  if (is("accepted candidates are undone") && accepted) own.outcome = AMBIT_TRY_UNDONE;
  if (is("the first accepted cluster is undone") && accepted && l->accepted == 1) own.outcome = AMBIT_TRY_UNDONE;
  if (is("decisions of an unknown kind")) own.outcome = 5;
  if (is("every fourth decision is left out") && l->tries % 4 == 0) return;
  if (is("no decision is told")) return;
  if (is("undone candidates are not told") && t->outcome == AMBIT_TRY_UNDONE) return;
  if (is("candidates counted from 1"))
    for (uint32_t i = 0; i < t->ncandidate; i++) l->list[i]++;
  if (is("one candidate more is accepted") && accepted && t->ncandidate < CANDIDATES)
    l->list[own.ncandidate++] = (l->list[0] + 1) % r->ncandidate;
  if (is("one candidate twice in a cluster") && t->ncandidate > 1) l->list[1] = l->list[0];
  if (is("the last of a cluster is forgotten") && t->ncandidate > 1) own.ncandidate--;
  if (is("clusters of no candidate")) own.ncandidate = 0;
  if (is("decisions of an older size")) own.size -= 8;
  if (is("another candidate is accepted") && accepted) l->list[0] = (l->list[0] + 1) % r->ncandidate;
  r->tried(r->user, &own);
  if (is("every decision twice")) r->tried(r->user, &own);
}

static void rank(void *user, uint32_t ranking, const double *value) {
  liar *l = user;
  const ambit_reduction *r = l->theirs;
  memcpy(l->value, value, r->ncandidate * sizeof *value);
  if (is("rankings with a NaN")) l->value[r->ncandidate - 1] = NAN;
  if (is("negative rankings")) l->value[0] = -1;
  if (is("rankings of an unknown kind")) ranking = 77;
  r->rank(r->user, ranking, l->value);
  if (is("rankings told twice")) r->rank(r->user, ranking, l->value);
}

static int32_t progress(ambit_sink *s, double done, const char *message) {
  liar *l = (liar *)(void *)s;
  if (is("no progress")) return 0;
  if (is("progress beyond 1")) done += 1.5;
  if (is("progress that is NaN")) done = NAN;
  int32_t stop = l->outer->progress(l->outer, done, message);
  if (stop) l->stopped = 1;
  return is("goes on after progress has stopped it") ? 0 : stop;
}

/* -- the plugin */

static ambit_status open_liar(const ambit_host *h, const ambit_reduction *r, const double *option, void **self) {
  liar *l = h->alloc(h, sizeof *l);
  mutant_host *own = mutant_lend(h);
  if (!l || !own) return AMBIT_NOMEM;
  *self = l;
  chosen->runs++;
  l->host = h, l->theirs = r, l->own = *r;
  if (l->own.ncandidate > CANDIDATES) return AMBIT_NOMEM;
  l->own.prove = prove, l->own.tried = tried, l->own.rank = rank, l->own.user = l;
  if (is("another answer the second time") && chosen->runs % 2 == 0) l->own.ncandidate -= l->own.ncandidate > 1;
  if (is("the last candidate is never tried") && l->own.ncandidate > 1) l->own.ncandidate--;
  if (is("from 20 candidates on the others are forgotten") && l->own.ncandidate > 20) l->own.ncandidate = 20;
  return chosen->base.open(&own->host, &l->own, option, &l->inner);
}

static ambit_status run(void *self, ambit_sink *sink) {
  liar *l = self;
  l->sink = (ambit_sink) { sizeof l->sink, NULL, progress };
  l->outer = sink;
  if (is("decides nothing")) return AMBIT_OK;
  ambit_status status = chosen->base.run(l->inner, &l->sink);
  if (chosen->conduct) chosen->conduct();
  if (is("says OK when it was stopped") && status == AMBIT_STOPPED) return AMBIT_OK;
  if (is("stops by itself") && status == AMBIT_OK) return AMBIT_STOPPED;
  if (is("gives up at the end")) return l->host->fail(l->host, AMBIT_UNABLE, "this model is too hard");
  if (is("says that there is no answer")) return AMBIT_DOMAIN;
  return status;
}

static void close_liar(void *self) { chosen->base.close(((liar *)self)->inner); }

static const char *const faults[] = { "proves nothing and believes that all is well", "every third proof is left out",
  "proofs of lowered order accept", "proofs of an unknown kind", "the last candidate is left out of proofs",
  "the first candidate is left out of proofs", "proofs of the empty cut", "proofs of one candidate more",
  "allocates at each proof", "every proof is believed", "what cannot be proved is taken for proved",
  "looks at the first output only", "bounds taken 10 % too large", "no proof is believed",
  "a stopped proof is a failed one", "a stopped proof is a good one", "undone candidates are accepted",
  "halved clusters are accepted", "halved clusters are undone", "accepted candidates are undone",
  "the first accepted cluster is undone", "decisions of an unknown kind", "every fourth decision is left out",
  "no decision is told", "undone candidates are not told", "candidates counted from 1",
  "one candidate more is accepted", "one candidate twice in a cluster", "the last of a cluster is forgotten",
  "clusters of no candidate", "decisions of an older size", "another candidate is accepted", "every decision twice",
  "rankings with a NaN", "negative rankings", "rankings of an unknown kind", "rankings told twice", "no progress",
  "progress beyond 1", "progress that is NaN", "goes on after progress has stopped it",
  "another answer the second time", "the last candidate is never tried",
  "from 20 candidates on the others are forgotten", "decides nothing", "says OK when it was stopped", "stops by itself",
  "gives up at the end", "says that there is no answer" };
enum { FAULTS = sizeof faults / sizeof *faults };

AMBIT_EXPORT const char *ambit_mutant_name(size_t i);
const char *ambit_mutant_name(size_t i) {
  return i < FAULTS ? faults[i] : i < FAULTS + CONDUCT_FAULTS ? conduct_faults[i - FAULTS].name : NULL;
}

__attribute__((constructor)) static void choose(void);
static void choose(void) {
  chosen = calloc(1, sizeof *chosen);
  chosen->name = strdup(mutant_wanted());
  chosen->conduct = conduct_of(chosen->name);
  ambit_strategy *own = mutant_wrap(AMBIT_STRATEGY, "reduction", &chosen->base, sizeof chosen->base);
  own->open = open_liar, own->run = run, own->close = close_liar;
}

AMBIT_EXPORT const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "solver.reduction_mutant", "1.0",
  "A strategy of reduction with one fault.", mutant_get };
