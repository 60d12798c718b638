/* Terms of equations: what they add up to and what replacing them means, by MPFR and an evaluator that follows the
** definitions word by word. */
#include "algebra/summands.h"
#include "algebra/term_tree.h"
#include "graph/sampler.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <cmocka.h>

#define EQUATIONS 3
#define LEVELS 4

/* What an equation is after a replacement, straight from the definition. */
typedef struct definition {
  pool *q;
  const ambit_term_tree *tree;
  const ambit_expr *by; /* [nterm], or NO_EXPR */
  uint32_t equation;
  size_t point;
  sample *known; /* [2 * count] */
  bool *has;     /* [2 * count] */
} definition;

static bool is_sum(const definition *d, ambit_expr e) { return ambit_op_is_sum(ambit_graph_node(d->q->s.g, e)->op); }

static const ambit_tree_sum *find_sum(const definition *d, ambit_expr e) {
  if (!is_sum(d, e)) return NULL;
  for (uint32_t k = d->tree->first_sum[d->equation]; k < d->tree->first_sum[d->equation + 1]; k++)
    if (d->tree->sum[k].node == e) return &d->tree->sum[k];
  return NULL;
}

static ambit_expr body_of(const definition *d, ambit_expr e) { return ambit_fold_split(d->q->s.g, e).body; }

static bool is_replaced(const definition *d, const ambit_tree_sum *sum, ambit_expr leaf) {
  for (uint32_t k = sum->first; k < sum->first + sum->count; k++)
    if (d->by[k] != AMBIT_NO_EXPR && body_of(d, d->tree->term[k].e) == body_of(d, leaf)) return true;
  return false;
}

static const sample *value(definition *d, ambit_expr e, bool maximal);

static void add(sample *total, const sample *x, bool negative) {
  sample r;
  sample_init(&r);
  sample_apply(negative ? AMBIT_OP_SUB : AMBIT_OP_ADD, &r, total, x, 0);
  mpfr_set(total->v, r.v, MPFR_RNDN);
  total->state = r.state;
  mpfr_clear(r.v);
}

/* Everything that is added in a sum, one by one. */
static void add_leaves(definition *d, const ambit_tree_sum *sum, ambit_expr e, bool negative, sample *total) {
  const ambit_node *x = ambit_graph_node(d->q->s.g, e);
  if (x->op == AMBIT_OP_NEG) {
    add_leaves(d, sum, x->a, !negative, total);
  } else if (ambit_op_is_sum(x->op)) {
    add_leaves(d, sum, x->a, negative, total);
    add_leaves(d, sum, x->b, negative != (x->op == AMBIT_OP_SUB), total);
  } else if (!is_replaced(d, sum, e)) {
    add(total, value(d, e, true), negative);
  }
}

static void apply(definition *d, ambit_expr e, bool maximal, sample *r) {
  const ambit_node *x = ambit_graph_node(d->q->s.g, e);
  bool inside = !is_sum(d, e) && !(x->op == AMBIT_OP_NEG && !maximal);
  const sample *a = value(d, x->a, inside);
  const sample *b = x->op == AMBIT_OP_POWN ? a : value(d, x->b, inside);
  sample_apply(x->op, r, a, b, (int32_t)x->b);
}

static const sample *value(definition *d, ambit_expr e, bool maximal) {
  size_t at = 2 * (size_t)e + (maximal ? 1 : 0);
  if (d->has[at]) return &d->known[at];
  sample *r = &d->known[at];
  sample_init(r);
  d->has[at] = true;
  const ambit_tree_sum *sum = maximal ? find_sum(d, e) : NULL;
  const sample *now = sampler_at(&d->q->s, e, d->point);
  if (sum) {
    add_leaves(d, sum, e, false, r);
    for (uint32_t k = sum->first; k < sum->first + sum->count; k++)
      if (d->by[k] != AMBIT_NO_EXPR) add(r, sampler_at(&d->q->s, d->by[k], d->point), sum->negative);
  } else if (ambit_graph_node(d->q->s.g, e)->op < AMBIT_OP_COUNT) {
    apply(d, e, maximal, r);
  } else {
    mpfr_set(r->v, now->v, MPFR_RNDN);
    r->state = now->state;
  }
  return r;
}

