/* u(x) - w(x - d) against 400 bits on random pairs, with d of any size: value, domain, and that nothing cancels. */
#include "algebra/difference.h"
#include "graph/hull.h"
#include "graph/tape.h"
#include "graph/sampler.h"
#include <ambit/arithmetic.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <time.h>
#include <cmocka.h>

/* A random pool of pairs: second[i] is made as first[i] is, but now and then something else is put in its place. */
typedef struct twins {
  sampler s;
  ambit_expr x, y, p, dx, dy;
  ambit_expr first[POOL_MAX], second[POOL_MAX];
  size_t count;
} twins;

static ambit_expr variable(twins *t, const char *name, const double value[SAMPLER_POINTS]) {
  ambit_expr e = ambit_graph_symbol(t->s.g, name, "1");
  sampler_update(&t->s);
  for (size_t k = 0; k < SAMPLER_POINTS; k++) mpfr_set_d(sampler_at(&t->s, e, k)->v, value[k], MPFR_RNDN);
  return e;
}

static ambit_expr drawn(twins *t, uint64_t *state, const char *name, double lo, double hi) {
  double value[SAMPLER_POINTS];
  for (size_t k = 0; k < SAMPLER_POINTS; k++) value[k] = oracle_uniform(state, lo, hi);
  return variable(t, name, value);
}

static void add_pair(twins *t, ambit_expr first, ambit_expr second) {
  t->first[t->count] = first;
  t->second[t->count++] = second;
}

static void open_twins(twins *t, uint64_t *state, double size) {
  t->count = 0;
  sampler_open(&t->s);
  t->x = drawn(t, state, "x", 0.2, 2), t->y = drawn(t, state, "y", -2, 2), t->p = drawn(t, state, "p", 0.5, 1);
  t->dx = drawn(t, state, "dx", -size, size), t->dy = drawn(t, state, "dy", -size, size);
  ambit_expr leaf[] = { t->x, t->y, t->p, ambit_graph_number(t->s.g, 2), ambit_graph_decimal(t->s.g, "1/3", NULL) };
  for (size_t i = 0; i < 5; i++) add_pair(t, leaf[i], leaf[i]);
}

static void close_twins(twins *t) { sampler_close(&t->s); }

static ambit_expr operation(ambit_graph *g, uint32_t op, ambit_expr a, ambit_expr b, int32_t n) {
  return op == AMBIT_OP_POWN ? ambit_graph_pown(g, a, n) : ambit_graph_op(g, op, a, b);
}

static void grow(twins *t, uint64_t *state, bool spoil) {
  static const uint32_t common[] = { AMBIT_OP_ADD, AMBIT_OP_SUB, AMBIT_OP_MUL, AMBIT_OP_ADD, AMBIT_OP_MUL, AMBIT_OP_DIV,
    AMBIT_OP_SIN, AMBIT_OP_COS };
  uint32_t op =
      oracle_random(state) % 3 ? common[oracle_random(state) % 8] : (uint32_t)(oracle_random(state) % AMBIT_OP_COUNT);
  size_t recent = t->count < 10 ? t->count : 10;
  size_t a = t->count - 1 - oracle_random(state) % recent, b = oracle_random(state) % t->count;
  int32_t n = (int32_t)(oracle_random(state) % 13) - 5;
  ambit_expr first = operation(t->s.g, op, t->first[a], t->first[b], n);
  ambit_expr second = operation(t->s.g, op, t->second[a], t->second[b], n);
  switch (spoil ? oracle_random(state) % 12 : 12) {
  case 0: second = ambit_graph_number(t->s.g, 0.5); break;
  case 1: second = t->second[b]; break;
  case 2: second = operation(t->s.g, op, t->second[b], t->second[a], n); break;
  default: break;
  }
  add_pair(t, first, second);
}

/* w(x - d), by substitution */
static ambit_expr at_difference(twins *t, ambit_expr w) {
  ambit_graph *g = t->s.g;
  ambit_failure f = { 0 };
  ambit_expr from[] = { t->x, t->y };
  ambit_expr to[] = { ambit_graph_op(g, AMBIT_OP_SUB, t->x, t->dx), ambit_graph_op(g, AMBIT_OP_SUB, t->y, t->dy) };
  assert_int_equal(ambit_graph_substitute(g, 1, &w, 2, from, to, &f), AMBIT_OK);
  return w;
}

static ambit_expr difference_of(twins *t, ambit_expr u, ambit_expr w, bool clamps) {
  ambit_expr leaf[] = { t->x, t->y }, delta[] = { t->dx, t->dy }, d;
  ambit_failure f = { 0 };
  assert_int_equal(ambit_graph_difference(t->s.g, 1, &u, &w, 2, leaf, delta, clamps, &d, &f), AMBIT_OK);
  return d;
}

