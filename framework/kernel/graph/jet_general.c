/* jet_general.c -- power series of a tape over any arithmetic: memory, orders, coefficients in and out.
**
** Mathematics in jet_value.c and jet_slope.c, proofs in docs/numerics/series.md. Elements are reached through run[]
** with one lane, an element being a "slot" of a block of pitch 1. Coefficients cross the border as midpoint and
** radius, rounded outward. Speed is secondary: an arithmetic that wants the integrators at full speed offers
** ambit_jets of its own.
*/
#include "graph/interpreter.h"
#include "graph/jet_general.h"
#include "num/rounding.h"
#include <ambit/block.h>
#include <string.h>

/* -- elements and rows */

static char *place(const ambit_series *s, uint32_t element) { return s->base + (size_t)element * s->elem; }

ambit_row ambit_series_row(const ambit_series *s, uint32_t slot, uint32_t column) {
  return (ambit_row) { s->first[slot] + column * s->length[slot], s->length[slot] };
}

ambit_row ambit_series_weighted(const ambit_series *s, uint32_t slot, uint32_t column) {
  return ambit_series_row(s, slot, s->columns + column);
}

uint32_t ambit_series_at(const ambit_series *s, ambit_row a, uint32_t k) {
  return k < a.length ? a.first + k : s->zero;
}

ambit_interval ambit_series_bounds(const ambit_series *s, uint32_t element) {
  ambit_interval x;
  ambit_bounds_read(s->arithmetic, s->ctx, place(s, element), 1, &x.lo, &x.hi);
  return x;
}

void ambit_series_set(ambit_series *s, uint32_t element, ambit_interval x) {
  s->arithmetic->set(s->ctx, place(s, element), 1, &x.lo, &x.hi, -1);
}

/* -- operations */

static uint32_t fresh(ambit_series *s, uint32_t dst) { return dst == AMBIT_SERIES_NEW ? s->scratch + s->used++ : dst; }

static void run(ambit_series *s, uint32_t op, size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  s->flags |= s->arithmetic->run[op](s->arithmetic, s->ctx, s->base, 1, 1, count, dst, a, b);
}

uint32_t ambit_series_apply(ambit_series *s, uint32_t dst, uint32_t op, uint32_t a, uint32_t b) {
  dst = fresh(s, dst);
  run(s, op, 1, &dst, &a, &b);
  return dst;
}

/* the sum of the n elements from `first`, halving their number each time; all in scratch but the last */
static uint32_t total(ambit_series *s, uint32_t dst, uint32_t first, uint32_t n) {
  while (n > 2) {
    uint32_t half = n / 2;
    for (uint32_t i = 0; i < half; i++) {
      s->target[i] = fresh(s, AMBIT_SERIES_NEW);
      s->left[i] = first + i;
      s->right[i] = first + half + i;
    }
    run(s, AMBIT_OP_ADD, half, s->target, s->left, s->right);
    uint32_t sum = s->target[0], odd = first + n - 1;
    if (n % 2) ambit_series_apply(s, AMBIT_SERIES_NEW, AMBIT_OP_ADD, odd, s->zero); /* next to the others */
    first = sum;
    n = half + n % 2;
  }
  return ambit_series_apply(s, dst, AMBIT_OP_ADD, first, n == 2 ? first + 1 : s->zero);
}

static uint32_t convolve_by_dot(ambit_series *s, uint32_t dst, uint32_t a, uint32_t b, uint32_t n) {
  dst = fresh(s, dst);
  s->flags |= s->arithmetic->dot(s->ctx, place(s, dst), place(s, a), 1, place(s, b), -1, n, 1);
  return dst;
}

uint32_t ambit_series_convolve(
    ambit_series *s, uint32_t dst, ambit_row a, ambit_row b, uint32_t from, uint32_t to, uint32_t k) {
  if (to >= a.length) to = a.length - 1;
  if (k >= b.length && from < k - b.length + 1) from = k - b.length + 1;
  if (from > to) return dst == AMBIT_SERIES_NEW ? s->zero : ambit_series_apply(s, dst, AMBIT_OP_ADD, s->zero, s->zero);
  uint32_t n = to - from + 1, x = a.first + from, y = b.first + k - from;
  if (n == 1) return ambit_series_apply(s, dst, AMBIT_OP_MUL, x, y);
  if (s->arithmetic->dot) return convolve_by_dot(s, dst, x, y, n);
  uint32_t product = s->scratch + s->used;
  for (uint32_t j = 0; j < n; j++) {
    s->target[j] = fresh(s, AMBIT_SERIES_NEW);
    s->left[j] = x + j;
    s->right[j] = y - j;
  }
  run(s, AMBIT_OP_MUL, n, s->target, s->left, s->right);
  return total(s, dst, product, n);
}