static void assert_means(pool *q, const ambit_term_tree *tree, const ambit_expr *by, uint32_t i, ambit_expr rate) {
  size_t count = 2 * (size_t)ambit_graph_count(q->s.g);
  uint32_t whole = 0;
  while (tree->term[whole].equation != i) whole++;
  const ambit_tree_sum *root = &tree->sum[tree->first_sum[i]];
  for (size_t p = 0; p < SAMPLER_POINTS; p++) {
    definition d = { q, tree, by, i, p, calloc(count, sizeof *d.known), calloc(count, sizeof *d.has) };
    sample want;
    sample_init(&want);
    if (by[whole] != AMBIT_NO_EXPR)
      add(&want, sampler_at(&q->s, by[whole], p), false);
    else if (!is_sum(&d, root->node) && root->count == 1 && by[root->first] != AMBIT_NO_EXPR)
      add(&want, sampler_at(&q->s, by[root->first], p), false);
    else
      add(&want, value(&d, root->node, true), root->negative);
    const sample *have = sampler_at(&q->s, rate, p);
    if (want.state != DOUBTFUL && have->state != DOUBTFUL) {
      assert_int_equal(want.state, have->state);
      if (want.state == DEFINED) assert_true(sample_close(&want, have, 1e-30));
    }
    mpfr_clear(want.v);
    for (size_t k = 0; k < count; k++)
      if (d.has[k]) mpfr_clear(d.known[k].v);
    free(d.known);
    free(d.has);
  }
}

/* Another form of e, known only by its value. */
static void assert_same(pool *q, ambit_expr e, ambit_expr other) {
  for (size_t p = 0; p < SAMPLER_POINTS; p++) {
    const sample *x = sampler_at(&q->s, e, p), *y = sampler_at(&q->s, other, p);
    if (x->state == DOUBTFUL || y->state == DOUBTFUL) continue;
    assert_int_equal(x->state, y->state);
    if (x->state == DEFINED) assert_true(sample_close(x, y, 1e-30));
  }
}

/* Every sum is the sum of its terms, every term of level n is inside one of level n - 1, which comes before. */
static void check_tree(pool *q, const ambit_term_tree *tree) {
  for (size_t k = 0; k < tree->nsum; k++) {
    const ambit_tree_sum *sum = &tree->sum[k];
    ambit_expr total = 0;
    for (uint32_t j = sum->first; j < sum->first + sum->count; j++)
      total = ambit_graph_op(q->s.g, AMBIT_OP_ADD, total, tree->term[j].e);
    if (sum->negative) total = ambit_graph_op(q->s.g, AMBIT_OP_NEG, total, total);
    sampler_update(&q->s);
    assert_same(q, sum->node, total);
  }
  for (size_t k = 0; k < tree->nterm; k++) {
    const ambit_tree_term *term = &tree->term[k];
    assert_true(term->level <= LEVELS);
    if (term->level == 0) {
      assert_int_equal(term->parent, AMBIT_NO_TERM);
      assert_int_equal(term->e, tree->rate[term->equation]);
      continue;
    }
    assert_true(term->parent < k);
    assert_int_equal(tree->term[term->parent].level, term->level - 1);
    assert_int_equal(tree->term[term->parent].equation, term->equation);
  }
}

/* Two terms of one body: not collected, since the sum of their coefficients is no double. */
static bool is_ambiguous(pool *q, const ambit_term_tree *tree) {
  for (size_t k = 0; k < tree->nsum; k++)
    for (uint32_t i = tree->sum[k].first; i < tree->sum[k].first + tree->sum[k].count; i++)
      for (uint32_t j = tree->sum[k].first; j < i; j++)
        if (ambit_fold_split(q->s.g, tree->term[i].e).body == ambit_fold_split(q->s.g, tree->term[j].e).body)
          return true;
  return false;
}

