/* test_calculus.c -- what else functions say of themselves: Taylor coefficients, derivatives, inverses, how they are
** written in other operations. Judged by divided differences of MPFR's function with thousands of bits. */
#include "described.h"
#include "graph/contract.h"
#include <ambit/graph.h>
#include "graph/hull.h"
#include "graph/tape.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define BITS 4000
#define STEP (-300) /* 2^STEP between the nodes */
#define ORDER 6

/* r := the divided difference of order k at x, x + h, ...: f^(k) / k! somewhere in [x, x + k h]. by: which operand */
static void difference(mpfr_ptr r, uint32_t op, double x, double y, int by, uint32_t k) {
  mpfr_t node[ORDER + 1], a, b, h;
  mpfr_inits2(BITS, a, b, h, (mpfr_ptr)NULL);
  mpfr_set_ui_2exp(h, 1, STEP, MPFR_RNDN);
  for (uint32_t i = 0; i <= k; i++) {
    mpfr_init2(node[i], BITS);
    mpfr_set_d(a, x, MPFR_RNDN), mpfr_set_d(b, y, MPFR_RNDN);
    mpfr_ptr moved = by ? b : a;
    for (uint32_t j = 0; j < i; j++) mpfr_add(moved, moved, h, MPFR_RNDN);
    judge_value(node[i], op, a, b, MPFR_RNDN);
  }
  for (uint32_t j = 1; j <= k; j++)
    for (uint32_t i = 0; i + j <= k; i++) {
      mpfr_sub(node[i], node[i + 1], node[i], MPFR_RNDN);
      mpfr_div(node[i], node[i], h, MPFR_RNDN), mpfr_div_ui(node[i], node[i], j, MPFR_RNDN);
    }
  mpfr_set(r, node[0], MPFR_RNDN);
  for (uint32_t i = 0; i <= k; i++) mpfr_clear(node[i]);
  mpfr_clears(a, b, h, (mpfr_ptr)NULL);
}

/* moderate, inside the domain and off the places where f is not smooth */
static double argument(uint32_t op, uint64_t *state) {
  for (;;) {
    double x = oracle_random(state) % 3 ? oracle_uniform(state, -3, 3) : oracle_uniform(state, -1, 1) * 0x1p-10;
    if (oracle_random(state) % 5 == 0) x *= 100;
    const ambit_described *f = ambit_function_of(op);
    bool inner = x > f->facts.least + 1e-6 && x < f->facts.most - 1e-6;
    if (inner && (!f->is_smooth || f->is_smooth((ambit_interval) { x, x }))) return x;
  }
}

/* is the number in x, but for 2^-60 of it (the error of the difference, far less)? */
static bool holds(ambit_interval x, mpfr_srcptr number) {
  MPFR_DECL_INIT(slack, 200);
  mpfr_abs(slack, number, MPFR_RNDU), mpfr_mul_2si(slack, slack, -150, MPFR_RNDU);
  mpfr_add(slack, number, slack, MPFR_RNDU);
  if (mpfr_cmp_d(slack, x.lo) < 0) return false;
  mpfr_abs(slack, number, MPFR_RNDU), mpfr_mul_2si(slack, slack, -150, MPFR_RNDU);
  mpfr_sub(slack, number, slack, MPFR_RNDD);
  return mpfr_cmp_d(slack, x.hi) <= 0;
}

static bool is_narrow(ambit_interval x, double relative, double absolute) {
  return x.hi - x.lo <= relative * fmax(fabs(x.lo), fabs(x.hi)) + absolute;
}

