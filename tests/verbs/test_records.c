/* test_records.c -- JSON lines: exact numbers, awkward text, and disks and pipes that refuse. */
#include "verbs/run/records.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

typedef struct fixture {
  char path[64], text[16384];
  ambit_records *records;
} fixture;

static int set_up(void **state) {
  fixture *x = calloc(1, sizeof *x);
  ambit_failure f = { 0 };
  strcpy(x->path, "/tmp/ambit-records-XXXXXX");
  close(mkstemp(x->path));
  assert_int_equal(ambit_records_open(x->path, &x->records, &f), AMBIT_OK);
  *state = x;
  return 0;
}

static int tear_down(void **state) {
  fixture *x = *state;
  assert_int_equal(ambit_records_close(x->records, NULL), AMBIT_OK);
  remove(x->path);
  free(x);
  return 0;
}

/* what the file holds at this moment: every line is there as soon as it is ended */
static const char *content(fixture *x) {
  FILE *in = fopen(x->path, "rb");
  x->text[fread(x->text, 1, sizeof x->text - 1, in)] = '\0';
  fclose(in);
  return x->text;
}

static void writes_lines_at_once(void **state) {
  fixture *x = *state;
  ambit_records_begin(x->records, "value");
  ambit_records_text(x->records, "name", "tip");
  ambit_records_interval(x->records, "x", (ambit_interval) { 0.1, 17 });
  assert_int_equal(ambit_records_end(x->records, NULL), AMBIT_OK);
  assert_string_equal(content(x), "{\"record\":\"value\",\"name\":\"tip\",\"x\":[0.1,17]}\n");
  ambit_records_begin(x->records, "result");
  ambit_records_open_object(x->records, "settings");
  ambit_records_number(x->records, "order", 20);
  ambit_records_close_object(x->records);
  assert_int_equal(ambit_records_end(x->records, NULL), AMBIT_OK);
  assert_string_equal(strchr(content(x), '\n') + 1, "{\"record\":\"result\",\"settings\":{\"order\":20}}\n");
}

static void writes_special_enclosures(void **state) {
  fixture *x = *state;
  ambit_records_begin(x->records, "value");
  ambit_records_interval(x->records, "none", AMBIT_EMPTY);
  ambit_records_interval(x->records, "all", AMBIT_ENTIRE);
  ambit_records_interval(x->records, "up", (ambit_interval) { -0.0, INFINITY });
  ambit_records_number(x->records, "unknown", NAN);
  assert_int_equal(ambit_records_end(x->records, NULL), AMBIT_OK);
  assert_string_equal(content(x),
      "{\"record\":\"value\",\"none\":[],\"all\":[\"-inf\",\"inf\"],\"up\":[-0,\"inf\"],\"unknown\":null}\n");
}

static int is_json_number(const char *s, const char *end) {
  if (*s == '-') s++;
  if (*s == '0' ? (s[1] >= '0' && s[1] <= '9') : !(*s >= '1' && *s <= '9')) return 0;
  while (*s >= '0' && *s <= '9') s++;
  if (*s == '.') {
    if (!(s[1] >= '0' && s[1] <= '9')) return 0;
    for (s++; *s >= '0' && *s <= '9';) s++;
  }
  if (*s == 'e' || *s == 'E') {
    s++;
    if (*s == '+' || *s == '-') s++;
    if (!(*s >= '0' && *s <= '9')) return 0;
    while (*s >= '0' && *s <= '9') s++;
  }
  return s == end;
}

static void numbers_round_trip(void **state) {
  fixture *x = *state;
  static const double nasty[] = { 0.1, 1e22, 1e23, 5e-324, 2.2250738585072014e-308, 1.7976931348623157e308, 1e-7, 0.3,
    -0.0, 9007199254740992, 1e21, 4.35, 1e100 };
  enum { COUNT = 300, NASTY = sizeof nasty / sizeof *nasty };
  double v[COUNT];
  unsigned long bits = 1;
  for (int i = 0; i < COUNT; i++) {
    do {
      bits = bits * 6364136223846793005ul + 1442695040888963407ul;
      memcpy(&v[i], &bits, sizeof v[i]);
    } while (!isfinite(v[i]));
    if (i < NASTY) v[i] = nasty[i];
  }
  ambit_records_begin(x->records, "v");
  for (int i = 0; i < COUNT; i++) ambit_records_number(x->records, "x", v[i]);
  assert_int_equal(ambit_records_end(x->records, NULL), AMBIT_OK);
  const char *at = content(x);
  for (int i = 0; i < COUNT; i++) {
    at = strstr(at, "\"x\":") + 4;
    char *end;
    double back = strtod(at, &end);
    assert_true(is_json_number(at, end));
    assert_memory_equal(&back, &v[i], sizeof back);
  }
}

static void repairs_text(void **state) {
  fixture *x = *state;
  ambit_records_begin(x->records, "note");
  ambit_records_text(x->records, "a", "say \"h\xc3\xa9\"\n\t\\ \x01");
  ambit_records_text(x->records, "b", "bad \xff\xc3( \xed\xa0\x80 end");
  assert_int_equal(ambit_records_end(x->records, NULL), AMBIT_OK);
  const char *bad = "\xef\xbf\xbd";
  char expected[256];
  snprintf(expected, sizeof expected,
      "{\"record\":\"note\",\"a\":\"say \\\"h\xc3\xa9\\\"\\n\\t\\\\ \\u0001\",\"b\":\"bad %s%s( %s%s%s end\"}\n", bad,
      bad, bad, bad, bad);
  assert_string_equal(content(x), expected);
}

