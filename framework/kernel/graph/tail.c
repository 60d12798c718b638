/* tail.c -- the tail pass: memory, magnitudes, powers of the step, the order of things.
**
** Magnitudes are fetched once per series and scaled once per step length, so that choosing a step and verifying it
** cost little.
*/
#include "graph/tail.h"
#include "num/rounding.h"
#include <math.h>
#include <string.h>

/* -- memory */

static void mark_flows(ambit_tails *t) {
  const ambit_tape *tape = t->tape;
  for (uint32_t i = 0; i < tape->ninstr; i++) {
    switch (tape->op[i]) {
    case AMBIT_OP_EXP:
    case AMBIT_OP_SIN:
    case AMBIT_OP_COS:
    case AMBIT_OP_SINH:
    case AMBIT_OP_COSH:
    case AMBIT_OP_TANH: t->flows[tape->a[i]] = 1; break;
    case AMBIT_OP_LOG:
    case AMBIT_OP_ATAN: t->flows[tape->dst[i]] = 1; break;
    case AMBIT_OP_ATAN2: t->flows[tape->a[i]] = t->flows[tape->b[i]] = t->flows[tape->dst[i]] = 1; break;
    default: break;
    }
  }
}

static bool allocate(const ambit_host *h, ambit_tails *t) {
  size_t n = t->tape->nslot, lanes = t->ndir, size = sizeof(double), row, all;
  if (__builtin_mul_overflow(n, t->stride, &row) || __builtin_mul_overflow(row, lanes + 1, &all) ||
      __builtin_mul_overflow(all, size, &all))
    return false;
  double **const rows[] = { &t->mag, &t->U, &t->W, &t->R, &t->RW };
  double **const each[] = { &t->lo, &t->hi, &t->sum, &t->swing, &t->tau };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    if (!(*rows[i] = h->alloc(h, row * size))) return false;
  for (size_t i = 0; i < sizeof each / sizeof *each; i++)
    if (!(*each[i] = h->alloc(h, n * size))) return false;
  t->active = h->alloc(h, t->tape->ninstr * sizeof *t->active);
  t->moving = h->alloc(h, n);
  t->flows = h->alloc(h, n);
  t->power = h->alloc(h, t->stride * size);
  t->weight = h->alloc(h, t->stride * size);
  if (!t->active || !t->moving || !t->flows || !t->power || !t->weight) return false;
  if (lanes == 0) return true;
  t->lane = h->alloc(h, lanes * size);
  t->dmag = h->alloc(h, row * lanes * size);
  t->V = h->alloc(h, row * lanes * size);
  t->vsum = h->alloc(h, n * lanes * size);
  t->sigma = h->alloc(h, n * lanes * size);
  return t->lane && t->dmag && t->V && t->vsum && t->sigma;
}

ambit_status ambit_tails_open(
    const ambit_host *h, const ambit_tape *tape, uint32_t order, uint32_t ndir, ambit_tails **tails) {
  ambit_tails *t = h->alloc(h, sizeof *t);
  if (!t) return h->fail(h, AMBIT_NOMEM, "out of memory for tails of power series");
  *t = (ambit_tails) { .tape = tape, .order = order, .ndir = ndir, .stride = ((size_t)order / 4 + 1) * 4 };
  if (!allocate(h, t))
    return h->fail(h, AMBIT_NOMEM, "out of memory for tails of power series of %u slots", tape->nslot);
  for (uint32_t v = 0; v < tape->nslot; v++) t->moving[v] = tape->degree[v] != 0;
  for (uint32_t i = 0; i < tape->ninstr; i++)
    if (t->moving[tape->dst[i]]) t->active[t->nactive++] = i;
  mark_flows(t);
  *tails = t;
  return AMBIT_OK;
}

/* -- coefficients */

static AMBIT_WORKER void bounds_of(double mid, double rad, double *lo, double *hi) {
  double low = -(rad - mid), high = mid + rad;
  bool is_set = low <= high && low < INFINITY && high > -INFINITY; /* false for NaN and for points at infinity */
  *lo = is_set ? low : -INFINITY;
  *hi = is_set ? high : INFINITY;
}

