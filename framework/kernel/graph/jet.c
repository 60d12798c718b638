/* jet.c -- service "ambit.jet/1": the arithmetic's own jets if it offers them, else the kernel's general ones; tails
** beside them. */
#include "graph/jet.h"
#include "base/meter.h"
#include <ambit/work.h>
#include "graph/tail.h"
#include "num/interval.h"
#include "num/rounding.h"
#include <math.h>
#include <string.h>

#define PROVES_NOTHING (AMBIT_F_PARTIAL | AMBIT_F_UNBOUNDED | AMBIT_F_EMPTY)

struct ambit_jet {
  const ambit_host *host;
  const ambit_jet *centre; /* of slopes; NULL: derivatives */
  ambit_jets jets;         /* completed copy */
  void *self;
  const ambit_tape *tape;
  uint32_t order, ndir;
  uint32_t known;          /* orders that are computed, all from 0 on */
  uint32_t flags;          /* raised by them */
  ambit_jet_source source; /* the general jets' context */
  ambit_tails *tails;
  double *mid, *rad; /* [ndir] scratch of integrate */
  ambit_work *work;  /* or NULL */
  bool metered;
  uint32_t *moving; /* [order + 1] results whose degree in time is at least k */
};

/* -- opening */

static bool has_series(uint32_t op) {
  switch (op) {
  case AMBIT_OP_POWN:
  case AMBIT_OP_TAN:
  case AMBIT_OP_ASIN:
  case AMBIT_OP_ACOS: return false;
  default: return op < AMBIT_OP_COUNT;
  }
}

static bool needs_aux(uint32_t op) {
  switch (op) {
  case AMBIT_OP_SIN:
  case AMBIT_OP_COS:
  case AMBIT_OP_SINH:
  case AMBIT_OP_COSH:
  case AMBIT_OP_TANH:
  case AMBIT_OP_ATAN:
  case AMBIT_OP_ATAN2: return true;
  default: return false;
  }
}

static ambit_status check_tape(const ambit_host *h, const ambit_tape *t) {
  if (!(t->flags & AMBIT_TAPE_SERIES))
    return h->fail(h, AMBIT_INVALID, "power series need a tape sealed with AMBIT_TAPE_SERIES");
  for (uint32_t i = 0; i < t->ninstr; i++) {
    if (!has_series(t->op[i]))
      return h->fail(
          h, AMBIT_INVALID, "instruction %u of the tape has opcode %u, which has no power series", i, t->op[i]);
    if (needs_aux(t->op[i]) && t->degree[t->dst[i]] != 0 && t->aux[i] >= t->nslot)
      return h->fail(h, AMBIT_INVALID, "instruction %u of the tape lacks its helper slot", i);
  }
  return AMBIT_OK;
}

static void choose_jets(ambit_jet *jet, const ambit_arithmetic *arithmetic) {
  const ambit_jets *own = arithmetic->jets ? arithmetic->jets : &ambit_jets_general;
  memcpy(&jet->jets, own, own->size < sizeof jet->jets ? own->size : sizeof jet->jets);
}

static bool is_complete(const ambit_jets *jets) {
  return jets->open && jets->close && jets->put && jets->advance && jets->get && jets->magnitude;
}

static ambit_status check_centre(const ambit_host *h, const ambit_jet *jet, const ambit_jet *centre) {
  if (!centre) return AMBIT_OK;
  if (centre->tape == jet->tape && centre->jets.open == jet->jets.open && centre->order >= jet->order) return AMBIT_OK;
  return h->fail(h, AMBIT_INVALID, "the centre of slopes must hold series of the same tape and arithmetic to order %u",
      jet->order);
}

/* how many results have a coefficient of each order */
static void count_moving(ambit_jet *jet) {
  const ambit_tape *t = jet->tape;
  for (uint32_t i = 0; i < t->ninstr; i++) {
    uint32_t degree = t->degree[t->dst[i]];
    jet->moving[degree < jet->order ? degree : jet->order]++;
  }
  for (uint32_t k = jet->order; k > 0; k--) jet->moving[k - 1] += jet->moving[k];
}

static ambit_jet *allocate(
    const ambit_host *h, const ambit_tape *t, uint32_t order, uint32_t ndir, const ambit_jet *centre) {
  ambit_jet *jet = h->alloc(h, sizeof *jet);
  if (!jet) return NULL;
  *jet = (ambit_jet) { .host = h, .centre = centre, .tape = t, .order = order, .ndir = ndir };
  jet->mid = h->alloc(h, ndir * sizeof(double));
  jet->rad = h->alloc(h, ndir * sizeof(double));
  jet->moving = h->alloc(h, (order + (size_t)1) * sizeof *jet->moving);
  jet->work = ambit_work_open(h);
  jet->metered = ambit_meter_is_on();
  if (!jet->mid || !jet->rad || !jet->moving) return NULL;
  count_moving(jet);
  if (jet->work) jet->work->series++;
  return jet;
}

