/* Sealed tapes: shape (order, runs, slots, helpers), meaning (interval evaluation against MPFR), degrees, errors. */
#include "graph/tape.h"
#include "num/interval.h"
#include "sampler.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <time.h>
#include <cmocka.h>

static bool in_series(uint32_t op) {
  return op != AMBIT_OP_TAN && op != AMBIT_OP_ASIN && op != AMBIT_OP_ACOS && op != AMBIT_OP_POWN;
}

static uint32_t find(const ambit_tape *t, uint32_t op, uint32_t a) {
  for (uint32_t i = 0; i < t->ninstr; i++)
    if (t->op[i] == op && t->a[i] == a) return t->dst[i];
  return AMBIT_NO_SLOT;
}

/* What aux has to be, found by opcode and operand; those of TANH, ATAN and ATAN2 are told by their values
** (check_helpers). */
static uint32_t expected_aux(const ambit_tape *t, uint32_t i) {
  uint32_t a = t->a[i];
  switch (t->op[i]) {
  case AMBIT_OP_SIN: return find(t, AMBIT_OP_COS, a);
  case AMBIT_OP_COS: return find(t, AMBIT_OP_SIN, a);
  case AMBIT_OP_SINH: return find(t, AMBIT_OP_COSH, a);
  case AMBIT_OP_COSH: return find(t, AMBIT_OP_SINH, a);
  case AMBIT_OP_TANH:
  case AMBIT_OP_ATAN:
  case AMBIT_OP_ATAN2: return t->aux[i];
  default: return AMBIT_NO_SLOT;
  }
}

static bool has_helper(uint32_t op) {
  return op == AMBIT_OP_SIN || op == AMBIT_OP_COS || op == AMBIT_OP_SINH || op == AMBIT_OP_COSH ||
         op == AMBIT_OP_TANH || op == AMBIT_OP_ATAN || op == AMBIT_OP_ATAN2;
}

static void check_shape(const ambit_tape *t) {
  assert_int_equal(t->size, sizeof *t);
  assert_int_equal(t->nslot, t->nconst + t->nin + t->ninstr);
  for (uint32_t i = 0; i < t->ninstr; i++) {
    assert_int_equal(t->dst[i], t->nconst + t->nin + i);
    assert_true(t->a[i] < t->dst[i]);
    if (t->op[i] != AMBIT_OP_POWN) assert_true(t->b[i] < t->dst[i]);
    if (t->op[i] != AMBIT_OP_POWN && !sampler_is_binary(t->op[i])) assert_int_equal(t->b[i], t->a[i]);
    bool helper = t->flags & AMBIT_TAPE_SERIES && has_helper(t->op[i]);
    if (t->flags & AMBIT_TAPE_SERIES) assert_true(in_series(t->op[i]));
    if (helper) assert_int_not_equal(t->aux[i], AMBIT_NO_SLOT);
    assert_int_equal(t->aux[i], helper ? expected_aux(t, i) : AMBIT_NO_SLOT);
  }
  uint32_t next = 0;
  for (uint32_t r = 0; r < t->nrun; r++) {
    assert_int_equal(t->run[r].first, next);
    assert_true(t->run[r].count > 0);
    for (uint32_t i = next; i < next + t->run[r].count; i++) {
      assert_int_equal(t->op[i], t->run[r].op);
      assert_true(t->a[i] < t->dst[next]); /* independent of each other */
      if (t->op[i] != AMBIT_OP_POWN) assert_true(t->b[i] < t->dst[next]);
    }
    next += t->run[r].count;
  }
  assert_int_equal(next, t->ninstr);
  for (uint32_t k = 0; k < t->nout; k++) assert_true(t->out[k] < t->nslot);
}

