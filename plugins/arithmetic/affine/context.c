/* context.c -- options, elements from bounds and back, the rounding mode around a batch, the entry of the plugin. */
#include "affine.h"
#include <string.h>
#include <unistd.h>

#define AFFINE_SYMBOLS 48 /* measured: docs/numerics/affine.md */
#define AFFINE_TEXT_(x) #x
#define AFFINE_TEXT(x) AFFINE_TEXT_(x)

enum { SYMBOLS, PRODUCT, LINEARISATION };

const ambit_param affine_params[] = {
  { "symbols", "1", "integer", AFFINE_TEXT(AFFINE_SYMBOLS),
      "noise symbols for the errors of nonlinear operations, besides one for each "
      "uncertain datum; 0: none, such errors stay uncorrelated" },
  { "product", "1", "fast|tight", "fast",
      "bound of the quadratic part of a product: from sums, or pair by pair (tighter, time grows with the square of "
      "the number of symbols)" },
  { "linearisation", "1", "chebyshev|min_range", "chebyshev",
      "of a function: least error, or a range that is the function's own" },
  { NULL, NULL, NULL, NULL, NULL },
};

static uint64_t blocks_of(double coefficients) { return ((uint64_t)coefficients + AFFINE_BLOCK - 1) / AFFINE_BLOCK; }

static size_t bytes(const affine_context *c) {
  return sizeof(affine_element) + (c->vblocks + blocks_of(c->symbols)) * AFFINE_BLOCK * sizeof(double);
}

/* one element must fit into this machine, with the few that operations need besides */
static ambit_status check_size(const ambit_host *h, double symbols, uint32_t nvar) {
  if (!(symbols >= 0)) return h->fail(h, AMBIT_INVALID, "option `symbols` must not be negative, but is %.17g", symbols);
  double need = (1 + AFFINE_SCRATCH) * (8.0 * (symbols + nvar + 2 * AFFINE_BLOCK) + sizeof(affine_element));
  double memory = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
  if (symbols > INT32_MAX || need > memory)
    return h->fail(h, AMBIT_NOMEM,
        "%.0f symbols and %u uncertain data need %.3g bytes for the working elements alone; this machine has %.3g",
        symbols, nvar, need, memory);
  return AMBIT_OK;
}

ambit_status affine_open(const ambit_host *h, const double *option, uint32_t nvar, const affine_kernels *kernels,
    const ambit_run_fn *run, void **ctx) {
  double symbols = option ? option[SYMBOLS] : AFFINE_SYMBOLS;
  ambit_status status = check_size(h, symbols, nvar);
  if (status != AMBIT_OK) return status;
  affine_context *c = h->alloc(h, sizeof *c);
  if (!c) return h->fail(h, AMBIT_NOMEM, "out of memory");
  c->num = h->service(h, AMBIT_NUM_SERVICE);
  c->meter = h->service(h, AMBIT_METER_SERVICE);
  if (!c->num) return h->fail(h, AMBIT_INVALID, "this kernel does not lend `%s`", AMBIT_NUM_SERVICE);
  c->kernels = kernels, c->run = run;
  c->nvar = nvar, c->symbols = (uint32_t)symbols;
  c->tight = option && option[PRODUCT] == 1, c->min_range = option && option[LINEARISATION] == 1;
  c->epoch = 1, c->vblocks = blocks_of(nvar);
  c->elem = bytes(c);
  char *scratch = h->alloc(h, AFFINE_SCRATCH * c->elem);
  c->weight = h->alloc(h, 2 * (c->symbols + 1) * sizeof *c->weight);
  c->rank = h->alloc(h, (c->symbols + 1) * sizeof *c->rank);
  if (!scratch || !c->weight || !c->rank)
    return h->fail(h, AMBIT_NOMEM, "out of memory: %u symbols and %u uncertain data need %zu bytes for each number",
        c->symbols, nvar, c->elem);
  for (size_t i = 0; i < AFFINE_SCRATCH; i++) c->scratch[i] = affine_at(c, scratch, i);
  *ctx = c;
  return AMBIT_OK;
}

void affine_close(void *ctx) { affine_close_plan(&((affine_context *)ctx)->plan); }

size_t affine_elem(void *ctx) { return ((affine_context *)ctx)->elem; }

void affine_enter(void *ctx) { ((affine_context *)ctx)->outside = ambit_round_up(); }
void affine_leave(void *ctx) { ambit_rounding_restore(((affine_context *)ctx)->outside); }

/* -- elements, in any rounding mode */

static AMBIT_WORKER void set_one(const affine_context *c, affine_element *r, double lo, double hi, int32_t var) {
  int nonempty = lo <= hi && lo < INFINITY && hi > -INFINITY; /* false for NaN */
  r->epoch = c->epoch;
  if (nonempty)
    affine_of_hull(r, -lo, hi);
  else
    affine_of_hull(r, -INFINITY, -INFINITY);
  if (var < 0 || (uint32_t)var >= c->nvar || !affine_has_form(r) || r->err == 0) return; /* no symbol for a point */
  r->blocks = (uint64_t)var / AFFINE_BLOCK + 1;
  memset(r->coef, 0, r->blocks * AFFINE_BLOCK * sizeof *r->coef);
  r->coef[var] = r->err;
  r->err = 0;
}

/* A variable that is set anew begins another calculation, with all symbols: so its result does not depend on what was
** computed before. What is left of the old one stays valid, only less correlated. */
void affine_set(void *ctx, void *dst, size_t n, const double *lo, const double *hi, int32_t var) {
  affine_context *c = ctx;
  if (var >= 0 && c->next > 0) c->epoch++, c->next = 0;
  ambit_rounding old = ambit_round_up();
  for (size_t i = 0; i < n; i++) set_one(c, affine_at(c, dst, i), lo[i], hi[i], var);
  ambit_rounding_restore(old);
}

/* minus x by its bits: right in every environment, and never -0 */
static double negated(double x) {
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  if (bits << 1)
    bits ^= (uint64_t)1 << 63;
  else
    bits = 0;
  memcpy(&x, &bits, sizeof x);
  return x;
}

void affine_bounds(void *ctx, const void *src, size_t n, double *lo, double *hi) {
  const affine_context *c = ctx;
  for (size_t i = 0; i < n; i++) {
    const affine_element *x = (const void *)((const char *)src + i * c->elem);
    lo[i] = negated(x->nlo), hi[i] = x->hi;
  }
}

/* The interfaces in their own right, for comparing: the same with other passes. NULL: this processor lacks them. */
#define INTERFACE "ambit.arithmetic."

static const void *get(const char *interface_id) {
  int any = strcmp(interface_id, AMBIT_ARITHMETIC) == 0;
#if defined(__x86_64__)
  if ((any || strcmp(interface_id, INTERFACE "avx512/1") == 0) && __builtin_cpu_supports("avx512f") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    return &affine_avx512;
  if ((any || strcmp(interface_id, INTERFACE "avx2/1") == 0) && __builtin_cpu_supports("avx2") &&
      __builtin_cpu_supports("fma"))
    return &affine_avx2;
#endif
  return any || strcmp(interface_id, INTERFACE "portable/1") == 0 ? &affine_portable : NULL;
}

const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "arithmetic.affine", "1.0",
  "Affine forms: a number is a centre plus a linear function of the uncertain data plus an error, all rounded outward. "
  "Remembers to first order what quantities have in common, so that differences and turned frames do not grow as with "
  "intervals; never wider than `interval`.",
  get };
