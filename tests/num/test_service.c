/* The service "ambit.num/1": the table says what the functions behind it say, through pairs of doubles. */
#include "num/service.h"
#include "num/interval.h"
#include "oracle.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

static const ambit_num_service *const num = &ambit_num_service_v1;

static void maps_every_operation(void **state) {
  (void)state;
  uint64_t random = 9;
  for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++)
    for (int i = 0; i < 300; i++) {
      double a[6], b[6], r[6];
      ambit_interval x[3], y[3], want[3];
      for (int j = 0; j < 3; j++) {
        double p = oracle_double(&random), q = oracle_double(&random);
        x[j] = (ambit_interval) { p < q ? p : q, p < q ? q : p }, y[j] = (ambit_interval) { q, q };
        if (i == 0 && j == 1) x[j] = AMBIT_EMPTY;
        a[2 * j] = x[j].lo, a[2 * j + 1] = x[j].hi, b[2 * j] = y[j].lo, b[2 * j + 1] = y[j].hi;
      }
      uint32_t flags = ambit_interval_map(op, 3, want, x, y, -3);
      assert_int_equal(num->map(op, 3, r, a, b, -3), flags);
      for (int j = 0; j < 3; j++) assert_true(r[2 * j] == want[j].lo && r[2 * j + 1] == want[j].hi);
      assert_int_equal(num->map(op, 3, a, a, b, -3), flags); /* in place */
      assert_memory_equal(a, r, sizeof r);
    }
}

static void unary_operations_need_no_second_operand(void **state) {
  (void)state;
  double a[2] = { 1, 2 }, r[2];
  assert_int_equal(num->map(AMBIT_OP_SQR, 1, r, a, NULL, 0), 0);
  assert_true(r[0] == 1 && r[1] == 4);
  const double lo[1] = { 0 }, hi[1] = { 0 };
  num->elementary(AMBIT_OP_EXP, 1, lo, hi, NULL, NULL, &r[0], &r[1]);
  assert_true(r[0] == 1 && r[1] == 1);
  assert_int_equal(num->pown(&r[0], &r[1], -2, 1, 2), 0);
  assert_true(r[0] == 0 && r[1] == 4);
  assert_int_equal(num->pown(&r[0], &r[1], 0, 0, -1), AMBIT_F_PARTIAL | AMBIT_F_EMPTY);
}

static void reads_and_writes_decimals(void **state) {
  (void)state;
  double lo, hi;
  char message[80], text[64];
  assert_int_equal(num->read("0.1", &lo, &hi, message, sizeof message), AMBIT_OK);
  assert_true(lo == 0x1.9999999999999p-4 && hi == 0.1);
  assert_int_equal(num->read("[1, 0.5]", &lo, &hi, message, sizeof message), AMBIT_INVALID);
  assert_non_null(strstr(message, "[1, 0.5]"));
  assert_int_equal(num->read("nonsense", &lo, &hi, NULL, 0), AMBIT_INVALID);
  assert_int_equal(num->shortest(text, sizeof text, 0.1), 3);
  assert_string_equal(text, "0.1");
  assert_int_equal(num->shortest(text, 3, 0.1), 0);
  assert_int_equal(num->shortest(text, 4, 0.1), 3);
}

static void multiplies_series_and_matrices(void **state) {
  (void)state;
  const double alo[4] = { 1, 2, 3, 4 }, ahi[4] = { 1, 2, 3, 5 }, blo[4] = { -1, 1, 0, 2 }, bhi[4] = { -1, 1, 0.5, 2 };
  double lo[4], hi[4];
  assert_int_equal(num->convolve(4, lo, hi, alo, ahi, blo, bhi), 0);
  const double series_lo[4] = { -1, -1, -1, 0 }, series_hi[4] = { -1, -1, -0.5, 2 };
  assert_memory_equal(lo, series_lo, sizeof lo);
  assert_memory_equal(hi, series_hi, sizeof hi);
  assert_int_equal(num->matmul(2, 2, 2, lo, hi, alo, ahi, blo, bhi), 0);
  const double matrix_lo[4] = { -1, 5, -3.25, 11 } /* of a product of two wide ones: -3 */,
               matrix_hi[4] = { 0, 5, -0.5, 13 };
  assert_memory_equal(lo, matrix_lo, sizeof lo);
  assert_memory_equal(hi, matrix_hi, sizeof hi);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(maps_every_operation),
    cmocka_unit_test(unary_operations_need_no_second_operand),
    cmocka_unit_test(reads_and_writes_decimals),
    cmocka_unit_test(multiplies_series_and_matrices),
  };
  return cmocka_run_group_tests_name("num service", tests, NULL, NULL);
}
