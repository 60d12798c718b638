/* context.c -- elements from bounds and back, the rounding mode around a batch, and the entry of the plugin. */
#include "interval.h"
#include <math.h>
#include <string.h>

ambit_status interval_open(const ambit_host *h, const double *option, uint32_t nvar, void **ctx) {
  (void)option, (void)nvar;
  interval_context *context = h->alloc(h, sizeof *context);
  if (!context) return h->fail(h, AMBIT_NOMEM, "interval: out of memory");
  context->num = h->service(h, AMBIT_NUM_SERVICE);
  if (!context->num) return h->fail(h, AMBIT_INVALID, "interval: this kernel does not lend `%s`", AMBIT_NUM_SERVICE);
  *ctx = context;
  return AMBIT_OK;
}

size_t interval_elem(void *ctx) {
  (void)ctx;
  return 2 * sizeof(double);
}

void interval_enter(void *ctx) { ((interval_context *)ctx)->outside = ambit_round_up(); }
void interval_leave(void *ctx) { ambit_rounding_restore(((interval_context *)ctx)->outside); }

void interval_set(void *ctx, void *dst, size_t n, const double *lo, const double *hi, int32_t var) {
  (void)ctx, (void)var;
  double *r = dst;
  for (size_t i = 0; i < n; i++) {
    int nonempty = lo[i] <= hi[i] && lo[i] < INFINITY && hi[i] > -INFINITY; /* false for NaN */
    r[2 * i] = nonempty ? -lo[i] : -INFINITY;
    r[2 * i + 1] = nonempty ? hi[i] : -INFINITY;
  }
}

void interval_bounds(void *ctx, const void *src, size_t n, double *lo, double *hi) {
  (void)ctx;
  const double *x = src;
  for (size_t i = 0; i < n; i++) {
    lo[i] = x[2 * i] == 0 ? 0 : -x[2 * i]; /* never -0 */
    hi[i] = x[2 * i + 1];
  }
}

/* The interface in its own right, for comparing the two: the same without AVX2. */
#define INTERVAL_PORTABLE "ambit.arithmetic.portable/1"

static const void *get(const char *interface_id) {
  if (strcmp(interface_id, INTERVAL_PORTABLE) == 0) return &interval_portable;
  if (strcmp(interface_id, AMBIT_ARITHMETIC) != 0) return NULL;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return &interval_avx2;
#endif
  return &interval_portable;
}

const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "arithmetic.interval", "1.0",
  "Closed intervals of doubles, rounded outward: every result contains the exact image (IEEE 1788 set-based flavour). "
  "Remembers no "
  "dependence between quantities. Offers fast Taylor series, so it is the arithmetic of choice for the `lohner` "
  "solver.",
  get };
