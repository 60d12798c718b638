/* test_registry.c -- plugins by name, with plugins that are broken in every way we could think of
** (tests/host/broken). */
#include <ambit/registry.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

#define PATH "/nowhere/at/all:" AMBIT_BROKEN_DIR

static int set_up(void **state) {
  *state = ambit_registry_open(PATH);
  return *state ? 0 : -1;
}

static int tear_down(void **state) {
  ambit_registry_close(*state);
  return 0;
}

static void assert_says(const ambit_failure *f, const char *part) {
  if (!strstr(f->message, part)) fail_msg("message lacks \"%s\":\n%s", part, f->message);
}

/* Loading the plugin fails with a message that names it and has the given part. */
static void assert_refused(ambit_registry *r, const char *kind, const char *name, const char *part) {
  ambit_failure f = { 0 };
  const void *got = "untouched";
  ambit_status status = AMBIT_OK;
  if (strcmp(kind, "arithmetic") == 0) status = ambit_registry_arithmetic(r, name, (const ambit_arithmetic **)&got, &f);
  if (strcmp(kind, "element") == 0) status = ambit_registry_element(r, name, (const ambit_element **)&got, &f);
  if (strcmp(kind, "solver") == 0) status = ambit_registry_solver(r, name, (const ambit_solver **)&got, &f);
  if (strcmp(kind, "root finder") == 0)
    status = ambit_registry_root_finder(r, name, (const ambit_root_finder **)&got, &f);
  if (strcmp(kind, "strategy") == 0) status = ambit_registry_strategy(r, name, (const ambit_strategy **)&got, &f);
  assert_int_equal(status, AMBIT_INVALID);
  assert_null(got);
  assert_says(&f, name);
  assert_says(&f, part);
}

static void loads_a_good_plugin_once(void **state) {
  ambit_failure f = { 0 };
  const ambit_arithmetic *a, *again;
  assert_int_equal(ambit_registry_arithmetic(*state, "small", &a, &f), AMBIT_OK);
  assert_int_equal(ambit_registry_arithmetic(*state, "small", &again, &f), AMBIT_OK);
  assert_ptr_equal(a, again);
  for (int op = 0; op < AMBIT_OP_COUNT; op++) assert_non_null(a->run[op]);
  assert_int_equal(a->rigorous, 1);
  const ambit_plugin *p;
  assert_int_equal(ambit_registry_plugin(*state, "arithmetic", "small", &p, &f), AMBIT_OK);
  assert_string_equal(p->id, "arithmetic.small");
}

static void takes_structs_of_other_minor_versions(void **state) {
  ambit_failure f = { 0 };
  const ambit_arithmetic *a;
  assert_int_equal(ambit_registry_arithmetic(*state, "newer", &a, &f), AMBIT_OK);
  assert_non_null(a->open);
  assert_null(a->eval_tape);
  assert_int_equal(ambit_registry_arithmetic(*state, "small", &a, &f), AMBIT_OK);
  assert_null(a->dot); /* beyond its own struct: zeroes, not the neighbour's bytes */
  assert_null(a->jets);
  assert_null(a->set_text);
}

static void refuses_another_abi(void **state) {
  assert_refused(*state, "arithmetic", "future", "2.7");
  assert_refused(*state, "arithmetic", "future", "1.0");
}

static void refuses_a_wrong_id(void **state) {
  assert_refused(*state, "arithmetic", "impostor", "arithmetic.somebody_else");
}

static void refuses_a_missing_or_odd_entry(void **state) {
  assert_refused(*state, "arithmetic", "mute", "ambit_entry");
  assert_refused(*state, "arithmetic", "callable", "not a struct ambit_plugin");
  assert_refused(*state, "arithmetic", "headless", "at least");
  assert_refused(*state, "arithmetic", "unresolved", "ambit_symbol_that_nobody_defines");
}

static void refuses_incomplete_interfaces(void **state) {
  assert_refused(*state, "arithmetic", "faceless", AMBIT_ARITHMETIC);
  assert_refused(*state, "arithmetic", "stunted", "bytes");
  assert_refused(*state, "arithmetic", "boundless", "lacks `bounds`");
  assert_refused(*state, "element", "inexpressive", "lacks `express`");
  assert_refused(*state, "element", "portless", "lacks `port`");
  assert_refused(*state, "solver", "idle", "lacks `run`");
  assert_refused(*state, "root finder", "mock", "does not offer the interface `" AMBIT_ROOT_FINDER "`");
  assert_refused(*state, "strategy", "mock", "does not offer the interface `" AMBIT_STRATEGY "`");
}

static void lists_what_was_tried(void **state) {
  assert_refused(*state, "arithmetic", "smal", "/nowhere/at/all/arithmetic/smal.so: no such file");
  assert_refused(*state, "arithmetic", "smal", AMBIT_BROKEN_DIR "/arithmetic/smal.so: no such file");
  assert_refused(*state, "arithmetic", "smal", "did you mean `small`?");
  assert_refused(*state, "arithmetic", "mock", "of kind solver");
}

