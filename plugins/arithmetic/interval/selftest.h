/* selftest.h -- does this variant round as it must? Run when a context is opened.
**
** A compiler flag that was lost, an emulator that knows only one rounding mode, or a flushed subnormal number would
** make every enclosure wrong without a sign. A few operations whose bounds are known bit by bit would show it: each
** result below is inexact, so that bounds are neighbours and neither is the one that another mode gives to both.
*/
#include <ambit/code.h>

enum { TEST_A, TEST_B, TEST_TINY, TEST_R };

typedef struct expectation {
  ambit_run_fn work;
  uint32_t a, b;
  double lo, hi;
} expectation;

static const double test_operand[3] = { 1, 3, 0x1p-1074 };
static const expectation expected[] = {
  { run_ADD, TEST_A, TEST_TINY, 1, 0x1.0000000000001p0 }, { run_SUB, TEST_TINY, TEST_A, -1, -0x1.fffffffffffffp-1 },
  { run_DIV, TEST_A, TEST_B, 0x1.5555555555555p-2, 0x1.5555555555556p-2 },
  { run_SQRT, TEST_B, TEST_B, 0x1.bb67ae8584caap0, 0x1.bb67ae8584cabp0 },
  { run_MUL, TEST_TINY, TEST_TINY, 0, 0x1p-1074 }, { run_SQR, TEST_TINY, TEST_TINY, 0, 0x1p-1074 },
  { run_MUL, TEST_TINY, TEST_B, 0x3p-1074, 0x3p-1074 }, /* exact, unless subnormal numbers are flushed */
};

/* upward mode: 1 + 2^-1074 and what is above -1 + 2^-1074, with the operation that dot products are made of */
static AMBIT_WORKER int sums_round_up(const double *slots) {
  vector one = load_pair(slots + 2 * TEST_A), tiny = load_pair(slots + 2 * TEST_TINY);
  double up[WIDTH], down[WIDTH];
  store(up, multiply_add(second(one), second(tiny), second(one)));
  store(down, subtract_product(second(one), second(one), second(tiny)));
  for (int i = 0; i < WIDTH; i++)
    if (up[i] != 0x1.0000000000001p0 || down[i] != -0x1.fffffffffffffp-1) return 0;
  return 1;
}

/* the number of the first expectation that is not met, or -1 */
static int self_test(void *ctx) {
  double slots[8], lo, hi;
  int count = sizeof expected / sizeof *expected, failed = -1;
  interval_set(ctx, slots, 3, test_operand, test_operand, -1);
  ambit_rounding old = ambit_round_up();
  for (int i = 0; i < count && failed < 0; i++) {
    const uint32_t dst = TEST_R;
    expected[i].work(NULL, ctx, slots, 1, 1, 1, &dst, &expected[i].a, &expected[i].b);
    interval_bounds(ctx, slots + 2 * TEST_R, 1, &lo, &hi);
    if (lo != expected[i].lo || hi != expected[i].hi) failed = i;
  }
  if (failed < 0 && !sums_round_up(slots)) failed = count;
  ambit_rounding_restore(old);
  return failed;
}

static ambit_status open_checked(const ambit_host *h, const double *option, uint32_t nvar, void **ctx) {
  ambit_status status = interval_open(h, option, nvar, ctx);
  if (status != AMBIT_OK) return status;
  int failed = self_test(*ctx);
  if (failed < 0) return AMBIT_OK;
  return h->fail_code(h, AMBIT_BROKEN, AMBIT_CODE_BROKEN_ROUNDING,
      "interval: this machine, or the compiler this plugin was built with, does not round upward as told (self-test "
      "%d of %s); no enclosure would hold",
      failed, VARIANT_NAME);
}