/* Every slot in interval arithmetic; returns the union of the flags. */
static uint32_t evaluate(const ambit_tape *t, const ambit_interval *in, ambit_interval *slot) {
  uint32_t flags = 0;
  for (uint32_t k = 0; k < t->nconst; k++) slot[k] = (ambit_interval) { t->lo[k], t->hi[k] };
  for (uint32_t k = 0; k < t->nin; k++) slot[t->nconst + k] = in[k];
  for (uint32_t i = 0; i < t->ninstr; i++) {
    ambit_interval *r = &slot[t->dst[i]];
    if (t->op[i] == AMBIT_OP_POWN)
      flags |= ambit_interval_pown(r, slot[t->a[i]], (int32_t)t->b[i]);
    else
      flags |= ambit_interval_op(t->op[i], r, slot[t->a[i]], slot[t->b[i]]);
  }
  return flags;
}

static void check_helpers(const ambit_tape *t, const ambit_interval *slot) {
  for (uint32_t i = 0; i < t->ninstr; i++) {
    bool atan2 = t->op[i] == AMBIT_OP_ATAN2, tanh = t->op[i] == AMBIT_OP_TANH;
    if (!(t->flags & AMBIT_TAPE_SERIES) || !(atan2 || tanh || t->op[i] == AMBIT_OP_ATAN)) continue;
    ambit_interval one = { 1, 1 }, a, b, want, have = slot[t->aux[i]];
    ambit_interval_op(AMBIT_OP_SQR, &a, slot[tanh ? t->dst[i] : t->a[i]], one);
    ambit_interval_op(AMBIT_OP_SQR, &b, atan2 ? slot[t->b[i]] : one, one);
    ambit_interval_op(tanh ? AMBIT_OP_SUB : AMBIT_OP_ADD, &want, tanh ? b : a, tanh ? a : b);
    if (ambit_interval_is_empty(want) || !ambit_interval_is_bounded(want)) continue;
    double slack = 1e-15 * want.hi; /* a constant is squared before or after it is folded */
    assert_true(fabs(have.lo - want.lo) <= slack && fabs(have.hi - want.hi) <= slack);
  }
}

static ambit_interval around(const sample *s) {
  return (ambit_interval) { mpfr_get_d(s->v, MPFR_RNDD), mpfr_get_d(s->v, MPFR_RNDU) };
}

/* All expressions of the pool as outputs of one tape, at each point. */
static void check_meaning(pool *q, uint32_t flags) {
  ambit_expr out[POOL_MAX], in[] = { q->x, q->y, q->u, q->v, q->t };
  ambit_failure f = { 0 };
  for (size_t i = 0; i < q->count; i++) out[i] = q->item[i].e;
  ambit_arena *arena = ambit_arena_open();
  const ambit_tape *t = NULL;
  assert_int_equal(ambit_tape_seal(q->s.g, arena, q->count, out, 5, in, 2, flags, &t, &f), AMBIT_OK);
  check_shape(t);
  ambit_interval *slot = calloc(t->nslot, sizeof *slot), input[5];
  for (size_t p = 0; p < SAMPLER_POINTS; p++) {
    for (size_t k = 0; k < 5; k++) input[k] = around(sampler_at(&q->s, in[k], p));
    uint32_t flagged = evaluate(t, input, slot);
    check_helpers(t, slot);
    for (size_t i = 0; i < q->count; i++) {
      const sample *truth = &q->item[i].truth[p];
      if (truth->state == UNDEFINED) assert_true(flagged & AMBIT_F_PARTIAL);
      if (truth->state != DEFINED) continue;
      ambit_interval range = { t->range_lo[t->out[i]], t->range_hi[t->out[i]] };
      assert_true(sample_inside(truth, range));
      if (sample_inside(truth, slot[t->out[i]])) continue;
      bool no_series = flags & AMBIT_TAPE_SERIES && flagged & AMBIT_F_PARTIAL; /* asin and acos at -1 and 1 */
      if (no_series && ambit_interval_is_empty(slot[t->out[i]])) continue;
      char text[2000];
      ambit_graph_text(q->s.g, out[i], text, sizeof text);
      fail_msg("flags %u: %s = %.17g is not in [%.17g, %.17g]", flags, text, mpfr_get_d(truth->v, MPFR_RNDN),
          slot[t->out[i]].lo, slot[t->out[i]].hi);
    }
  }
  free(slot);
  ambit_arena_close(arena);
}