/* Whose time it is that follows, to the end of the frame around: all that an instruction's rules do is the
** instruction's; AMBIT_OP_COUNT: nobody's. */
static void tell(const ambit_series *s, uint32_t op) {
  if (s->meter) s->meter->operation(op);
}

/* -- one order */

static void weigh(ambit_series *s, uint32_t slot, uint32_t column, uint32_t k) {
  if (!s->weighted[slot]) return;
  uint32_t u = ambit_series_row(s, slot, column).first + k;
  ambit_series_apply(s, ambit_series_weighted(s, slot, column).first + k, AMBIT_OP_MUL, u, s->number + k);
}

/* (u(X) + u(c)) / 2 */
static void average(ambit_series *s, uint32_t slot, uint32_t k) {
  if (!s->centre) return;
  s->used = 0;
  uint32_t u = ambit_series_row(s, slot, 0).first + k;
  uint32_t c = fresh(s, AMBIT_SERIES_NEW);
  ambit_series_set(s, c, ambit_series_bounds(s->centre, ambit_series_row(s->centre, slot, 0).first + k));
  uint32_t sum = ambit_series_apply(s, AMBIT_SERIES_NEW, AMBIT_OP_ADD, u, c);
  ambit_series_apply(s, ambit_series_row(s, slot, s->mean).first + k, AMBIT_OP_MUL, s->half, sum);
  weigh(s, slot, s->mean, k);
}

static void advance_input(ambit_series *s, uint32_t slot, uint32_t k) {
  if (k >= s->length[slot]) return;
  weigh(s, slot, 0, k);
  average(s, slot, k);
  for (uint32_t d = 0; d < s->ndir; d++) weigh(s, slot, s->slope + d, k);
}

static void advance_instruction(ambit_series *s, uint32_t i, uint32_t k) {
  uint32_t slot = s->tape->dst[i];
  if (k >= s->length[slot]) return;
  tell(s, s->tape->op[i]);
  s->used = 0;
  ambit_series_value(s, i, k);
  weigh(s, slot, 0, k);
  average(s, slot, k);
  if (k == 0 && s->ndir > 0) ambit_series_factor(s, i);
  for (uint32_t d = 0; d < s->ndir; d++) {
    s->used = 0;
    ambit_series_slope(s, i, k, d);
    weigh(s, slot, s->slope + d, k);
  }
}

static uint32_t advance(void *self, uint32_t k) {
  ambit_series *s = self;
  if (k > s->order) return AMBIT_F_UNBOUNDED;
  s->flags = s->refused;
  if (s->arithmetic->enter) s->arithmetic->enter(s->ctx);
  tell(s, AMBIT_OP_COUNT);
  for (uint32_t i = 0; i < s->tape->nin; i++) advance_input(s, s->tape->nconst + i, k);
  for (uint32_t i = 0; i < s->tape->ninstr; i++) advance_instruction(s, i, k);
  if (s->arithmetic->leave) s->arithmetic->leave(s->ctx);
  s->raised = k ? s->raised | s->flags : s->flags;
  return s->flags;
}

static void integrate(void *self, uint32_t in, uint32_t slot, uint32_t k) {
  ambit_series *s = self;
  uint32_t to = s->tape->nconst + in;
  if (k >= s->order) return;
  if (k + 1 >= s->length[to]) {
    s->refused = AMBIT_F_UNBOUNDED;
    return;
  }
  tell(s, AMBIT_OP_COUNT);
  if (s->arithmetic->enter) s->arithmetic->enter(s->ctx);
  for (uint32_t c = 0; c < s->columns; c++) {
    if (c == s->mean && s->centre) continue;
    uint32_t u = ambit_series_at(s, ambit_series_row(s, slot, c), k);
    ambit_series_apply(s, ambit_series_row(s, to, c).first + k + 1, AMBIT_OP_DIV, u, s->number + k + 1);
  }
  if (s->arithmetic->leave) s->arithmetic->leave(s->ctx);
}

/* -- coefficients in and out */

