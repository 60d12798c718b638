/* contract.c -- HC4-revise (Benhamou, Goualard, Granvilliers & Puget, ICLP 1999): forward evaluation of a tape over a
** box, outputs narrowed to what they have to be, then every instruction backwards.
**
** Sound: let x be a point of the box at which the tape is defined and its outputs are as demanded. Forward, every slot
** holds the slot's value at x (natural interval extension; parts outside a domain are dropped, x is not among them).
** Backwards the value stays in its slot, because each inverse keeps every solution of its instruction. A slot is used
** by later instructions only, so that it is as narrow as they make it when its own turn comes. One pass; the caller
** repeats it while it pays.
*/
#include "graph/contract.h"
#include "num/interval.h"
#include <ambit/work.h>
#include <float.h>
#include <math.h>
#include <string.h>

struct ambit_contractor {
  const ambit_tape *tape;
  ambit_interval *slot; /* [nslot] */
  uint32_t *lowest;     /* [nslot] the first input that the slot depends on, or nin */
  ambit_work *work;     /* or NULL */
};

static int32_t exponent(const ambit_tape *t, uint32_t i) {
  int32_t n;
  memcpy(&n, &t->b[i], sizeof n);
  return n;
}

static uint32_t lower(uint32_t a, uint32_t b) { return a < b ? a : b; }

static void find_lowest(const ambit_tape *t, uint32_t *lowest) {
  for (uint32_t i = 0; i < t->nconst; i++) lowest[i] = t->nin;
  for (uint32_t i = 0; i < t->nin; i++) lowest[t->nconst + i] = i;
  for (uint32_t i = 0; i < t->ninstr; i++) {
    uint32_t a = lowest[t->a[i]];
    lowest[t->dst[i]] = t->op[i] == AMBIT_OP_POWN ? a : lower(a, lowest[t->b[i]]);
  }
}

static ambit_status open(const ambit_host *h, const ambit_tape *t, ambit_contractor **out) {
  ambit_contractor *c = h->alloc(h, sizeof *c);
  ambit_interval *slot = h->alloc(h, (t->nslot + 1u) * sizeof *slot);
  uint32_t *lowest = h->alloc(h, (t->nslot + 1u) * sizeof *lowest);
  if (!c || !slot || !lowest) return h->fail(h, AMBIT_NOMEM, "out of memory");
  *c = (ambit_contractor) { t, slot, lowest, ambit_work_open(h) };
  find_lowest(t, lowest);
  for (uint32_t i = 0; i < t->nconst; i++) slot[i] = (ambit_interval) { t->lo[i], t->hi[i] };
  *out = c;
  return AMBIT_OK;
}

/* does op jump or bend somewhere over these operands? */
static bool has_kink(uint32_t op, ambit_interval a, ambit_interval b) {
  switch (op) {
  case AMBIT_OP_ABS: return a.lo < 0 && a.hi > 0;
  case AMBIT_OP_MIN:
  case AMBIT_OP_MAX: return a.lo <= b.hi && b.lo <= a.hi;
  case AMBIT_OP_ATAN2: return b.lo < 0 && a.lo < 0 && a.hi >= 0; /* across the negative half axis */
  default: return false;
  }
}

/* constants are in place; flags over all slots; KINK along the first n inputs */
static uint32_t forward(const ambit_contractor *c, const double *lo, const double *hi, uint32_t n) {
  const ambit_tape *t = c->tape;
  ambit_interval *slot = c->slot;
  uint32_t flags = 0;
  for (uint32_t i = 0; i < t->nin; i++) slot[t->nconst + i] = (ambit_interval) { lo[i], hi[i] };
  for (uint32_t i = 0; i < t->ninstr; i++) {
    ambit_interval *r = &slot[t->dst[i]], a = slot[t->a[i]];
    if (t->op[i] == AMBIT_OP_POWN) {
      flags |= ambit_interval_pown(r, a, exponent(t, i));
      continue;
    }
    ambit_interval b = slot[t->b[i]];
    flags |= ambit_interval_op(t->op[i], r, a, b);
    if (has_kink(t->op[i], a, b)) flags |= c->lowest[t->dst[i]] < n ? AMBIT_F_KINK : AMBIT_F_KINK_ELSEWHERE;
  }
  return flags;
}

