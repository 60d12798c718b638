/* Inverse operations and HC4-revise keep every solution (random operands, points in them, nasty bounds) and narrow
** where they can. */
#include "graph/contract.h"
#include <ambit/graph.h>
#include "graph/tape.h"
#include "host/services.h"
#include "num/interval.h"
#include <float.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define ROUNDS 20000

static uint64_t state = 0x9e3779b97f4a7c15u;

static double uniform(void) { /* xorshift64* */
  state ^= state >> 12, state ^= state << 25, state ^= state >> 27;
  return (double)((state * 0x2545f4914f6cdd1du) >> 11) * 0x1p-53;
}

/* ordinary, small, large, integer and special numbers of both signs */
static double number(void) {
  static const double special[] = { 0, 1, -1, 0.5, 2, 1e-300, -1e-300, 1e10, -1e10, 3.141592653589793,
    -1.5707963267948966, DBL_MAX, -DBL_MAX, 1e-5 };
  double x = 2 * uniform() - 1;
  switch ((int)(6 * uniform())) {
  case 0: return special[(size_t)(uniform() * (sizeof special / sizeof *special))];
  case 1: return 100 * x;
  case 2: return 1e-3 * x;
  case 3: return floor(10 * x);
  default: return 4 * x;
  }
}

/* an interval around x: a point, thin, wide, or unbounded */
static ambit_interval around(double x) {
  double l = 0, r = 0;
  switch ((int)(5 * uniform())) {
  case 0: break;
  case 1: l = 1e-9 * fabs(x), r = 1e-9; break;
  case 2: l = uniform(), r = 10 * uniform(); break;
  case 3:
    l = INFINITY;
    r = uniform();
    break;
  default: l = 3 * uniform() * (1 + fabs(x)), r = 3 * uniform(); break;
  }
  return (ambit_interval) { x - l, x + r };
}

static bool is_binary(uint32_t op) {
  return op == AMBIT_OP_ADD || op == AMBIT_OP_SUB || op == AMBIT_OP_MUL || op == AMBIT_OP_DIV || op == AMBIT_OP_ATAN2 ||
         op == AMBIT_OP_MIN || op == AMBIT_OP_MAX;
}

static void inverses_keep_every_solution(void **unused) {
  (void)unused;
  for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++)
    for (int i = 0; i < ROUNDS; i++) {
      double x = number(), y = number();
      ambit_interval r, a = around(x), b = around(y), px = { x, x }, py = { y, y };
      int32_t n = (int32_t)(12 * uniform()) - 5;
      uint32_t flags = op == AMBIT_OP_POWN ? ambit_interval_pown(&r, px, n) : ambit_interval_op(op, &r, px, py);
      if (flags & (AMBIT_F_PARTIAL | AMBIT_F_EMPTY)) continue;
      if (uniform() < 0.5) r = ambit_interval_hull(r, around(r.lo > -INFINITY ? r.lo : 0));
      ambit_interval wide_a = a, wide_b = b;
      bool some = op == AMBIT_OP_POWN ? ambit_inverse_pown(n, r, &a) : ambit_inverse(op, r, &a, &b);
      bool kept = some && ambit_interval_contains(a, x) && (!is_binary(op) || ambit_interval_contains(b, y));
      if (!kept)
        fail_msg("op %u (n = %d): %a, %a lost: r [%a, %a], a [%a, %a] -> [%a, %a], b [%a, %a] -> [%a, %a]", op, n, x, y,
            r.lo, r.hi, wide_a.lo, wide_a.hi, a.lo, a.hi, wide_b.lo, wide_b.hi, b.lo, b.hi);
      assert_true(a.lo >= wide_a.lo && a.hi <= wide_a.hi);
    }
}

/* -- they narrow: what is left is near the true preimage */

static void expect(uint32_t op, ambit_interval r, ambit_interval a, ambit_interval b, double lo, double hi) {
  if (!ambit_inverse(op, r, &a, &b)) fail_msg("op %u: nothing is left", op);
  double slack = 1e-12 * (1 + fabs(lo) + fabs(hi));
  if (!(fabs(a.lo - lo) <= slack && fabs(a.hi - hi) <= slack))
    fail_msg("op %u: [%.17g, %.17g] instead of [%g, %g]", op, a.lo, a.hi, lo, hi);
}

