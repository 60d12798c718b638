/* rank.c -- the rankings that are asked for, one after the other, and the order that one of them gives. */
#include "reduce.h"
#include <ambit/code.h>
#include <math.h>
#include <string.h>

int reduce_is_stopped(reducer *s, double done, const char *message) {
  return s->sink->progress && s->sink->progress(s->sink, done, message);
}

double reduce_relative(const reducer *s, const double *error) {
  double worst = 0;
  for (uint32_t o = 0; o < s->r.noutput; o++) {
    double relative = fabs(error[o]) / s->r.bound[o];
    if (!(relative <= worst)) worst = relative;
  }
  return isfinite(worst) ? worst : INFINITY;
}

ambit_status reduce_prove(reducer *s, uint32_t how, const uint8_t *cut) {
  if (s->proofs >= s->options.proofs_max)
    return s->host->fail_code(s->host, AMBIT_STOPPED, AMBIT_CODE_STOPPED_LIMIT,
        "the limit of %.0f proofs is reached: what was accepted until then is proved; raise `proofs_max` to go on",
        s->options.proofs_max);
  s->proofs++;
  ambit_status status = s->r.prove(s->r.user, how, cut, s->error);
  return status == AMBIT_DOMAIN ? AMBIT_UNABLE : status;
}

static ambit_status compute(reducer *s, uint32_t ranking) {
  if (!s->r.neffect && ranking != AMBIT_RANK_LOWERED && ranking != AMBIT_RANK_EXACT) return AMBIT_OK; /* all are 0 */
  switch (ranking) {
  case AMBIT_RANK_RESIDUAL: residual_rank(s); return AMBIT_OK;
  case AMBIT_RANK_ONE_STEP: one_step_rank(s); return AMBIT_OK;
  case AMBIT_RANK_ADJOINT: adjoint_rank(s); return AMBIT_OK;
  default: return alone_rank(s, ranking);
  }
}

static void tell_undefined(const reducer *s, const double *value) {
  uint32_t n = 0, first = 0;
  for (uint32_t k = 0; k < s->r.ncandidate; k++)
    if (!isfinite(value[k]) && n++ == 0) first = k;
  if (n)
    s->host->note(s->host, "reduction: the effect of %u candidate%s is not defined along the references (`%s`%s): last",
        n, n == 1 ? "" : "s", s->r.candidate[first], n == 1 ? "" : ", ...");
  if (s->undefined)
    s->host->note(
        s->host, "reduction: %u derivatives are not defined along the references and count as 0", s->undefined);
}

ambit_status rank_all(reducer *s) {
  if (s->r.neffect && s->r.nreference) residual_settle_scales(s);
  for (uint32_t i = 0; i < AMBIT_RANK_COUNT; i++) {
    if (!s->value[i]) continue;
    if (reduce_is_stopped(s, 0, "reduction: ranking")) return AMBIT_STOPPED;
    ambit_status status = compute(s, i);
    if (status != AMBIT_OK) return status;
    if (s->r.rank) s->r.rank(s->r.user, i, s->value[i]);
    if (i == s->options.ranking) tell_undefined(s, s->value[i]);
  }
  return AMBIT_OK;
}
