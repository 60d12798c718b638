/* skeleton.c -- a rigorous interval arithmetic to start from: addition and squares of its own, the rest by the kernel.
**
** An element is a pair of bounds; the empty set is (+inf, -inf). Each run function is called between enter and leave,
** thus in upward rounding; a lower bound is the negated upper bound of the negated value: lo(a + b) = -up(-a - b). The
** file must be compiled with -frounding-math -ffp-contract=off (clang: -ffp-model=strict), see Makefile.
**
** Where to go on: an element that knows more than its bounds (change `element`, `set`, `bounds`), then operations in
** which it is better than intervals. docs/arithmetics.md explains every part; `ambit check` tells what is wrong.
*/
#include <ambit/arithmetic.h>
#include <ambit/rounding.h>
#include <math.h>
#include <string.h>

typedef struct element {
  double lo, hi;
} element;

typedef struct context {
  ambit_rounding outside; /* of the caller, between enter and leave */
} context;

static ambit_status open(const ambit_host *h, const double *option, uint32_t nvar, void **ctx) {
  (void)option, (void)nvar; /* options are declared in `params` below and arrive here in this order */
  *ctx = h->alloc(h, sizeof(context));
  return *ctx ? AMBIT_OK : AMBIT_NOMEM;
}

static void close(void *ctx) { (void)ctx; } /* what alloc gave is freed by the kernel */
static size_t elem(void *ctx) { return (void)ctx, sizeof(element); }

static void enter(void *ctx) { ((context *)ctx)->outside = ambit_round_up(); }
static void leave(void *ctx) { ambit_rounding_restore(((context *)ctx)->outside); }

/* These two are called outside of enter and leave too. Copies need no rounding; where you compute, set the mode. */

static void set(void *ctx, void *dst, size_t n, const double *lo, const double *hi, int32_t var) {
  element *r = dst;
  (void)ctx, (void)var; /* var >= 0: an uncertain datum; what has the same number is the same quantity */
  for (size_t i = 0; i < n; i++) r[i] = (element) { lo[i], hi[i] };
}

static void bounds(void *ctx, const void *src, size_t n, double *lo, double *hi) {
  const element *x = src;
  (void)ctx;
  for (size_t i = 0; i < n; i++) lo[i] = x[i].lo, hi[i] = x[i].hi;
}

/* -- operations: one element at a time ... */

static int is_empty(element x) { return x.lo > x.hi; }
static element empty(void) { return (element) { INFINITY, -INFINITY }; }

static element add(element a, element b) {
  if (is_empty(a) || is_empty(b)) return empty();
  return (element) { -(-a.lo - b.lo), a.hi + b.hi };
}

static element sqr(element a, element unused) {
  (void)unused;
  if (is_empty(a)) return empty();
  double near = a.lo > 0 ? a.lo : a.hi < 0 ? -a.hi : 0, far = a.hi > -a.lo ? a.hi : -a.lo;
  return (element) { -(-near * near), far * far };
}

/* -- ... over a run: `count` independent instructions, `lanes` problems each; element (slot, lane) lies at slot * pitch
** + lane. The flags of all results are joined. */

static uint32_t flags_of(element x) {
  if (is_empty(x)) return AMBIT_F_EMPTY;
  return x.lo == -INFINITY || x.hi == INFINITY ? AMBIT_F_UNBOUNDED : 0;
}

static uint32_t run(element (*op)(element, element), void *base, size_t pitch, size_t lanes, size_t count,
    const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  element *slot = base;
  uint32_t flags = 0;
  for (size_t i = 0; i < count; i++)
    for (size_t lane = 0; lane < lanes; lane++) {
      element r = op(slot[a[i] * pitch + lane], slot[b[i] * pitch + lane]);
      slot[dst[i] * pitch + lane] = r;
      flags |= flags_of(r);
    }
  return flags;
}

static uint32_t run_add(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes, size_t count,
    const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  return (void)self, (void)ctx, run(add, base, pitch, lanes, count, dst, a, b);
}

static uint32_t run_sqr(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes, size_t count,
    const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  return (void)self, (void)ctx, run(sqr, base, pitch, lanes, count, dst, a, b);
}

/* -- what the kernel sees */

static const ambit_param params[] = {
  /* { "degree", "1", "integer", "5", "of the polynomials" }, */
  { NULL, NULL, NULL, NULL, NULL },
};

static const ambit_arithmetic arithmetic = {
  .size = sizeof arithmetic,
  .rigorous = 1,
  .param = params,
  .open = open,
  .close = close,
  .elem = elem,
  .enter = enter,
  .leave = leave,
  .set = set,
  .bounds = bounds,
  .run = { [AMBIT_OP_ADD] = run_add, [AMBIT_OP_SQR] = run_sqr }, /* the kernel does all others, by bounds */
};

static const void *get(const char *id) { return strcmp(id, AMBIT_ARITHMETIC) == 0 ? &arithmetic : NULL; }

AMBIT_EXPORT const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "arithmetic.skeleton", "0.1",
  "Closed intervals of doubles.", get };
