/* test_trust.c -- what may speak: plugins that take shipped names (findings S5), files and folders that others may
** write. Works as root and as a user; a folder of somebody else can be made by root only.
*/
#include "host/load.h"
#include <ambit/registry.h>
#include "host/trust.h"
#include <dlfcn.h>
#include <link.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

typedef struct place {
  char root[64], folder[96], file[160];
} place;

static void copy_file(const char *from, const char *to) {
  char buffer[4096];
  FILE *in = fopen(from, "rb"), *out = fopen(to, "wb");
  assert_true(in && out);
  for (size_t n; (n = fread(buffer, 1, sizeof buffer, in)) > 0;) fwrite(buffer, 1, n, out);
  fclose(in);
  assert_int_equal(fclose(out), 0);
}

/* <root>/arithmetic/small.so, a plugin that works, in a fresh folder of the sticky /tmp */
static int set_up(void **state) {
  place *p = calloc(1, sizeof *p);
  umask(022);
  strcpy(p->root, "/tmp/ambit-trust-XXXXXX");
  if (!mkdtemp(p->root)) return -1;
  chmod(p->root, 0755);
  snprintf(p->folder, sizeof p->folder, "%s/arithmetic", p->root);
  snprintf(p->file, sizeof p->file, "%s/small.so", p->folder);
  if (mkdir(p->folder, 0755) != 0) return -1;
  copy_file(AMBIT_BROKEN_DIR "/arithmetic/small.so", p->file);
  *state = p;
  return 0;
}

static int tear_down(void **state) {
  place *p = *state;
  unlink(p->file);
  rmdir(p->folder);
  rmdir(p->root);
  free(p);
  return 0;
}

/* What loading `small` from the place says; "" if it was loaded. */
static const char *load(const place *p) {
  static ambit_failure f;
  ambit_failure_clear(&f);
  const ambit_arithmetic *a;
  ambit_registry *r = ambit_registry_open(p->root);
  ambit_status status = ambit_registry_arithmetic(r, "small", &a, &f);
  ambit_registry_close(r);
  assert_int_equal(status == AMBIT_OK, f.message[0] == '\0');
  return f.message;
}

static void assert_says(const char *message, const char *part) {
  if (!strstr(message, part)) fail_msg("message lacks \"%s\":\n%s", part, message);
}

static void refuses_what_others_may_write(void **state) {
  place *p = *state;
  assert_string_equal(load(p), "");
  chmod(p->file, 0666);
  assert_says(load(p), "small.so may be written by everybody (mode 0666)");
  chmod(p->file, 0644);
  chmod(p->folder, 0777);
  assert_says(load(p), "/arithmetic may be written by everybody (mode 0777)");
  assert_says(load(p), "--trust /tmp/ambit-trust-");
  chmod(p->folder, 01777); /* sticky: others cannot replace what is there */
  assert_string_equal(load(p), "");
  chmod(p->folder, 0755);
  chmod(p->root, 0777); /* any folder above */
  assert_says(load(p), "may be written by everybody (mode 0777)");
  chmod(p->root, 0755);
  assert_string_equal(load(p), "");
}

/* Seen through a symbolic link, the file is the one that it leads to. */
static void looks_at_real_names(void **state) {
  place *p = *state, link = *p;
  snprintf(link.root, sizeof link.root, "%.40s-link", p->root);
  assert_int_equal(symlink(p->root, link.root), 0);
  assert_string_equal(load(&link), "");
  chmod(p->folder, 0777);
  assert_says(load(&link), p->folder);
  unlink(link.root);
}

/* The loader is given the name that was looked at, not the link, which may lead elsewhere by then. */
static void maps_the_real_file(void **state) {
  place *p = *state;
  char link[96], reason[AMBIT_REASON_MAX] = "";
  snprintf(link, sizeof link, "%.40s-link.so", p->root);
  assert_int_equal(symlink(p->file, link), 0);
  ambit_loaded loaded;
  struct link_map *map;
  if (ambit_load_file(link, "arithmetic.small", &loaded, reason) != AMBIT_OK) fail_msg("%s", reason);
  assert_int_equal(dlinfo(loaded.handle, RTLD_DI_LINKMAP, &map), 0);
  char *real = realpath(p->file, NULL);
  assert_string_equal(map->l_name, real);
  free(real);
  dlclose(loaded.handle);
  unlink(link);
}

