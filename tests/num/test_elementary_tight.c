/* test_elementary_tight.c -- how often a bound is the tightest double: points and narrow intervals of [-10, 10], or of
** the domain inside it, against MPFR. Of all results at least 99.5 % must be, and none may be off by more than 1 ulp.
*/
#include "elementary_oracle.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <cmocka.h>

#define N 512
#define ROUNDS 40
#define LEAST 0.995

typedef struct batch {
  double alo[N], ahi[N], blo[N], bhi[N], rlo[N], rhi[N];
} batch;

typedef struct domain {
  uint32_t op;
  const char *name;
  double lo, hi;
} domain;

static const domain domains[] = { { AMBIT_OP_EXP, "exp", -10, 10 }, { AMBIT_OP_LOG, "log", 0, 10 },
  { AMBIT_OP_SIN, "sin", -10, 10 }, { AMBIT_OP_COS, "cos", -10, 10 }, { AMBIT_OP_TAN, "tan", -10, 10 },
  { AMBIT_OP_ASIN, "asin", -1, 1 }, { AMBIT_OP_ACOS, "acos", -1, 1 }, { AMBIT_OP_ATAN, "atan", -10, 10 },
  { AMBIT_OP_ATAN2, "atan2", -10, 10 }, { AMBIT_OP_SINH, "sinh", -10, 10 }, { AMBIT_OP_COSH, "cosh", -10, 10 },
  { AMBIT_OP_TANH, "tanh", -10, 10 } };

static double inside(const domain *d, uint64_t *s) {
  double x;
  do x = d->lo + (d->hi - d->lo) * random_unit(s);
  while (x == d->lo);
  return x;
}

static void fill(batch *b, const domain *d, double width, uint64_t *s) {
  for (size_t i = 0; i < N; i++) {
    b->alo[i] = inside(d, s), b->ahi[i] = fmin(b->alo[i] + width, d->hi);
    b->blo[i] = inside(d, s), b->bhi[i] = b->blo[i] + width;
  }
}

/* doubles between a bound and the tightest one, counted up to 2 */
static int excess(double got, double want, double outward) {
  if (got == want) return 0;
  return got == nextafter(want, outward) ? 1 : 2;
}

/* the fraction of tightest results */
static double measure(const domain *d, double width) {
  static batch b;
  uint64_t seed = 88172645463325252u;
  size_t tight = 0;
  for (int round = 0; round < ROUNDS; round++) {
    fill(&b, d, width, &seed);
    ambit_elementary(d->op, N, b.alo, b.ahi, b.blo, b.bhi, b.rlo, b.rhi);
    for (size_t i = 0; i < N; i++) {
      ambit_interval x = { b.alo[i], b.ahi[i] }, y = { b.blo[i], b.bhi[i] }, want = image(d->op, x, y, 0);
      int low = excess(b.rlo[i], want.lo, -INFINITY), high = excess(b.rhi[i], want.hi, INFINITY);
      if (low > 1 || high > 1) fail_msg("%s([%a, %a]) is off by more than 1 ulp", d->name, x.lo, x.hi);
      tight += low == 0 && high == 0;
    }
  }
  return (double)tight / (N * ROUNDS);
}

static void nearly_always_tightest(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof domains / sizeof *domains; i++) {
    double thin = measure(&domains[i], 0), narrow = measure(&domains[i], 1e-3);
    print_message("%-6s tightest: points %.3f %%, width 0.001 %.3f %%\n", domains[i].name, 100 * thin, 100 * narrow);
    assert_true(thin >= LEAST);
    assert_true(narrow >= LEAST);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(nearly_always_tightest) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