static void random_tapes_enclose(void **unused) {
  (void)unused;
  static const uint32_t flags[] = { 0, AMBIT_TAPE_SERIES, AMBIT_SEAL_KEEP, AMBIT_TAPE_SERIES | AMBIT_SEAL_KEEP };
  uint64_t state = 41;
  static pool q;
  for (int round = 0; round < 400; round++) {
    pool_open(&q, &state, pool_draw);
    while (q.count < 60) pool_grow(&q, &state, false);
    check_meaning(&q, flags[round % 4]);
    pool_close(&q);
  }
}

/* -- by hand */

static ambit_graph *g;
static ambit_arena *arena;
static ambit_expr x, y, time_leaf;
static ambit_failure failure;

static int open_graph(void **unused) {
  (void)unused;
  g = ambit_graph_open();
  arena = ambit_arena_open();
  x = ambit_graph_symbol(g, "x", "m"), y = ambit_graph_symbol(g, "y", "m"), time_leaf = ambit_graph_time(g);
  ambit_failure_clear(&failure);
  return 0;
}

static int close_graph(void **unused) {
  (void)unused;
  ambit_graph_close(g);
  ambit_arena_close(arena);
  return 0;
}

#define OP(name, a, b) ambit_graph_op(g, AMBIT_OP_##name, a, b)
#define NUMBER(v) ambit_graph_number(g, v)

/* inputs x, y, time; x varies */
static const ambit_tape *seal(size_t nout, const ambit_expr *out, uint32_t flags) {
  ambit_expr in[] = { x, y, time_leaf };
  const ambit_tape *t = NULL;
  assert_int_equal(ambit_tape_seal(g, arena, nout, out, 3, in, 1, flags, &t, &failure), AMBIT_OK);
  check_shape(t);
  return t;
}

static void only_what_is_reached(void **unused) {
  (void)unused;
  OP(SIN, OP(MUL, x, y), 0); /* not asked for */
  ambit_expr sum = OP(ADD, x, y), out[] = { sum, OP(COS, sum, 0), x, NUMBER(7), sum };
  const ambit_tape *t = seal(5, out, 0);
  assert_int_equal(t->ninstr, 2);
  assert_int_equal(t->nconst, 1);
  assert_int_equal(t->out[0], t->out[4]);
  assert_int_equal(t->out[2], t->nconst);
  assert_int_equal(t->out[3], 0);
  assert_true(t->lo[0] == 7 && t->hi[0] == 7 && !t->text[0]);
}

static void constants_fold_at_sealing(void **unused) {
  (void)unused;
  ambit_expr tenth = ambit_graph_decimal(g, "0.1", NULL), third = OP(DIV, NUMBER(1), NUMBER(3));
  ambit_expr out[] = { OP(MUL, OP(MUL, tenth, third), x), OP(ADD, tenth, y), OP(MUL, tenth, third) };
  const ambit_tape *t = seal(3, out, 0);
  assert_int_equal(t->ninstr, 2);
  assert_int_equal(t->nconst, 2);
  uint32_t product = t->out[2], literal = 1 - product;
  assert_null(t->text[product]);
  assert_true(t->lo[product] < t->hi[product] && t->hi[product] - t->lo[product] < 1e-16);
  assert_string_equal(t->text[literal], "0.1");
  t = seal(3, out, AMBIT_SEAL_KEEP);
  assert_int_equal(t->ninstr, 4);
  assert_int_equal(t->nconst, 3); /* 0.1, 1, 3 */
}

