/* newer.c -- a good plugin of a later minor version: fields behind those that this kernel knows; options to choose
** from. */
#include <ambit/arithmetic.h>
#include <stddef.h>

typedef struct later_arithmetic {
  ambit_arithmetic known;
  void *appended[4];
} later_arithmetic;

static ambit_status start(const ambit_host *h, const double *option, uint32_t nvar, void **ctx) {
  (void)nvar;
  if (option[0] < 1) return h->fail(h, AMBIT_INVALID, "degree %g is below 1", option[0]);
  *ctx = h->alloc(h, sizeof(double));
  return *ctx ? AMBIT_OK : AMBIT_NOMEM;
}

static void finish(void *ctx) { (void)ctx; }

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

static const ambit_param option[] = { { "degree", "1", "integer", "2", "Highest power kept." },
  { NULL, NULL, NULL, NULL, NULL } };
static const later_arithmetic newer = { .known = { .size = sizeof newer,
                                            .rigorous = 0,
                                            .param = option,
                                            .open = start,
                                            .close = finish,
                                            .elem = elem,
                                            .set = set,
                                            .bounds = bounds },
  .appended = { (void *)&option, NULL, NULL, NULL } };
static const void *get(const char *id) { return id[6] == 'a' ? &newer : NULL; }
const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI + 1, "arithmetic.newer", "9",
  "From the future, politely.", get };
