/* middle.c -- a tiny arithmetic from outside the tree: plain intervals, every operation left to the kernel. */
#include <ambit/arithmetic.h>
#include <string.h>

static size_t elem(void *ctx) { return (void)ctx, 2 * sizeof(double); }

static void set(void *ctx, void *dst, size_t n, const double *lo, const double *hi, int32_t var) {
  double *d = dst;
  (void)ctx, (void)var;
  for (size_t i = 0; i < n; i++) d[2 * i] = lo[i], d[2 * i + 1] = hi[i];
}

static void bounds(void *ctx, const void *src, size_t n, double *lo, double *hi) {
  const double *s = src;
  (void)ctx;
  for (size_t i = 0; i < n; i++) lo[i] = s[2 * i], hi[i] = s[2 * i + 1];
}

static const ambit_arithmetic arithmetic = { sizeof arithmetic, 1, .elem = elem, .set = set, .bounds = bounds };
static const void *get(const char *id) { return strcmp(id, AMBIT_ARITHMETIC) == 0 ? &arithmetic : NULL; }
AMBIT_EXPORT const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "arithmetic.middle", "1.0",
  "Plain intervals.", get };