static ambit_expr difference(twins *t, ambit_expr u, ambit_expr w) { return difference_of(t, u, w, false); }

static bool has(const ambit_graph *g, ambit_expr e, uint32_t op) {
  ambit_expr stack[4096];
  size_t depth = 0;
  stack[depth++] = e;
  while (depth) {
    const ambit_node *x = ambit_graph_node(g, stack[--depth]);
    if (x->op == op) return true;
    if (x->op >= AMBIT_OP_COUNT || depth + 2 > 4096) continue;
    stack[depth++] = x->a;
    if (sampler_is_binary(x->op)) stack[depth++] = x->b;
  }
  return false;
}

/* Where u and w~ are defined the result is, and is u - w~ to 1e-30 of |u| + |w~|. */
static size_t check_pair(twins *t, size_t i, bool clamps) {
  ambit_expr u = t->first[i], w = at_difference(t, t->second[i]);
  ambit_expr d = difference_of(t, u, t->second[i], clamps);
  sampler_update(&t->s);
  size_t seen = 0;
  for (size_t k = 0; k < SAMPLER_POINTS; k++) {
    const sample *a = sampler_at(&t->s, u, k), *b = sampler_at(&t->s, w, k), *c = sampler_at(&t->s, d, k);
    if (a->state != DEFINED || b->state != DEFINED || c->state == DOUBTFUL) continue;
    sample truth;
    sample_init(&truth);
    mpfr_sub(truth.v, a->v, b->v, MPFR_RNDN);
    bool root = c->state == UNDEFINED && has(t->s.g, u, AMBIT_OP_SQRT); /* 0/(sqrt 0 + sqrt 0) */
    bool close = c->state == DEFINED && sample_close(&truth, c, 1e-30);
    if (!close && !root) {
      char text[2000], other[2000];
      ambit_graph_text(t->s.g, u, text, sizeof text), ambit_graph_text(t->s.g, t->second[i], other, sizeof other);
      fail_msg("%s: %s against %s", c->state == DEFINED ? "wrong" : "undefined", text, other);
    }
    seen += close;
    mpfr_clear(truth.v);
  }
  return seen;
}

static void random_pairs(void **unused) {
  (void)unused;
  uint64_t state = 77;
  static twins t;
  size_t seen = 0;
  for (int round = 0; round < 60; round++) {
    open_twins(&t, &state, round % 3 == 0 ? 1 : round % 3 == 1 ? 1e-3 : 1e-9);
    while (t.count < 90) grow(&t, &state, round % 4 != 0);
    for (size_t i = 5; i < t.count; i++) seen += check_pair(&t, i, i % 2 == 0);
    close_twins(&t);
  }
  assert_true(seen > 5000);
}

/* -- nothing cancels */

static ambit_interval enclose(twins *t, ambit_expr d, const ambit_interval *at) {
  ambit_expr input[] = { t->x, t->y, t->p, t->dx, t->dy };
  const ambit_tape *tape;
  ambit_failure f = { 0 };
  ambit_arena *arena = ambit_arena_open();
  assert_int_equal(ambit_tape_seal(t->s.g, arena, 1, &d, 5, input, 0, 0, &tape, &f), AMBIT_OK);
  ambit_interval *slot = ambit_arena_alloc(arena, tape->nslot * sizeof *slot);
  uint32_t flags = ambit_hull(tape, at, slot);
  ambit_interval r = flags & AMBIT_F_PARTIAL ? AMBIT_EMPTY : slot[tape->out[0]];
  ambit_arena_close(arena);
  return r;
}

/* Width of the enclosure at a point, relative to the greatest that the value can be. */
static double relative_width(twins *t, ambit_expr d, double x, double y, double dx, double dy) {
  ambit_interval at[] = { { x, x }, { y, y }, { 0.75, 0.75 }, { dx, dx }, { dy, dy } };
  ambit_interval r = enclose(t, d, at);
  return ambit_interval_is_empty(r) || ambit_interval_mag(r) == 0 ? 0 : (r.hi - r.lo) / ambit_interval_mag(r);
}

/* The greatest |d| for x, y in [-1, 1] and dx, dy in [-0.01, 0.01]. */
static double magnitude(twins *t, ambit_expr d) {
  ambit_interval wide = { -1, 1 }, narrow = { -0.01, 0.01 }, one = { 1, 1 };
  return ambit_interval_mag(enclose(t, d, (ambit_interval[]) { wide, wide, one, narrow, narrow }));
}