static AMBIT_WORKER void ball(double mid, double rad, ambit_interval *x) {
  double lo = -(rad - mid), hi = mid + rad;
  bool is_set = lo <= hi && lo < INFINITY && hi > -INFINITY; /* false for NaN and for points at infinity */
  *x = is_set ? (ambit_interval) { lo, hi } : AMBIT_ENTIRE;
}

static void put_element(ambit_series *s, uint32_t in, uint32_t column, uint32_t k, double mid, double rad) {
  uint32_t slot = s->tape->nconst + in;
  ambit_interval x;
  ambit_rounding old = ambit_round_up();
  ball(mid, rad, &x);
  ambit_rounding_restore(old);
  if (k < s->length[slot])
    ambit_series_set(s, ambit_series_row(s, slot, column).first + k, x);
  else if (k <= s->order && !(x.lo == 0 && x.hi == 0))
    s->refused = AMBIT_F_UNBOUNDED;
}

static void put(void *self, uint32_t in, uint32_t k, double mid, double rad, const double *dmid, const double *drad) {
  ambit_series *s = self;
  put_element(s, in, 0, k, mid, rad);
  for (uint32_t d = 0; d < s->ndir; d++) put_element(s, in, s->slope + d, k, dmid ? dmid[d] : 0, drad ? drad[d] : 0);
}

static ambit_interval coefficient(const ambit_series *s, uint32_t slot, uint32_t column, uint32_t k) {
  ambit_interval x = ambit_series_bounds(s, ambit_series_at(s, ambit_series_row(s, slot, column), k));
  ambit_empty_check(s->arithmetic, s->raised, 0, x.lo, x.hi);
  return ambit_interval_is_empty(x) ? AMBIT_ENTIRE : x; /* an operand left the domain: claim nothing */
}

static void get(const void *self, uint32_t slot, uint32_t k, double *mid, double *rad, double *dmid, double *drad) {
  const ambit_series *s = self;
  ambit_interval x = coefficient(s, slot, 0, k);
  *mid = ambit_interval_mid(x);
  *rad = ambit_interval_rad(x);
  for (uint32_t d = 0; d < s->ndir && (dmid || drad); d++) {
    x = coefficient(s, slot, s->slope + d, k);
    if (dmid) dmid[d] = ambit_interval_mid(x);
    if (drad) drad[d] = ambit_interval_rad(x);
  }
}

static void magnitude(const void *self, uint32_t slot, uint32_t n, double *mag, double *dmag) {
  const ambit_series *s = self;
  for (uint32_t k = 0; k < n; k++) {
    mag[k] = ambit_interval_mag(coefficient(s, slot, 0, k));
    for (uint32_t d = 0; d < s->ndir && dmag; d++)
      dmag[(size_t)k * s->ndir + d] = ambit_interval_mag(coefficient(s, slot, s->slope + d, k));
  }
}

/* -- life */

/* slots that some recursion needs as k u_k */
static void mark_weighted(ambit_series *s) {
  const ambit_tape *t = s->tape;
  for (uint32_t i = 0; i < t->ninstr; i++) switch (t->op[i]) {
    case AMBIT_OP_EXP:
    case AMBIT_OP_SIN:
    case AMBIT_OP_COS:
    case AMBIT_OP_SINH:
    case AMBIT_OP_COSH:
    case AMBIT_OP_TANH: s->weighted[t->a[i]] = 1; break;
    case AMBIT_OP_LOG:
    case AMBIT_OP_ATAN: s->weighted[t->dst[i]] = 1; break;
    case AMBIT_OP_ATAN2: s->weighted[t->a[i]] = s->weighted[t->b[i]] = s->weighted[t->dst[i]] = 1; break;
    default: break;
    }
}

/* Convolutions in one rule are at most six, each with fewer than 2 (order + 1) + 32 elements of scratch. */
static bool lay_out(ambit_series *s) {
  const ambit_tape *t = s->tape;
  size_t next = 0;
  for (uint32_t v = 0; v < t->nslot; v++) {
    s->length[v] = t->degree[v] < s->order ? t->degree[v] + 1 : s->order + 1;
    s->first[v] = (uint32_t)next;
    next += (size_t)s->columns * s->length[v] * (s->weighted[v] ? 2 : 1);
    if (next > UINT32_MAX / 2) return false;
  }
  s->zero = (uint32_t)next++;
  s->half = (uint32_t)next++;
  s->factor = (uint32_t)next, next += 2;
  s->number = (uint32_t)next, next += (size_t)s->order + 1;
  s->scratch = (uint32_t)next, next += 6 * (2 * ((size_t)s->order + 1) + 32);
  s->count = next;
  return next < UINT32_MAX;
}

