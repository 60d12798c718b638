/* context.c -- opening, elements from bounds and back, the rounding mode around a batch, and the entry of the plugin.
*/
#include "gradient.h"
#include <string.h>

static ambit_status open_with(const ambit_host *h, uint32_t nvar, const gradient_loops *loops, void **ctx) {
  gradient_context *c = h->alloc(h, sizeof *c);
  if (!c) return h->fail(h, AMBIT_NOMEM, "out of memory");
  c->num = h->service(h, AMBIT_NUM_SERVICE);
  if (!c->num) return h->fail(h, AMBIT_INVALID, "this kernel does not lend `%s`", AMBIT_NUM_SERVICE);
  c->loops = loops;
  c->nvar = nvar, c->width = ((size_t)nvar + 3) / 4 * 4;
  *ctx = c;
  return AMBIT_OK;
}

static ambit_status open_portable(const ambit_host *h, const double *option, uint32_t nvar, void **ctx) {
  (void)option;
  return open_with(h, nvar, &gradient_portable, ctx);
}

static ambit_status open_fastest(const ambit_host *h, const double *option, uint32_t nvar, void **ctx) {
  (void)option;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) return open_with(h, nvar, &gradient_avx2, ctx);
#endif
  return open_with(h, nvar, &gradient_portable, ctx);
}

static size_t elem(void *ctx) { return 8 * element_doubles(ctx); }
static void enter(void *ctx) { ((gradient_context *)ctx)->outside = ambit_round_up(); }
static void leave(void *ctx) { ambit_rounding_restore(((gradient_context *)ctx)->outside); }

/* any finite number of the set will do; the middle makes the slopes' reach smallest */
static double middle(double lo, double hi) {
  if (lo == -INFINITY) return hi == INFINITY ? 0 : hi;
  if (hi == INFINITY) return lo;
  double m = lo / 2 + hi / 2;
  return m < lo ? lo : m > hi ? hi : m;
}

static void set_variable(const gradient_context *c, element *x, double lo, double hi, uint32_t var) {
  double m = middle(lo, hi), reach = pair_max(hi - m, m - lo);
  x->centre = pair_point(m);
  x->known = VARIES | KNOWN_DERIVATIVE | (reach < INFINITY ? KNOWN_SLOPE : 0);
  memset(x->part, 0, 4 * c->width * sizeof(double));
  for (int part = DERIVATIVE; part <= SLOPE; part++) {
    double *p = part_of(c, x, part), size = part == SLOPE ? reach : 1;
    p[var] = -size, p[c->width + var] = size;
  }
}

static AMBIT_WORKER void set_elements(
    const gradient_context *c, void *dst, size_t n, const double *lo, const double *hi, int32_t var) {
  for (size_t i = 0; i < n; i++) {
    element *x = element_at(c, dst, i);
    int nonempty = lo[i] <= hi[i] && lo[i] < INFINITY && hi[i] > -INFINITY; /* false for NaN */
    if (!nonempty) {
      gradient_write_empty(x);
      continue;
    }
    gradient_write_value(x, pair_of(lo[i], hi[i]), 0, KNOWN_DERIVATIVE | KNOWN_SLOPE);
    if (var >= 0 && (size_t)var < c->nvar) set_variable(c, x, lo[i], hi[i], (uint32_t)var);
  }
}

static void set(void *ctx, void *dst, size_t n, const double *lo, const double *hi, int32_t var) {
  ambit_rounding old = ambit_round_up();
  set_elements(ctx, dst, n, lo, hi, var);
  ambit_rounding_restore(old);
}

static double lower_bound(double n) { return n == 0 ? 0 : -n; } /* never -0 */

static AMBIT_WORKER void read_bounds(const gradient_context *c, const double *src, size_t n, double *lo, double *hi) {
  for (size_t i = 0; i < n; i++) {
    pair x = ((const element *)(const void *)(src + i * element_doubles(c)))->value;
    lo[i] = pair_is_empty(x) ? INFINITY : lower_bound(x.n), hi[i] = x.h;
  }
}

/* The environment is set although nothing is rounded: the caller's may take subnormal numbers for 0. */
static void bounds(void *ctx, const void *src, size_t n, double *lo, double *hi) {
  ambit_rounding old = ambit_round_up();
  read_bounds(ctx, src, n, lo, hi);
  ambit_rounding_restore(old);
}

static AMBIT_WORKER void read_gradient(const gradient_context *c, const element *x, double *lo, double *hi) {
  const double *p = part_in(c, x, DERIVATIVE);
  for (size_t j = 0; j < c->nvar; j++) {
    lo[j] = x->known & VARIES ? lower_bound(p[j]) : 0;
    hi[j] = x->known & VARIES ? p[c->width + j] : 0;
  }
}

static int32_t gradient(void *ctx, const void *src, double *lo, double *hi) {
  if (!(((const element *)src)->known & KNOWN_DERIVATIVE)) return 0;
  ambit_rounding old = ambit_round_up();
  read_gradient(ctx, src, lo, hi);
  ambit_rounding_restore(old);
  return 1;
}

#define RUN(OP, arity, symbol)                                                                                         \
  static uint32_t run_##OP(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,            \
      size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {                                       \
    (void)self;                                                                                                        \
    return gradient_run(ctx, AMBIT_OP_##OP, base, pitch, lanes, count, dst, a, b);                                     \
  }
AMBIT_OPS(RUN)

static uint32_t run_function(const ambit_arithmetic *self, void *ctx, uint32_t op, void *base, size_t pitch,
    size_t lanes, size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  (void)self;
  return gradient_run(ctx, op, base, pitch, lanes, count, dst, a, b);
}

#define ENTRY(OP, arity, symbol) [AMBIT_OP_##OP] = run_##OP,
#define ARITHMETIC(opener)                                                                                             \
  {                                                                                                                    \
    .size = sizeof(ambit_arithmetic), .rigorous = 1, .open = opener, .elem = elem, .enter = enter, .leave = leave,     \
    .set = set, .bounds = bounds, .run = { AMBIT_OPS(ENTRY) }, .gradient = gradient, .function = run_function,         \
  }
static const ambit_arithmetic fastest = ARITHMETIC(open_fastest), portable = ARITHMETIC(open_portable);

/* for comparing the two: the same without AVX2 */
#define GRADIENT_PORTABLE "ambit.arithmetic.portable/1"

static const void *get(const char *interface_id) {
  if (strcmp(interface_id, GRADIENT_PORTABLE) == 0) return &portable;
  return strcmp(interface_id, AMBIT_ARITHMETIC) == 0 ? &fastest : NULL;
}

const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "arithmetic.gradient", "1.0",
  "Intervals with first derivatives: beside its bounds each value carries its value at the centre of the box and "
  "enclosures of its partial derivatives and slopes by every uncertain datum. Bounds are the better of the natural "
  "and the mean-value form at every step; `evaluate` also uses the derivatives to find where a result is monotone, and "
  "then its bounds at the corners.",
  get };