static void writes_steps(void **state) {
  fixture *x = *state;
  static const char *const name[] = { "beta1", "beta1'" };
  double lo[] = { 1, -2 }, hi[] = { 1.5, -1 };
  ambit_record step = { .size = sizeof step,
    .kind = AMBIT_REC_STEP,
    .t_from = 0.5,
    .t_to = 0.25,
    .nx = 2,
    .lo = lo,
    .hi = hi,
    .tube_lo = lo,
    .tube_hi = hi,
    .order = 12,
    .rigorous = 1 };
  assert_int_equal(ambit_records_solver(x->records, &step, name, NULL), AMBIT_OK);
  assert_string_equal(content(x),
      "{\"record\":\"step\",\"t\":[0.25,0.25],\"span\":[0.25,0.5],"
      "\"x\":{\"beta1\":[1,1.5],\"beta1'\":[-2,-1]},\"tube\":{\"beta1\":[1,1.5],\"beta1'\":[-2,-1]},"
      "\"order\":12,\"rigorous\":true}\n");
  step = (ambit_record) { .size = sizeof step, .kind = AMBIT_REC_EVENT, .t_from = 1, .t_to = 2, .event = 3 };
  assert_int_equal(ambit_records_solver(x->records, &step, name, NULL), AMBIT_OK);
  assert_string_equal(
      strchr(content(x), '\n') + 1, "{\"record\":\"event\",\"t\":[1,2],\"event\":3,\"rigorous\":false}\n");
}

static void put_value(ambit_records *r, double x) {
  ambit_records_begin(r, "value");
  ambit_records_number(r, "x", x);
  assert_int_equal(ambit_records_end(r, NULL), AMBIT_OK);
}

static ambit_status put_basis(void *user, ambit_failure *f) {
  fixture *x = user;
  ambit_records_watch(x->records, NULL, NULL); /* once */
  ambit_records_begin(x->records, "plugin");
  return ambit_records_end(x->records, f);
}

/* What is held is written or dropped; what later lines rest on is written in any case. */
static void holds_lines_until_it_is_known_whether_they_count(void **state) {
  fixture *x = *state;
  put_value(x->records, 1);
  ambit_records_hold(x->records);
  for (int i = 0; i < 100; i++) put_value(x->records, 2);
  ambit_records_watch(x->records, put_basis, x);
  put_value(x->records, 3);
  assert_string_equal(content(x), "{\"record\":\"value\",\"x\":1}\n{\"record\":\"plugin\"}\n");
  assert_int_equal(ambit_records_release(x->records, false, NULL), AMBIT_OK);
  ambit_records_hold(x->records);
  put_value(x->records, 4);
  put_value(x->records, 5);
  assert_int_equal(ambit_records_release(x->records, true, NULL), AMBIT_OK);
  assert_int_equal(ambit_records_release(x->records, true, NULL), AMBIT_OK);
  put_value(x->records, 6);
  assert_string_equal(content(x),
      "{\"record\":\"value\",\"x\":1}\n{\"record\":\"plugin\"}\n{\"record\":\"value\",\"x\":4}\n"
      "{\"record\":\"value\",\"x\":5}\n{\"record\":\"value\",\"x\":6}\n");
}

/* After a refused write: one message, then quietly AMBIT_STOPPED. */
static void assert_refused_once(ambit_records *r, const char *part) {
  ambit_failure f = { 0 }, later = { 0 };
  ambit_records_begin(r, "value");
  assert_int_equal(ambit_records_end(r, &f), AMBIT_STOPPED);
  if (!strstr(f.message, part)) fail_msg("\"%s\" expected, got: %s", part, f.message);
  ambit_records_begin(r, "value");
  assert_int_equal(ambit_records_end(r, &later), AMBIT_STOPPED);
  assert_string_equal(later.message, "");
  assert_int_equal(ambit_records_close(r, &later), AMBIT_STOPPED);
}

static void reports_a_full_disk(void **state) {
  ambit_records *r;
  (void)state;
  if (access("/dev/full", W_OK) != 0) skip();
  assert_int_equal(ambit_records_open("/dev/full", &r, NULL), AMBIT_OK);
  assert_refused_once(r, "/dev/full: No space left");
}

static void survives_a_closed_pipe(void **state) {
  ambit_records *r;
  int ends[2];
  char path[64];
  (void)state;
  assert_int_equal(pipe(ends), 0);
  snprintf(path, sizeof path, "/proc/self/fd/%d", ends[1]);
  assert_int_equal(ambit_records_open(path, &r, NULL), AMBIT_OK);
  close(ends[0]);
  close(ends[1]);
  assert_refused_once(r, "Broken pipe"); /* SIGPIPE has its default action here: it would kill the test */
}

static void refuses_a_path_that_cannot_be(void **state) {
  ambit_records *r;
  ambit_failure f = { 0 };
  (void)state;
  assert_int_equal(ambit_records_open("/nowhere/at/all.jsonl", &r, &f), AMBIT_INVALID);
  assert_null(r);
  assert_non_null(strstr(f.message, "/nowhere/at/all.jsonl: No such file"));
  assert_int_equal(ambit_records_close(NULL, NULL), AMBIT_OK);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(writes_lines_at_once, set_up, tear_down),
    cmocka_unit_test_setup_teardown(writes_special_enclosures, set_up, tear_down),
    cmocka_unit_test_setup_teardown(numbers_round_trip, set_up, tear_down),
    cmocka_unit_test_setup_teardown(repairs_text, set_up, tear_down),
    cmocka_unit_test_setup_teardown(writes_steps, set_up, tear_down),
    cmocka_unit_test_setup_teardown(holds_lines_until_it_is_known_whether_they_count, set_up, tear_down),
    cmocka_unit_test(reports_a_full_disk),
    cmocka_unit_test(survives_a_closed_pipe),
    cmocka_unit_test(refuses_a_path_that_cannot_be),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