static void undefined_constants_stay(void **unused) {
  (void)unused;
  ambit_expr out[] = { OP(DIV, NUMBER(1), NUMBER(0)), OP(ADD, x, OP(LOG, NUMBER(-1), 0)) };
  const ambit_tape *t = seal(2, out, AMBIT_TAPE_SERIES);
  ambit_interval in[] = { { 1, 1 }, { 1, 1 }, { 1, 1 } }, slot[20];
  assert_true(t->nslot <= 20);
  assert_true(evaluate(t, in, slot) & AMBIT_F_PARTIAL);
}

static void equal_points_share_unequal_enclosures_do_not(void **unused) {
  (void)unused;
  ambit_interval unit = { 0, 1 };
  ambit_expr a = ambit_graph_interval(g, unit), b = ambit_graph_interval(g, unit);
  ambit_expr out[] = { OP(MUL, a, x), OP(MUL, b, x), OP(ADD, OP(SIN, NUMBER(0), 0), OP(MUL, NUMBER(2), x)),
    OP(MUL, NUMBER(2), y) };
  const ambit_tape *t = seal(4, out, 0);
  assert_int_equal(t->nconst, 3);
}

static void degrees(void **unused) {
  (void)unused;
  ambit_expr t = time_leaf, t3 = ambit_graph_pown(g, t, 3);
  const struct {
    ambit_expr e;
    uint32_t degree;
  } want[] = {
    { NUMBER(3), 0 },
    { y, 0 },
    { t, 1 },
    { x, AMBIT_DEGREE_ANY },
    { OP(ADD, t3, t), 3 },
    { OP(MUL, t3, OP(ADD, t, y)), 4 },
    { OP(SQR, OP(ADD, t, NUMBER(1)), 0), 2 },
    { OP(DIV, t3, OP(EXP, y, 0)), 3 },
    { OP(DIV, y, t), AMBIT_DEGREE_ANY },
    { OP(SIN, t, 0), AMBIT_DEGREE_ANY },
    { OP(SIN, y, 0), 0 },
    { OP(MUL, x, t), AMBIT_DEGREE_ANY },
    { OP(NEG, t, 0), 1 },
    { OP(ABS, t, 0), AMBIT_DEGREE_ANY },
    { ambit_graph_pown(g, t, -2), AMBIT_DEGREE_ANY },
    { OP(MIN, y, NUMBER(1)), 0 },
  };
  for (uint32_t flags = 0; flags <= AMBIT_TAPE_SERIES; flags++)
    for (size_t i = 0; i < sizeof want / sizeof *want; i++) {
      const ambit_tape *tape = seal(1, &want[i].e, flags);
      assert_int_equal(tape->degree[tape->out[0]], want[i].degree);
    }
}

static void series_form(void **unused) {
  (void)unused;
  ambit_expr out[] = { OP(TAN, x, 0), OP(TANH, x, 0), OP(ASIN, x, 0), OP(ACOS, x, 0), ambit_graph_pown(g, x, 7),
    ambit_graph_pown(g, x, -6), OP(ATAN, y, 0), OP(ATAN2, x, y), OP(SINH, y, 0) };
  static const double value[] = { 0.54630248984379051326, 0.46211715726000975850, 0.52359877559829887308,
    1.04719755119659774615, 0.0078125, 64, 0.78539816339744830962, 0.46364760900080611621,
    1.17520119364380145688 }; /* x = 1/2, y = 1; DLMF 4 */
  const ambit_tape *t = seal(9, out, AMBIT_TAPE_SERIES);
  ambit_interval in[] = { { 0.5, 0.5 }, { 1, 1 }, { 0, 0 } }, *slot = calloc(t->nslot, sizeof *slot);
  assert_int_equal(evaluate(t, in, slot), 0);
  for (size_t i = 0; i < 9; i++) {
    ambit_interval r = slot[t->out[i]];
    assert_true(r.lo <= value[i] * (1 + 1e-15) && r.hi >= value[i] * (1 - 1e-15) && r.hi - r.lo < 1e-13 * value[i]);
  }
  free(slot);
  assert_true(t->range_lo[t->out[1]] == -1 && t->range_hi[t->out[1]] == 1); /* tanh keeps its bounds */
}