static void inverses_narrow(void **unused) {
  (void)unused;
  const ambit_interval all = AMBIT_ENTIRE, wide = { -100, 100 };
  const double pi = 3.141592653589793;
  expect(AMBIT_OP_ADD, (ambit_interval) { 1, 2 }, all, (ambit_interval) { 3, 4 }, -3, -1);
  expect(AMBIT_OP_MUL, (ambit_interval) { 1, 2 }, wide, (ambit_interval) { 4, 8 }, 0.125, 0.5);
  expect(AMBIT_OP_MUL, (ambit_interval) { 1, 2 }, (ambit_interval) { 0, 100 }, (ambit_interval) { -4, 2 }, 0.5, 100);
  expect(AMBIT_OP_SQR, (ambit_interval) { 4, 9 }, (ambit_interval) { -1, 10 }, all, 2, 3);
  expect(AMBIT_OP_SQR, (ambit_interval) { 4, 9 }, wide, all, -3, 3);
  expect(AMBIT_OP_SIN, (ambit_interval) { 1, 2 }, (ambit_interval) { 0, 6 }, all, pi / 2, pi / 2);
  expect(AMBIT_OP_SIN, (ambit_interval) { -1, 0 }, (ambit_interval) { 0.5, 6 }, all, pi, 6);
  expect(AMBIT_OP_COS, (ambit_interval) { 0, 1 }, (ambit_interval) { 2, 6 }, all, 1.5 * pi, 6);
  expect(AMBIT_OP_COS, (ambit_interval) { 0, 0 }, (ambit_interval) { -20, 21 }, all, -6.5 * pi + pi, 6.5 * pi);
  expect(AMBIT_OP_TAN, (ambit_interval) { 1, 1 }, (ambit_interval) { -1, 2 }, all, pi / 4, pi / 4);
  expect(AMBIT_OP_EXP, (ambit_interval) { 1, 2 }, all, all, 0, log(2));
  expect(AMBIT_OP_SINH, (ambit_interval) { -1, 1 }, all, all, -asinh(1), asinh(1));
  expect(AMBIT_OP_COSH, (ambit_interval) { 2, 3 }, (ambit_interval) { -1, 9 }, all, acosh(2), acosh(3));
  expect(AMBIT_OP_TANH, (ambit_interval) { -0.5, 0.5 }, all, all, -atanh(0.5), atanh(0.5));
  expect(AMBIT_OP_ABS, (ambit_interval) { 2, 3 }, (ambit_interval) { -1, 9 }, all, 2, 3);
  expect(AMBIT_OP_MIN, (ambit_interval) { 2, 3 }, wide, (ambit_interval) { 5, 6 }, 2, 3);
  expect(AMBIT_OP_MAX, (ambit_interval) { 2, 3 }, wide, (ambit_interval) { 0, 1 }, 2, 3);
  expect(AMBIT_OP_ATAN2, (ambit_interval) { 0, pi / 4 }, wide, (ambit_interval) { -5, 7 }, 0, 7);
  ambit_interval a = wide, b = wide;
  assert_true(ambit_inverse_pown(3, (ambit_interval) { -8, 27 }, &a));
  assert_true(fabs(a.lo + 2) < 1e-12 && fabs(a.hi - 3) < 1e-12);
  a = wide;
  assert_true(ambit_inverse_pown(-2, (ambit_interval) { 0.25, 1 }, &a));
  assert_true(fabs(a.lo + 2) < 1e-12 && fabs(a.hi - 2) < 1e-12);
  a = (ambit_interval) { 1, 2 };
  assert_false(ambit_inverse(AMBIT_OP_SIN, (ambit_interval) { -1, -0.5 }, &a, &b));
  assert_false(ambit_inverse(AMBIT_OP_EXP, (ambit_interval) { -2, -1 }, &a, &b));
  assert_false(ambit_inverse(AMBIT_OP_ABS, (ambit_interval) { -2, -1 }, &a, &b));
}

/* -- whole tapes */

typedef struct fixture {
  ambit_graph *graph;
  ambit_arena *arena;
  ambit_scope *scope;
  ambit_contractor *contractor;
  const ambit_tape *tape;
} fixture;

static void seal(fixture *s, uint32_t nout, const ambit_expr *out, uint32_t nin, const ambit_expr *in) {
  ambit_failure f = { 0 };
  if (ambit_tape_seal(s->graph, s->arena, nout, out, nin, in, 0, 0, &s->tape, &f) != AMBIT_OK)
    fail_msg("%s", f.message);
  assert_int_equal(ambit_scope_open(&s->scope, NULL, NULL), AMBIT_OK);
  const ambit_contract_service *service = s->scope->host.service(&s->scope->host, AMBIT_CONTRACT_SERVICE);
  assert_ptr_equal(service, &ambit_contract_service_v1);
  assert_int_equal(service->open(&s->scope->host, s->tape, &s->contractor), AMBIT_OK);
}

/* x^2 + y^2 - 1 and atan2(y, x) - z */
static fixture make_fixture(void) {
  fixture s = { .graph = ambit_graph_open(), .arena = ambit_arena_open() };
  ambit_graph *g = s.graph;
  ambit_expr x = ambit_graph_symbol(g, "x", "1"), y = ambit_graph_symbol(g, "y", "1"),
             z = ambit_graph_symbol(g, "z", "1"), in[] = { x, y, z };
  ambit_expr sum =
      ambit_graph_op(g, AMBIT_OP_ADD, ambit_graph_op(g, AMBIT_OP_SQR, x, x), ambit_graph_op(g, AMBIT_OP_SQR, y, y));
  ambit_expr out[] = { ambit_graph_op(g, AMBIT_OP_SUB, sum, ambit_graph_number(g, 1)),
    ambit_graph_op(g, AMBIT_OP_SUB, ambit_graph_op(g, AMBIT_OP_ATAN2, y, x), z) };
  seal(&s, 2, out, 3, in);
  return s;
}

