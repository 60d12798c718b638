/* series.c -- life and access of the polynomial series. */
#include "series.h"
#include <string.h>

#define ULP 0x1p-52
#define SIGN_LEAVES 65 /* parts of the cube on the way to a sign */

static void *room(const ambit_host *h, size_t count, size_t size) { return h->alloc(h, count ? count * size : size); }

static int divides(uint32_t op) {
  return op == AMBIT_OP_DIV || op == AMBIT_OP_SQRT || op == AMBIT_OP_LOG || op == AMBIT_OP_ATAN || op == AMBIT_OP_ATAN2;
}

static int allocate(const ambit_host *h, series *s) {
  const ambit_tape *t = s->tape;
  size_t stride = s->space->stride, inverses = 0;
  s->has_inverse = room(h, t->ninstr, sizeof *s->has_inverse);
  s->branch = room(h, t->ninstr, sizeof *s->branch);
  if (!s->has_inverse || !s->branch) return 0;
  for (uint32_t i = 0; i < t->ninstr; i++)
    if (divides(t->op[i])) s->has_inverse[i] = (uint32_t)++inverses;
  s->cells = room(h, (size_t)t->nslot * (s->order + 1u) * stride, sizeof(double));
  s->inverses = room(h, inverses * stride, sizeof(double));
  s->scratch = room(h, SCRATCH_CELLS * stride, sizeof(double));
  s->defect = room(h, (size_t)t->nin * (s->order + 1u), sizeof(double));
  s->sum.c = room(h, s->space->size, sizeof(double));
  return s->cells && s->inverses && s->scratch && s->defect && s->sum.c &&
         search_open(h, &s->search, s->space, SIGN_LEAVES);
}

static AMBIT_WORKER void put_constants(series *s) {
  const ambit_tape *t = s->tape;
  for (uint32_t slot = 0; slot < t->nslot; slot++)
    for (uint32_t k = 0; k <= s->order; k++) cell_clear(s->space, series_cell(s, slot, k));
  for (uint32_t i = 0; i < t->nconst; i++) {
    double mid = 0.5 * (t->lo[i] + t->hi[i]);
    cell_constant(s->space, series_cell(s, i, 0), mid, larger(t->hi[i] - mid, mid - t->lo[i]));
  }
}

static ambit_status open(const ambit_host *h, void *ctx, const ambit_tape *t, uint32_t order, uint32_t ndir,
    const void *centre, void **self) {
  series_source *source = ctx;
  (void)centre;
  if (ndir) return h->fail(h, AMBIT_INVALID, "taylor_model: polynomial series carry no slopes");
  series *s = h->alloc(h, sizeof *s);
  if (!s) return AMBIT_NOMEM;
  *s = (series) { .space = source->space, .num = source->num, .tape = t, .order = order };
  s->meter = h->service(h, AMBIT_METER_SERVICE);
  if (!allocate(h, s)) return h->fail(h, AMBIT_NOMEM, "taylor_model: out of memory for polynomial series");
  ambit_rounding old = ambit_round_up();
  put_constants(s);
  ambit_rounding_restore(old);
  source->made = s;
  *self = s;
  return AMBIT_OK;
}

static void close(void *self) { (void)self; }

void series_put(series *s, uint32_t in, const double *c, double rad) {
  cell x = series_cell(s, s->tape->nconst + in, 0);
  memcpy(x.c, c, s->space->size * sizeof *c);
  cell_finish(s->space, x, rad);
}

static void put(void *self, uint32_t in, uint32_t k, double mid, double rad, const double *dmid, const double *drad) {
  series *s = self;
  (void)dmid, (void)drad;
  cell_constant(s->space, series_cell(s, s->tape->nconst + in, k), mid, rad);
}

static uint32_t advance(void *self, uint32_t k) {
  series *s = self;
  uint32_t flags = 0;
  for (uint32_t i = 0; i < s->tape->ninstr && !flags; i++) {
    uint32_t degree = s->tape->degree[s->tape->dst[i]];
    if (k > degree) continue;
    if (s->meter) s->meter->operation(s->tape->op[i]);
    flags = series_rule(s, i, k);
  }
  for (uint32_t i = 0; i < s->tape->nout && !flags; i++) {
    cell x = series_cell(s, s->tape->out[i], k);
    if (!(cell_norm(x) + cell_rad(x) < INFINITY)) flags = AMBIT_F_UNBOUNDED;
  }
  return flags;
}

static void get(const void *self, uint32_t slot, uint32_t k, double *mid, double *rad, double *dmid, double *drad) {
  const series *s = self;
  cell x = series_cell(s, slot, k);
  double low, high;
  (void)dmid, (void)drad;
  polynomial_bounds(s->space, x.c, &low, &high);
  *mid = 0.5 * (low + high);
  *rad = larger(high - *mid, *mid - low) + cell_rad(x);
}

static void magnitude(const void *self, uint32_t slot, uint32_t n, double *mag, double *dmag) {
  const series *s = self;
  (void)dmag;
  for (uint32_t k = 0; k < n; k++) {
    cell x = series_cell(s, slot, k);
    mag[k] = cell_norm(x) + cell_rad(x);
  }
}

/* x_(k+1) := fl(f_k / (k + 1)), exact from now on; what f_k is besides (k + 1) x_(k+1) is the defect of order k */
static void integrate(void *self, uint32_t in, uint32_t slot, uint32_t k) {
  series *s = self;
  const space *w = s->space;
  cell f = series_cell(s, slot, k), x = series_cell(s, s->tape->nconst + in, k + 1);
  double n = k + 1.0;
  for (size_t j = 0; j < w->size; j++) x.c[j] = f.c[j] / n;
  cell_finish(w, x, 0);
  s->defect[(size_t)in * (s->order + 1u) + k] = cell_rad(f) + n * (ULP * cell_norm(x)) + (cell_norm(f) > 0 ? TINY : 0);
}

const ambit_jets series_jets = { sizeof(ambit_jets), open, close, put, advance, get, magnitude, integrate };
