/* reduction_build.c -- tapes of effects and derivatives, references as rows of the tapes' inputs, scales of states. */
#include "verbs/reduce/reduction_build.h"
#include "graph/name.h"
#include "graph/tape.h"
#include "verbs/run/unknowns.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* rounding of a state that stays where it is must not count as its variation */
#define LEAST_VARIATION 1e-6

typedef struct build {
  const ambit_reduction_request *q;
  ambit_arena *arena;
  ambit_reduction *r;
  ambit_expr *effect, *rate, *output; /* with the data that references do not give at their middle */
  ambit_expr *in;                     /* [nin] */
} build;

static void *room(const build *b, size_t n, size_t size) { return ambit_arena_alloc(b->arena, (n + 1) * size); }

/* -- the request */

static ambit_status check_effects(const ambit_reduction_request *q, ambit_failure *f) {
  for (size_t m = 0; m < q->neffect; m++) {
    if (q->effect_candidate[m] >= q->ncandidate)
      return ambit_fail(f, AMBIT_INVALID, "effect %zu is of candidate %u, but there are %zu", m + 1,
          q->effect_candidate[m] + 1u, q->ncandidate);
    if (q->effect_state[m] >= q->nx)
      return ambit_fail(f, AMBIT_INVALID, "effect %zu changes the rate of state %u, but there are %zu", m + 1,
          q->effect_state[m] + 1u, q->nx);
  }
  return AMBIT_OK;
}

static bool all_finite(size_t n, const double *x) {
  for (size_t i = 0; i < n; i++)
    if (!isfinite(x[i])) return false;
  return true;
}

static ambit_status check_reference(const ambit_reduction_request *q, size_t k, ambit_failure *f) {
  const ambit_reduction_reference *r = &q->reference[k];
  if (r->ntime == 0) return ambit_fail(f, AMBIT_INVALID, "reference %zu has no times", k + 1);
  for (size_t i = 1; i < r->ntime; i++)
    if (!(r->time[i - 1] < r->time[i]))
      return ambit_fail(f, AMBIT_INVALID, "the times of reference %zu do not ascend: %g is followed by %g", k + 1,
          r->time[i - 1], r->time[i]);
  if (!all_finite(r->ntime, r->time) || !all_finite(r->ntime * q->nx, r->x) ||
      !all_finite(r->ntime * q->ndata, r->data))
    return ambit_fail(f, AMBIT_INVALID, "reference %zu holds values that are not finite", k + 1);
  return AMBIT_OK;
}

static ambit_status check(const ambit_reduction_request *q, ambit_failure *f) {
  if (q->nx == 0) return ambit_fail(f, AMBIT_INVALID, "the model has no states");
  if (q->noutput == 0) return ambit_fail(f, AMBIT_INVALID, "there are no outputs: nothing says what may be left out");
  for (size_t o = 0; o < q->noutput; o++)
    if (!(q->bound[o] > 0 && q->bound[o] < INFINITY))
      return ambit_fail(f, AMBIT_INVALID, "the error bound of output `%s` must be greater than 0 and finite, not %g",
          q->output[o], q->bound[o]);
  ambit_status status = check_effects(q, f);
  for (size_t k = 0; k < q->nreference && status == AMBIT_OK; k++) status = check_reference(q, k, f);
  return status;
}

/* -- expressions */

static bool is_given(const ambit_reduction_request *q, ambit_expr leaf) {
  for (size_t i = 0; i < q->ndata; i++)
    if (q->data[i] == leaf) return true;
  return false;
}

/* The unknowns of e [n] that references do not give become the middle of their range. */
static ambit_status settle(const build *b, size_t n, ambit_expr *e, ambit_failure *f) {
  ambit_graph *g = b->q->graph;
  size_t nleaf, nfrom = 0;
  ambit_expr *leaf;
  ambit_status status = ambit_unknowns_leaves(g, b->arena, n, e, &nleaf, &leaf, f);
  if (status != AMBIT_OK) return status;
  ambit_expr *to = room(b, nleaf, sizeof *to);
  if (!to) return ambit_no_memory(f);
  for (size_t i = 0; i < nleaf; i++) {
    const ambit_node *node = ambit_graph_node(g, leaf[i]);
    if (!ambit_leaf_is_uncertain(node->op) || is_given(b->q, leaf[i])) continue;
    if (!ambit_interval_is_bounded(node->value)) {
      char name[AMBIT_DATUM_NAME_MAX];
      ambit_graph_leaf_name(g, leaf[i], name);
      return ambit_fail(f, AMBIT_INVALID, "the uncertain datum `%s` is not bounded", name);
    }
    leaf[nfrom] = leaf[i];
    to[nfrom] = ambit_graph_number(g, ambit_interval_mid(node->value));
    if (to[nfrom++] == AMBIT_NO_EXPR) return ambit_no_memory(f);
  }
  return ambit_graph_substitute(g, n, e, nfrom, leaf, to, f);
}

static ambit_expr *copy(const build *b, size_t n, const ambit_expr *e) {
  ambit_expr *to = room(b, n, sizeof *to);
  if (to && n) memcpy(to, e, n * sizeof *to);
  return to;
}

