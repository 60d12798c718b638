/* Ten thousand random expressions in every arithmetic of the plugin folder: all enclosures contain the value (MPFR)
** at sampled points, have a point in common, and do so whether the graph folds the expression or not.
**
** AMBIT_AGREE_COUNT=n AMBIT_AGREE_SEED=s: n expressions from seed s on (default 10000 from 1); the same as arguments.
** A failure prints the smallest part of the expression that fails, as a scene, and the seed that reproduces it.
*/
#include "agreement.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define FAILURES_MAX 20

static uint64_t count = 10000, first = 1;

static void explain(agreement *s, uint64_t seed) {
  char whole[sizeof s->failure];
  memcpy(whole, s->failure, sizeof whole);
  uint32_t node = 0; /* the first part that fails by itself: at the latest the whole */
  while (node + 1 < s->x.count && agree_node(s, node)) node++;
  if (node + 1 == s->x.count) memcpy(s->failure, whole, sizeof whole);
  fprintf(stderr, "\nseed %llu: %s\n", (unsigned long long)seed, s->failure);
  fprintf(
      stderr, "again: AMBIT_AGREE_SEED=%llu AMBIT_AGREE_COUNT=1; the smallest part of it:\n", (unsigned long long)seed);
  random_print(&s->x, node, stderr);
}

static void all_arithmetics_agree(void **unused) {
  (void)unused;
  static agreement s;
  size_t failures = 0, values = 0;
  agree_open(&s);
  assert_true(s.ncandidate >= 1);
  for (uint64_t seed = first; seed < first + count && failures < FAILURES_MAX; seed++) {
    agree_draw(&s, seed);
    if (!agree_node(&s, s.x.count - 1)) {
      failures++;
      explain(&s, seed);
    } else
      agree_count(&s);
    for (size_t p = 0; p < AGREE_POINTS; p++) values += s.oracle[p].node[s.x.count - 1].state == DEFINED;
    ambit_graph_close(s.graph);
  }
  agree_print_counts(&s, stdout);
  printf("%zu sampled values\n", values);
  agree_close(&s);
  assert_int_equal(failures, 0);
  assert_true(values >= count); /* of five points of each, most have a value */
}

/* A judge that finds nothing proves little: each of these results breaks one promise. */
static void wrong_results_are_seen(void **unused) {
  (void)unused;
  static agreement s;
  agree_open(&s);
  for (uint64_t seed = 1; seed <= 200; seed++) {
    agree_draw(&s, seed);
    uint32_t node = s.x.count - 1;
    assert_true(agree_node(&s, node));
    agree_result good = s.result[0][FOLDED], *r = &s.result[0][FOLDED];
    bool defined = false, undefined = false;
    for (size_t p = 0; p < AGREE_POINTS; p++) {
      defined = defined || s.oracle[p].node[node].state == DEFINED;
      undefined = undefined || s.oracle[p].node[node].state == UNDEFINED;
    }
    if (defined && good.x.hi < 1e300) {
      r->x = (ambit_interval) { good.x.hi + fmax(1, fabs(good.x.hi)), 3e300 };
      assert_false(judge_result(&s, node, 0, FOLDED));
      r->x = AMBIT_EMPTY;
      assert_false(judge_pair(&s, &s.result[0][PLAIN], r));
    }
    *r = good, r->flags = 0;
    assert_int_equal(judge_result(&s, node, 0, FOLDED), !undefined);
    *r = good, r->status = AMBIT_UNABLE;
    assert_false(judge_result(&s, node, 0, FOLDED));
    ambit_graph_close(s.graph);
  }
  agree_close(&s);
}

static void read_number(const char *text, uint64_t *number) {
  if (text && text[0]) *number = strtoull(text, NULL, 10);
}

int main(int argc, char **argv) {
  read_number(getenv("AMBIT_AGREE_COUNT"), &count);
  read_number(getenv("AMBIT_AGREE_SEED"), &first);
  read_number(argc > 1 ? argv[1] : NULL, &count);
  read_number(argc > 2 ? argv[2] : NULL, &first);
  const struct CMUnitTest tests[] = { cmocka_unit_test(wrong_results_are_seen),
    cmocka_unit_test(all_arithmetics_agree) };
  return cmocka_run_group_tests_name("arithmetics agree", tests, NULL, NULL);
}
