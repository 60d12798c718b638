/* arithmetic_kit_contexts.c -- other callers: rounding modes and flush-to-zero, several contexts, threads, no memory,
** and other options. */
#include "host/params.h"
#include "kit/arithmetic_kit_inside.h"
#include <fenv.h>
#include <math.h>
#include <mpfr.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

static const kit_environment usual = { "round to nearest", FE_TONEAREST, 0 };

/* -- environments */

static const kit_environment environments[] = {
  { "round upward", FE_UPWARD, 0 },
  { "round downward", FE_DOWNWARD, 0 },
  { "round toward zero", FE_TOWARDZERO, 0 },
#if defined(__x86_64__) || defined(__i386__)
  { "flush-to-zero and denormals-are-zero", FE_TONEAREST, 0x8040 },
  { "flush-to-zero, denormals-are-zero and round upward", FE_UPWARD, 0x8040 },
#endif
};

enum { ENVIRONMENTS = sizeof environments / sizeof *environments };

/* the same checks by the caller `into`, from a context opened in the environment */
static void check_caller(kit_state *into, const kit_environment *environment) {
  kit_state s;
  if (kit_open(&s, into->kit, into->option, KIT_NVAR, environment, NULL)) {
    s.section = into->section, s.tally = into->tally;
    kit_reseed(&s, (uint64_t)(environment - environments));
    kit_slice(&s, 0.6 / ENVIRONMENTS);
    for (int round = 0; kit_more(&s, round, 12); round++) {
      kit_check_briefly(&s, 1);
      if (round == 0) kit_check_special_sets(&s), kit_check_identities(&s), kit_check_dot(&s), kit_check_text(&s);
      if (round == 1) kit_check_programs(&s), kit_slice(&s, 0.3 / ENVIRONMENTS);
    }
    into->tally = s.tally;
  }
  kit_take(into, &s);
  kit_close(&s);
}

void kit_check_environments(kit_state *s) {
  for (size_t i = 0; i < ENVIRONMENTS; i++) check_caller(s, &environments[i]);
}

/* -- contexts */

static kit_set add_half(kit_state *s, double x) {
  kit_set_element(s, 0, 0, (kit_set) { x, x + 0.25 }), kit_set_element(s, 1, 0, (kit_set) { 0.5, 0.5 });
  kit_apply(s, AMBIT_OP_ADD, 2, 0, 1, 1);
  return kit_bounds_of(s, 2, 0);
}

/* two contexts used in turn keep their elements apart */
static void check_two(kit_state *s) {
  kit_state other;
  if (kit_open(&other, s->kit, s->option, 1, &usual, NULL)) {
    kit_set mine = add_half(s, 1), theirs = add_half(&other, 3);
    kit_set again = kit_bounds_of(s, 2, 0);
    s->judged++;
    bool sound = !s->rigorous || (mine.lo <= 1.5 && mine.hi >= 1.75 && theirs.lo <= 3.5 && theirs.hi >= 3.75);
    if (!sound || mine.lo != again.lo || mine.hi != again.hi)
      kit_find(s, "contexts", "two contexts disturb each other: [%a, %a] and [%a, %a], then [%a, %a]", mine.lo, mine.hi,
          theirs.lo, theirs.hi, again.lo, again.hi);
  }
  kit_take(s, &other);
  kit_close(&other);
}

/* Findings of two threads go through one lock. */
typedef struct shared {
  const arithmetic_kit *kit;
  pthread_mutex_t lock;
} shared;

static void locked_finding(void *user, const char *promise, const char *message) {
  shared *both = user;
  char text[720];
  snprintf(text, sizeof text, "while another thread computes: %s", message);
  pthread_mutex_lock(&both->lock);
  both->kit->finding(both->kit->user, promise, text);
  pthread_mutex_unlock(&both->lock);
}

typedef struct worker {
  arithmetic_kit kit;
  kit_state state;
  const double *option;
} worker;

static void *work(void *user) {
  worker *w = user;
  if (kit_open(&w->state, &w->kit, w->option, KIT_NVAR, &usual, NULL)) {
    w->state.section = "threads";
    kit_slice(&w->state, 0.3); /* of both together */
    for (int round = 0; kit_more(&w->state, round, 10); round++) kit_check_briefly(&w->state, 1);
  }
  kit_close(&w->state);
  mpfr_free_cache(); /* each thread has one */
  return NULL;
}

static void check_threads(kit_state *s) {
  shared both = { s->kit, PTHREAD_MUTEX_INITIALIZER };
  worker w[2];
  pthread_t thread[2];
  bool started[2];
  for (int i = 0; i < 2; i++) {
    w[i] = (worker) { .kit = *s->kit, .option = s->option };
    w[i].kit.finding = locked_finding, w[i].kit.user = &both, w[i].kit.seed = s->kit->seed + (uint64_t)i;
    started[i] = pthread_create(&thread[i], NULL, work, &w[i]) == 0;
  }
  for (int i = 0; i < 2; i++)
    if (started[i]) pthread_join(thread[i], NULL), kit_take(s, &w[i].state);
  pthread_mutex_destroy(&both.lock);
}