static ambit_status gather(build *b, ambit_failure *f) {
  const ambit_reduction_request *q = b->q;
  size_t nin = q->nx + q->ndata + 1;
  b->effect = copy(b, q->neffect, q->effect);
  b->rate = copy(b, q->nx, q->rate);
  b->output = copy(b, q->noutput, q->output_expression);
  b->in = room(b, nin, sizeof *b->in);
  if (!b->effect || !b->rate || !b->output || !b->in) return ambit_no_memory(f);
  memcpy(b->in, q->symbol, q->nx * sizeof *b->in);
  if (q->ndata) memcpy(b->in + q->nx, q->data, q->ndata * sizeof *b->in);
  b->in[nin - 1] = ambit_graph_time(q->graph);
  b->r->nin = (uint32_t)nin;
  ambit_status status = settle(b, q->neffect, b->effect, f);
  if (status == AMBIT_OK) status = settle(b, q->nx, b->rate, f);
  return status == AMBIT_OK ? settle(b, q->noutput, b->output, f) : status;
}

static ambit_status seal(const build *b, size_t n, const ambit_expr *e, const ambit_tape **tape, ambit_failure *f) {
  return ambit_tape_seal(b->q->graph, b->arena, n, e, b->r->nin, b->in, 0, 0, tape, f);
}

/* *tape stays NULL where an expression has no derivative. */
static ambit_status differentiate(
    const build *b, size_t n, const ambit_expr *e, const ambit_tape **tape, ambit_failure *f) {
  size_t nx = b->q->nx;
  ambit_expr *entry = room(b, n * nx, sizeof *entry);
  if (!entry) return ambit_no_memory(f);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < nx; j++) {
      ambit_failure why = { 0 };
      entry[i * nx + j] = ambit_graph_derivative(b->q->graph, e[i], b->in[j], &why);
      if (entry[i * nx + j] == AMBIT_NO_EXPR) return why.status == AMBIT_INVALID ? AMBIT_OK : ambit_no_memory(f);
    }
  return seal(b, n * nx, entry, tape, f);
}

static ambit_status seal_all(build *b, uint32_t want, ambit_failure *f) {
  const ambit_reduction_request *q = b->q;
  ambit_reduction *r = b->r;
  ambit_status status = q->neffect ? seal(b, q->neffect, b->effect, &r->effect, f) : AMBIT_OK;
  if (status != AMBIT_OK || !(want & AMBIT_STRATEGY_WANT_SLOPES)) return status;
  status = seal(b, q->nx, b->rate, &r->rates, f);
  if (status == AMBIT_OK) status = seal(b, q->noutput, b->output, &r->output_value, f);
  if (status == AMBIT_OK) status = differentiate(b, q->nx, b->rate, &r->jacobian, f);
  return status == AMBIT_OK ? differentiate(b, q->noutput, b->output, &r->output_jacobian, f) : status;
}

/* -- references */

static ambit_status copy_reference(
    const build *b, const ambit_reduction_reference *from, ambit_reference *to, ambit_failure *f) {
  size_t nx = b->q->nx, ndata = b->q->ndata, nin = b->r->nin;
  double *in = room(b, from->ntime * nin, sizeof *in);
  if (!in) return ambit_no_memory(f);
  for (size_t j = 0; j < from->ntime; j++) {
    memcpy(in + j * nin, from->x + j * nx, nx * sizeof *in);
    if (ndata) memcpy(in + j * nin + nx, from->data + j * ndata, ndata * sizeof *in);
    in[j * nin + nx + ndata] = from->time[j];
  }
  *to = (ambit_reference) { from->scenario, (uint32_t)from->ntime, from->time, in };
  return AMBIT_OK;
}

static double find_scale(const ambit_reduction_request *q, size_t i) {
  double lo = INFINITY, hi = -INFINITY;
  for (size_t k = 0; k < q->nreference; k++)
    for (size_t j = 0; j < q->reference[k].ntime; j++) {
      double x = q->reference[k].x[j * q->nx + i];
      lo = fmin(lo, x), hi = fmax(hi, x);
    }
  if (!(lo <= hi)) return 0;
  double size = fmax(fabs(lo), fabs(hi));
  return hi - lo > LEAST_VARIATION * size ? fmin(hi - lo, DBL_MAX) : size;
}

static ambit_status build_references(build *b, ambit_failure *f) {
  const ambit_reduction_request *q = b->q;
  ambit_reference *reference = room(b, q->nreference, sizeof *reference);
  double *scale = room(b, q->nx, sizeof *scale);
  if (!reference || !scale) return ambit_no_memory(f);
  ambit_status status = AMBIT_OK;
  for (size_t k = 0; k < q->nreference && status == AMBIT_OK; k++)
    status = copy_reference(b, &q->reference[k], &reference[k], f);
  for (size_t i = 0; i < q->nx; i++) scale[i] = find_scale(q, i);
  b->r->reference = reference, b->r->scale = scale;
  return status;
}

ambit_status ambit_reduction_build(
    const ambit_reduction_request *q, uint32_t want, ambit_arena *arena, ambit_reduction *r, ambit_failure *f) {
  *r = (ambit_reduction) { .size = sizeof *r,
    .ncandidate = (uint32_t)q->ncandidate,
    .noutput = (uint32_t)q->noutput,
    .nreference = (uint32_t)q->nreference,
    .neffect = (uint32_t)q->neffect,
    .candidate = q->candidate,
    .output = q->output,
    .bound = q->bound,
    .effect_candidate = q->effect_candidate,
    .effect_state = q->effect_state };
  build b = { .q = q, .arena = arena, .r = r };
  ambit_status status = check(q, f);
  if (status == AMBIT_OK) status = gather(&b, f);
  if (status == AMBIT_OK) status = seal_all(&b, want, f);
  return status == AMBIT_OK ? build_references(&b, f) : status;
}
