/* context.c -- precision, elements from bounds and back, runs, MPFR's environment, and the entry of the plugin.
**
** MPFR's exponent range and flags are per thread and may be the host program's: each call sets the widest range and
** puts back what it found, between enter and leave once for the batch. Numbers beyond that range (2^(2^62)) round to
** the largest finite number or to infinity, whichever is outward.
*/
#include "sets.h"
#include <float.h>
#include <math.h>
#include <string.h>

#define LEAST_PRECISION 2
#define MOST_PRECISION 1000000

static environment environment_enter(void) {
  environment old = { mpfr_get_emin(), mpfr_get_emax(), mpfr_flags_save(), ambit_round_nearest() };
  mpfr_set_emin(mpfr_get_emin_min());
  mpfr_set_emax(mpfr_get_emax_max());
  return old;
}

static void environment_leave(environment old) {
  mpfr_set_emin(old.least);
  mpfr_set_emax(old.most);
  mpfr_flags_restore(old.flags, MPFR_FLAGS_ALL);
  ambit_rounding_restore(old.rounding);
}

/* -- life */

static int take(const ambit_host *h, mpfr_ptr x, mpfr_prec_t precision) {
  void *digits = h->alloc(h, mpfr_custom_get_size(precision));
  if (!digits) return 0;
  mpfr_custom_init_set(x, MPFR_ZERO_KIND, 0, precision, digits);
  return 1;
}

static ambit_status open_context(const ambit_host *h, const double *option, uint32_t nvar, void **ctx) {
  (void)nvar;
  double precision = option ? option[0] : 128;
  if (!(precision >= LEAST_PRECISION && precision <= MOST_PRECISION))
    return h->fail(
        h, AMBIT_INVALID, "`precision` of %.17g bits: expected %d to %d", precision, LEAST_PRECISION, MOST_PRECISION);
  context *c = h->alloc(h, sizeof *c);
  int there = c != NULL;
  mpfr_prec_t bits = (mpfr_prec_t)precision;
  for (int i = 0; there && i < WORK; i++) there = take(h, c->work[i], bits);
  for (int i = 0; there && i < FINE; i++) there = take(h, c->fine[i], bits + 64);
  if (!there)
    return h->fail(h, AMBIT_NOMEM, "out of memory for %d numbers of %.0f bits, %zu bytes each", WORK + FINE, precision,
        mpfr_custom_get_size(bits));
  c->num = h->service(h, AMBIT_NUM_SERVICE);
  if (!c->num) return h->fail(h, AMBIT_INVALID, "this kernel does not lend `%s`", AMBIT_NUM_SERVICE);
  c->precision = bits;
  c->half = sizeof(half) + mpfr_custom_get_size(bits);
  *ctx = c;
  return AMBIT_OK;
}

static void close_context(void *ctx) {
  (void)ctx; /* memory is the host's; constants that MPFR keeps for this thread are not */
  mpfr_free_cache();
}

static size_t elem(void *ctx) { return 2 * ((context *)ctx)->half; }

static void enter(void *ctx) { ((context *)ctx)->outside = environment_enter(); }
static void leave(void *ctx) { environment_leave(((context *)ctx)->outside); }

/* -- elements */

static void load_half(const context *c, mpfr_ptr x, void *place) {
  half *p = place;
  mpfr_custom_init_set(x, (int)p->kind, (mpfr_exp_t)p->exponent, c->precision, p->digits);
}

static void store_half(mpfr_ptr x, void *place) {
  half *p = place;
  if (mpfr_zero_p(x)) mpfr_set_zero(x, 1);
  p->kind = mpfr_custom_get_kind(x);
  p->exponent = mpfr_regular_p(x) ? mpfr_custom_get_exp(x) : 0;
}

static set load(const context *c, void *place) {
  set x;
  load_half(c, x.lo, place);
  load_half(c, x.hi, (char *)place + c->half);
  return x;
}

static void store(const context *c, set *x, void *place) {
  store_half(x->lo, place);
  store_half(x->hi, (char *)place + c->half);
}

/* a place for a result: zeros, whatever was there */
static set fresh(const context *c, void *place) {
  memset(place, 0, 2 * c->half);
  return load(c, place);
}

static int is_empty(const set *x) { return mpfr_nan_p(x->lo) != 0; }

static AMBIT_WORKER void set_bounds(context *c, char *place, size_t n, const double *lo, const double *hi) {
  for (size_t i = 0; i < n; i++, place += 2 * c->half) {
    set x = fresh(c, place);
    int nonempty = lo[i] <= hi[i] && lo[i] < INFINITY && hi[i] > -INFINITY; /* false for NaN */
    if (nonempty) {
      mpfr_set_d(x.lo, lo[i], MPFR_RNDD);
      mpfr_set_d(x.hi, hi[i], MPFR_RNDU);
    }
    store(c, &x, place);
  }
}

static void set_elements(void *ctx, void *dst, size_t n, const double *lo, const double *hi, int32_t var) {
  (void)var;
  environment old = environment_enter();
  set_bounds(ctx, dst, n, lo, hi);
  environment_leave(old);
}

