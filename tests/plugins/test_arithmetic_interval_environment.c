/* The interval plugin and the number service for a caller who has changed the floating-point environment: another
** rounding mode, flush-to-zero, denormals-are-zero. Every result must have the bits that it has in the default one, and
** the caller must find its environment as it was. */
#include "kit/arithmetic_loader.h"
#include "kit/tape_builder.h"
#include <ambit/interval.h>
#include "num/service.h"
#include "oracle.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif
#include <fenv.h>

#define N 24

/* the environments of a caller; 0 is the default */
#if defined(__x86_64__)
static const unsigned environment[] = { 0x1f80, 0x3f80, 0x5f80, 0x7f80, 0x9fc0, 0xdfc0, 0x1fc0 };
static void enter_environment(size_t i) { _mm_setcsr(environment[i]); }
static int is_environment(size_t i) { return (_mm_getcsr() & ~0x3fu) == (environment[i] & ~0x3fu); }
#else
static const int environment[] = { FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO };
static void enter_environment(size_t i) { fesetround(environment[i]); }
static int is_environment(size_t i) { return fegetround() == environment[i]; }
#endif
#define ENVIRONMENTS (sizeof environment / sizeof *environment)

static const char *const variant[] = { "ambit.arithmetic.portable/1", "ambit.arithmetic.avx2/1",
  "ambit.arithmetic.avx512/1" };

/* what differs if subnormal numbers count as zero, or a bound is rounded another way */
static void fill(double *lo, double *hi, uint64_t *state) {
  static const double tiny[] = { 0x1p-1074, -0x1p-1074, 0x1p-1030, -0x1p-1023, 0, -0.0, 0x1p-1022, 1, -1, 0x1.8p-540 };
  for (int i = 0; i < N; i++) {
    double x = tiny[oracle_random(state) % 10], y = oracle_random(state) % 3 ? tiny[oracle_random(state) % 10] : x;
    if (i % 4 == 3) x = oracle_uniform(state, -2, 2), y = oracle_uniform(state, -2, 2);
    lo[i] = x, hi[i] = y; /* reversed ones are the empty set */
  }
}

typedef struct outcome {
  double lo[AMBIT_OP_COUNT][N], hi[AMBIT_OP_COUNT][N], dot_lo[N], dot_hi[N];
  uint32_t flags[AMBIT_OP_COUNT + 1];
} outcome;

static void run_plugin(const arithmetic_loader *l, const double *lo, const double *hi, outcome *o) {
  _Alignas(64) double block[3 * N * 2];
  l->full.set(l->ctx, block, N, lo, hi, -1);
  l->full.set(l->ctx, block + 2 * N, N, hi, lo, -1);
  l->full.set(l->ctx, block + 2 * N, N / 2, lo + N / 2, hi + N / 2, -1);
  const uint32_t a = 0, b = 1, dst = 2, cube = (uint32_t)-3;
  for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++) {
    l->full.enter(l->ctx);
    o->flags[op] = l->full.run[op](&l->full, l->ctx, block, N, N, 1, &dst, &a, op == AMBIT_OP_POWN ? &cube : &b);
    l->full.leave(l->ctx);
    l->full.bounds(l->ctx, block + 4 * N, N, o->lo[op], o->hi[op]);
  }
  o->flags[AMBIT_OP_COUNT] = l->full.dot(l->ctx, block + 4 * N, block, N / 2, block + 2 * N, N / 2, 2, N / 2);
  l->full.bounds(l->ctx, block + 4 * N, N / 2, o->dot_lo, o->dot_hi);
  o->flags[AMBIT_OP_COUNT] |= l->full.dot(l->ctx, block + 4 * N, block, 1, block + 2 * N + 20, -1, N / 2, 1);
  l->full.bounds(l->ctx, block + 4 * N, 1, o->dot_lo + N / 2, o->dot_hi + N / 2);
}

static void the_plugin_gives_the_same_bits(void **unused) {
  (void)unused;
  for (int v = 0; v < 3; v++) {
    arithmetic_loader l;
    if (arithmetic_load_as(&l, "interval", variant[v])) {
      arithmetic_unload(&l);
      assert_true(v > 0);
      continue;
    }
    uint64_t state = 31;
    for (int pass = 0; pass < 200; pass++) {
      static outcome want, got;
      double lo[N], hi[N];
      fill(lo, hi, &state);
      memset(&want, 0, sizeof want), memset(&got, 0, sizeof got);
      run_plugin(&l, lo, hi, &want);
      for (size_t e = 1; e < ENVIRONMENTS; e++) {
        enter_environment(e);
        run_plugin(&l, lo, hi, &got);
        int kept = is_environment(e);
        enter_environment(0);
        assert_true(kept);
        for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++)
          if (memcmp(got.lo[op], want.lo[op], sizeof got.lo[op]) ||
              memcmp(got.hi[op], want.hi[op], sizeof got.hi[op]) || got.flags[op] != want.flags[op])
            fail_msg("%s: op %u in environment %zu", variant[v], op, e);
        assert_memory_equal(&got, &want, sizeof want);
      }
    }
    arithmetic_unload(&l);
  }
}

