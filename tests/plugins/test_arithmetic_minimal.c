/* The smallest arithmetic plugin passes the kit with every operation left to the kernel; and the kit finds what is
** broken. */
#include "arithmetic_case.h"
#include <ambit/rounding.h>
#include <string.h>

static void passes_the_kit(void **state) {
  (void)state;
  arithmetic_loader l;
  size_t fallbacks;
  case_load(&l, "minimal");
  assert_int_equal(case_run(&l, true, &fallbacks), 0);
  assert_int_equal(fallbacks, AMBIT_OP_COUNT);
  arithmetic_unload(&l);
}

/* A kit that finds nothing proves little: each of these plugins breaks one promise. */

static void quiet(void *user, const char *check, const char *message) {
  (void)message;
  char *first = user;
  if (!first[0]) strncpy(first, check, 31);
}

static const ambit_arithmetic *sound; /* the completed minimal arithmetic */

static uint32_t inward_add(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,
    size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  uint32_t flags = sound->run[AMBIT_OP_ADD](self, ctx, base, pitch, lanes, count, dst, a, b);
  double *r = (double *)base + 2 * pitch * dst[0];
  if (r[0] < r[1]) r[1] = nextafter(r[1], -INFINITY);
  return flags;
}

static uint32_t silent_sqrt(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,
    size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  return sound->run[AMBIT_OP_SQRT](self, ctx, base, pitch, lanes, count, dst, a, b) & ~AMBIT_F_PARTIAL;
}

static uint32_t greedy_neg(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,
    size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  return sound->run[AMBIT_OP_NEG](self, ctx, base, pitch, lanes + 1, count, dst, a, b);
}

static uint32_t hollow_mul(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,
    size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  uint32_t flags = sound->run[AMBIT_OP_MUL](self, ctx, base, pitch, lanes, count, dst, a, b);
  double *r = (double *)base + 2 * pitch * dst[0];
  for (size_t l = 0; l < lanes; l++)
    if (r[2 * l] > r[2 * l + 1]) r[2 * l] = 0, r[2 * l + 1] = 0;
  return flags;
}

static void forget_mode(void *ctx) {
  (void)ctx;
  (void)ambit_round_up();
}

/* one instruction too few, if there are several */
static uint32_t lazy_sub(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes, size_t count,
    const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  return sound->run[AMBIT_OP_SUB](self, ctx, base, pitch, lanes, count > 1 ? count - 1 : 1, dst, a, b);
}

/* eight lanes at a time, and no thought of the ninth */
static uint32_t short_sub(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes, size_t count,
    const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  return sound->run[AMBIT_OP_SUB](self, ctx, base, pitch, lanes < 8 ? lanes : 8, count, dst, a, b);
}

static uint32_t timid_cosh(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,
    size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  return sound->run[AMBIT_OP_COSH](self, ctx, base, pitch, lanes, count, dst, a, b) | AMBIT_F_UNBOUNDED;
}

/* right in the default environment, where the sum of subnormal numbers is not flushed to zero */
static uint32_t flushed_add(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,
    size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  uint32_t flags = sound->run[AMBIT_OP_ADD](self, ctx, base, pitch, lanes, count, dst, a, b);
  for (size_t i = 0; i < 2 * lanes; i++) {
    volatile double x = ((double *)base)[2 * pitch * a[0] + i], y = ((double *)base)[2 * pitch * b[0] + i];
    if (fabs(x) < DBL_MIN && fabs(y) < DBL_MIN && x == y) ((double *)base)[2 * pitch * dst[0] + i] = x + y;
  }
  return flags;
}

/* the last instruction is forgotten: its slot is what it was */
static uint32_t forgetful_tape(void *ctx, const ambit_tape *t, void *base, size_t pitch, size_t lanes) {
  uint32_t flags = 0;
  for (uint32_t i = 0; i + 1 < t->ninstr; i++)
    flags |= sound->run[t->op[i]](sound, ctx, base, pitch, lanes, 1, t->dst + i, t->a + i, t->b + i);
  memset((double *)base + 2 * pitch * t->dst[t->ninstr - 1], 0, 2 * lanes * sizeof(double));
  return flags;
}

static uint32_t nearest_dot(
    void *ctx, void *dst, const void *a, ptrdiff_t sa, const void *b, ptrdiff_t sb, size_t m, size_t lanes) {
  (void)ctx;
  for (size_t i = 0; i < 2 * lanes; i++) {
    double sum = 0;
    for (ptrdiff_t j = 0; j < (ptrdiff_t)m; j++)
      sum += ((const double *)a)[2 * j * sa + (ptrdiff_t)i] * ((const double *)b)[2 * j * sb + (ptrdiff_t)i];
    ((double *)dst)[i] = sum;
  }
  return 0;
}

static int32_t nearest_text(void *ctx, void *dst, const char *text) {
  char *end;
  double x = strtod(text, &end);
  if (end == text || *end) return 0;
  sound->set(ctx, dst, 1, &x, &x, -1);
  return 1;
}

static int32_t flat_gradient(void *ctx, const void *src, double *lo, double *hi) {
  (void)ctx, (void)src;
  for (int j = 0; j < 3; j++) lo[j] = hi[j] = 0;
  return 1;
}

