/* IEEE 1788-2015 set-based results of every opcode of the interval plugin, with flags: domains, zero, empty and
** unbounded sets. The expected bounds are the tightest, worked out by hand; those of irrational numbers are neighbours.
*/
#include "kit/arithmetic_loader.h"
#include "num/interval.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <float.h>

static const char *const variant[] = { "ambit.arithmetic.portable/1", "ambit.arithmetic.avx2/1",
  "ambit.arithmetic.avx512/1" };

#define INF INFINITY
#define PI_DOWN 0x1.921fb54442d18p+1
#define PI_UP 0x1.921fb54442d19p+1
#define HALF_DOWN 0x1.921fb54442d18p+0
#define HALF_UP 0x1.921fb54442d19p+0
#define THIRD_DOWN 0x1.5555555555555p-2
#define THIRD_UP 0x1.5555555555556p-2
#define I(lo, hi)                                                                                                      \
  { lo, hi }
#define NONE                                                                                                           \
  { INF, -INF }
#define ALL                                                                                                            \
  { -INF, INF }
#define UNUSED                                                                                                         \
  { 0, 0 }

enum { P = AMBIT_F_PARTIAL, E = AMBIT_F_EMPTY, U = AMBIT_F_UNBOUNDED };

typedef struct fact {
  uint32_t op;
  int32_t n; /* exponent of POWN */
  ambit_interval a, b, r;
  uint32_t flags;
} fact;

