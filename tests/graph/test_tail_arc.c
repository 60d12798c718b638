/* What the slopes of an arc tangent's tail owe to its defect, by magnitudes made for it: all other parts are 0, which
** in a program they never are. N E' = -d - ..., so |dE'| has 2 |d| |u| |du| / N^2, and d has P_y' [u^2] of orders
** beyond K. */
#include "graph/tail_slope.c"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

enum { U, Q, Y, SLOTS, ORDER = 3, STRIDE = 4 };

static void the_defect_counts(void **state) {
  (void)state;
  uint32_t op = AMBIT_OP_ATAN, dst = Y, a = U, aux = Q;
  ambit_tape tape = { .nslot = SLOTS, .ninstr = 1, .op = &op, .dst = &dst, .a = &a, .b = &a, .aux = &aux };
  uint8_t moving[SLOTS] = { 1, 1, 1 };
  double lo[SLOTS] = { -1, 1, -1 }, hi[SLOTS] = { 1, 2, 1 };
  double values[SLOTS * STRIDE] = { 0 }, slopes_of[SLOTS * STRIDE] = { 0 }, speeds[SLOTS * STRIDE] = { 0 };
  double highest[SLOTS * STRIDE] = { 0 }, fastest[SLOTS * STRIDE] = { 0 };
  double sum_of[SLOTS] = { 1, 0, 0 }, swing[SLOTS] = { 1, 0, 0 }, vsum[SLOTS] = { 1, 0, 0 };
  double tau[SLOTS] = { 0 }, sigma[SLOTS] = { 0 }, weight[STRIDE], lane;
  ambit_tails t = { .tape = &tape,
    .order = ORDER,
    .ndir = 1,
    .stride = STRIDE,
    .K = ORDER,
    .h = 1,
    .moving = moving,
    .lo = lo,
    .hi = hi,
    .U = values,
    .V = slopes_of,
    .W = speeds,
    .R = highest,
    .RW = fastest,
    .sum = sum_of,
    .swing = swing,
    .vsum = vsum,
    .tau = tau,
    .sigma = sigma,
    .weight = weight,
    .lane = &lane };
  values[U * STRIDE + ORDER] = 1, highest[U * STRIDE + ORDER] = 1; /* u = s^3: u^2 = s^6, beyond the order */
  fastest[Y * STRIDE + ORDER] = 5;
  double floor = ambit_tails_atan_floor(&t, 0), change = 0;
  arc(&t, &change, 0, U, Y);
  assert_true(floor >= 1 && isfinite(floor));
  assert_true(ambit_tails_product(&t, U, U) == 1 && ambit_tails_flow(&t, Y, Q) == 0);
  double expected = 5 * 2 / floor / (ORDER + 1) / floor;
  assert_true(change >= expected * (1 - 1e-12) && change <= expected * (1 + 1e-12));
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(the_defect_counts) };
  return cmocka_run_group_tests_name("tail_arc", tests, NULL, NULL);
}