#define OP(name, a, b) ambit_graph_op(g, AMBIT_OP_##name, a, b)
#define NUMBER(c) ambit_graph_number(g, c)

/* In doubles, with d of 1e-13: a difference taken as it stands would keep no digit but three. */
static void tiny_differences_keep_their_digits(void **unused) {
  (void)unused;
  uint64_t state = 5;
  static twins t;
  open_twins(&t, &state, 1);
  ambit_graph *g = t.s.g;
  ambit_expr x = t.x, y = t.y, sum = OP(ADD, x, OP(MUL, NUMBER(3), y));
  ambit_expr one = OP(ADD, NUMBER(1), OP(SQR, x, x));
  ambit_expr u[] = { OP(SIN, sum, 0), OP(COS, sum, 0), OP(TAN, x, 0), OP(EXP, sum, 0), OP(SQRT, one, 0),
    OP(ATAN, sum, 0), OP(SINH, x, 0), OP(COSH, OP(MUL, x, y), 0), OP(TANH, sum, 0), OP(DIV, sum, one), OP(MUL, x, y),
    OP(SQR, sum, 0), ambit_graph_pown(g, x, 7), ambit_graph_pown(g, x, -5), ambit_graph_pown(g, one, 12),
    OP(MUL, OP(SIN, x, 0), OP(EXP, y, 0)), OP(MUL, OP(MUL, x, y), t.p) };
  for (size_t i = 0; i < sizeof u / sizeof *u; i++) {
    ambit_expr d = difference(&t, u[i], u[i]);
    double width = relative_width(&t, d, 0.7, 0.3, 1e-13, 2e-13);
    if (!(width < 1e-12)) {
      char text[500];
      ambit_graph_text(g, u[i], text, sizeof text);
      fail_msg("%s: relative width %g", text, width);
    }
    ambit_expr plain = OP(SUB, u[i], at_difference(&t, u[i]));
    assert_true(relative_width(&t, plain, 0.7, 0.3, 1e-13, 2e-13) > 1e-6); /* so the check can fail */
  }
  close_twins(&t);
}

/* -- by hand */

static void what_is_common_vanishes(void **unused) {
  (void)unused;
  uint64_t state = 6;
  static twins t;
  open_twins(&t, &state, 1);
  ambit_graph *g = t.s.g;
  ambit_expr x = t.x, y = t.y, p = t.p, dx = t.dx, dy = t.dy;
  ambit_expr cut = OP(SIN, y, 0), rest = OP(ADD, OP(MUL, p, x), OP(COS, p, 0)), u = OP(ADD, rest, cut);
  assert_int_equal(difference(&t, rest, rest), OP(MUL, p, dx)); /* what is linear stays linear */
  assert_int_equal(difference(&t, u, rest), OP(ADD, OP(MUL, p, dx), cut));
  assert_int_equal(difference(&t, rest, u), OP(SUB, OP(MUL, p, dx), OP(SIN, OP(SUB, y, dy), 0)));
  assert_int_equal(difference(&t, u, NUMBER(0)), u);
  assert_int_equal(difference(&t, OP(MUL, NUMBER(3), y), OP(MUL, NUMBER(2), y)),
      OP(ADD, y, OP(MUL, NUMBER(2), dy))); /* coefficients */
  assert_int_equal(difference(&t, p, p), 0);
  assert_int_equal(difference(&t, x, x), dx);
  assert_int_equal(difference(&t, x, y), OP(SUB, x, OP(SUB, y, dy)));
  ambit_expr none[1], same;
  ambit_failure f = { 0 };
  assert_int_equal(ambit_graph_difference(g, 1, &u, &u, 0, none, none, false, &same, &f), AMBIT_OK);
  assert_int_equal(same, 0); /* no leaf moves: equal models do not differ */
  /* a term inside a function inside a product: only its effect is left */
  ambit_expr inner = OP(MUL, p, OP(SIN, OP(ADD, x, cut), 0)), less = OP(MUL, p, OP(SIN, x, 0));
  ambit_expr d = difference(&t, inner, less);
  ambit_expr zero[] = { NUMBER(0), NUMBER(0), NUMBER(0) }, from[] = { dx, dy, y };
  assert_int_equal(ambit_graph_substitute(g, 1, &d, 3, from, zero, &f), AMBIT_OK);
  assert_int_equal(d, 0);
  close_twins(&t);
}

