/* Opening the interval plugin fails if directed rounding does not work, in every variant. */
#include "kit/arithmetic_loader.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

static const char *const variant[] = { "ambit.arithmetic.portable/1", "ambit.arithmetic.avx2/1",
  "ambit.arithmetic.avx512/1" };

/* the plugin's status and message in an environment where upward mode is `mode` */
static ambit_status open_in(const ambit_arithmetic *plugin, const char *mode, char *message, size_t room) {
  ambit_scope *scope;
  void *ctx = NULL;
  assert_int_equal(setenv("AMBIT_TEST_ROUNDING", mode, 1), 0);
  assert_int_equal(ambit_scope_open(&scope, NULL, NULL), AMBIT_OK);
  ambit_status status = plugin->open(&scope->host, NULL, 0, &ctx);
  snprintf(message, room, "%s", scope->failure.message);
  ambit_scope_close(scope);
  return status;
}

static void refuses_without_upward_mode(void **unused) {
  (void)unused;
  static const char *const broken[] = { "nearest", "down", "zero", "flush" };
  int modes = 3;
#if defined(__x86_64__)
  modes = 4;
#endif
  void *library = dlopen(UNROUNDED_PATH "/arithmetic/interval.so", RTLD_NOW | RTLD_LOCAL);
  if (!library) fail_msg("%s", dlerror());
  const ambit_plugin *entry = dlsym(library, "ambit_entry");
  for (int v = 0; v < 3; v++) {
    const ambit_arithmetic *plugin = entry->get(variant[v]);
    char message[1024];
    if (!plugin) continue;
    for (int i = 0; i < modes; i++) {
      assert_int_equal(open_in(plugin, broken[i], message, sizeof message), AMBIT_BROKEN);
      assert_non_null(strstr(message, "does not round upward"));
    }
    assert_int_equal(open_in(plugin, "up", message, sizeof message), AMBIT_OK);
  }
  dlclose(library);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(refuses_without_upward_mode),
  };
  return cmocka_run_group_tests_name("interval self-test", tests, NULL, NULL);
}