static void set_and_bounds_inside_a_batch(void **unused) {
  (void)unused;
  arithmetic_loader l;
  assert_null(arithmetic_load(&l, "interval"));
  const double lo[3] = { -0x1p-1074, 0x1p-1074, 0x1p-1074 }, hi[3] = { 0, 0, 0x1p-1074 };
  for (size_t e = 0; e < ENVIRONMENTS; e++) {
    double x[6], down[3], up[3];
    enter_environment(e);
    l.full.set(l.ctx, x, 3, lo, hi, -1);
    l.full.bounds(l.ctx, x, 3, down, up);
    enter_environment(0);
    assert_true(down[0] == -0x1p-1074 && up[0] == 0);
    assert_true(down[1] == INFINITY && up[1] == -INFINITY);
    assert_true(down[2] == 0x1p-1074 && up[2] == 0x1p-1074);
  }
  arithmetic_unload(&l);
}

/* -- series */

#define ORDER 6

typedef struct coefficients {
  double mid[TAPE_ROOM][ORDER + 1], rad[TAPE_ROOM][ORDER + 1], mag[TAPE_ROOM][ORDER + 1];
  double dmid[TAPE_ROOM][ORDER + 1][2], drad[TAPE_ROOM][ORDER + 1][2];
  uint32_t flags;
} coefficients;

static void run_jets(const arithmetic_loader *l, const ambit_tape *t, coefficients *c) {
  void *jets;
  const ambit_jets *j = l->plugin->jets;
  assert_int_equal(j->open(&l->scope->host, l->ctx, t, ORDER, 2, NULL, &jets), AMBIT_OK);
  c->flags = 0;
  for (uint32_t k = 0; k <= ORDER; k++) {
    static const double slope[2][2] = { { 1.0 / 3, 0x1p-1074 }, { 0, -0.7 } };
    static const double mid[ORDER + 1] = { 0.3, -0.17, 0.9, 0x1p-1060, 0, 0.123, 1.0 / 7 };
    j->put(jets, 0, k, mid[k], 0x1p-1060, slope[0], NULL);
    j->put(jets, 1, k, -0x1.8p-1070, 0x1p-50, slope[1], NULL);
    c->flags |= j->advance(jets, k);
  }
  for (uint32_t s = 0; s < t->nslot; s++) {
    for (uint32_t k = 0; k <= ORDER; k++)
      j->get(jets, s, k, &c->mid[s][k], &c->rad[s][k], c->dmid[s][k], c->drad[s][k]);
    j->magnitude(jets, s, ORDER + 1, c->mag[s], NULL);
  }
  j->close(jets);
}

static const ambit_tape *every_rule(tape_builder *t) {
  tape_begin(t);
  uint32_t one = tape_constant(t, 1, 1), tenth = tape_constant(t, 0x1.9999999999999p-4, 0.1);
  uint32_t x = tape_input(t, AMBIT_DEGREE_ANY), y = tape_input(t, AMBIT_DEGREE_ANY);
  uint32_t product = tape_op(t, AMBIT_OP_MUL, x, tape_op(t, AMBIT_OP_ADD, y, tenth));
  uint32_t positive = tape_op(t, AMBIT_OP_ADD, one, tape_unary(t, AMBIT_OP_SQR, product));
  tape_op(t, AMBIT_OP_DIV, product, positive), tape_unary(t, AMBIT_OP_SQRT, positive);
  tape_unary(t, AMBIT_OP_EXP, y), tape_unary(t, AMBIT_OP_LOG, positive), tape_unary(t, AMBIT_OP_SIN, x);
  tape_unary(t, AMBIT_OP_ATAN, y), tape_op(t, AMBIT_OP_ATAN2, x, positive), tape_unary(t, AMBIT_OP_SINH, y);
  tape_op(t, AMBIT_OP_MAX, positive, y), tape_unary(t, AMBIT_OP_ABS, positive);
  return tape_seal(t, one);
}

static void series_give_the_same_bits(void **unused) {
  (void)unused;
  arithmetic_loader l;
  static tape_builder t;
  static coefficients want, got;
  assert_null(arithmetic_load(&l, "interval"));
  const ambit_tape *tape = every_rule(&t);
  run_jets(&l, tape, &want);
  assert_int_equal(want.flags, 0);
  for (size_t e = 1; e < ENVIRONMENTS; e++) {
    enter_environment(e);
    run_jets(&l, tape, &got);
    int kept = is_environment(e);
    enter_environment(0);
    assert_true(kept);
    assert_memory_equal(&got, &want, sizeof want);
  }
  arithmetic_unload(&l);
}

