/* small.c -- a good plugin: the least that an arithmetic must have. Its struct ends before run[], as one of an older
** ABI might. */
#include <ambit/arithmetic.h>
#include <stddef.h>

static size_t elem(void *ctx) {
  (void)ctx;
  return 2 * sizeof(double);
}

static void set(void *ctx, void *dst, size_t n, const double *lo, const double *hi, int32_t var) {
  double *x = dst;
  (void)ctx, (void)var;
  for (size_t i = 0; i < n; i++) x[2 * i] = lo[i], x[2 * i + 1] = hi[i];
}

static void bounds(void *ctx, const void *src, size_t n, double *lo, double *hi) {
  const double *x = src;
  (void)ctx;
  for (size_t i = 0; i < n; i++) lo[i] = x[2 * i], hi[i] = x[2 * i + 1];
}

static const ambit_arithmetic small = {
  .size = offsetof(ambit_arithmetic, run), .rigorous = 1, .elem = elem, .set = set, .bounds = bounds
};
static const void *get(const char *id) { return id[6] == 'a' ? &small : NULL; } /* "ambit.arithmetic/1" */
const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "arithmetic.small", "1", "Hulls only.", get };
