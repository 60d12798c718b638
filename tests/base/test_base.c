/* Arena, failures, nearest names, growing arrays. */
#include <ambit/arena.h>
#include "base/names.h"
#include <ambit/status.h>
#include "base/vector.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

static void arena_hands_out_aligned_zeroed_memory(void **unused) {
  (void)unused;
  ambit_arena *arena = ambit_arena_open();
  char *first = ambit_arena_alloc(arena, 10);
  memset(first, 1, 10);
  for (size_t n = 1; n < 100000; n = n * 3 + 1) {
    char *p = ambit_arena_alloc(arena, n);
    assert_int_equal((uintptr_t)p % 64, 0);
    for (size_t i = 0; i < n; i++) assert_int_equal(p[i], 0);
    memset(p, 2, n);
  }
  for (int i = 0; i < 10; i++) assert_int_equal(first[i], 1);
  assert_string_equal(ambit_arena_text(arena, "abc"), "abc");
  assert_true(ambit_arena_bytes(arena) > 100000);
  assert_null(ambit_arena_alloc(arena, SIZE_MAX));
  assert_non_null(ambit_arena_alloc(arena, 0));
  ambit_arena_close(arena);
  ambit_arena_close(NULL);
}

static void the_first_failure_is_kept(void **unused) {
  (void)unused;
  ambit_failure f = { 0 };
  assert_int_equal(ambit_fail(&f, AMBIT_INVALID, "first %d", 1), AMBIT_INVALID);
  assert_int_equal(ambit_fail(&f, AMBIT_UNABLE, "second"), AMBIT_UNABLE);
  assert_string_equal(f.message, "first 1");
  assert_int_equal(f.status, AMBIT_INVALID);
  ambit_failure_clear(&f);
  assert_int_equal(f.status, AMBIT_OK);
  assert_int_equal(ambit_fail(NULL, AMBIT_NOMEM, "nobody listens"), AMBIT_NOMEM);
  assert_string_equal(ambit_status_name(AMBIT_UNABLE), "unable");
  assert_string_equal(ambit_status_name(99), "unknown");
}

static void nearest_names(void **unused) {
  (void)unused;
  const char *const known[] = { "revolute", "prismatic", "rigid_link" };
  assert_string_equal(ambit_names_nearest("revolut", known, 3), "revolute");
  assert_string_equal(ambit_names_nearest("ridig_link", known, 3), "rigid_link");
  assert_null(ambit_names_nearest("spring", known, 3));
  const char *const states[] = { "top.3", "top.3'", "op.3" };
  assert_string_equal(ambit_names_nearest("top'.3", states, 3), "top.3'");
  assert_string_equal(ambit_names_nearest("tpo.3", states, 3), "top.3");
  assert_string_equal(ambit_names_nearest("top.33", states, 3), "top.3");
  assert_null(ambit_names_nearest("x", known, 0));
}

static void arrays_grow(void **unused) {
  (void)unused;
  size_t room = 0;
  int *a = NULL;
  for (size_t n = 0; n < 1000; n++) {
    a = ambit_vector_reserve(a, &room, n + 1, sizeof *a);
    assert_non_null(a);
    a[n] = (int)n;
  }
  for (int n = 0; n < 1000; n++) assert_int_equal(a[n], n);
  assert_null(ambit_vector_reserve(NULL, &(size_t) { 0 }, SIZE_MAX, 8));
  free(a);
}

/* A code that is not formed as codes are would become that of its status. */
static void codes_are_told_as_they_are_written(void **unused) {
  (void)unused;
  size_t n;
  const ambit_code *table = ambit_code_table(&n);
  assert_true(n > 20);
  for (size_t i = 0; i < n; i++) {
    int found = 0;
    for (int status = AMBIT_OK; status <= AMBIT_BROKEN; status++) {
      char code[AMBIT_CODE_MAX];
      ambit_code_set(code, (ambit_status)status, table[i].code);
      found = found || strcmp(code, table[i].code) == 0;
    }
    if (!found) fail_msg("%s", table[i].code);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(arena_hands_out_aligned_zeroed_memory),
    cmocka_unit_test(the_first_failure_is_kept),
    cmocka_unit_test(codes_are_told_as_they_are_written),
    cmocka_unit_test(nearest_names),
    cmocka_unit_test(arrays_grow),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