/* open with the n-th allocation failing: an answer, and everything can be freed
*/
static void check_no_memory(kit_state *s) {
  for (size_t n = 1; s->full->open && n <= 20; n++) {
    kit_host h;
    void *ctx = NULL;
    kit_host_open(&h, s->kit->host);
    h.fail_at = n;
    ambit_status status = s->full->open(&h.host, s->option, KIT_NVAR, &ctx);
    bool failed = h.count >= n;
    s->judged++;
    if (status == AMBIT_OK && s->full->close) s->full->close(ctx);
    if (failed && status == AMBIT_OK && n == 1)
      kit_find(s, "contexts", "open says OK though its first allocation failed");
    kit_host_close(&h);
    if (!failed) break;
  }
}

void kit_check_contexts(kit_state *s) {
  check_two(s);
  check_no_memory(s);
  check_threads(s);
}

/* -- options */

/* A context with these numbers: works, or refuses with a message. */
static void try_context(kit_state *s, const double *option, uint32_t nvar, const char *what) {
  kit_state other;
  const char *refused = NULL;
  size_t found = s->findings;
  s->judged++;
  if (kit_open(&other, s->kit, option, nvar, &usual, &refused)) {
    other.section = s->section, other.tally = s->tally;
    kit_reseed(&other, nvar);
    kit_slice(&other, 0);
    if (nvar >= KIT_NVAR) kit_check_programs(&other);
    kit_check_briefly(&other, 1);
    s->tally = other.tally;
  }
  kit_take(s, &other);
  kit_close(&other);
  if (s->findings > found) kit_find(s, "options", "the findings above are with %s", what);
}

/* text for an option: words of a choice, both flags, numbers a user may come up with */
static const char *candidate(const ambit_param *param, size_t i, char *out, size_t room) {
  static const char *const number[] = { "0", "1", "2", "3", "-1", "7", "1000000000", "9007199254740992" };
  static const char *const flag[] = { "true", "false" };
  const char *word = param->shape;
  if (strcmp(word, "flag") == 0) return i < 2 ? flag[i] : NULL;
  if (!strchr(word, '|'))
    return (word[0] == '\0' || strcmp(word, "integer") == 0) && i < sizeof number / sizeof *number ? number[i] : NULL;
  for (; i > 0 && word; i--) word = strchr(word, '|') ? strchr(word, '|') + 1 : NULL;
  if (!word) return NULL;
  snprintf(out, room, "%.*s", (int)strcspn(word, "|"), word);
  return out;
}

static bool is_declared_well(kit_state *s, const ambit_param *param) {
  s->judged++;
  bool whole = param->unit && param->shape && param->doc && param->doc[0];
  if (!whole) kit_find(s, "options", "option `%s` lacks a unit, a shape or its sentence", param->name);
  if (!param->fallback)
    kit_find(s, "options", "option `%s` of an arithmetic needs a fallback: most scenes do not set it", param->name);
  return whole;
}

static void try_option(kit_state *s, const ambit_param *param) {
  char word[64], what[160];
  const char *text;
  for (size_t i = 0; (text = candidate(param, i, word, sizeof word)) != NULL; i++) {
    ambit_option given[KIT_OPTIONS];
    size_t n = 0;
    double option[KIT_OPTIONS];
    ambit_failure f = { 0 };
    for (size_t k = 0; k < s->kit->noption && n + 1 < KIT_OPTIONS; k++)
      if (strcmp(s->kit->option[k].name, param->name) != 0) given[n++] = s->kit->option[k];
    given[n++] = (ambit_option) { param->name, text };
    snprintf(what, sizeof what, "option %s = %s", param->name, text);
    if (ambit_params_resolve(s->full->param, "the arithmetic", n, given, option, &f) == AMBIT_OK)
      try_context(s, option, KIT_NVAR, what);
    else
      kit_find(s, "options", "%s: %s", what, f.message);
  }
}

void kit_check_options(kit_state *s) {
  static const uint32_t count[] = { 0, 1, 40, 1000000, UINT32_MAX };
  char what[64];
  for (const ambit_param *param = s->full->param; param && param->name; param++)
    if (is_declared_well(s, param)) try_option(s, param);
  for (size_t i = 0; i < sizeof count / sizeof *count; i++) {
    snprintf(what, sizeof what, "%u variables", (unsigned)count[i]);
    try_context(s, s->option, count[i], what);
  }
}
