/* The interpreter: filled-in operations against the kernel's intervals, constants, blocks, refusals. */
#include "graph/series_fixture.h"
#include "num/interval.h"
#include <setjmp.h>
#include <stddef.h>
#include <cmocka.h>

static const uint32_t every_op[] = {
#define AMBIT_X(name, arity, symbol) AMBIT_OP_##name,
  AMBIT_OPS(AMBIT_X)
#undef AMBIT_X
};

static ambit_interval random_interval(uint64_t *state) {
  double a = oracle_double(state), b = oracle_double(state);
  switch (oracle_random(state) % 8) {
  case 0: return AMBIT_EMPTY;
  case 1: return AMBIT_ENTIRE;
  case 2: return (ambit_interval) { a, a };
  default: return a <= b ? (ambit_interval) { a, b } : (ambit_interval) { b, a };
  }
}

/* One run of `count` instructions of each opcode over `lanes`: every lane must get the kernel's own result. */
static void check_runs(fixture_host *host, const ambit_arithmetic *full, size_t lanes, uint32_t count) {
  uint64_t state = 7 + lanes;
  fixture_tape *x = fixture_tape_open(host);
  uint32_t a = fixture_input(x, 0), b = fixture_input(x, 0), nop = sizeof every_op / sizeof *every_op;
  for (uint32_t k = 0; k < nop; k++) {
    x->run[x->tape.nrun] = (ambit_run) { .op = every_op[k], .first = x->tape.ninstr, .count = count };
    for (uint32_t c = 0; c < count; c++) {
      uint32_t nrun = x->tape.nrun, i = x->tape.ninstr;
      ambit_run keep = x->run[nrun];
      fixture_op(x, every_op[k], a, b);
      x->run[nrun] = keep, x->tape.nrun = nrun;
      if (every_op[k] == AMBIT_OP_POWN) x->b[i] = (uint32_t)((int32_t)c - 3);
    }
    x->tape.nrun++;
  }
  fixture_output_all(x);
  ambit_block *block;
  assert_int_equal(ambit_block_open(&x->tape, full, NULL, lanes, &block, NULL), AMBIT_OK);
  ambit_interval A[128], B[128];
  uint32_t expected = 0;
  for (size_t l = 0; l < lanes; l++) {
    A[l] = random_interval(&state), B[l] = random_interval(&state);
    ambit_block_set(block, 0, l, A[l], -1), ambit_block_set(block, 1, l, B[l], -1);
  }
  uint32_t flags = ambit_block_run(block);
  for (uint32_t i = 0; i < x->tape.ninstr; i++)
    for (size_t l = 0; l < lanes; l++) {
      ambit_interval r, got = ambit_block_get(block, x->dst[i], l);
      if (x->op[i] == AMBIT_OP_POWN)
        expected |= ambit_interval_pown(&r, A[l], (int32_t)x->b[i]);
      else
        expected |= ambit_interval_op(x->op[i], &r, A[l], B[l]);
      if (got.lo != r.lo || got.hi != r.hi)
        fail_msg("op %u lane %zu: [%a, %a], expected [%a, %a]", x->op[i], l, got.lo, got.hi, r.lo, r.hi);
    }
  assert_int_equal(flags, expected);
  ambit_block_close(block);
}

static void filled_operations_are_the_kernels(void **unused) {
  (void)unused;
  fixture_host host;
  fixture_host_open(&host);
  ambit_arithmetic full = fixture_arithmetic();
  const size_t lanes[] = { 1, 3, 63, 64, 65, 128 };
  for (size_t i = 0; i < sizeof lanes / sizeof *lanes; i++) check_runs(&host, &full, lanes[i], 7);
  fixture_host_close(&host);
}

static uint32_t mine(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes, size_t count,
    const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  (void)self, (void)ctx, (void)a, (void)b;
  for (size_t i = 0; i < count; i++)
    for (size_t l = 0; l < lanes; l++) ((ambit_interval *)base)[dst[i] * pitch + l] = (ambit_interval) { 42, 42 };
  return 0;
}