static bool demand(const ambit_contractor *c, const double *out_lo, const double *out_hi) {
  const ambit_tape *t = c->tape;
  for (uint32_t k = 0; k < t->nout; k++) {
    ambit_interval wanted = { out_lo ? out_lo[k] : 0, out_hi ? out_hi[k] : 0 }, *r = &c->slot[t->out[k]];
    if (t->out[k] < t->nconst) { /* constants stay as they are: the next forward pass needs them */
      if (ambit_interval_is_empty(ambit_interval_intersect(*r, wanted))) return false;
      continue;
    }
    *r = ambit_interval_intersect(*r, wanted);
    if (ambit_interval_is_empty(*r)) return false;
  }
  return true;
}

static bool is_bounded(const ambit_contractor *c, const double *lo, const double *hi) {
  for (uint32_t i = 0; i < c->tape->nin; i++)
    if (isinf(lo[i]) || isinf(hi[i])) return false;
  return true;
}

/* exp has no zero, but the limit 0 at -infinity. Where bounded inputs lead there, at the edge of the domain of a
** logarithm or quotient, it is kept: x^y, which is exp(y log(x)), is 0 at x = 0 as whoever writes it means it. */
static bool inverse_exp(bool bounded, ambit_interval r, ambit_interval *a) {
  if (!bounded || r.hi != 0 || a->lo > -INFINITY) return ambit_inverse(AMBIT_OP_EXP, r, a, a);
  a->hi = fmin(a->hi, -DBL_MAX);
  return true;
}

static bool backward(const ambit_contractor *c, bool bounded) {
  const ambit_tape *t = c->tape;
  ambit_interval *slot = c->slot;
  for (uint32_t i = t->ninstr; i-- > 0;) {
    ambit_interval r = slot[t->dst[i]], a = slot[t->a[i]];
    if (t->op[i] == AMBIT_OP_POWN) {
      if (!ambit_inverse_pown(exponent(t, i), r, &a)) return false;
    } else if (t->op[i] == AMBIT_OP_EXP) {
      if (!inverse_exp(bounded, r, &a)) return false;
    } else {
      ambit_interval b = slot[t->b[i]];
      if (!ambit_inverse(t->op[i], r, &a, &b)) return false;
      if (t->b[i] != t->a[i] && t->b[i] >= t->nconst) slot[t->b[i]] = b;
    }
    if (t->a[i] >= t->nconst) slot[t->a[i]] = a;
  }
  return true;
}

static ambit_status narrow(ambit_contractor *c, double *lo, double *hi, const double *out_lo, const double *out_hi) {
  const ambit_tape *t = c->tape;
  if (c->work) c->work->contractions++, c->work->operations += 2 * (uint64_t)t->ninstr;
  if (forward(c, lo, hi, 0) & AMBIT_F_EMPTY) return AMBIT_DOMAIN;
  if (!demand(c, out_lo, out_hi) || !backward(c, is_bounded(c, lo, hi))) return AMBIT_DOMAIN;
  for (uint32_t i = 0; i < t->nin; i++) {
    lo[i] = c->slot[t->nconst + i].lo;
    hi[i] = c->slot[t->nconst + i].hi;
  }
  return AMBIT_OK;
}

static uint32_t inspect_in(ambit_contractor *c, const double *lo, const double *hi, uint32_t n) {
  ambit_work_evaluate(c->work, c->tape->ninstr, 1);
  return forward(c, lo, hi, n);
}

/* a constant operation may have a kink too */
static uint32_t inspect(ambit_contractor *c, const double *lo, const double *hi) {
  return inspect_in(c, lo, hi, UINT32_MAX);
}

const ambit_contract_service ambit_contract_service_v1 = { sizeof ambit_contract_service_v1, open, narrow, inspect,
  inspect_in };