static ambit_status open(const ambit_host *h, const ambit_tape *t, const ambit_arithmetic *arithmetic, void *actx,
    uint32_t order, uint32_t ndir, const ambit_jet *centre, ambit_jet **jet) {
  *jet = NULL;
  ambit_status status = check_tape(h, t);
  if (status != AMBIT_OK) return status;
  if (order > UINT32_MAX / 4 || ndir > UINT32_MAX / 4)
    return h->fail(h, AMBIT_INVALID, "power series to order %u with %u directions are too large", order, ndir);
  ambit_jet *made = allocate(h, t, order, ndir, centre);
  if (!made) return h->fail(h, AMBIT_NOMEM, "out of memory for power series");
  made->source = (ambit_jet_source) { arithmetic, actx };
  choose_jets(made, arithmetic);
  if (!is_complete(&made->jets))
    return h->fail(
        h, AMBIT_INVALID, "the arithmetic's power series lack one of open, close, put, advance, get, magnitude");
  status = check_centre(h, made, centre);
  if (status == AMBIT_OK) status = ambit_tails_open(h, t, order, ndir, &made->tails);
  if (status != AMBIT_OK) return status;
  void *ctx = arithmetic->jets ? actx : &made->source;
  status = made->jets.open(h, ctx, t, order, ndir, centre ? centre->self : NULL, &made->self);
  if (status == AMBIT_OK) *jet = made;
  return status;
}

static void close(ambit_jet *jet) {
  if (jet && jet->self) jet->jets.close(jet->self);
  if (jet) jet->self = NULL;
}

/* -- coefficients */

static void put(
    ambit_jet *jet, uint32_t in, uint32_t k, double mid, double rad, const double *dmid, const double *drad) {
  if (k > jet->order) return;
  if (jet->known > k) jet->known = k;
  jet->tails->fetched = 0;
  jet->jets.put(jet->self, in, k, mid, rad, dmid, drad);
}

static void count_order(const ambit_jet *jet, uint32_t k) {
  ambit_work *work = jet->work;
  if (!work) return;
  uint64_t each = 1 + (uint64_t)jet->ndir, done = jet->moving[k] * each;
  work->orders++;
  work->operations += done;
  work->coefficients += done;
  work->skipped += jet->tape->ninstr * each - done;
}

static bool has_empty_constant(const ambit_tape *t) {
  for (uint32_t i = 0; i < t->nconst; i++)
    if (!(t->lo[i] <= t->hi[i])) return true;
  return false;
}

/* `flags`: of all orders so far and of the centre. Inputs are never empty. */
static void check_empty(const ambit_jet *jet, uint32_t flags) {
  if (flags & AMBIT_F_EMPTY)
    ambit_empty_check(jet->source.arithmetic, flags, has_empty_constant(jet->tape), INFINITY, -INFINITY);
}

/* An order builds on all below it, slopes also on the centre's. */
static uint32_t advance(ambit_jet *jet, uint32_t k) {
  const ambit_jet *centre = jet->centre;
  if (k > jet->known || k > jet->order || (centre && k >= centre->known)) return AMBIT_F_UNBOUNDED;
  if (jet->metered) ambit_meter_enter(AMBIT_FRAME_ARITHMETIC, jet->source.arithmetic->jets ? "own series" : "series");
  uint32_t flags = jet->jets.advance(jet->self, k);
  if (jet->metered) ambit_meter_leave();
  count_order(jet, k);
  if (centre && (centre->flags & PROVES_NOTHING)) flags |= AMBIT_F_UNBOUNDED;
  jet->tails->fetched = 0;
  jet->known = k + 1;
  jet->flags = k ? jet->flags | flags : flags;
  check_empty(jet, jet->flags | (centre ? centre->flags : 0));
  return flags;
}

static void get(const ambit_jet *jet, uint32_t slot, uint32_t k, double *mid, double *rad, double *dmid, double *drad) {
  jet->jets.get(jet->self, slot, k, mid, rad, dmid, drad);
  if (*rad < 0) ambit_fault_note(jet->source.arithmetic, AMBIT_FAULT_SERIES, *mid, *rad);
  for (uint32_t d = 0; drad && d < jet->ndir; d++)
    if (drad[d] < 0) ambit_fault_note(jet->source.arithmetic, AMBIT_FAULT_SERIES, dmid ? dmid[d] : 0, drad[d]);
}

/* (mid +- rad) / n in upward mode: the quotient's rounding goes into the radius */
static void divide(double *mid, double *rad, double n) {
  double high = *mid / n, low = -(-*mid / n);
  *rad = *rad / n + (high - low);
  *mid = high;
}

static AMBIT_WORKER void divide_all(size_t ndir, double *mid, double *rad, double *dmid, double *drad, uint32_t n) {
  divide(mid, rad, n);
  for (size_t d = 0; d < ndir; d++) divide(&dmid[d], &drad[d], n);
}