static void ranges_of_unknowns(void **unused) {
  (void)unused;
  ambit_expr u = ambit_graph_unknown(g, "u", (ambit_interval) { 1, 2 }), e = OP(MUL, u, OP(COS, u, 0));
  const ambit_tape *t = NULL;
  assert_int_equal(ambit_tape_seal(g, arena, 1, &e, 1, &u, 0, 0, &t, &failure), AMBIT_OK);
  assert_true(t->range_lo[0] == 1 && t->range_hi[0] == 2);
  assert_true(t->range_lo[t->out[0]] >= -1 && t->range_hi[t->out[0]] <= 1.09);
}

static void refused(const char *part, size_t nin, const ambit_expr *in, ambit_expr out) {
  const ambit_tape *t = NULL;
  ambit_failure_clear(&failure);
  assert_int_equal(ambit_tape_seal(g, arena, 1, &out, nin, in, 0, 0, &t, &failure), AMBIT_INVALID);
  assert_null(t);
  if (!strstr(failure.message, part)) fail_msg("\"%s\" does not mention %s", failure.message, part);
}

static void what_is_missing_is_named(void **unused) {
  (void)unused;
  ambit_expr u = ambit_graph_unknown(g, "length", (ambit_interval) { 1, 2 }),
             n = ambit_graph_unknown(g, NULL, (ambit_interval) { 1, 2 });
  refused("'y'", 1, &x, OP(ADD, x, y));
  refused("time", 1, &x, OP(ADD, x, time_leaf));
  refused("'length'", 1, &x, OP(ADD, x, u));
  refused("unknown", 1, &x, n);
  refused("output 1", 1, &x, AMBIT_NO_EXPR);
  ambit_expr sum = OP(ADD, x, y);
  refused("input 1", 1, &sum, x);
}

/* else one of two quantities would be taken for the other */
static void what_is_given_twice_is_named(void **unused) {
  (void)unused;
  const ambit_tape *t;
  ambit_failure f = { 0 };
  ambit_expr x = ambit_graph_symbol(g, "x", "1"), twice[] = { x, ambit_graph_symbol(g, "x", "1") };
  assert_int_equal(ambit_tape_seal(g, arena, 1, &x, 1, twice, 1, 0, &t, &f), AMBIT_OK);
  assert_int_equal(ambit_tape_seal(g, arena, 1, &x, 2, twice, 1, 0, &t, &f), AMBIT_INVALID);
  assert_non_null(strstr(f.message, "two quantities have the same name, `x`"));
}

static void large_tapes_seal_quickly(void **unused) {
  (void)unused;
  clock_t start = clock();
  ambit_expr e = x;
  for (int i = 0; i < 50000; i++) e = OP(SIN, OP(ADD, e, y), 0);
  ambit_expr in[] = { x, y };
  const ambit_tape *t = NULL;
  assert_int_equal(ambit_tape_seal(g, arena, 1, &e, 2, in, 2, AMBIT_TAPE_SERIES, &t, &failure), AMBIT_OK);
  assert_int_equal(t->ninstr, 150000);
  assert_true((double)(clock() - start) / CLOCKS_PER_SEC < 5); /* 0.1 without sanitizers */
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(random_tapes_enclose),
    cmocka_unit_test_setup_teardown(only_what_is_reached, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(constants_fold_at_sealing, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(undefined_constants_stay, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(equal_points_share_unequal_enclosures_do_not, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(degrees, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(series_form, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(ranges_of_unknowns, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(what_is_missing_is_named, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(what_is_given_twice_is_named, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(large_tapes_seal_quickly, open_graph, close_graph),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
