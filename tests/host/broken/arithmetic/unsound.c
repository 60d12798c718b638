/* unsound.c -- broken: adds bounds to the nearest doubles. */
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

static uint32_t run(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes, size_t count,
    const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  double *x = base;
  (void)self, (void)ctx;
  for (size_t i = 0; i < count; i++)
    for (size_t k = 0; k < 2 * lanes; k++)
      x[2 * dst[i] * pitch + k] = x[2 * a[i] * pitch + k] + x[2 * b[i] * pitch + k];
  return 0;
}

static const ambit_arithmetic unsound = {
  .size = sizeof unsound, .rigorous = 1, .elem = elem, .set = set, .bounds = bounds, .run = { [AMBIT_OP_ADD] = run }
};
static const void *get(const char *id) { return id[6] == 'a' ? &unsound : NULL; } /* "ambit.arithmetic/1" */
const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "arithmetic.unsound", "1", "Sums are not enclosed.",
  get };
