/* plugin.c -- the entry of the plugin and its options. */
#include "reduce.h"
#include <math.h>
#include <string.h>

enum {
  OPTION_RANKING,
  OPTION_RESIDUAL,
  OPTION_ONE_STEP,
  OPTION_LOWERED_ORDER,
  OPTION_EXACT,
  OPTION_ADJOINT,
  OPTION_CLUSTER,
  OPTION_STRATEGY,
  OPTION_GIVE_UP,
  OPTION_PROOFS_MAX,
  OPTION_NORM,
  OPTION_ENDS
};

static const ambit_param param[] = {
  { "ranking", "1", "residual|one_step|lowered_order|exact|adjoint", "residual",
      "the estimated effect that decides in which order candidates are tried" },
  { "residual", "1", "flag", "false", "compute this ranking as well, for comparison: norm of the changed rates" },
  { "one_step", "1", "flag", "false", "compute this ranking as well: change of the outputs in one implicit step" },
  { "lowered_order", "1", "flag", "false", "compute this ranking as well: a cheap proof of each candidate alone" },
  { "exact", "1", "flag", "false", "compute this ranking as well: a full proof of each candidate alone" },
  { "adjoint", "1", "flag", "false", "compute this ranking as well: change of the outputs to first order" },
  { "cluster", "1", "", "10",
      "candidates whose effects differ by at most this factor are tried with one proof; 1: one by one; inf: all" },
  { "strategy", "1", "clusters|predicted", "clusters",
      "clusters: by that factor; predicted: as many as fit into the bounds if effects add up (`ranking`: adjoint, "
      "exact "
      "or lowered_order)" },
  { "give_up", "1", "", "inf",
      "a cluster that fails is not halved if each of it alone exceeds the bounds more than so many times, by the "
      "adjoint ranking (or by exact, lowered_order if that one decides)" },
  { "proofs_max", "1", "integer", "1000000", "proofs before the search stops with what was accepted until then" },
  { "norm", "1", "rms|max", "rms", "over time, of the residual ranking" },
  { "ends", "1", "integer", "16", "times at which the adjoint ranking looks at the outputs, spread over a reference" },
  { NULL, NULL, NULL, NULL, NULL },
};

static void read_options(const double *option, options *o) {
  static const uint32_t ranking[] = { AMBIT_RANK_RESIDUAL, AMBIT_RANK_ONE_STEP, AMBIT_RANK_LOWERED, AMBIT_RANK_EXACT,
    AMBIT_RANK_ADJOINT };
  *o = (options) { .ranking = ranking[(size_t)option[OPTION_RANKING]],
    .norm = (uint32_t)option[OPTION_NORM],
    .cluster = option[OPTION_CLUSTER],
    .strategy = (uint32_t)option[OPTION_STRATEGY],
    .give_up = option[OPTION_GIVE_UP],
    .proofs_max = option[OPTION_PROOFS_MAX] };
  for (uint32_t i = 0; i < AMBIT_RANK_COUNT; i++) o->also[ranking[i]] = option[OPTION_RESIDUAL + i] != 0;
  if (o->give_up < INFINITY && !reduce_is_relative(o->ranking)) o->also[AMBIT_RANK_ADJOINT] = 1;
}

ambit_status reduce_options(const ambit_host *h, const double *option, options *o) {
  read_options(option, o);
  if (!(o->cluster >= 1)) return h->fail(h, AMBIT_INVALID, "option `cluster` must be 1 or greater, not %g", o->cluster);
  if (!(o->proofs_max >= 1))
    return h->fail(h, AMBIT_INVALID, "option `proofs_max` must be 1 or greater, not %g", o->proofs_max);
  if (!(o->give_up >= 1)) return h->fail(h, AMBIT_INVALID, "option `give_up` must be 1 or greater, not %g", o->give_up);
  if (o->strategy == STRATEGY_PREDICTED && !reduce_is_relative(o->ranking))
    return h->fail(h, AMBIT_INVALID,
        "option `strategy` = predicted needs a `ranking` relative to the bounds: adjoint, exact or lowered_order");
  if (!(option[OPTION_ENDS] >= 1 && option[OPTION_ENDS] <= 10000))
    return h->fail(h, AMBIT_INVALID, "option `ends` must be between 1 and 10000, not %g", option[OPTION_ENDS]);
  o->ends = (uint32_t)option[OPTION_ENDS];
  return AMBIT_OK;
}

static ambit_status run(void *self, ambit_sink *sink) {
  reducer *s = self;
  s->sink = sink;
  if (!s->r.ncandidate) return AMBIT_OK;
  ambit_status status = rank_all(s);
  return status == AMBIT_OK ? cancel_run(s) : status;
}

static uint32_t want_for(const double *option) {
  options o;
  read_options(option, &o);
  return reduce_wants(&o, AMBIT_RANK_ONE_STEP) || reduce_wants(&o, AMBIT_RANK_ADJOINT) ? AMBIT_STRATEGY_WANT_SLOPES : 0;
}

static const ambit_strategy interface = {
  .size = sizeof interface,
  .want = AMBIT_STRATEGY_WANT_SLOPES,
  .needs_rigorous = 0,
  .arithmetics = "real",
  .param = param,
  .open = reduce_open,
  .run = run,
  .close = reduce_close,
  .want_for = want_for,
};

static const void *get(const char *interface_id) {
  return strcmp(interface_id, AMBIT_STRATEGY) == 0 ? &interface : NULL;
}

const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "solver.reduction", "1.0",
  "Chooses which terms a model may leave out: ranks them by their effect (residual, one implicit step, adjoint, each "
  "proved alone), cuts them in ascending order, in clusters that one proof decides, and undoes and halves what fails.",
  get };