static void free_fixture(fixture *s) {
  ambit_scope_close(s->scope);
  ambit_arena_close(s->arena);
  ambit_graph_close(s->graph);
}

static void tapes_keep_every_solution(void **unused) {
  (void)unused;
  fixture s = make_fixture();
  for (int i = 0; i < ROUNDS; i++) {
    double t = 6.4 * uniform() - 3.2, lo[3], hi[3], slack = 1e-14, out_lo[2] = { -slack, -slack },
           out_hi[2] = { slack, slack };
    double at[3] = { cos(t), sin(t), atan2(sin(t), cos(t)) };
    for (int k = 0; k < 3; k++) {
      ambit_interval x = around(at[k]);
      lo[k] = x.lo, hi[k] = x.hi;
    }
    assert_int_equal(ambit_contract_service_v1.narrow(s.contractor, lo, hi, out_lo, out_hi), AMBIT_OK);
    for (int k = 0; k < 3; k++)
      if (!(lo[k] <= at[k] && at[k] <= hi[k])) fail_msg("%a lost: [%a, %a]", at[k], lo[k], hi[k]);
  }
  free_fixture(&s);
}

static void tapes_narrow_and_refuse(void **unused) {
  (void)unused;
  fixture s = make_fixture();
  double lo[3] = { 0.6, -9, -9 }, hi[3] = { 0.6, 9, 9 };
  assert_int_equal(ambit_contract_service_v1.narrow(s.contractor, lo, hi, NULL, NULL), AMBIT_OK);
  assert_true(lo[1] > -0.8001 && hi[1] < 0.8001 && lo[2] >= -1.5708 && hi[2] <= 1.5708);
  double none_lo[3] = { 2, -9, -9 }, none_hi[3] = { 3, 9, 9 };
  assert_int_equal(ambit_contract_service_v1.narrow(s.contractor, none_lo, none_hi, NULL, NULL), AMBIT_DOMAIN);
  assert_true(none_lo[0] == 2 && none_hi[2] == 9);
  free_fixture(&s);
}

static void inspection_sees_jumps_and_domains(void **unused) {
  (void)unused;
  fixture s = make_fixture();
  static const struct {
    double lo[3], hi[3];
    uint32_t flags;
  } c[] = {
    { { 1, 1, 0 }, { 2, 2, 1 }, 0 },
    { { -2, -1, 0 }, { -1, 1, 1 }, AMBIT_F_KINK },
    { { -2, 0, 0 }, { -1, 1, 1 }, 0 },             /* the upper side of the cut belongs to the angle pi */
    { { -2, -1, 0 }, { -1, 0, 1 }, AMBIT_F_KINK }, /* the lower one does not */
    { { -1, -1, 0 }, { 1, 1, 1 }, AMBIT_F_KINK | AMBIT_F_PARTIAL },
  };
  for (size_t i = 0; i < sizeof c / sizeof *c; i++)
    if (ambit_contract_service_v1.inspect(s.contractor, c[i].lo, c[i].hi) != c[i].flags) fail_msg("case %zu", i);
  free_fixture(&s);
}

/* e^u, u = x or log(x)/3: no zero but the limit 0, which is kept where finite x lead to it */
static void powers_keep_their_limit(void **unused) {
  (void)unused;
  for (int power = 0; power < 2; power++) {
    fixture s = { .graph = ambit_graph_open(), .arena = ambit_arena_open() };
    ambit_graph *g = s.graph;
    ambit_expr x = ambit_graph_symbol(g, "x", "1"), u = ambit_graph_op(g, AMBIT_OP_LOG, x, x);
    u = ambit_graph_op(g, AMBIT_OP_DIV, u, ambit_graph_number(g, 3));
    ambit_expr out = ambit_graph_op(g, AMBIT_OP_EXP, power ? u : x, x);
    seal(&s, 1, &out, 1, &x);
    double lo = power ? -1 : -2000, hi = 2, low = power ? 1e-9 : -INFINITY, high = 3;
    ambit_status status = ambit_contract_service_v1.narrow(s.contractor, &lo, &hi, NULL, NULL);
    assert_int_equal(status, power ? AMBIT_OK : AMBIT_DOMAIN);
    if (power) assert_true(lo >= 0 && lo <= DBL_TRUE_MIN && hi <= DBL_TRUE_MIN);
    assert_int_equal(ambit_contract_service_v1.narrow(s.contractor, &low, &high, NULL, NULL), AMBIT_DOMAIN);
    free_fixture(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(inverses_keep_every_solution), cmocka_unit_test(inverses_narrow),
    cmocka_unit_test(tapes_keep_every_solution), cmocka_unit_test(tapes_narrow_and_refuse),
    cmocka_unit_test(inspection_sees_jumps_and_domains), cmocka_unit_test(powers_keep_their_limit) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