/* NaN or negative: claims nothing */
static void sanitize(double *x, size_t n) {
  for (size_t i = 0; i < n; i++)
    if (!(x[i] >= 0)) x[i] = INFINITY;
}

static void fetch_slot(ambit_tails *t, const ambit_jets *jets, const void *self, uint32_t v, uint32_t n) {
  size_t at = (size_t)v * t->stride;
  double *mag = t->mag + at, *dmag = t->ndir ? t->dmag + at * t->ndir : NULL, mid = 0, rad = INFINITY;
  jets->magnitude(self, v, n, mag, dmag);
  sanitize(mag, n);
  if (dmag) sanitize(dmag, (size_t)n * t->ndir);
  jets->get(self, v, 0, &mid, &rad, NULL, NULL);
  ambit_rounding old = ambit_round_up();
  bounds_of(mid, rad, &t->lo[v], &t->hi[v]);
  ambit_rounding_restore(old);
  if (t->moving[v]) return;
  t->U[at] = t->sum[v] = mag[0];
  for (uint32_t d = 0; d < t->ndir && dmag; d++) t->V[at * t->ndir + d] = t->vsum[(size_t)v * t->ndir + d] = dmag[d];
}

/* orders that a pass reads: of an input that is a polynomial, those above K as well */
static uint32_t orders_of(const ambit_tails *t, uint32_t v, uint32_t K) {
  const ambit_tape *tape = t->tape;
  bool is_input = v >= tape->nconst && v < tape->nconst + tape->nin;
  if (!t->moving[v]) return 1;
  return is_input && tape->degree[v] <= t->order && tape->degree[v] > K ? tape->degree[v] + 1 : K + 1;
}

static void fetch(ambit_tails *t, const ambit_jets *jets, const void *self, uint32_t K) {
  if (t->fetched > K) return;
  for (uint32_t v = 0; v < t->tape->nslot; v++) fetch_slot(t, jets, self, v, orders_of(t, v, K));
  t->fetched = K + 1;
  t->scaled = false;
}

static void scale_values(ambit_tails *t, uint32_t v, uint32_t K) {
  size_t at = (size_t)v * t->stride, padded = ((size_t)K / 4 + 1) * 4;
  double *restrict U = t->U + at, *restrict R = t->R + at;
  const double *restrict mag = t->mag + at, *restrict power = t->power;
  for (size_t k = 0; k <= K; k++) U[k] = mag[k] * power[k];
  for (size_t k = K + 1; k < padded; k++) U[k] = R[k] = 0;
  R[0] = 0;
  for (size_t i = 1; i <= K; i++) R[i] = R[i - 1] + U[K + 1 - i];
  t->swing[v] = R[K];
  t->sum[v] = R[K] + U[0];
}

static void scale_flow(ambit_tails *t, uint32_t v, uint32_t K) {
  size_t at = (size_t)v * t->stride, padded = ((size_t)K / 4 + 1) * 4;
  double *restrict W = t->W + at, *restrict RW = t->RW + at;
  const double *restrict U = t->U + at;
  double order = 0;
  for (size_t k = 0; k <= K; k++, order += 1) W[k] = order * U[k];
  for (size_t k = K + 1; k < padded; k++) W[k] = RW[k] = 0;
  RW[0] = 0;
  for (size_t i = 1; i <= K; i++) RW[i] = RW[i - 1] + W[K + 1 - i];
}

/* four directions at a time in registers */
static void scale_slopes(ambit_tails *t, uint32_t v, uint32_t K) {
  size_t nd = t->ndir, at = (size_t)v * t->stride * nd, d = 0;
  double *V = t->V + at, *sum = t->vsum + (size_t)v * nd;
  const double *dmag = t->dmag + at;
  for (; d + 4 <= nd; d += 4) {
    ambit_four total = { 0, 0, 0, 0 };
    for (size_t k = 0; k <= K; k++) {
      ambit_four x = *(const ambit_four *)(const void *)(dmag + k * nd + d) * t->power[k];
      *(ambit_four *)(void *)(V + k * nd + d) = x;
      total += x;
    }
    *(ambit_four *)(void *)(sum + d) = total;
  }
  for (; d < nd; d++) {
    sum[d] = 0;
    for (size_t k = 0; k <= K; k++) sum[d] += V[k * nd + d] = dmag[k * nd + d] * t->power[k];
  }
}