static void checks_names(void **state) {
  ambit_failure f = { 0 };
  const ambit_plugin *p;
  assert_refused(*state, "arithmetic", "../small", "cannot be the name");
  assert_refused(*state, "arithmetic", "", "cannot be the name");
  assert_refused(*state, "arithmetic", ".hidden", "cannot be the name");
  assert_int_equal(ambit_registry_plugin(*state, "solvers", "mock", &p, &f), AMBIT_INVALID);
  assert_says(&f, "did you mean `solver`?");
}

static void loads_any_file(void **state) {
  ambit_failure f = { 0 };
  const ambit_plugin *p;
  assert_int_equal(ambit_registry_load_file(*state, AMBIT_BROKEN_DIR "/solver/mock.so", &p, &f), AMBIT_OK);
  assert_string_equal(p->id, "solver.mock");
  assert_int_equal(ambit_registry_load_file(*state, AMBIT_BROKEN_DIR "/solver/none.so", &p, &f), AMBIT_INVALID);
  assert_null(p);
  assert_says(&f, "no such file");
}

static void lists_without_loading(void **state) {
  ambit_listing list[128];
  size_t n = ambit_registry_list(*state, 128, list), seen = 0;
  assert_in_range(n, 10, 128);
  assert_int_equal(ambit_registry_list(*state, 0, NULL), n);
  for (size_t i = 0; i < n; i++) {
    assert_int_equal(list[i].loaded, 0);
    if (i && strcmp(list[i - 1].kind, list[i].kind) == 0) assert_true(strcmp(list[i - 1].name, list[i].name) < 0);
    seen += strcmp(list[i].kind, "solver") == 0 && strcmp(list[i].name, "mock") == 0;
  }
  assert_int_equal(seen, 1);
  const ambit_solver *s;
  assert_int_equal(ambit_registry_solver(*state, "mock", &s, NULL), AMBIT_OK);
  n = ambit_registry_list(*state, 128, list);
  for (size_t i = 0; i < n; i++) assert_int_equal(list[i].loaded, strcmp(list[i].name, "mock") == 0);
}

static void shows_exports(void **state) {
  const ambit_plugin *p;
  const ambit_exports *e;
  assert_int_equal(ambit_registry_plugin(*state, "arithmetic", "small", &p, NULL), AMBIT_OK);
  assert_int_equal(ambit_registry_exports(*state, p, &e, NULL), AMBIT_OK);
  assert_null(e);
  ambit_plugin stranger = *p;
  assert_int_equal(ambit_registry_exports(*state, &stranger, &e, NULL), AMBIT_INVALID);
}

static void takes_the_path_from_the_environment(void **state) {
  (void)state;
  char *old = getenv("AMBIT_PATH"), *kept = old ? strdup(old) : NULL;
  const ambit_solver *s;
  setenv("AMBIT_PATH", "::" AMBIT_BROKEN_DIR ":", 1);
  ambit_registry *r = ambit_registry_open(NULL);
  assert_int_equal(ambit_registry_solver(r, "mock", &s, NULL), AMBIT_OK);
  ambit_registry_close(r);
  if (kept)
    setenv("AMBIT_PATH", kept, 1);
  else
    unsetenv("AMBIT_PATH");
  free(kept);
}

static void stays_where_it_was_opened(void **state) {
  (void)state;
  char *here = getcwd(NULL, 0);
  const ambit_solver *s;
  assert_int_equal(chdir(AMBIT_BROKEN_DIR), 0);
  ambit_registry *r = ambit_registry_open("."), *up = ambit_registry_open("../nowhere:./.");
  assert_int_equal(chdir("/"), 0);
  assert_int_equal(ambit_registry_solver(r, "mock", &s, NULL), AMBIT_OK);
  assert_int_equal(ambit_registry_solver(up, "mock", &s, NULL), AMBIT_OK);
  ambit_registry_close(r);
  ambit_registry_close(up);
  assert_int_equal(chdir(here), 0);
  free(here);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(loads_a_good_plugin_once, set_up, tear_down),
    cmocka_unit_test_setup_teardown(takes_structs_of_other_minor_versions, set_up, tear_down),
    cmocka_unit_test_setup_teardown(refuses_another_abi, set_up, tear_down),
    cmocka_unit_test_setup_teardown(refuses_a_wrong_id, set_up, tear_down),
    cmocka_unit_test_setup_teardown(refuses_a_missing_or_odd_entry, set_up, tear_down),
    cmocka_unit_test_setup_teardown(refuses_incomplete_interfaces, set_up, tear_down),
    cmocka_unit_test_setup_teardown(lists_what_was_tried, set_up, tear_down),
    cmocka_unit_test_setup_teardown(checks_names, set_up, tear_down),
    cmocka_unit_test_setup_teardown(loads_any_file, set_up, tear_down),
    cmocka_unit_test_setup_teardown(lists_without_loading, set_up, tear_down),
    cmocka_unit_test_setup_teardown(shows_exports, set_up, tear_down),
    cmocka_unit_test(takes_the_path_from_the_environment),
    cmocka_unit_test(stays_where_it_was_opened),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