static ambit_status allocate(const ambit_host *h, ambit_series *s) {
  const ambit_tape *t = s->tape;
  s->first = h->alloc(h, (size_t)t->nslot * sizeof *s->first);
  s->length = h->alloc(h, (size_t)t->nslot * sizeof *s->length);
  s->weighted = h->alloc(h, t->nslot);
  s->branch = h->alloc(h, t->ninstr);
  size_t list = ((size_t)s->order + 1) * sizeof *s->target;
  s->target = h->alloc(h, list), s->left = h->alloc(h, list), s->right = h->alloc(h, list);
  if (!s->first || !s->length || !s->weighted || !s->branch || !s->target || !s->left || !s->right)
    return h->fail(h, AMBIT_NOMEM, "out of memory for power series of %u slots", t->nslot);
  mark_weighted(s);
  size_t bytes;
  if (!lay_out(s) || __builtin_mul_overflow(s->count, s->elem, &bytes))
    return h->fail(h, AMBIT_INVALID, "power series to order %u with %u directions of %u slots are too many elements",
        s->order, s->ndir, t->nslot);
  s->base = h->alloc(h, bytes);
  if (!s->base)
    return h->fail(h, AMBIT_NOMEM, "out of memory: power series of %u slots need %zu bytes", t->nslot, bytes);
  ambit_status status = s->arithmetic->init ? s->arithmetic->init(s->ctx, s->base, s->count) : AMBIT_OK;
  if (status != AMBIT_OK) return h->fail(h, status, "the arithmetic could not initialise %zu elements", s->count);
  return AMBIT_OK;
}

static void set_constants(ambit_series *s) {
  const ambit_tape *t = s->tape;
  for (uint32_t i = 0; i < s->count; i++) ambit_series_set(s, i, (ambit_interval) { 0, 0 });
  ambit_series_set(s, s->half, (ambit_interval) { 0.5, 0.5 });
  for (uint32_t k = 0; k <= s->order; k++) ambit_series_set(s, s->number + k, (ambit_interval) { k, k });
  for (uint32_t v = 0; v < t->nconst; v++) /* a constant is its own mean */
    for (uint32_t c = 0; c < s->slope; c++)
      ambit_constant_set(s->arithmetic, s->ctx, place(s, ambit_series_row(s, v, c).first), t, v);
}

static ambit_status open(const ambit_host *h, void *ctx, const ambit_tape *t, uint32_t order, uint32_t ndir,
    const void *centre, void **self) {
  const ambit_jet_source *source = ctx;
  const ambit_series *middle = centre;
  *self = NULL;
  if (middle && (middle->tape != t || middle->order < order || middle->arithmetic != source->arithmetic))
    return h->fail(
        h, AMBIT_INVALID, "the centre of slopes must hold series of the same tape and arithmetic to order %u", order);
  ambit_series *s = h->alloc(h, sizeof *s);
  if (!s) return h->fail(h, AMBIT_NOMEM, "out of memory for power series");
  uint32_t mean = centre ? 1 : 0;
  *s = (ambit_series) { .tape = t,
    .arithmetic = source->arithmetic,
    .ctx = source->actx,
    .centre = centre,
    .meter = h->service ? h->service(h, AMBIT_METER_SERVICE) : NULL,
    .order = order,
    .ndir = ndir,
    .mean = mean,
    .slope = mean + 1,
    .columns = mean + 1 + ndir };
  s->elem = s->arithmetic->elem(s->ctx);
  ambit_status status = allocate(h, s);
  if (status != AMBIT_OK) return status;
  set_constants(s);
  *self = s;
  return AMBIT_OK;
}

/* The memory itself belongs to the host object. */
static void close(void *self) {
  ambit_series *s = self;
  if (s && s->arithmetic->clear) s->arithmetic->clear(s->ctx, s->base, s->count);
}

const ambit_jets ambit_jets_general = {
  .size = sizeof(ambit_jets),
  .open = open,
  .close = close,
  .put = put,
  .advance = advance,
  .get = get,
  .magnitude = magnitude,
  .integrate = integrate,
};