static void completing(void **unused) {
  (void)unused;
  ambit_arithmetic plugin = fixture_arithmetic(), full;
  ambit_failure f = { 0 };
  plugin.run[AMBIT_OP_EXP] = mine;
  assert_int_equal(ambit_arithmetic_complete(&plugin, &full, &f), AMBIT_OK);
  assert_true(full.run[AMBIT_OP_EXP] == mine);
  for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++) assert_non_null(full.run[op]);
  plugin.jets = &ambit_jets_general;
  plugin.size = offsetof(ambit_arithmetic, jets); /* an older plugin: nothing behind its size is read */
  assert_int_equal(ambit_arithmetic_complete(&plugin, &full, &f), AMBIT_OK);
  assert_null(full.jets);
  plugin.bounds = NULL;
  assert_int_equal(ambit_arithmetic_complete(&plugin, &full, &f), AMBIT_INVALID);
  assert_non_null(strstr(f.message, "'bounds'"));
  ambit_failure_clear(&f);
  plugin = fixture_arithmetic();
  plugin.size = 8;
  assert_int_equal(ambit_arithmetic_complete(&plugin, &full, &f), AMBIT_INVALID);
  assert_non_null(strstr(f.message, "'elem'"));
}

/* what happens to a context */
typedef struct counters {
  int entered, left, initialised, cleared, whole;
} counters;

static void count_enter(void *ctx) { ((counters *)ctx)->entered++; }
static void count_leave(void *ctx) { ((counters *)ctx)->left++; }
static void count_clear(void *ctx, void *base, size_t n) {
  (void)base;
  ((counters *)ctx)->cleared += (int)n;
}
static ambit_status count_init(void *ctx, void *base, size_t n) {
  for (size_t i = 0; i < n; i++) ((ambit_interval *)base)[i] = AMBIT_EMPTY;
  ((counters *)ctx)->initialised += (int)n;
  return AMBIT_OK;
}
static ambit_status refuse_init(void *ctx, void *base, size_t n) {
  (void)ctx, (void)base, (void)n;
  return AMBIT_NOMEM;
}
static int32_t text_of_third(void *ctx, void *dst, const char *text) {
  (void)ctx;
  if (strcmp(text, "1/3") != 0) return 0;
  *(ambit_interval *)dst = (ambit_interval) { 3, 3 };
  return 1;
}
static uint32_t whole_tape(void *ctx, const ambit_tape *t, void *base, size_t pitch, size_t lanes) {
  ((counters *)ctx)->whole++;
  for (size_t l = 0; l < lanes; l++) ((ambit_interval *)base)[t->out[0] * pitch + l] = (ambit_interval) { 5, 6 };
  return AMBIT_F_PARTIAL;
}

static void a_block_keeps_the_contract(void **unused) {
  (void)unused;
  fixture_host host;
  fixture_host_open(&host);
  counters c = { 0 };
  ambit_arithmetic full = fixture_arithmetic();
  full.enter = count_enter, full.leave = count_leave, full.init = count_init, full.clear = count_clear;
  full.set_text = text_of_third;
  fixture_tape *x = fixture_tape_open(&host);
  uint32_t third = fixture_constant(x, 0.3, 0.4), half = fixture_constant(x, 0.5, 0.5), u = fixture_input(x, 0);
  x->text[third] = "1/3", x->text[half] = "1/2";
  fixture_output(x, fixture_op(x, AMBIT_OP_MUL, third, fixture_op(x, AMBIT_OP_ADD, u, half)));
  ambit_block *block;
  assert_int_equal(ambit_block_open(&x->tape, &full, &c, 2, &block, NULL), AMBIT_OK);
  assert_int_equal(c.initialised, 2 * x->tape.nslot);
  size_t pitch;
  assert_non_null(ambit_block_base(block, &pitch));
  assert_int_equal(pitch, 2);
  ambit_block_set(block, 0, 0, (ambit_interval) { 1, 2 }, -1);
  ambit_block_set(block, 0, 1, AMBIT_EMPTY, -1);
  for (int turn = 1; turn <= 2; turn++) { /* constants survive a run */
    assert_int_equal(ambit_block_run(block), AMBIT_F_EMPTY);
    ambit_interval r = ambit_block_get(block, 0, 0);
    assert_true(r.lo == 4.5 && r.hi == 7.5);
    assert_true(ambit_interval_is_empty(ambit_block_get(block, 0, 1)));
    assert_true(c.entered == turn && c.left == turn);
  }
  full.eval_tape = whole_tape;
  assert_int_equal(ambit_block_run(block), AMBIT_F_PARTIAL);
  assert_true(ambit_block_get(block, 0, 1).hi == 6 && c.whole == 1);
  ambit_block_close(block);
  assert_int_equal(c.cleared, 2 * x->tape.nslot);
  fixture_host_close(&host);
}