static void coefficients_hold_derivatives(void **state) {
  (void)state;
  mpfr_t want;
  mpfr_init2(want, BITS);
  EACH_FUNCTION(op) {
    if (ambit_op_arity(op) != 1) continue;
    uint64_t seed = 31415 + op;
    for (int i = 0; i < 60; i++) {
      double x = argument(op, &seed), wide = ldexp(fabs(x), -4 - (int)(oracle_random(&seed) % 3) * 12);
      ambit_interval point[ORDER + 1], set[ORDER + 1];
      assert_int_equal(ambit_function_taylor(op, ORDER, point, (ambit_interval) { x, x }), 0);
      ambit_interval over = { fmax(x - wide, ambit_function_of(op)->facts.least),
        fmin(x + wide, ambit_function_of(op)->facts.most) };
      ambit_function_taylor(op, ORDER, set, over);
      for (uint32_t k = 0; k <= ORDER; k++) {
        difference(want, op, x, 0, 0, k);
        if (!holds(point[k], want) || !holds(set[k], want))
          fail_msg("%s: coefficient %u at %.17g is %.17g, not in [%.17g, %.17g]", name_of(op), k, x,
              mpfr_get_d(want, MPFR_RNDN), point[k].lo, point[k].hi);
        if (!is_narrow(point[k], 1e-10, 1e-12 * fmax(1, fabs(point[1].hi))) && fabs(x) < 4 && fabs(x) > 0.1)
          fail_msg(
              "%s: coefficient %u at %.17g in [%.17g, %.17g] is wide", name_of(op), k, x, point[k].lo, point[k].hi);
      }
    }
  }
  mpfr_clear(want);
}

typedef struct model {
  ambit_graph *g;
  ambit_arena *arena;
  ambit_expr x, y, e;
} model;

static model open_model(uint32_t op) {
  model m = { ambit_graph_open(), ambit_arena_open(), 0, 0, 0 };
  m.x = ambit_graph_symbol(m.g, "x", NULL), m.y = ambit_graph_symbol(m.g, "y", NULL);
  m.e = ambit_graph_op(m.g, op, m.x, m.y);
  return m;
}
static void close_model(model *m) { ambit_graph_close(m->g), ambit_arena_close(m->arena); }

/* e over a box, by intervals */
static uint32_t over_box(const model *m, ambit_expr e, uint32_t flags, const ambit_interval in[2], ambit_interval *r) {
  const ambit_tape *t;
  ambit_failure f = { 0 };
  ambit_expr leaf[2] = { m->x, m->y };
  ambit_interval slot[200];
  assert_int_equal(ambit_tape_seal(m->g, m->arena, 1, &e, 2, leaf, 2, flags, &t, &f), AMBIT_OK);
  assert_true(t->nslot < 200);
  for (uint32_t i = 0; i < t->ninstr && flags; i++) assert_true(t->op[i] < AMBIT_OP_COUNT);
  uint32_t raised = ambit_hull(t, in, slot);
  *r = slot[t->out[0]];
  return raised;
}

static void derivatives_are_those(void **state) {
  (void)state;
  mpfr_t want;
  mpfr_init2(want, BITS);
  EACH_FUNCTION(op) {
    model m = open_model(op);
    uint64_t seed = 2718 + op;
    for (uint32_t by = 0; by < ambit_op_arity(op); by++) {
      ambit_failure f = { 0 };
      ambit_expr d = ambit_graph_derivative(m.g, m.e, by ? m.y : m.x, &f);
      assert_true(d != AMBIT_NO_EXPR);
      for (int i = 0; i < 50; i++) {
        double x = argument(op, &seed), y = oracle_uniform(&seed, -3, 3);
        ambit_interval in[2] = { { x, x }, { y, y } }, r;
        over_box(&m, d, 0, in, &r);
        difference(want, op, x, y, (int)by, 1);
        if (!holds(r, want) || !is_narrow(r, 1e-9, 1e-10))
          fail_msg("%s: derivative at %.17g, %.17g", name_of(op), x, y);
      }
    }
    close_model(&m);
  }
  mpfr_clear(want);
}

static void written_out_they_are_the_same(void **state) {
  (void)state;
  static const uint32_t ways[] = { AMBIT_TAPE_SERIES, AMBIT_SEAL_WRITE_FUNCTIONS | AMBIT_SEAL_WRITE_PAIRS };
  mpfr_t want;
  mpfr_init2(want, BITS);
  EACH_FUNCTION(op) {
    model m = open_model(op);
    uint64_t seed = 1618 + op;
    for (int i = 0; i < 100; i++) {
      double x = argument(op, &seed), y = oracle_uniform(&seed, -3, 3), wide = i % 2 ? 0 : 1e-3;
      ambit_interval in[2] = { { x - wide, x + wide }, { y - wide, y + wide } }, r;
      uint32_t flags = over_box(&m, m.e, ways[i % 4 / 2], in, &r);
      difference(want, op, x, y, 0, 0);
      if (!holds(r, want)) fail_msg("%s written out misses the value at %.17g, %.17g", name_of(op), x, y);
      if (i % 2 && (flags || !is_narrow(r, 1e-10, 1e-12)))
        fail_msg("%s written out at %.17g, %.17g is [%.17g, %.17g]", name_of(op), x, y, r.lo, r.hi);
    }
    close_model(&m);
  }
  mpfr_clear(want);
}

