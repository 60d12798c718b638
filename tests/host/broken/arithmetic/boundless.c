/* boundless.c -- broken: lacks the required function `bounds`. */
#include <ambit/arithmetic.h>
#include <stddef.h>

static size_t elem(void *ctx) {
  (void)ctx;
  return 16;
}

static void set(void *ctx, void *dst, size_t n, const double *lo, const double *hi, int32_t var) {
  (void)ctx, (void)dst, (void)n, (void)lo, (void)hi, (void)var;
}

static const ambit_arithmetic boundless = { .size = sizeof boundless, .rigorous = 1, .elem = elem, .set = set };
static const void *get(const char *id) { return id[6] == 'a' ? &boundless : NULL; }
const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "arithmetic.boundless", "1", "", get };
