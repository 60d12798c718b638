/* Requests beyond the memory that is there are refused before anything is taken. */
#include <ambit/arena.h>
#include "base/memory.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <sys/resource.h>
#include <cmocka.h>

static void knows_the_machine(void **unused) {
  (void)unused;
  size_t available = ambit_memory_available();
  assert_true(available > 1000000);
  assert_true(available < SIZE_MAX); /* every Linux tells */
  assert_true(ambit_memory_allows(0));
  assert_true(ambit_memory_allows(1000000));
  assert_false(ambit_memory_allows(SIZE_MAX));
  assert_false(ambit_memory_allows((size_t)1 << 60));
}

static void an_arena_refuses_what_is_not_there(void **unused) {
  (void)unused;
  ambit_arena *arena = ambit_arena_open();
  assert_null(ambit_arena_alloc(arena, (size_t)1 << 50));
  assert_non_null(ambit_arena_alloc(arena, 100)); /* and still works */
  ambit_arena_close(arena);
}

static void obeys_the_limit_of_the_process(void **unused) {
  (void)unused;
#if defined(__SANITIZE_ADDRESS__)
  skip(); /* its shadow alone is terabytes of addresses */
#else
  struct rlimit old, low;
  assert_int_equal(getrlimit(RLIMIT_AS, &old), 0);
  low = old, low.rlim_cur = (rlim_t)1 << 30;
  assert_int_equal(setrlimit(RLIMIT_AS, &low), 0);
  assert_true(ambit_memory_available() < (size_t)1 << 30);
  assert_false(ambit_memory_allows((size_t)1 << 30));
  assert_int_equal(setrlimit(RLIMIT_AS, &old), 0);
#endif
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(knows_the_machine),
    cmocka_unit_test(an_arena_refuses_what_is_not_there),
    cmocka_unit_test(obeys_the_limit_of_the_process),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
