/* liar.c -- broken: says that it is rigorous, and reports bounds that no enclosure can have. Right for every number:
** only sets are lied about. */
#include <ambit/arithmetic.h>
#include <math.h>
#include <stddef.h>

enum { NOTHING, GIVE_NAN, GIVE_REVERSED, GIVE_EMPTY, DERIVATIVE_NAN };

typedef struct liar {
  int lie;
} liar;

static ambit_status start(const ambit_host *h, const double *option, uint32_t nvar, void **ctx) {
  liar *l = h->alloc(h, sizeof *l);
  (void)nvar;
  if (!l) return AMBIT_NOMEM;
  l->lie = (int)option[0];
  *ctx = l;
  return AMBIT_OK;
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
  const liar *l = ctx;
  const double *x = src;
  for (size_t i = 0; i < n; i++) {
    lo[i] = x[2 * i], hi[i] = x[2 * i + 1];
    if (!(lo[i] < hi[i])) continue;
    if (l->lie == GIVE_NAN) lo[i] = NAN;
    if (l->lie == GIVE_REVERSED) lo[i] = x[2 * i + 1], hi[i] = x[2 * i];
    if (l->lie == GIVE_EMPTY) lo[i] = INFINITY, hi[i] = -INFINITY;
  }
}

static int32_t gradient(void *ctx, const void *src, double *lo, double *hi) {
  const liar *l = ctx;
  (void)src;
  lo[0] = l->lie == DERIVATIVE_NAN ? NAN : -INFINITY, hi[0] = INFINITY;
  return 1;
}

static const ambit_param option[] = {
  { "lie", "1", "nothing|nan|reversed|empty|derivative", "reversed", "What to lie about." },
  { NULL, NULL, NULL, NULL, NULL },
};
static const ambit_arithmetic arithmetic = { .size = sizeof arithmetic,
  .rigorous = 1,
  .param = option,
  .open = start,
  .close = finish,
  .elem = elem,
  .set = set,
  .bounds = bounds,
  .gradient = gradient };
static const void *get(const char *id) { return id[6] == 'a' ? &arithmetic : NULL; } /* "ambit.arithmetic/1" */
const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "arithmetic.liar", "1", "Gives no enclosures.", get };
