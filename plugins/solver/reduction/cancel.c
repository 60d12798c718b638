/* cancel.c -- Algorithm 1 of Mikelsons and Brandt 2009: candidates in ascending order, in clusters that one proof
** decides; a cluster that fails is undone and halved, both halves come next.
**
** If all of a first half is accepted, the second half on top of it is the very cut that failed before it was halved: it
** fails again, and is not proved again. The result is the algorithm's, with fewer proofs.
**
** Two departures are optional. `give_up`: a cluster that fails is not halved if each of its candidates, by the adjoint
** ranking or a proof of its own, is over the bounds by more than that factor. `strategy = predicted`: effects relative
** to the bounds are taken to add up, and one proof decides about all that fit.
*/
#include "reduce.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define UNKNOWN UINT32_MAX

static const double *deciding(const reducer *s) { return s->value[s->options.ranking]; }

/* by value, equal ones by their number: insertion by bisection */
static void sort(reducer *s) {
  const double *value = deciding(s);
  for (uint32_t k = 0; k < s->r.ncandidate; k++) {
    uint32_t lo = 0, hi = k;
    while (lo < hi) {
      uint32_t mid = lo + (hi - lo) / 2;
      if (value[s->order[mid]] <= value[k])
        lo = mid + 1;
      else
        hi = mid;
    }
    memmove(s->order + lo + 1, s->order + lo, (k - lo) * sizeof *s->order);
    s->order[lo] = k;
  }
}

/* -- clusters */

/* by a factor: is value v of the cluster that begins with value `first`? */
static int belongs(const reducer *s, double first, double v) {
  if (s->options.cluster <= 1) return 0;
  return v == first || v <= first * s->options.cluster; /* the first: both 0 or infinite */
}

/* The untried candidate of least value and those that are like it. */
static cluster next_like(const reducer *s) {
  const double *value = deciding(s);
  cluster c = { s->next, 1, 0, UNKNOWN };
  while (
      c.first + c.count < s->r.ncandidate && belongs(s, value[s->order[c.first]], value[s->order[c.first + c.count]]))
    c.count++;
  return c;
}

/* As many as fit into what is left of the bounds if effects add up; if not even the next one does, it and those like
** it; and all together that nothing is hoped of. */
static cluster next_predicted(const reducer *s) {
  const double *value = deciding(s);
  cluster c = { s->next, 0, 0, UNKNOWN };
  uint32_t left = s->r.ncandidate - s->next;
  double sum = s->used;
  while (c.count < left && (sum += value[s->order[c.first + c.count]]) <= 1) c.count++;
  if (c.count == 0 && !(value[s->order[c.first]] > s->options.give_up)) return next_like(s);
  if (c.count == 0) c.count = left;
  return c;
}

static void push(reducer *s, cluster c) { s->stack[s->nstack++] = c; }

/* halves come before everything else */
static cluster next(reducer *s) {
  if (s->nstack) return s->stack[--s->nstack];
  cluster c = s->options.strategy == STRATEGY_PREDICTED ? next_predicted(s) : next_like(s);
  s->next += c.count;
  return c;
}

/* nothing is hoped of any of them alone */
static int is_hopeless(const reducer *s, const cluster *c) {
  const double *relative = s->value[reduce_is_relative(s->options.ranking) ? s->options.ranking : AMBIT_RANK_ADJOINT];
  if (s->options.give_up == INFINITY) return 0;
  for (uint32_t i = 0; i < c->count; i++)
    if (!(relative[s->order[c->first + i]] > s->options.give_up)) return 0;
  return 1;
}

/* -- trials */

static void mark(reducer *s, const cluster *c, uint8_t is_cut) {
  for (uint32_t i = 0; i < c->count; i++) s->cut[s->order[c->first + i]] = is_cut;
}

static void tell(const reducer *s, const cluster *c, uint32_t outcome, const double *error) {
  const ambit_try t = {
    .size = sizeof t, .outcome = outcome, .ncandidate = c->count, .candidate = s->order + c->first, .error = error
  };
  s->r.tried(s->r.user, &t);
}

/* The halves inherit the error: it is that of the second one, should the first be accepted. */
static void fail(reducer *s, const cluster *c, const double *error) {
  int halves = c->count > 1 && !is_hopeless(s, c);
  mark(s, c, 0);
  tell(s, c, halves ? AMBIT_TRY_HALVED : AMBIT_TRY_UNDONE, error);
  if (!halves) return;
  uint32_t half = c->count / 2, depth = c->depth + 1;
  s->is_known[depth] = error != NULL;
  if (error) memcpy(s->known + (size_t)depth * s->r.noutput, error, s->r.noutput * sizeof *error);
  push(s, (cluster) { c->first + half, c->count - half, depth, s->accepted + half });
  push(s, (cluster) { c->first, half, depth, UNKNOWN });
}

static int is_within(const reducer *s) {
  for (uint32_t o = 0; o < s->r.noutput; o++)
    if (!(s->error[o] <= s->r.bound[o])) return 0;
  return 1;
}

static ambit_status try_cluster(reducer *s, const cluster *c) {
  if (c->fails_at == s->accepted) {
    fail(s, c, s->is_known[c->depth] ? s->known + (size_t)c->depth * s->r.noutput : NULL);
    return AMBIT_OK;
  }
  mark(s, c, 1);
  ambit_status status = reduce_prove(s, AMBIT_PROVE_FULL, s->cut);
  if (status != AMBIT_OK && status != AMBIT_UNABLE) return status;
  if (status == AMBIT_OK && is_within(s)) {
    s->accepted += c->count;
    s->used = reduce_relative(s, s->error);
    tell(s, c, AMBIT_TRY_ACCEPTED, s->error);
  } else {
    fail(s, c, status == AMBIT_OK ? s->error : NULL);
  }
  return AMBIT_OK;
}

ambit_status cancel_run(reducer *s) {
  uint32_t n = s->r.ncandidate;
  char message[96];
  sort(s);
  while (s->nstack || s->next < n) {
    cluster c = next(s);
    snprintf(message, sizeof message, "reduction: %u of %u cut", s->accepted, n);
    if (reduce_is_stopped(s, (double)c.first / n, message)) return AMBIT_STOPPED;
    ambit_status status = try_cluster(s, &c);
    if (status != AMBIT_OK) return status;
  }
  return AMBIT_OK;
}