static AMBIT_WORKER void read_bounds(const context *c, char *place, size_t n, double *lo, double *hi) {
  for (size_t i = 0; i < n; i++, place += 2 * c->half) {
    const set x = load(c, place);
    lo[i] = is_empty(&x) ? INFINITY : mpfr_get_d(x.lo, MPFR_RNDD);
    hi[i] = is_empty(&x) ? -INFINITY : mpfr_get_d(x.hi, MPFR_RNDU);
  }
}

static void bounds(void *ctx, const void *src, size_t n, double *lo, double *hi) {
  environment old = environment_enter();
  read_bounds(ctx, (char *)(uintptr_t)src, n, lo, hi); /* it only reads */
  environment_leave(old);
}

static int32_t set_text(void *ctx, void *dst, const char *text) {
  context *c = ctx;
  environment old = environment_enter();
  set x = fresh(c, dst);
  int32_t read = sets_read(c, &x, text);
  store(c, &x, dst);
  environment_leave(old);
  return read;
}

/* -- runs */

/* no double is there: the bounds that others see are infinite */
static int beyond_doubles(const set *x) {
  if (mpfr_inf_p(x->lo) || mpfr_inf_p(x->hi)) return 1;
  return mpfr_cmp_d(x->hi, DBL_MAX) > 0 || mpfr_cmp_d(x->lo, -DBL_MAX) < 0;
}

static uint32_t apply(context *c, operation f, void *place, const set *a, const set *b, int32_t n) {
  set r = fresh(c, place);
  uint32_t flags;
  if (is_empty(a) || is_empty(b))
    flags = sets_none(&r, 0);
  else
    flags = f(c, &r, a, b, n);
  if (!is_empty(&r) && beyond_doubles(&r)) flags |= AMBIT_F_UNBOUNDED;
  store(c, &r, place);
  return flags;
}

typedef struct block {
  char *base;
  size_t pitch, elem;
} block;

static void *at(const block *k, uint32_t slot, size_t lane) {
  return k->base + ((size_t)slot * k->pitch + lane) * k->elem;
}

/* powers: b holds exponents */
static uint32_t run(context *c, operation f, int powers, block k, size_t lanes, size_t count, const uint32_t *dst,
    const uint32_t *a, const uint32_t *b) {
  uint32_t flags = 0;
  for (size_t i = 0; i < count; i++)
    for (size_t lane = 0; lane < lanes; lane++) {
      const set x = load(c, at(&k, a[i], lane)), y = load(c, at(&k, powers ? a[i] : b[i], lane));
      flags |= apply(c, f, at(&k, dst[i], lane), &x, &y, powers ? (int32_t)b[i] : 0);
    }
  return flags;
}

#define RUN(OP, arity, symbol)                                                                                         \
  static uint32_t run_##OP(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,            \
      size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {                                       \
    (void)self;                                                                                                        \
    block k = { base, pitch, elem(ctx) };                                                                              \
    return run(ctx, sets_##OP, AMBIT_OP_##OP == AMBIT_OP_POWN, k, lanes, count, dst, a,                                \
        arity == 2 || AMBIT_OP_##OP == AMBIT_OP_POWN ? b : a);                                                         \
  }
AMBIT_OPS(RUN)

static uint32_t run_function(const ambit_arithmetic *self, void *ctx, uint32_t op, void *base, size_t pitch,
    size_t lanes, size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  (void)self;
  context *c = ctx;
  block k = { base, pitch, elem(ctx) };
  c->facts = c->num->facts(op);
  uint32_t flags = 0;
  for (size_t i = 0; i < count; i++)
    for (size_t lane = 0; lane < lanes; lane++) {
      const set x = load(c, at(&k, a[i], lane)), y = load(c, at(&k, b[i], lane));
      flags |= apply(c, sets_function, at(&k, dst[i], lane), &x, &y, (int32_t)op);
    }
  return flags;
}

static const ambit_param param[] = {
  { "precision", "1", "integer", "128", "digits of every bound, in bits: 53 are a double's, 333 are 100 decimals" },
  { NULL, NULL, NULL, NULL, NULL },
};

#define ENTRY(OP, arity, symbol) [AMBIT_OP_##OP] = run_##OP,
static const ambit_arithmetic arithmetic = {
  .size = sizeof arithmetic,
  .rigorous = 1,
  .param = param,
  .open = open_context,
  .close = close_context,
  .elem = elem,
  .enter = enter,
  .leave = leave,
  .set = set_elements,
  .bounds = bounds,
  .run = { AMBIT_OPS(ENTRY) },
  .set_text = set_text,
  .function = run_function,
  .pair = run_function,
};

static const void *get(const char *interface_id) {
  return strcmp(interface_id, AMBIT_ARITHMETIC) == 0 ? &arithmetic : NULL;
}

const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "arithmetic.mpfr", "1.0",
  "Closed intervals of GNU MPFR numbers with as many digits as asked for: every operation is the tightest of that "
  "precision. Constants written as text are read to all their digits. Slow; for checking the other arithmetics, and "
  "for expressions that cancel more digits than a double has.",
  get };