static size_t odd_elem(void *ctx) {
  (void)ctx;
  return 12;
}

static void nan_bounds(void *ctx, const void *src, size_t n, double *lo, double *hi) {
  (void)ctx, (void)src;
  for (size_t i = 0; i < n; i++) lo[i] = hi[i] = NAN;
}

static void refusals(void **unused) {
  (void)unused;
  fixture_host host;
  fixture_host_open(&host);
  ambit_arithmetic full = fixture_arithmetic();
  fixture_tape *x = fixture_tape_open(&host);
  fixture_output(x, fixture_op(x, AMBIT_OP_SQR, fixture_input(x, 0), 0));
  ambit_block *block;
  ambit_failure f = { 0 };
  assert_int_equal(ambit_block_open(&x->tape, &full, NULL, SIZE_MAX / 8, &block, &f), AMBIT_INVALID);
  assert_null(block);
  assert_non_null(strstr(f.message, "bytes, more than there are addresses"));
  ambit_failure_clear(&f);
  assert_int_equal(ambit_block_open(&x->tape, &full, NULL, 0, &block, &f), AMBIT_INVALID);
  ambit_failure_clear(&f);
  full.init = refuse_init;
  assert_int_equal(ambit_block_open(&x->tape, &full, NULL, 1, &block, &f), AMBIT_NOMEM);
  ambit_failure_clear(&f);
  full = fixture_arithmetic();
  full.elem = odd_elem;
  assert_int_equal(ambit_block_open(&x->tape, &full, NULL, 1, &block, &f), AMBIT_INVALID);
  assert_non_null(strstr(f.message, "12 bytes"));
  full = fixture_arithmetic();
  full.bounds = nan_bounds;
  assert_int_equal(ambit_block_open(&x->tape, &full, NULL, 1, &block, NULL), AMBIT_OK);
  ambit_interval r = ambit_block_get(block, 0, 0);
  assert_true(r.lo == -INFINITY && r.hi == INFINITY);
  ambit_block_close(block);
  fixture_host_close(&host);
}

static void senseless_bounds(void *ctx, const void *src, size_t n, double *lo, double *hi) {
  box_bounds(NULL, src, n, lo, hi);
  for (size_t i = 0; i < n; i++)
    if (lo[i] == 1 && hi[i] == 2) lo[i] = hi[i] = *(const double *)ctx;
}

/* Bounds that are no set are unknown, not proved empty. */
static void senseless_bounds_bound_nothing(void **unused) {
  (void)unused;
  fixture_host host;
  fixture_host_open(&host);
  ambit_arithmetic full = fixture_arithmetic();
  full.bounds = senseless_bounds;
  fixture_tape *x = fixture_tape_open(&host);
  uint32_t one = fixture_constant(x, 1, 1), u = fixture_input(x, 0);
  fixture_output(x, fixture_op(x, AMBIT_OP_DIV, one, u)), fixture_output(x, fixture_op(x, AMBIT_OP_EXP, u, u));
  fixture_output(x, u);
  const double value[] = { NAN, INFINITY, -INFINITY };
  for (size_t i = 0; i < 3; i++) {
    double no_bound = value[i];
    ambit_block *block;
    assert_int_equal(ambit_block_open(&x->tape, &full, &no_bound, 1, &block, NULL), AMBIT_OK);
    ambit_block_set(block, 0, 0, (ambit_interval) { 1, 2 }, -1);
    assert_int_equal(ambit_block_run(block), AMBIT_F_PARTIAL | AMBIT_F_UNBOUNDED); /* 1/u */
    ambit_interval inverse = ambit_block_get(block, 0, 0), power = ambit_block_get(block, 1, 0),
                   input = ambit_block_get(block, 2, 0);
    assert_true(inverse.lo == -INFINITY && inverse.hi == INFINITY && power.lo == 0 && power.hi == INFINITY);
    assert_true(input.lo == -INFINITY && input.hi == INFINITY);
    ambit_block_close(block);
  }
  fixture_host_close(&host);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(filled_operations_are_the_kernels),
    cmocka_unit_test(completing),
    cmocka_unit_test(a_block_keeps_the_contract),
    cmocka_unit_test(refusals),
    cmocka_unit_test(senseless_bounds_bound_nothing),
  };
  return cmocka_run_group_tests_name("interpreter", tests, NULL, NULL);
}
