/* test_services.c -- what the kernel lends: memory, one failure message, notes, services by id; the slow path of the
** elementary functions. */
#include "host/trust.h"
#include "host/services.h"
#include "graph/jet.h"
#include <ambit/registry.h>
#include "num/interval.h"
#include "num/service.h"
#include <link.h>
#include <mpfr.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

static void keep_line(void *user, const char *line) { snprintf(user, 64, "%s", line); }

static void lends_memory(void **state) {
  ambit_scope *scope;
  (void)state;
  assert_int_equal(ambit_scope_open(&scope, NULL, NULL), AMBIT_OK);
  const ambit_host *h = &scope->host;
  assert_int_equal(h->size, sizeof *h);
  assert_int_equal(h->abi, AMBIT_ABI);
  for (size_t bytes = 1; bytes < 100000; bytes = bytes * 3 + 1) {
    unsigned char *p = h->alloc(h, bytes);
    assert_int_equal((uintptr_t)p % 64, 0);
    for (size_t i = 0; i < bytes; i++) assert_int_equal(p[i], 0);
    memset(p, 0xff, bytes);
  }
  assert_null(h->alloc(h, SIZE_MAX));
  h->note(h, "nobody listens to %d", 1);
  ambit_scope_close(scope);
  ambit_scope_close(NULL);
}

static void keeps_the_first_failure(void **state) {
  ambit_scope *scope;
  char line[64] = "";
  (void)state;
  assert_int_equal(ambit_scope_open(&scope, keep_line, line), AMBIT_OK);
  const ambit_host *h = &scope->host;
  assert_int_equal((h->fail)(h, AMBIT_UNABLE, "step %d", 3), AMBIT_UNABLE);
  assert_int_equal((h->fail)(h, AMBIT_DOMAIN, "later"), AMBIT_DOMAIN);
  assert_string_equal(scope->failure.message, "step 3");
  assert_int_equal(scope->failure.status, AMBIT_UNABLE);
  h->note(h, "order %d", 12);
  assert_string_equal(line, "order 12");
  ambit_scope_close(scope);
}

static void finds_services(void **state) {
  ambit_scope *scope;
  (void)state;
  assert_int_equal(ambit_scope_open(&scope, NULL, NULL), AMBIT_OK);
  const ambit_host *h = &scope->host;
  assert_ptr_equal(h->service(h, "ambit.num/1"), &ambit_num_service_v1);
  assert_ptr_equal(h->service(h, "ambit.jet/1"), &ambit_jet_service_v1);
  assert_null(h->service(h, "ambit.jet/2"));
  assert_null(h->service(h, ""));
  ambit_scope_close(scope);
}

static int is_slow_path(struct dl_phdr_info *info, size_t size, void *found) {
  (void)size;
  if (strstr(info->dlpi_name, "plugins/service/elementary.so")) *(int *)found = 1;
  return 0;
}

static int slow_path_is_loaded(void) {
  int found = 0;
  dl_iterate_phdr(is_slow_path, &found);
  return found;
}

static void count_note(void *user, const char *line) {
  assert_non_null(strstr(line, "does not offer `ambit.elementary/1`"));
  ++*(int *)user;
}

/* Without the plugin: sound, coarse, and said once. */
static void does_without_the_slow_path(void **state) {
  ambit_interval s, huge = { 1e300, 1e300 };
  int notes = 0;
  (void)state;
  ambit_trust_shadows();
  ambit_registry *r = ambit_registry_open(AMBIT_SHADOW_DIR);
  assert_non_null(r);
  ambit_registry_set_note(r, count_note, &notes);
  for (int i = 0; i < 3; i++) {
    ambit_interval_op(AMBIT_OP_SIN, &s, huge, huge);
    assert_true(s.lo == -1 && s.hi == 1);
  }
  assert_int_equal(notes, 1);
  ambit_registry_close(r);
}

/* The plugin comes at the first argument that needs it and not before; the bounds then hold MPFR's value and are
** next to each other. */
static void loads_the_slow_path_late(void **state) {
  ambit_interval s, huge = { 1e300, 1e300 }, plain = { 0.5, 0.5 };
  (void)state;
  ambit_registry *r = ambit_registry_open(NULL);
  assert_non_null(r);
  ambit_interval_op(AMBIT_OP_SIN, &s, plain, plain);
  assert_int_equal(slow_path_is_loaded(), 0);
  ambit_interval_op(AMBIT_OP_SIN, &s, huge, huge);
  assert_int_equal(slow_path_is_loaded(), 1);
  ambit_registry_close(r);
  ambit_interval_op(AMBIT_OP_COS, &plain, huge, huge); /* still there */
  assert_true(ambit_interval_width(plain) <= 0x1p-51);
  mpfr_t x;
  mpfr_init2(x, 200);
  mpfr_set_d(x, 1e300, MPFR_RNDN);
  mpfr_sin(x, x, MPFR_RNDN);
  assert_true(mpfr_cmp_d(x, s.lo) >= 0 && mpfr_cmp_d(x, s.hi) <= 0);
  assert_true(ambit_interval_width(s) <= 0x1p-51);
  mpfr_clear(x);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(lends_memory),
    cmocka_unit_test(keeps_the_first_failure),
    cmocka_unit_test(finds_services),
    cmocka_unit_test(does_without_the_slow_path), /* before the plugin is there for good */
    cmocka_unit_test(loads_the_slow_path_late),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