static void scale(ambit_tails *t, uint32_t K, double h) {
  double power = 1;
  for (uint32_t k = 0; k <= K; k++, power *= h) t->power[k] = power;
  for (uint32_t v = 0; v < t->tape->nslot; v++) {
    if (!t->moving[v]) continue;
    scale_values(t, v, K);
    if (t->flows[v]) scale_flow(t, v, K);
    if (t->ndir) scale_slopes(t, v, K);
  }
  t->K = K, t->h = h, t->scaled = true;
}

/* -- the pass */

/* x += sum_{K<k<=degree} |u_k| h^k, the coefficients `step` apart; NaN claims nothing */
static double with_rest(double x, const double *mag, size_t step, uint32_t K, uint32_t degree, double h) {
  double power = 1;
  for (uint32_t k = 1; k <= degree; k++) {
    power *= h;
    if (k > K) x += mag[k * step] * power;
  }
  return x >= 0 ? x : INFINITY;
}

/* What of an input polynomial lies above order K belongs to its tail; above the order of the series it is unknown. */
static void add_rest(ambit_tails *t, uint32_t v, uint32_t K, double h) {
  uint32_t degree = t->tape->degree[v];
  size_t nd = t->ndir, at = (size_t)v * t->stride;
  if (degree == AMBIT_DEGREE_ANY || degree <= K) return;
  bool held = degree <= t->order;
  t->tau[v] = held ? with_rest(t->tau[v], t->mag + at, 1, K, degree, h) : INFINITY;
  for (size_t d = 0; d < nd; d++) {
    double *sigma = &t->sigma[v * nd + d];
    *sigma = held ? with_rest(*sigma, t->dmag + at * nd + d, nd, K, degree, h) : INFINITY;
  }
}

static void take_inputs(ambit_tails *t, uint32_t K, double h, const double *tail_in, const double *dtail_in) {
  for (uint32_t i = 0; i < t->tape->nin; i++) {
    uint32_t v = t->tape->nconst + i;
    if (!t->moving[v]) continue;
    t->tau[v] = tail_in ? tail_in[i] : 0;
    for (size_t d = 0; d < t->ndir; d++)
      t->sigma[(size_t)v * t->ndir + d] = dtail_in ? dtail_in[(size_t)i * t->ndir + d] : 0;
    add_rest(t, v, K, h);
  }
}

static AMBIT_WORKER void pass(ambit_tails *t, uint32_t K, double h, const double *tail_in, const double *dtail_in) {
  take_inputs(t, K, h, tail_in, dtail_in);
  if (!t->scaled || t->K != K || t->h != h) scale(t, K, h);
  for (uint32_t i = 0; i < t->nactive; i++) {
    ambit_tails_values(t, t->active[i]);
    if (t->ndir) ambit_tails_slopes(t, t->active[i]);
  }
}

void ambit_tails_run(ambit_tails *t, const ambit_jets *jets, const void *self, uint32_t K, double h,
    const double *tail_in, const double *dtail_in, double *tail_out, double *dtail_out) {
  fetch(t, jets, self, K);
  ambit_rounding old = ambit_round_up();
  pass(t, K, fabs(h), tail_in, dtail_in);
  ambit_rounding_restore(old);
  const ambit_tape *tape = t->tape;
  for (uint32_t o = 0; o < tape->nout; o++) {
    tail_out[o] = t->tau[tape->out[o]];
    if (!dtail_out || !t->ndir) continue;
    memcpy(dtail_out + (size_t)o * t->ndir, t->sigma + (size_t)tape->out[o] * t->ndir, t->ndir * sizeof(double));
  }
}
