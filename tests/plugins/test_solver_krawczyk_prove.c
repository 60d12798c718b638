/* Pieces of parameters' ranges, from inside: where no parameter moves the root nothing is cut, and every box stays as
** it is. */
#define krawczyk_newton seen_newton
#include "solver/krawczyk/prove.c"
#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

enum verdict seen_newton(krawczyk *k, span *x) {
  (void)k, (void)x;
  return VERDICT_AT_MOST;
}

static void nothing_is_cut_without_parameters(void **unused) {
  (void)unused;
  span room[3] = { { 1, 2 }, { -1, 1 }, { -1, 1 } }, common[1], left[1];
  krawczyk k = { .n = 1, .m = 1, .common = common, .left = left };
  k.half.x = room, k.half.room = 3, k.half.count = 2;
  assert_int_equal(halve(&k), 0);
  assert_int_equal(k.half.count, 2);
  for (size_t i = 0; i < 3; i++) assert_true(room[i].lo == (i ? -1 : 1) && room[i].hi == (i ? 1 : 2));
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(nothing_is_cut_without_parameters) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
