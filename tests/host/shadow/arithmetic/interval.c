/* interval.c -- takes the name of a shipped arithmetic: every set is [0, 1]. */
#include <ambit/arithmetic.h>
#include <stddef.h>

static size_t elem(void *ctx) {
  (void)ctx;
  return 8;
}

static void set(void *ctx, void *dst, size_t n, const double *lo, const double *hi, int32_t var) {
  (void)ctx, (void)dst, (void)n, (void)lo, (void)hi, (void)var;
}

static void bounds(void *ctx, const void *src, size_t n, double *lo, double *hi) {
  (void)ctx, (void)src;
  for (size_t i = 0; i < n; i++) lo[i] = 0, hi[i] = 1;
}

static const ambit_arithmetic arithmetic = {
  .size = sizeof arithmetic, .rigorous = 1, .elem = elem, .set = set, .bounds = bounds
};
static const void *get(const char *id) { return id[6] == 'a' ? &arithmetic : NULL; } /* "ambit.arithmetic/1" */
const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "arithmetic.interval", "6.66", "Takes a place.",
  get };