/* a coefficient above the degree of its input is refused, be it ever so small */
static void a_subnormal_coefficient_is_none(void **unused) {
  (void)unused;
  arithmetic_loader l;
  static tape_builder t;
  assert_null(arithmetic_load(&l, "interval"));
  tape_begin(&t);
  uint32_t one = tape_constant(&t, 1, 1), x = tape_input(&t, 0);
  tape_op(&t, AMBIT_OP_ADD, x, one);
  const ambit_tape *tape = tape_seal(&t, one);
  for (size_t e = 0; e < ENVIRONMENTS; e++) {
    void *jets;
    const ambit_jets *j = l.plugin->jets;
    assert_int_equal(j->open(&l.scope->host, l.ctx, tape, 2, 0, NULL, &jets), AMBIT_OK);
    enter_environment(e);
    j->put(jets, 0, 0, 1, 0, NULL, NULL);
    j->put(jets, 0, 1, 0x1p-1074, 0, NULL, NULL);
    uint32_t flags = j->advance(jets, 0);
    flags |= j->advance(jets, 1);
    enter_environment(0);
    assert_int_equal(flags, AMBIT_F_UNBOUNDED);
    j->close(jets);
  }
  arithmetic_unload(&l);
}

/* -- the kernel's service and what stands beside it */

typedef struct service_outcome {
  double map[AMBIT_OP_COUNT][2 * N], elementary[2][N], series[2][N], matrix[2][16];
  double hull[N], meet[N], mid[N], rad[N], mag[N], mig[N], literal[2];
  uint32_t flags[AMBIT_OP_COUNT + 2];
  char text[64];
} service_outcome;

static void run_service(const double *lo, const double *hi, service_outcome *o) {
  const ambit_num_service *num = &ambit_num_service_v1;
  double a[2 * N], b[2 * N];
  for (int i = 0; i < N; i++) {
    ambit_interval x = ambit_interval_of(lo[i], hi[i]), y = ambit_interval_of(lo[N - 1 - i], hi[N - 1 - i]);
    a[2 * i] = x.lo, a[2 * i + 1] = x.hi, b[2 * i] = y.lo, b[2 * i + 1] = y.hi;
    ambit_interval hull = ambit_interval_hull(x, y), meet = ambit_interval_intersect(x, y);
    o->hull[i] = i % 2 ? hull.lo : hull.hi, o->meet[i] = i % 2 ? meet.lo : meet.hi;
    o->mid[i] = ambit_interval_is_empty(x) ? 0 : ambit_interval_mid(x), o->rad[i] = ambit_interval_rad(x);
    o->mag[i] = ambit_interval_mag(x), o->mig[i] = ambit_interval_mig(x);
  }
  for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++) o->flags[op] = num->map(op, N, o->map[op], a, b, -3);
  num->elementary(AMBIT_OP_SINH, N, lo, hi, NULL, NULL, o->elementary[0], o->elementary[1]);
  o->flags[AMBIT_OP_COUNT] = num->convolve(N, o->series[0], o->series[1], lo, hi, lo, hi);
  o->flags[AMBIT_OP_COUNT + 1] = num->matmul(4, 4, 4, o->matrix[0], o->matrix[1], lo, hi, lo + 4, hi + 4);
  num->read("0.1", &o->literal[0], &o->literal[1], NULL, 0);
  num->shortest(o->text, sizeof o->text, 0x1.8p-1070);
}

static void the_service_gives_the_same_bits(void **unused) {
  (void)unused;
  uint64_t state = 32;
  for (int pass = 0; pass < 300; pass++) {
    static service_outcome want, got;
    double lo[N], hi[N];
    fill(lo, hi, &state);
    for (int i = 0; pass % 2 && i < N; i++) /* the fast way of products takes no empty sets */
      if (lo[i] > hi[i]) lo[i] = hi[i];
    memset(&want, 0, sizeof want), memset(&got, 0, sizeof got);
    run_service(lo, hi, &want);
    for (size_t e = 1; e < ENVIRONMENTS; e++) {
      enter_environment(e);
      run_service(lo, hi, &got);
      int kept = is_environment(e);
      enter_environment(0);
      assert_true(kept);
      for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++)
        if (memcmp(got.map[op], want.map[op], sizeof got.map[op]) || got.flags[op] != want.flags[op])
          fail_msg("map of op %u in environment %zu", op, e);
      assert_memory_equal(&got, &want, sizeof want);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_plugin_gives_the_same_bits),
    cmocka_unit_test(set_and_bounds_inside_a_batch),
    cmocka_unit_test(series_give_the_same_bits),
    cmocka_unit_test(a_subnormal_coefficient_is_none),
    cmocka_unit_test(the_service_gives_the_same_bits),
  };
  return cmocka_run_group_tests_name("interval environment", tests, NULL, NULL);
}