static size_t replace_some(pool *q, uint64_t *state, const ambit_term_tree *tree) {
  static uint32_t index[AMBIT_TERM_TREE_MAX];
  static ambit_expr by[AMBIT_TERM_TREE_MAX], with[AMBIT_TERM_TREE_MAX];
  size_t n = 0;
  uint64_t rarely = 1 + oracle_random(state) % 8;
  for (uint32_t k = 0; k < tree->nterm; k++) {
    by[k] = AMBIT_NO_EXPR;
    if (oracle_random(state) % rarely || (tree->term[k].level == 0 && oracle_random(state) % 8)) continue;
    by[k] = oracle_random(state) % 2 ? 0 : q->item[oracle_random(state) % q->count].e;
    index[n] = k, with[n++] = by[k];
  }
  ambit_expr rate[EQUATIONS];
  assert_int_equal(ambit_term_tree_rewrite(q->s.g, tree, n, index, with, rate, NULL), AMBIT_OK);
  sampler_update(&q->s);
  for (uint32_t i = 0; i < EQUATIONS; i++) {
    assert_means(q, tree, by, i, rate[i]);
    bool any = false;
    for (uint32_t k = 0; k < tree->nterm; k++) any = any || (tree->term[k].equation == i && by[k] != AMBIT_NO_EXPR);
    if (!any) assert_int_equal(rate[i], tree->rate[i]);
  }
  return n;
}

static void random_equations(void **unused) {
  (void)unused;
  uint64_t state = 11;
  static pool q;
  size_t replaced = 0, deep = 0;
  for (int round = 0; round < 800; round++) {
    pool_open(&q, &state, pool_draw);
    while (q.count < 100) pool_grow(&q, &state, false);
    ambit_expr rate[EQUATIONS];
    for (size_t i = 0; i < EQUATIONS; i++) rate[i] = q.item[POOL_LEAVES + 25 + oracle_random(&state) % 60].e;
    ambit_term_tree tree;
    size_t limit = round % 2 ? 0 : 40;
    assert_int_equal(ambit_term_tree_open(q.s.g, EQUATIONS, rate, LEVELS, limit, &tree, NULL), AMBIT_OK);
    sampler_update(&q.s);
    check_tree(&q, &tree);
    for (size_t k = 0; k < tree.nterm; k++) deep += tree.term[k].level > 1;
    for (int k = 0; k < 3 && !is_ambiguous(&q, &tree); k++) replaced += replace_some(&q, &state, &tree);
    ambit_term_tree_close(&tree);
    pool_close(&q);
  }
  assert_true(replaced > 4000 && deep > 1500);
}

static ambit_graph *g;
static ambit_expr x, y, z;

#define OP(name, a, b) ambit_graph_op(g, AMBIT_OP_##name, a, b)
#define ADD(a, b) OP(ADD, a, b)
#define SUB(a, b) OP(SUB, a, b)
#define MUL(a, b) OP(MUL, a, b)
#define DIV(a, b) OP(DIV, a, b)
#define SIN(a) OP(SIN, a, 0)
#define NEG(a) OP(NEG, a, 0)
#define NUMBER(v) ambit_graph_number(g, v)

static int open_graph(void **unused) {
  (void)unused;
  g = ambit_graph_open();
  x = ambit_graph_symbol(g, "x", "m"), y = ambit_graph_symbol(g, "y", "m"), z = ambit_graph_symbol(g, "z", "m");
  return 0;
}

static int close_graph(void **unused) {
  (void)unused;
  ambit_graph_close(g);
  return 0;
}

static void assert_term(const ambit_term_tree *tree, size_t k, uint32_t level, uint32_t parent, ambit_expr e) {
  assert_true(k < tree->nterm);
  assert_int_equal(tree->term[k].level, level);
  assert_int_equal(tree->term[k].parent, parent);
  assert_int_equal(tree->term[k].e, e);
}

static void assert_expr(ambit_expr have, ambit_expr want) {
  char a[2000], b[2000];
  ambit_graph_text(g, have, a, sizeof a);
  ambit_graph_text(g, want, b, sizeof b);
  if (have != want) fail_msg("%s, expected %s", a, b);
}

static ambit_expr cut(const ambit_term_tree *tree, uint32_t k, ambit_expr by) {
  ambit_expr rate[8];
  assert_int_equal(ambit_term_tree_rewrite(g, tree, 1, &k, &by, rate, NULL), AMBIT_OK);
  return rate[tree->term[k].equation];
}