static void misuse_is_refused(void **unused) {
  (void)unused;
  uint64_t state = 6;
  static twins t;
  open_twins(&t, &state, 1);
  ambit_expr far = 1u << 30, leaf = ambit_graph_op(t.s.g, AMBIT_OP_SIN, t.x, 0), d;
  ambit_failure f = { 0 };
  assert_int_equal(ambit_graph_difference(t.s.g, 1, &far, &t.x, 0, NULL, NULL, false, &d, &f), AMBIT_INVALID);
  assert_int_equal(ambit_graph_difference(t.s.g, 1, &t.x, &far, 0, NULL, NULL, false, &d, &f), AMBIT_INVALID);
  assert_int_equal(ambit_graph_difference(t.s.g, 1, &t.x, &t.x, 1, &t.x, &far, false, &d, &f), AMBIT_INVALID);
  ambit_failure_clear(&f);
  assert_int_equal(ambit_graph_difference(t.s.g, 1, &t.x, &t.x, 1, &leaf, &t.dx, false, &d, &f), AMBIT_INVALID);
  ambit_failure_clear(&f);
  close_twins(&t);
}

/* 60 000 operations above each other: no recursion may follow them; shared sums of 2^100 terms. */
static void deep_and_shared_expressions(void **unused) {
  (void)unused;
  uint64_t state = 6;
  static twins t;
  open_twins(&t, &state, 1);
  ambit_graph *g = t.s.g;
  ambit_expr u = t.x, w = t.x;
  for (int i = 0; i < 30000; i++) {
    u = OP(SIN, OP(ADD, u, t.p), 0);
    w = OP(SIN, OP(ADD, w, i == 15000 ? t.y : t.p), 0);
  }
  ambit_expr leaf[] = { t.x }, delta[] = { t.dx }, d;
  ambit_failure f = { 0 };
  assert_int_equal(ambit_graph_difference(g, 1, &u, &w, 1, leaf, delta, false, &d, &f), AMBIT_OK);
  u = OP(MUL, t.x, t.y), w = OP(SIN, t.x, 0);
  for (int i = 0; i < 100; i++) {
    u = OP(ADD, OP(SQR, u, 0), OP(SUB, u, t.p));
    w = OP(ADD, OP(SQR, w, 0), OP(SUB, w, t.p));
    if (i % 2) u = OP(ADD, u, OP(MUL, u, t.p)), w = OP(ADD, w, OP(MUL, w, t.p));
  }
  assert_int_equal(ambit_graph_difference(g, 1, &u, &w, 1, leaf, delta, false, &d, &f), AMBIT_OK);
  ambit_graph_close(g);
  for (size_t i = 0; i < t.s.count * SAMPLER_POINTS; i++) mpfr_clear(t.s.node[i].v);
  free(t.s.node);
}

/* Over a box, not at a point. */
static void kinks_are_clamped_on_demand(void **unused) {
  (void)unused;
  uint64_t state = 8;
  twins t;
  open_twins(&t, &state, 1);
  ambit_graph *g = t.s.g;
  ambit_expr x = t.x, y = t.y;
  ambit_expr u[] = { OP(ABS, x, x), OP(MIN, x, y), OP(MAX, OP(ABS, y, y), OP(MUL, t.p, x)) };
  for (size_t i = 0; i < 3; i++) {
    assert_true(magnitude(&t, difference_of(&t, u[i], u[i], true)) <= 0.01);
    assert_true(magnitude(&t, difference(&t, u[i], u[i])) > 0.9); /* so the check can fail */
  }
  close_twins(&t);
}

/* -(450 terms) against the same but one: too many to be matched one by one. */
static void negated_long_sums(void **unused) {
  (void)unused;
  uint64_t state = 7;
  twins t;
  open_twins(&t, &state, 1);
  ambit_graph *g = t.s.g;
  ambit_expr u = OP(SQR, t.x, 0), w = OP(SIN, t.x, 0);
  for (int i = 0; i < 450; i++) {
    char name[16];
    snprintf(name, sizeof name, "v%d", i);
    ambit_expr v = OP(COS, ambit_graph_symbol(g, name, "1"), 0);
    u = OP(ADD, v, u), w = OP(ADD, v, w);
  }
  ambit_expr expected = difference(&t, OP(SQR, t.x, 0), OP(SIN, t.x, 0));
  assert_int_equal(difference(&t, u, w), expected);
  assert_int_equal(difference(&t, OP(NEG, u, 0), OP(NEG, w, 0)), OP(NEG, expected, 0));
  close_twins(&t);
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(random_pairs),
    cmocka_unit_test(tiny_differences_keep_their_digits), cmocka_unit_test(what_is_common_vanishes),
    cmocka_unit_test(misuse_is_refused), cmocka_unit_test(deep_and_shared_expressions),
    cmocka_unit_test(negated_long_sums), cmocka_unit_test(kinks_are_clamped_on_demand) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
