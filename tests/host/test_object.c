/* test_object.c -- files that are no plugin: truncated at many lengths, text, empty, a directory, another machine.
** Each must be an error, not a crash of the loader. */
#include <ambit/registry.h>
#include <elf.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cmocka.h>

typedef struct fixture {
  char root[64], file[128];
  unsigned char *good; /* bytes of a plugin that works */
  size_t size;
  ambit_registry *registry;
} fixture;

static void read_good(fixture *x) {
  FILE *in = fopen(AMBIT_BROKEN_DIR "/arithmetic/small.so", "rb");
  assert_non_null(in);
  fseek(in, 0, SEEK_END);
  x->size = (size_t)ftell(in);
  rewind(in);
  x->good = malloc(x->size);
  assert_int_equal(fread(x->good, 1, x->size, in), x->size);
  fclose(in);
}

static int set_up(void **state) {
  fixture *x = calloc(1, sizeof *x);
  char kind[96];
  strcpy(x->root, "/tmp/ambit-object-XXXXXX");
  assert_non_null(mkdtemp(x->root));
  snprintf(kind, sizeof kind, "%s/arithmetic", x->root);
  assert_int_equal(mkdir(kind, 0700), 0);
  snprintf(x->file, sizeof x->file, "%s/small.so", kind);
  read_good(x);
  x->registry = ambit_registry_open(x->root);
  *state = x;
  return 0;
}

static int tear_down(void **state) {
  fixture *x = *state;
  char kind[96];
  ambit_registry_close(x->registry);
  remove(x->file);
  snprintf(kind, sizeof kind, "%s/arithmetic", x->root);
  rmdir(kind);
  rmdir(x->root);
  free(x->good);
  free(x);
  return 0;
}

static void write_file(const fixture *x, const void *bytes, size_t size) {
  remove(x->file); /* a new inode: the loader must not find the old one */
  FILE *out = fopen(x->file, "wb");
  assert_non_null(out);
  assert_int_equal(fwrite(bytes, 1, size, out), size);
  fclose(out);
}

static void assert_refused(const fixture *x, const char *part) {
  ambit_failure f = { 0 };
  const ambit_arithmetic *a;
  assert_int_equal(ambit_registry_arithmetic(x->registry, "small", &a, &f), AMBIT_INVALID);
  if (!strstr(f.message, part) || !strstr(f.message, x->file)) fail_msg("\"%s\" expected, got: %s", part, f.message);
}

static void refuses_every_truncation(void **state) {
  const fixture *x = *state;
  for (size_t n = 1; n < x->size; n = n < 80 ? n + 1 : n + 1 + x->size / 97) {
    write_file(x, x->good, n);
    assert_refused(x, n < SELFMAG ? "not a shared object" : "truncated");
  }
  write_file(x, x->good, x->size - 1);
  assert_refused(x, "truncated");
}

static void refuses_other_machines(void **state) {
  fixture *x = *state;
  Elf64_Ehdr header;
  memcpy(&header, x->good, sizeof header);
  Elf64_Ehdr other = header;
  other.e_machine = header.e_machine == EM_RISCV ? EM_X86_64 : EM_RISCV;
  memcpy(x->good, &other, sizeof other);
  write_file(x, x->good, x->size);
  assert_refused(x, "another architecture");
  other = header;
  other.e_ident[EI_CLASS] = header.e_ident[EI_CLASS] == ELFCLASS64 ? ELFCLASS32 : ELFCLASS64;
  memcpy(x->good, &other, sizeof other);
  write_file(x, x->good, x->size);
  assert_refused(x, "another architecture");
  other = header;
  other.e_type = ET_REL;
  memcpy(x->good, &other, sizeof other);
  write_file(x, x->good, x->size);
  assert_refused(x, "not a shared object");
}

static void refuses_what_is_no_object(void **state) {
  const fixture *x = *state;
  const char text[] =
      "INPUT(libm.so)\nthis is a text file of some length, longer than an ELF header would be, by far\n";
  write_file(x, text, sizeof text);
  assert_refused(x, "not a shared object");
  write_file(x, "", 0);
  assert_refused(x, "empty");
  remove(x->file);
  assert_int_equal(mkdir(x->file, 0700), 0);
  assert_refused(x, "not a regular file");
  rmdir(x->file);
}

static void takes_the_whole_file(void **state) {
  const fixture *x = *state;
  const ambit_arithmetic *a;
  write_file(x, x->good, x->size);
  assert_int_equal(ambit_registry_arithmetic(x->registry, "small", &a, NULL), AMBIT_OK);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(refuses_every_truncation, set_up, tear_down),
    cmocka_unit_test_setup_teardown(refuses_other_machines, set_up, tear_down),
    cmocka_unit_test_setup_teardown(refuses_what_is_no_object, set_up, tear_down),
    cmocka_unit_test_setup_teardown(takes_the_whole_file, set_up, tear_down),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