/* over a set that reaches to the end of the domain, or to infinity, the limit there belongs to the range */
static void limits_are_in_the_range(void **state) {
  (void)state;
  static const double other[] = { 0.5, -0.5, 3, -2.5, 1 };
  EACH_FUNCTION(op) {
    model m = open_model(op);
    const ambit_function_facts *f = &ambit_function_of(op)->facts;
    double inner = fmax(fmin(1.5, f->most / 2), f->least + 0.5);
    for (size_t i = 0; i < sizeof other / sizeof *other; i++)
      for (int upper = 0; upper < 2; upper++) {
        double end = upper ? f->most : f->least, want = judge_rounded(op, end, other[i], MPFR_RNDN);
        ambit_interval in[2] = { { upper ? inner : end, upper ? end : inner }, { other[i], other[i] } }, r;
        over_box(&m, m.e, 0, in, &r);
        bool above = fabs(want) > DBL_MAX ? (want > 0 ? r.hi == want : r.lo == want) : r.lo <= want && r.hi >= want;
        if (!above) fail_msg("%s: %g (%g) is not in [%g, %g]", name_of(op), end, other[i], r.lo, r.hi);
      }
    close_model(&m);
  }
}

static double somewhere(ambit_interval x, uint64_t *state) {
  return fmin(fmax(oracle_uniform(state, x.lo, x.hi), x.lo), x.hi);
}

/* no solution is lost, and of an operand that is otherwise free little is left */
static void inverses_keep_every_solution(void **state) {
  (void)state;
  EACH_FUNCTION(op) {
    uint64_t seed = 5772 + op;
    for (int i = 0; i < 4000; i++) {
      double x = i % 4 ? argument(op, &seed) : hard_argument(op, &seed),
             y = i % 8 ? oracle_uniform(&seed, -3, 3) : hard_number(&seed);
      if (!isfinite(y)) continue;
      double lo = judge_rounded(op, x, y, MPFR_RNDD), hi = judge_rounded(op, x, y, MPFR_RNDU);
      double w = i % 3 ? 0 : oracle_uniform(&seed, 0, 1);
      ambit_interval r = { lo - w, hi + w }, a = { x - somewhere((ambit_interval) { 0, 3 }, &seed), x + w },
                     b = { y - w, y + 1 };
      if (r.lo == INFINITY || r.hi == -INFINITY) continue;
      ambit_interval old_a = a, old_b = b;
      if (!ambit_inverse(op, r, &a, &b) || !ambit_interval_contains(a, x) ||
          (ambit_op_arity(op) == 2 && !ambit_interval_contains(b, y)))
        fail_msg("%s: the inverse loses %a, %a", name_of(op), x, y);
      assert_true(a.lo >= old_a.lo && a.hi <= old_a.hi && b.lo >= old_b.lo && b.hi <= old_b.hi);
      a = AMBIT_ENTIRE, b = (ambit_interval) { y, y };
      if (i % 4 == 0 || fabs(x) < 0.1 || fabs(x) > 2) continue;
      r = (ambit_interval) { lo, hi };
      assert_true(ambit_inverse(op, r, &a, &b));
      bool sure = ambit_op_arity(op) == 1 || (op == AMBIT_OP_POW && fabs(y) > 0.1);
      if (sure && !is_narrow(a, 1e-11, 0)) fail_msg("%s: the inverse of %a is [%a, %a]", name_of(op), lo, a.lo, a.hi);
    }
    ambit_interval a = { -5, 5 }, b = { 1, 2 };
    const ambit_described *f = ambit_function_of(op);
    if (f->image.lo > -INFINITY)
      assert_false(ambit_inverse(op, (ambit_interval) { f->image.lo - 2, f->image.lo - 1 }, &a, &b));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(coefficients_hold_derivatives),
    cmocka_unit_test(derivatives_are_those), cmocka_unit_test(written_out_they_are_the_same),
    cmocka_unit_test(limits_are_in_the_range), cmocka_unit_test(inverses_keep_every_solution) };
  return cmocka_run_group_tests_name("functions: calculus", tests, NULL, NULL);
}
