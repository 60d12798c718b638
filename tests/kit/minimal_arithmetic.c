/* minimal_arithmetic.c -- the smallest arithmetic: what an element is, and how to get in and out. The kernel does the
** rest. */
#include <ambit/arithmetic.h>
#include <string.h>

typedef struct pair {
  double lo, hi;
} pair;

static size_t elem(void *ctx) { return (void)ctx, sizeof(pair); }

static void set(void *ctx, void *dst, size_t n, const double *lo, const double *hi, int32_t var) {
  for (size_t i = 0; i < n; i++) ((pair *)dst)[i] = (pair) { lo[i], hi[i] };
  (void)ctx, (void)var;
}

static void bounds(void *ctx, const void *src, size_t n, double *lo, double *hi) {
  for (size_t i = 0; i < n; i++) lo[i] = ((const pair *)src)[i].lo, hi[i] = ((const pair *)src)[i].hi;
  (void)ctx;
}

static const ambit_arithmetic arithmetic = {
  .size = sizeof arithmetic, .rigorous = 1, .elem = elem, .set = set, .bounds = bounds
};
static const void *get(const char *id) { return strcmp(id, AMBIT_ARITHMETIC) == 0 ? &arithmetic : NULL; }
const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "arithmetic.minimal", "1.0", "Pairs of bounds.",
  get };