static ambit_status careless_open(const ambit_host *h, const double *option, uint32_t nvar, void **ctx) {
  (void)option, (void)nvar;
  *ctx = h->alloc(h, 8);
  return AMBIT_OK;
}

static ambit_status sullen_open(const ambit_host *h, const double *option, uint32_t nvar, void **ctx) {
  *ctx = NULL;
  (void)option, (void)h;
  return nvar > 3 ? AMBIT_INVALID : AMBIT_OK;
}

static const ambit_param undecided[] = { { "order", "1", "integer", NULL, "of something" },
  { NULL, NULL, NULL, NULL, NULL } };

static const char *first_finding(const arithmetic_loader *l, const ambit_arithmetic *broken, char check[32]) {
  ambit_arithmetic full;
  check[0] = '\0';
  assert_int_equal(ambit_arithmetic_complete(broken, &full, NULL), AMBIT_OK);
  arithmetic_kit kit = { .plugin = broken,
    .full = &full,
    .host = &l->scope->host,
    .isotonic = true,
    .seed = 1,
    .oracle = case_oracle,
    .finding = quiet,
    .user = check,
    .effort = 0.2 };
  return arithmetic_kit_run(&kit) ? check : "nothing";
}

static void finds_broken_operations(void **state) {
  (void)state;
  static const struct {
    uint32_t op;
    ambit_run_fn run;
    const char *promise;
  } mistakes[] = { { AMBIT_OP_ADD, inward_add, "inclusion" }, { AMBIT_OP_SQRT, silent_sqrt, "partial" },
    { AMBIT_OP_NEG, greedy_neg, "layout" }, { AMBIT_OP_MUL, hollow_mul, "empty" },
    { AMBIT_OP_SUB, lazy_sub, "inclusion" }, { AMBIT_OP_SUB, short_sub, "inclusion" },
    { AMBIT_OP_COSH, timid_cosh, "flags" }, { AMBIT_OP_ADD, flushed_add, "inclusion" } };
  arithmetic_loader l;
  char check[32];
  case_load(&l, "minimal");
  sound = &l.full;
  for (size_t i = 0; i < sizeof mistakes / sizeof *mistakes; i++) {
    ambit_arithmetic broken = *l.plugin;
    broken.run[mistakes[i].op] = mistakes[i].run;
    assert_string_equal(first_finding(&l, &broken, check), mistakes[i].promise);
  }
  arithmetic_unload(&l);
}

static void finds_other_mistakes(void **state) {
  (void)state;
  arithmetic_loader l;
  char check[32];
  case_load(&l, "minimal");
  sound = &l.full;
  ambit_arithmetic broken = *l.plugin;
  assert_string_equal(first_finding(&l, &broken, check), "nothing");
  broken = *l.plugin, broken.enter = forget_mode;
  assert_string_equal(first_finding(&l, &broken, check), "environment");
  broken = *l.plugin, broken.eval_tape = forgetful_tape;
  assert_string_equal(first_finding(&l, &broken, check), "program");
  broken = *l.plugin, broken.dot = nearest_dot;
  assert_string_equal(first_finding(&l, &broken, check), "dot");
  broken = *l.plugin, broken.set_text = nearest_text;
  assert_string_equal(first_finding(&l, &broken, check), "set_text");
  broken = *l.plugin, broken.gradient = flat_gradient;
  assert_string_equal(first_finding(&l, &broken, check), "gradient");
  broken = *l.plugin, broken.open = careless_open;
  assert_string_equal(first_finding(&l, &broken, check), "contexts");
  broken = *l.plugin, broken.open = sullen_open;
  assert_string_equal(first_finding(&l, &broken, check), "open");
  broken = *l.plugin, broken.param = undecided;
  assert_string_equal(first_finding(&l, &broken, check), "options");
  arithmetic_unload(&l);
}

static void options_at_other_values(void **state) {
  (void)state;
  arithmetic_loader l;
  char check[32] = "";
  case_load(&l, "minimal");
  const ambit_option option = { "order", "3" };
  arithmetic_kit kit = { .plugin = &l.full,
    .full = &l.full,
    .host = &l.scope->host,
    .seed = 1,
    .oracle = case_oracle,
    .finding = quiet,
    .user = check,
    .effort = 0.05,
    .noption = 1,
    .option = &option };
  assert_int_equal(arithmetic_kit_run(&kit), 1); /* it has no such option */
  assert_string_equal(check, "options");
  arithmetic_unload(&l);
}

/* what `ambit new` writes */
static void the_skeleton_passes(void **state) {
  (void)state;
  arithmetic_loader l;
  size_t fallbacks;
  case_load(&l, "skeleton");
  assert_int_equal(case_run(&l, true, &fallbacks), 0);
  assert_int_equal(fallbacks, AMBIT_OP_COUNT - 2);
  arithmetic_unload(&l);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(passes_the_kit),
    cmocka_unit_test(finds_broken_operations),
    cmocka_unit_test(finds_other_mistakes),
    cmocka_unit_test(options_at_other_values),
    cmocka_unit_test(the_skeleton_passes),
  };
  return cmocka_run_group_tests_name("arithmetic kit, minimal plugin", tests, NULL, NULL);
}