static void levels_and_parents(void **unused) {
  (void)unused;
  ambit_expr inner = ADD(x, MUL(y, ADD(NUMBER(1), z))),
             rate[] = { SUB(SIN(inner), DIV(ADD(x, y), z)), NEG(ADD(x, y)), 0, OP(EXP, SUB(NEG(x), y), 0) };
  ambit_term_tree tree;
  assert_int_equal(ambit_term_tree_open(g, 4, rate, 9, 0, &tree, NULL), AMBIT_OK);
  assert_int_equal(tree.nterm, 17);
  assert_term(&tree, 0, 0, AMBIT_NO_TERM, rate[0]);
  assert_term(&tree, 1, 1, 0, SIN(inner));
  assert_term(&tree, 2, 1, 0, NEG(DIV(ADD(x, y), z)));
  assert_term(&tree, 3, 2, 1, x);
  assert_term(&tree, 4, 2, 1, MUL(y, ADD(NUMBER(1), z)));
  assert_term(&tree, 5, 2, 2, x);
  assert_term(&tree, 7, 3, 4, NUMBER(1));
  assert_term(&tree, 10, 1, 9, NEG(x));
  assert_term(&tree, 11, 1, 9, NEG(y));
  assert_term(&tree, 12, 0, AMBIT_NO_TERM, 0); /* 0 has no summands */
  assert_term(&tree, 14, 1, 13, rate[3]);
  assert_expr(cut(&tree, 3, 0), SUB(SIN(MUL(y, ADD(NUMBER(1), z))), DIV(ADD(x, y), z)));
  assert_expr(cut(&tree, 2, z), ADD(SIN(inner), z));
  assert_expr(cut(&tree, 10, 0), NEG(y));
  assert_expr(cut(&tree, 11, x), 0);
  assert_expr(cut(&tree, 14, z), z);
  assert_expr(cut(&tree, 15, 0), OP(EXP, NEG(y), 0));
  ambit_term_tree_close(&tree);
}

static uint32_t find(const ambit_term_tree *tree, uint32_t equation, uint32_t level, ambit_expr e) {
  for (uint32_t k = 0; k < tree->nterm; k++)
    if (tree->term[k].equation == equation && tree->term[k].level == level && tree->term[k].e == e) return k;
  fail();
  return 0;
}

static void a_sum_counts_once_and_the_outer_replacement_wins(void **unused) {
  (void)unused;
  ambit_expr s = ADD(x, y), first = SIN(s), second = MUL(z, OP(COS, s, 0));
  ambit_expr both[] = { ADD(first, second), ADD(OP(EXP, s, 0), z) };
  ambit_term_tree tree;
  assert_int_equal(ambit_term_tree_open(g, 2, both, 2, 0, &tree, NULL), AMBIT_OK);
  assert_int_equal(tree.nterm, 3 + 2 + 3 + 2);
  uint32_t a = find(&tree, 0, 1, first), b = find(&tree, 0, 2, x), c = find(&tree, 0, 2, y);
  assert_term(&tree, b, 2, a, x);
  assert_expr(cut(&tree, c, 0), ADD(SIN(x), MUL(z, OP(COS, x, 0))));
  ambit_expr by[] = { z, 0, 0, NUMBER(2) }, rates[2];
  uint32_t index[] = { a, b, find(&tree, 1, 2, x), find(&tree, 1, 1, OP(EXP, s, 0)) };
  assert_int_equal(ambit_term_tree_rewrite(g, &tree, 4, index, by, rates, NULL), AMBIT_OK);
  assert_expr(rates[0], ADD(z, MUL(z, OP(COS, y, 0))));
  assert_expr(rates[1], ADD(NUMBER(2), z));
  ambit_term_tree_close(&tree);
}