#define UNARY(op, a, r, flags)                                                                                         \
  { AMBIT_OP_##op, 0, a, UNUSED, r, flags }
#define BINARY(op, a, b, r, flags)                                                                                     \
  { AMBIT_OP_##op, 0, a, b, r, flags }
#define POWER(n, a, r, flags)                                                                                          \
  { AMBIT_OP_POWN, n, a, UNUSED, r, flags }

static const fact facts[] = {
  BINARY(ADD, I(-INF, 1), I(1, INF), ALL, U),
  BINARY(ADD, I(1, 2), I(-INF, INF), ALL, U),
  BINARY(ADD, I(DBL_MAX, DBL_MAX), I(DBL_MAX, DBL_MAX), I(DBL_MAX, INF), U),
  BINARY(ADD, I(1, 1), I(0x1p-1074, 0x1p-1074), I(1, 0x1.0000000000001p0), 0),
  BINARY(SUB, I(1, INF), I(1, INF), ALL, U),
  BINARY(SUB, I(-INF, 1), I(1, INF), I(-INF, 0), U),
  BINARY(SUB, I(1, 2), I(1, 2), I(-1, 1), 0),
  UNARY(NEG, I(1, INF), I(-INF, -1), U),
  UNARY(NEG, I(-2, 3), I(-3, 2), 0),
  BINARY(MUL, I(0, 0), ALL, I(0, 0), 0),
  BINARY(MUL, ALL, I(0, 0), I(0, 0), 0),
  BINARY(MUL, I(-INF, -1), I(0, 1), I(-INF, 0), U),
  BINARY(MUL, I(0, INF), I(-INF, 0), I(-INF, 0), U),
  BINARY(MUL, I(-INF, 2), I(-3, INF), ALL, U),
  BINARY(MUL, I(-1, 2), I(-3, 4), I(-6, 8), 0),
  BINARY(MUL, I(0x1p-1074, 0x1p-1074), I(0.5, 0.5), I(0, 0x1p-1074), 0),
  UNARY(SQR, ALL, I(0, INF), U),
  UNARY(SQR, I(-3, 2), I(0, 9), 0),
  UNARY(SQR, I(-3, -2), I(4, 9), 0),
  UNARY(SQR, I(-INF, -2), I(4, INF), U),
  BINARY(DIV, I(1, 2), ALL, ALL, P | U),
  BINARY(DIV, I(0, 0), ALL, I(0, 0), P),
  BINARY(DIV, I(0, 0), I(0, 0), NONE, P | E),
  BINARY(DIV, ALL, I(0, 0), NONE, P | E),
  BINARY(DIV, I(1, 2), I(-INF, -2), I(-1, 0), 0),
  BINARY(DIV, I(1, 2), I(0, INF), I(0, INF), P | U),
  BINARY(DIV, I(-1, 2), I(0, 4), ALL, P | U),
  BINARY(DIV, I(-INF, -1), I(0, 3), I(-INF, -THIRD_DOWN), P | U),
  BINARY(DIV, I(1, 1), I(-3, 0), I(-INF, -THIRD_DOWN), P | U),
  BINARY(DIV, I(1, 1), I(-3, 3), ALL, P | U),
  BINARY(DIV, I(1, 1), I(3, 3), I(THIRD_DOWN, THIRD_UP), 0),
  BINARY(DIV, I(-INF, 1), I(-2, -1), I(-1, INF), U),
  BINARY(DIV, I(1, INF), I(1, INF), I(0, INF), U),
  UNARY(SQRT, ALL, I(0, INF), P | U),
  UNARY(SQRT, I(-1, 0), I(0, 0), P),
  UNARY(SQRT, I(-2, -1), NONE, P | E),
  UNARY(SQRT, I(4, 9), I(2, 3), 0),
  POWER(-1, I(0, 0), NONE, P | E),
  POWER(-1, I(0, 4), I(0.25, INF), P | U),
  POWER(-1, I(-4, 0), I(-INF, -0.25), P | U),
  POWER(-1, I(-1, 2), ALL, P | U),
  POWER(-1, I(2, 4), I(0.25, 0.5), 0),
  POWER(-1, I(1, INF), I(0, 1), 0),
  POWER(-1, I(-INF, -1), I(-1, 0), 0),
  POWER(-1, I(3, 3), I(THIRD_DOWN, THIRD_UP), 0),
  POWER(-1, ALL, ALL, P | U),
  POWER(-2, I(0, 0), NONE, P | E),
  POWER(-2, I(-1, 2), I(0.25, INF), P | U),
  POWER(-2, I(-2, -1), I(0.25, 1), 0),
  POWER(-2, I(0, INF), I(0, INF), P | U),
  POWER(-2, ALL, I(0, INF), P | U),
  POWER(-3, I(-2, 0), I(-INF, -0.125), P | U),
  POWER(-3, I(-2, -1), I(-1, -0.125), 0),
  POWER(INT32_MIN, I(-1, 1), I(1, INF), P | U),
  POWER(INT32_MIN, I(1, 1), I(1, 1), 0),
  POWER(0, I(0, 0), I(1, 1), 0),
  POWER(0, ALL, I(1, 1), 0),
  POWER(1, I(-2, INF), I(-2, INF), U),
  POWER(2, I(-3, 2), I(0, 9), 0),
  POWER(2, ALL, I(0, INF), U),
  POWER(3, I(-2, 3), I(-8, 27), 0),
  POWER(3, I(-INF, 2), I(-INF, 8), U),
  POWER(INT32_MAX, I(-1, 1), I(-1, 1), 0),
  UNARY(EXP, I(-INF, 0), I(0, 1), 0),
  UNARY(EXP, I(0, INF), I(1, INF), U),
  UNARY(LOG, I(0, 0), NONE, P | E),
  UNARY(LOG, I(-2, -1), NONE, P | E),
  UNARY(LOG, I(0, 1), I(-INF, 0), P | U),
  UNARY(LOG, I(-1, 1), I(-INF, 0), P | U),
  UNARY(LOG, I(1, INF), I(0, INF), U),
  UNARY(SIN, ALL, I(-1, 1), 0),
  UNARY(SIN, I(0, 0), I(0, 0), 0),
  UNARY(COS, I(0, INF), I(-1, 1), 0),
  UNARY(COS, I(0, 0), I(1, 1), 0),
  UNARY(TAN, I(0, 0), I(0, 0), 0),
  UNARY(TAN, I(1, 2), ALL, P | U),
  UNARY(TAN, ALL, ALL, P | U),
  UNARY(ASIN, I(-2, 1), I(-HALF_UP, HALF_UP), P),
  UNARY(ASIN, I(1, 1), I(HALF_DOWN, HALF_UP), 0),
  UNARY(ASIN, I(2, 3), NONE, P | E),
  UNARY(ACOS, I(1, 2), I(0, 0), P),
  UNARY(ACOS, I(-1, -1), I(PI_DOWN, PI_UP), 0),
  UNARY(ACOS, ALL, I(0, PI_UP), P),
  UNARY(ATAN, ALL, I(-HALF_UP, HALF_UP), 0),
  UNARY(ATAN, I(0, 0), I(0, 0), 0),
  BINARY(ATAN2, I(0, 0), I(0, 0), NONE, P | E),
  BINARY(ATAN2, I(0, 0), I(1, 2), I(0, 0), 0),
  BINARY(ATAN2, I(0, 0), I(-2, -1), I(PI_DOWN, PI_UP), 0),
  BINARY(ATAN2, I(0, 0), I(-1, 1), I(0, PI_UP), P),
  BINARY(ATAN2, I(0, 0), ALL, I(0, PI_UP), P),
  BINARY(ATAN2, I(0, 1), I(0, 0), I(HALF_DOWN, HALF_UP), P),
  BINARY(ATAN2, I(-1, 0), I(0, 0), I(-HALF_UP, -HALF_DOWN), P),
  BINARY(ATAN2, I(-1, -1), I(0, 0), I(-HALF_UP, -HALF_DOWN), 0),
  BINARY(ATAN2, I(-1, 1), I(-1, -1), I(-PI_UP, PI_UP), 0),
  BINARY(ATAN2, I(-1, 0), I(-1, -1), I(-PI_UP, PI_UP), 0),
  BINARY(ATAN2, I(0, 1), I(0, 1), I(0, HALF_UP), P),
  BINARY(ATAN2, I(0, INF), I(0, INF), I(0, HALF_UP), P),
  BINARY(ATAN2, I(1, INF), ALL, I(0, PI_UP), 0),
  BINARY(ATAN2, ALL, I(1, INF), I(-HALF_UP, HALF_UP), 0),
  BINARY(ATAN2, ALL, ALL, I(-PI_UP, PI_UP), P),
  UNARY(SINH, ALL, ALL, U),
  UNARY(SINH, I(0, 0), I(0, 0), 0),
  UNARY(COSH, ALL, I(1, INF), U),
  UNARY(COSH, I(0, 0), I(1, 1), 0),
  UNARY(TANH, ALL, I(-1, 1), 0),
  UNARY(ABS, ALL, I(0, INF), U),
  UNARY(ABS, I(-3, 2), I(0, 3), 0),
  UNARY(ABS, I(-3, -2), I(2, 3), 0),
  BINARY(MIN, I(1, INF), I(2, 3), I(1, 3), 0),
  BINARY(MIN, ALL, I(0, 1), I(-INF, 1), U),
  BINARY(MAX, ALL, I(0, 1), I(0, INF), U),
  BINARY(MAX, I(-INF, 0), I(1, 2), I(1, 2), 0),
};

static uint32_t apply(
    const arithmetic_loader *l, uint32_t op, int32_t n, ambit_interval a, ambit_interval b, ambit_interval *r) {
  double block[6];
  const double lo[2] = { a.lo, b.lo }, hi[2] = { a.hi, b.hi };
  const uint32_t dst = 2, x = 0, y = op == AMBIT_OP_POWN ? (uint32_t)n : 1;
  l->full.set(l->ctx, block, 2, lo, hi, -1);
  l->full.enter(l->ctx);
  uint32_t flags = l->full.run[op](&l->full, l->ctx, block, 1, 1, 1, &dst, &x, &y);
  l->full.leave(l->ctx);
  l->full.bounds(l->ctx, block + 4, 1, &r->lo, &r->hi);
  return flags;
}

static void check(const arithmetic_loader *l, const fact *f) {
  ambit_interval r, k;
  uint32_t flags = apply(l, f->op, f->n, f->a, f->b, &r);
  if (r.lo != f->r.lo || r.hi != f->r.hi || flags != f->flags)
    fail_msg("op %u of [%g, %g], [%g, %g], n = %d: [%a, %a] flags %u instead of [%a, %a] flags %u", f->op, f->a.lo,
        f->a.hi, f->b.lo, f->b.hi, f->n, r.lo, r.hi, flags, f->r.lo, f->r.hi, f->flags);
  flags = ambit_interval_map(f->op, 1, &k, &f->a, &f->b, f->n);
  assert_true(k.lo == r.lo && k.hi == r.hi && flags == f->flags);
}

static void check_empty(const arithmetic_loader *l) {
  static const ambit_interval none = NONE, any[] = { ALL, { 1, 2 }, { 0, 0 }, { -INF, 0 }, NONE };
  for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++)
    for (size_t i = 0; i < sizeof any / sizeof *any; i++) {
      ambit_interval r;
      assert_int_equal(apply(l, op, -2 + (int32_t)i, none, any[i], &r), AMBIT_F_EMPTY);
      assert_true(r.lo == INF && r.hi == -INF);
      int binary = op == AMBIT_OP_ADD || op == AMBIT_OP_SUB || op == AMBIT_OP_MUL || op == AMBIT_OP_DIV ||
                   op == AMBIT_OP_ATAN2 || op == AMBIT_OP_MIN || op == AMBIT_OP_MAX;
      if (!binary) continue;
      assert_int_equal(apply(l, op, 0, any[i], none, &r), AMBIT_F_EMPTY);
      assert_true(r.lo == INF && r.hi == -INF);
    }
}

static void every_opcode(void **unused) {
  (void)unused;
  for (int v = 0; v < 3; v++) {
    arithmetic_loader l;
    int here = arithmetic_load_as(&l, "interval", variant[v]) == NULL;
    assert_true(here || v > 0);
    for (size_t i = 0; here && i < sizeof facts / sizeof *facts; i++) check(&l, &facts[i]);
    if (here) check_empty(&l);
    arithmetic_unload(&l);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(every_opcode) };
  return cmocka_run_group_tests_name("interval sets", tests, NULL, NULL);
}