static void refuses_what_belongs_to_others(void **state) {
  place *p = *state;
  if (geteuid() != 0) skip();
  assert_int_equal(chown(p->file, 12345, 12345), 0);
  assert_says(load(p), "small.so belongs to somebody else");
  assert_int_equal(chown(p->file, 0, 12345), 0);
  assert_string_equal(load(p), "");
  chmod(p->file, 0664); /* a group that is nobody's own */
  assert_says(load(p), "may be written by its group (mode 0664)");
  assert_int_equal(chown(p->file, 0, 0), 0); /* root's own group */
  assert_string_equal(load(p), "");
}

/* By kind and name; not by a file that its user names. */
static void refuses_shipped_names(void **state) {
  (void)state;
  ambit_failure f = { 0 };
  const ambit_arithmetic *a;
  const ambit_plugin *plugin;
  ambit_registry *r = ambit_registry_open(AMBIT_SHADOW_DIR);
  assert_int_equal(ambit_registry_arithmetic(r, "interval", &a, &f), AMBIT_INVALID);
  assert_says(
      f.message, "arithmetic plugin `interval`: " AMBIT_SHADOW_DIR "/arithmetic/interval.so would take the place");
  assert_says(f.message, "/plugins/arithmetic/interval.so");
  assert_says(f.message, "--allow-shadow");
  ambit_failure_clear(&f);
  assert_int_equal(ambit_registry_load_file(r, AMBIT_SHADOW_DIR "/arithmetic/interval.so", &plugin, &f), AMBIT_OK);
  assert_string_equal(plugin->version, "6.66");
  ambit_registry_close(r);
}

/* Ambit's own folder on the path, by whatever name, shadows nothing. */
static void knows_its_own(void **state) {
  (void)state;
  ambit_failure f = { 0 };
  const ambit_arithmetic *a;
  ambit_registry *r = ambit_registry_open(AMBIT_PLUGINS_DIR);
  if (ambit_registry_arithmetic(r, "interval", &a, &f) != AMBIT_OK) fail_msg("%s", f.message);
  ambit_registry_close(r);
}

/* Holds for the process, so these come last. */
static void believes_who_allows(void **state) {
  place *p = *state;
  ambit_failure f = { 0 };
  chmod(p->folder, 0777);
  assert_int_equal(ambit_trust_folder("/nowhere/at/all", &f), AMBIT_INVALID);
  assert_says(f.message, "cannot trust /nowhere/at/all: No such file");
  ambit_failure_clear(&f);
  assert_int_equal(ambit_trust_folder(p->file, &f), AMBIT_INVALID);
  assert_says(f.message, "Not a directory");
  assert_int_equal(ambit_trust_folder(p->folder, NULL), AMBIT_OK);
  assert_string_equal(load(p), "");
  ambit_trust_shadows();
  const ambit_plugin *plugin;
  ambit_registry *r = ambit_registry_open(AMBIT_SHADOW_DIR);
  ambit_failure_clear(&f);
  assert_int_equal(ambit_registry_plugin(r, "arithmetic", "interval", &plugin, &f), AMBIT_OK);
  assert_string_equal(plugin->version, "6.66");
  ambit_registry_close(r);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(refuses_what_others_may_write, set_up, tear_down),
    cmocka_unit_test_setup_teardown(looks_at_real_names, set_up, tear_down),
    cmocka_unit_test_setup_teardown(maps_the_real_file, set_up, tear_down),
    cmocka_unit_test_setup_teardown(refuses_what_belongs_to_others, set_up, tear_down),
    cmocka_unit_test(refuses_shipped_names),
    cmocka_unit_test(knows_its_own),
    cmocka_unit_test_setup_teardown(believes_who_allows, set_up, tear_down),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