static void integrate(ambit_jet *jet, uint32_t in, uint32_t slot, uint32_t k) {
  double mid = 0, rad = 0;
  if (jet->jets.integrate) {
    jet->jets.integrate(jet->self, in, slot, k);
    return;
  }
  get(jet, slot, k, &mid, &rad, jet->mid, jet->rad);
  ambit_rounding old = ambit_round_up();
  divide_all(jet->ndir, &mid, &rad, jet->mid, jet->rad, k + 1);
  ambit_rounding_restore(old);
  jet->jets.put(jet->self, in, k + 1, mid, rad, jet->mid, jet->rad);
}

static uint32_t solve(ambit_jet *jet, uint32_t nx, uint32_t order) {
  for (uint32_t k = 0; k < order; k++) {
    uint32_t flags = advance(jet, k);
    if (flags) return flags;
    if (jet->metered) ambit_meter_enter(AMBIT_FRAME_ARITHMETIC, "integration");
    for (uint32_t i = 0; i < nx; i++) integrate(jet, i, jet->tape->out[i], k);
    if (jet->metered) ambit_meter_leave();
  }
  return 0;
}

static void claim_nothing(const ambit_jet *jet, double *tail_out, double *dtail_out) {
  for (uint32_t o = 0; o < jet->tape->nout; o++) tail_out[o] = INFINITY;
  for (size_t o = 0; o < (size_t)jet->tape->nout * jet->ndir && dtail_out; o++) dtail_out[o] = INFINITY;
}

/* a bound of a tail; of an input that is constant in time: none */
static bool is_tail(double x, bool steady) { return steady ? x == 0 : x >= 0; }

static ambit_status check_input(const ambit_jet *jet, uint32_t i, double tail, const double *dtail) {
  bool steady = jet->tape->degree[jet->tape->nconst + i] == 0;
  const char *expected = steady ? "0, for the tape takes the input for constant in time" : "a number >= 0";
  if (!is_tail(tail, steady))
    return jet->host->fail(jet->host, AMBIT_INVALID, "the tail of input %u is %g, not %s", i, tail, expected);
  for (uint32_t d = 0; d < jet->ndir && dtail; d++)
    if (!is_tail(dtail[d], steady))
      return jet->host->fail(
          jet->host, AMBIT_INVALID, "the tail of input %u in direction %u is %g, not %s", i, d, dtail[d], expected);
  return AMBIT_OK;
}

static ambit_status check_tail(
    const ambit_jet *jet, uint32_t K, double h, const double *tail_in, const double *dtail_in) {
  if (K >= jet->known)
    return jet->host->fail(jet->host, AMBIT_INVALID,
        "a tail beyond order %u needs all orders up to it, but only %u are computed", K, jet->known);
  if (!isfinite(h)) return jet->host->fail(jet->host, AMBIT_INVALID, "a tail needs a finite step, not %g", h);
  ambit_status status = AMBIT_OK;
  for (uint32_t i = 0; i < jet->tape->nin && status == AMBIT_OK; i++)
    status = check_input(jet, i, tail_in ? tail_in[i] : 0, dtail_in ? dtail_in + (size_t)i * jet->ndir : NULL);
  return status;
}

static ambit_status tail(ambit_jet *jet, uint32_t K, double h, const double *tail_in, const double *dtail_in,
    double *tail_out, double *dtail_out) {
  ambit_status status = check_tail(jet, K, h, tail_in, dtail_in);
  if (status != AMBIT_OK || (jet->flags & PROVES_NOTHING))
    claim_nothing(jet, tail_out, dtail_out);
  else
    ambit_tails_run(jet->tails, &jet->jets, jet->self, K, h, tail_in, dtail_in, tail_out, dtail_out);
  if (jet->work) jet->work->tails++;
  return status;
}

/* bounds of coefficient 0, as midpoint and radius */
static ambit_interval start_of(const ambit_jet *jet, uint32_t slot) {
  double mid, rad;
  get(jet, slot, 0, &mid, &rad, NULL, NULL);
  if (!isfinite(mid) || !isfinite(rad)) return AMBIT_ENTIRE;
  return ambit_interval_add((ambit_interval) { mid, mid }, (ambit_interval) { -rad, rad });
}

static const char *kink(const ambit_jet *jet) {
  const ambit_tape *t = jet->tape;
  for (uint32_t i = 0; i < t->ninstr && jet->known && t->kink; i++) {
    if (!t->kink[i]) continue;
    ambit_interval x = start_of(jet, t->a[i]);
    if (t->op[i] != AMBIT_OP_ABS) x = ambit_interval_sub(x, start_of(jet, t->b[i]));
    if (x.lo <= 0 && x.hi >= 0) return t->kink[i];
  }
  return NULL;
}

const ambit_jet_service ambit_jet_service_v1 = {
  .size = sizeof(ambit_jet_service),
  .open = open,
  .close = close,
  .put = put,
  .advance = advance,
  .get = get,
  .solve = solve,
  .tail = tail,
  .kink = kink,
};