/* A partial sum of one sum, and by itself inside of another term. */
static void partial_sums_are_not_maximal(void **unused) {
  (void)unused;
  ambit_expr s = ADD(x, y), rate = ADD(ADD(s, z), SIN(s));
  ambit_term_tree tree;
  assert_int_equal(ambit_term_tree_open(g, 1, &rate, 5, 0, &tree, NULL), AMBIT_OK);
  assert_int_equal(tree.nterm, 1 + 4 + 2);
  assert_expr(cut(&tree, 5, 0), ADD(ADD(s, z), SIN(tree.term[6].e)));
  ambit_term_tree_close(&tree);
  ambit_expr deep = ADD(SIN(s), OP(COS, MUL(z, OP(EXP, ADD(s, z), 0)), 0)); /* s + z is deeper than the levels */
  ambit_expr nested = ADD(SIN(MUL(z, ADD(x, SIN(ADD(y, SIN(ADD(s, z))))))), SIN(s));
  ambit_expr rates[] = { deep, nested };
  assert_int_equal(ambit_term_tree_open(g, 2, rates, 2, 0, &tree, NULL), AMBIT_OK);
  for (uint32_t k = 0; k < tree.nterm; k++)
    if (tree.term[k].equation == 1 && tree.term[k].e == y)
      assert_expr(cut(&tree, k, 0), ADD(SIN(MUL(z, ADD(x, SIN(ADD(y, SIN(ADD(s, z))))))), SIN(x)));
  ambit_term_tree_close(&tree);
}

/* 2^60 paths; 20000 levels deep. */
static void sharing_and_depth(void **unused) {
  (void)unused;
  ambit_expr e = x, chain = x;
  for (int i = 0; i < 60; i++) e = ambit_store_make(g, AMBIT_OP_ADD, ambit_store_make(g, AMBIT_OP_ADD, e, y), e);
  ambit_term_tree tree;
  ambit_failure f = { 0 };
  assert_int_equal(ambit_term_tree_open(g, 1, &e, 3, 0, &tree, &f), AMBIT_INVALID); /* 2^60 - 1 is no double */
  assert_non_null(strstr(f.message, "equation 1: a term is repeated"));
  ambit_term_tree_close(&tree);
  for (int i = 0; i < 20000; i++) chain = ADD(SIN(chain), y);
  assert_int_equal(ambit_term_tree_open(g, 1, &chain, UINT32_MAX, 0, &tree, NULL), AMBIT_OK);
  assert_int_equal(tree.nterm, 1 + 2 * 20000);
  assert_int_equal(tree.term[40000].level, 20000);
  uint32_t last = tree.term[39999].e == y ? 40000 : 39999;
  assert_int_not_equal(cut(&tree, last, 0), chain);
  assert_expr(cut(&tree, last, tree.term[last].e), chain);
  ambit_term_tree_close(&tree);
  e = x;
  for (int i = 0; i < 60; i++) e = MUL(SIN(e), OP(COS, e, 0));
  e = ADD(e, y);
  assert_int_equal(ambit_term_tree_open(g, 1, &e, 100, 1000, &tree, NULL), AMBIT_OK);
  assert_int_equal(tree.nterm, 3);
  ambit_term_tree_close(&tree);
}

static void too_many_terms(void **unused) {
  (void)unused;
  ambit_expr e = x;
  char name[16];
  for (int i = 0; i < 1000; i++) { /* sum i is inside of sum i + 1, and a part of it */
    snprintf(name, sizeof name, "a%d", i);
    e = ADD(e, MUL(ambit_graph_symbol(g, name, "1"), SIN(e)));
  }
  ambit_term_tree tree;
  ambit_failure f = { 0 };
  assert_int_equal(ambit_term_tree_open(g, 1, &e, UINT32_MAX, 0, &tree, &f), AMBIT_INVALID);
  assert_non_null(strstr(f.message, "more than 100000 terms up to level 2"));
  ambit_term_tree_close(&tree);
  assert_int_equal(ambit_term_tree_open(g, 1, &e, 1, 0, &tree, NULL), AMBIT_OK);
  assert_int_equal(tree.nterm, 1002);
  ambit_expr by = 0, rate;
  uint32_t none = 1002, twice[] = { 1, 1 };
  ambit_expr zeros[] = { 0, 0 };
  assert_int_equal(ambit_term_tree_rewrite(g, &tree, 1, &none, &by, &rate, NULL), AMBIT_INVALID);
  assert_int_equal(ambit_term_tree_rewrite(g, &tree, 2, twice, zeros, &rate, NULL), AMBIT_INVALID);
  ambit_term_tree_close(&tree);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(random_equations),
    cmocka_unit_test_setup_teardown(levels_and_parents, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(a_sum_counts_once_and_the_outer_replacement_wins, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(partial_sums_are_not_maximal, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(sharing_and_depth, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(too_many_terms, open_graph, close_graph),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
