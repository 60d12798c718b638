/* context.c -- elements from bounds and back, the rounding mode around a batch, and the entry of the plugin. */
#include "interval.h"
#include <string.h>

ambit_status interval_open(const ambit_host *h, const double *option, uint32_t nvar, void **ctx) {
  (void)option, (void)nvar;
  interval_context *context = h->alloc(h, sizeof *context);
  if (!context) return h->fail(h, AMBIT_NOMEM, "out of memory");
  context->num = h->service(h, AMBIT_NUM_SERVICE);
  context->meter = h->service(h, AMBIT_METER_SERVICE);
  if (!context->num) return h->fail(h, AMBIT_INVALID, "this kernel does not lend `%s`", AMBIT_NUM_SERVICE);
  *ctx = context;
  return AMBIT_OK;
}

size_t interval_elem(void *ctx) {
  (void)ctx;
  return 2 * sizeof(double);
}

void interval_enter(void *ctx) { ((interval_context *)ctx)->outside = ambit_round_up(); }
void interval_leave(void *ctx) { ambit_rounding_restore(((interval_context *)ctx)->outside); }

/* These two may be called outside enter and leave, in an environment that takes subnormal numbers for zero; so they
** look at bits and do no arithmetic on doubles. */
#define SIGN INT64_MIN
#define BITS_OF_INFINITY INT64_C(0x7ff0000000000000)

static int64_t bits_of(double x) {
  int64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits;
}

static void write_bits(double *x, int64_t bits) { memcpy(x, &bits, sizeof bits); }

/* increasing with the double; the same for -0 and 0; beyond those of the infinities for NaN */
static int64_t rank(int64_t bits) { return bits < 0 ? -(bits & INT64_MAX) : bits; }

static int is_interval(int64_t lo, int64_t hi) {
  return lo <= hi && lo >= -BITS_OF_INFINITY && lo < BITS_OF_INFINITY && hi > -BITS_OF_INFINITY &&
         hi <= BITS_OF_INFINITY;
}

void interval_set(void *ctx, void *dst, size_t n, const double *lo, const double *hi, int32_t var) {
  (void)ctx, (void)var;
  double *r = dst;
  for (size_t i = 0; i < n; i++) {
    int64_t down = bits_of(lo[i]), up = bits_of(hi[i]), empty = SIGN | BITS_OF_INFINITY;
    int nonempty = is_interval(rank(down), rank(up));
    write_bits(r + 2 * i, nonempty ? down ^ SIGN : empty);
    write_bits(r + 2 * i + 1, nonempty ? up : empty);
  }
}

void interval_bounds(void *ctx, const void *src, size_t n, double *lo, double *hi) {
  (void)ctx;
  const double *x = src;
  for (size_t i = 0; i < n; i++) {
    int64_t negated = bits_of(x[2 * i]);
    write_bits(lo + i, negated == 0 ? 0 : negated ^ SIGN); /* never -0 */
    hi[i] = x[2 * i + 1];
  }
}

#if defined(__x86_64__)
static int has_avx2(void) { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"); }

static int has_avx512(void) {
  return has_avx2() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl");
}
#endif

/* Each variant is an interface in its own right too, for comparing them; NULL if this processor cannot run it. */

static const void *get(const char *interface_id) {
  int any = strcmp(interface_id, AMBIT_ARITHMETIC) == 0;
#if defined(__x86_64__)
  if ((any || strcmp(interface_id, "ambit.arithmetic.avx512/1") == 0) && has_avx512()) return &interval_avx512;
  if ((any || strcmp(interface_id, "ambit.arithmetic.avx2/1") == 0) && has_avx2()) return &interval_avx2;
#endif
  return any || strcmp(interface_id, "ambit.arithmetic.portable/1") == 0 ? &interval_portable : NULL;
}

const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "arithmetic.interval", "1.0",
  "Closed intervals of doubles, rounded outward: every result contains the exact image (IEEE 1788 set-based flavour). "
  "Remembers no "
  "dependence between quantities. Offers fast Taylor series, so it is the arithmetic of choice for the `lohner` "
  "solver.",
  get };
