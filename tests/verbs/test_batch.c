/* A tape streamed through a batch gives what a block gives, bit by bit, lane by lane, in any arithmetic. */
#include "verbs/sample/batch.h"
#include "kit/arithmetic_loader.h"
#include "kit/tape_builder.h"
#include "oracle.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

#define NIN 4
#define LANES 700

static void load(arithmetic_loader *l, const char *name) {
  const char *problem = arithmetic_load(l, name);
  if (problem) fail_msg("%s", problem);
}

static const ambit_tape *random_tape(tape_builder *t, uint64_t *state, int length) {
  tape_begin(t);
  tape_constant(t, 1, 1), tape_constant(t, 0.1, nextafter(0.1, 1));
  for (int i = 0; i < NIN; i++) tape_input(t, AMBIT_DEGREE_ANY);
  for (int i = 0; i < length; i++) {
    uint32_t op = (uint32_t)(oracle_random(state) % AMBIT_OP_COUNT), n = t->tape.nslot;
    uint32_t recent = n < 12 ? n : 12; /* so that early slots die */
    uint32_t a = n - 1 - (uint32_t)(oracle_random(state) % recent), b = n - 1 - (uint32_t)(oracle_random(state) % n);
    if (op == AMBIT_OP_POWN) b = (uint32_t)(int32_t)(oracle_random(state) % 7) - 3u;
    tape_op(t, op, a, b);
  }
  const ambit_tape *sealed = tape_seal(t, AMBIT_NO_SLOT);
  for (uint32_t i = 0; i < t->tape.ninstr; i++)
    if (t->op[i] != AMBIT_OP_POWN && t->op[i] != AMBIT_OP_ADD && oracle_random(state) % 8 == 0) t->b[i] = t->a[i];
  return sealed;
}

/* a few outputs only: the last instruction, an input, a constant, one twice */
static void choose_outputs(tape_builder *t, uint64_t *state) {
  t->out[0] = t->tape.nslot - 1, t->out[1] = t->tape.nconst + 2, t->out[2] = 1;
  t->out[3] = t->out[4] = (uint32_t)(oracle_random(state) % t->tape.nslot);
  t->tape.nout = 5;
}

static double in_lo[NIN * LANES], in_hi[NIN * LANES], out_lo[TAPE_ROOM * LANES], out_hi[TAPE_ROOM * LANES];

static void random_inputs(size_t lanes, uint64_t *state) {
  for (size_t i = 0; i < NIN * lanes; i++) {
    double x = oracle_double(state), y = oracle_random(state) % 2 ? x : oracle_double(state);
    in_lo[i] = x < y ? x : y, in_hi[i] = x < y ? y : x;
    if (oracle_random(state) % 50 == 0) in_lo[i] = INFINITY, in_hi[i] = -INFINITY;
  }
}

static void compare(const arithmetic_loader *l, const ambit_tape *t, size_t lanes) {
  ambit_batch *batch;
  ambit_block *block;
  assert_int_equal(ambit_batch_open(t, &l->full, l->ctx, &batch, NULL), AMBIT_OK);
  assert_int_equal(ambit_block_open(t, &l->full, l->ctx, lanes, &block, NULL), AMBIT_OK);
  assert_true(ambit_batch_places(batch) <= t->nslot && ambit_batch_width(batch) > 0);
  for (uint32_t i = 0; i < NIN; i++)
    for (size_t lane = 0; lane < lanes; lane++)
      ambit_block_set(block, i, lane, (ambit_interval) { in_lo[i * lanes + lane], in_hi[i * lanes + lane] }, -1);
  uint32_t flags = ambit_batch_run(batch, lanes, in_lo, in_hi, NULL, out_lo, out_hi);
  assert_int_equal(flags, ambit_block_run(block));
  for (uint32_t o = 0; o < t->nout; o++)
    for (size_t lane = 0; lane < lanes; lane++) {
      ambit_interval want = ambit_block_get(block, o, lane);
      double lo = out_lo[o * lanes + lane], hi = out_hi[o * lanes + lane];
      if (lo != want.lo || hi != want.hi)
        fail_msg("output %u lane %zu of %zu: [%a, %a] instead of [%a, %a]", o, lane, lanes, lo, hi, want.lo, want.hi);
    }
  ambit_batch_close(batch), ambit_block_close(block);
}

static void equals_a_block(void **unused) {
  (void)unused;
  static const char *const name[] = { "interval", "real" };
  static const size_t lanes[] = { 1, 2, 15, 16, 17, 255, 256, 257, LANES };
  static tape_builder t;
  uint64_t state = 21;
  for (int n = 0; n < 2; n++) {
    arithmetic_loader l;
    load(&l, name[n]);
    for (size_t i = 0; i < sizeof lanes / sizeof *lanes; i++)
      for (int pass = 0; pass < 12; pass++) {
        const ambit_tape *tape = random_tape(&t, &state, 1 + (int)(oracle_random(&state) % 80));
        if (pass % 3) choose_outputs(&t, &state);
        if (n == 1 && pass % 3 == 0) choose_outputs(&t, &state);
        random_inputs(lanes[i], &state);
        compare(&l, tape, lanes[i]);
      }
    arithmetic_unload(&l);
  }
}

static void the_same_batch_again(void **unused) {
  (void)unused;
  arithmetic_loader l;
  static tape_builder t;
  uint64_t state = 22;
  load(&l, "interval");
  const ambit_tape *tape = random_tape(&t, &state, 60);
  choose_outputs(&t, &state);
  ambit_batch *batch;
  assert_int_equal(ambit_batch_open(tape, &l.full, l.ctx, &batch, NULL), AMBIT_OK);
  static double first_lo[5 * 40], first_hi[5 * 40];
  random_inputs(40, &state);
  uint32_t flags = ambit_batch_run(batch, 40, in_lo, in_hi, NULL, first_lo, first_hi);
  ambit_batch_run(batch, 7, in_lo + 3, in_hi + 3, NULL, out_lo, out_hi);
  assert_int_equal(ambit_batch_run(batch, 40, in_lo, in_hi, NULL, out_lo, out_hi), flags);
  assert_memory_equal(out_lo, first_lo, sizeof first_lo);
  assert_memory_equal(out_hi, first_hi, sizeof first_hi);
  assert_int_equal(ambit_batch_run(batch, 0, NULL, NULL, NULL, NULL, NULL), 0);
  ambit_batch_close(batch);
  arithmetic_unload(&l);
}

/* a chain needs three places however long it is */
static void places_are_shared(void **unused) {
  (void)unused;
  arithmetic_loader l;
  static tape_builder t;
  load(&l, "interval");
  tape_begin(&t);
  uint32_t x = tape_input(&t, 0), y = tape_input(&t, 0);
  for (int i = 0; i < 200; i++) x = tape_op(&t, AMBIT_OP_ADD, x, y);
  tape_seal(&t, AMBIT_NO_SLOT);
  t.out[0] = x, t.tape.nout = 1;
  ambit_batch *batch;
  assert_int_equal(ambit_batch_open(&t.tape, &l.full, l.ctx, &batch, NULL), AMBIT_OK);
  assert_int_equal(ambit_batch_places(batch), 3);
  const double in[2] = { 1, 2 };
  double lo, hi;
  assert_int_equal(ambit_batch_run(batch, 1, in, in, NULL, &lo, &hi), 0);
  assert_true(lo == 401 && hi == 401);
  ambit_batch_close(batch);
  arithmetic_unload(&l);
}

/* An arithmetic with elements that own something, and that wants to know its variables: it counts. */
typedef struct counting {
  size_t alive, set_as[3];
} counting;

static size_t counting_elem(void *ctx) { return (void)ctx, 3 * sizeof(double); }

static ambit_status counting_init(void *ctx, void *base, size_t n) {
  (void)base;
  ((counting *)ctx)->alive += n;
  return AMBIT_OK;
}

static void counting_clear(void *ctx, void *base, size_t n) {
  (void)base;
  ((counting *)ctx)->alive -= n;
}

static void counting_set(void *ctx, void *dst, size_t n, const double *lo, const double *hi, int32_t var) {
  if (var >= 0) ((counting *)ctx)->set_as[var] += n;
  for (size_t i = 0; i < n; i++) ((double *)dst)[3 * i] = lo[i], ((double *)dst)[3 * i + 1] = hi[i];
}

static void counting_bounds(void *ctx, const void *src, size_t n, double *lo, double *hi) {
  (void)ctx;
  for (size_t i = 0; i < n; i++) lo[i] = ((const double *)src)[3 * i], hi[i] = ((const double *)src)[3 * i + 1];
}

static void elements_are_initialised_and_variables_named(void **unused) {
  (void)unused;
  static const ambit_arithmetic small = { .size = sizeof small,
    .elem = counting_elem,
    .init = counting_init,
    .clear = counting_clear,
    .set = counting_set,
    .bounds = counting_bounds };
  static tape_builder t;
  counting c = { 0 };
  ambit_arithmetic full;
  assert_int_equal(ambit_arithmetic_complete(&small, &full, NULL), AMBIT_OK);
  tape_begin(&t);
  uint32_t x = tape_input(&t, 0), y = tape_input(&t, 0);
  tape_op(&t, AMBIT_OP_MUL, x, y);
  tape_seal(&t, AMBIT_NO_SLOT);
  ambit_batch *batch;
  assert_int_equal(ambit_batch_open(&t.tape, &full, &c, &batch, NULL), AMBIT_OK);
  assert_int_equal(c.alive, ambit_batch_places(batch) * ambit_batch_width(batch));
  double lo[600], hi[600], rlo[900], rhi[900];
  for (int i = 0; i < 600; i++) lo[i] = i, hi[i] = i + 1;
  const int32_t var[2] = { 2, -1 };
  ambit_batch_run(batch, 300, lo, hi, var, rlo, rhi);
  assert_true(c.set_as[2] == 300 && c.set_as[0] == 0);
  assert_true(rlo[600 + 299] == 299.0 * 599 && rhi[600 + 299] == 300.0 * 600);
  ambit_batch_close(batch);
  assert_int_equal(c.alive, 0);
}

static size_t odd_elem(void *ctx) { return (void)ctx, 12; }

static void bad_elements_are_refused(void **unused) {
  (void)unused;
  ambit_arithmetic odd = { .size = sizeof odd, .elem = odd_elem, .set = counting_set, .bounds = counting_bounds };
  static tape_builder t;
  ambit_failure f = { 0 };
  ambit_batch *batch;
  tape_begin(&t), tape_input(&t, 0), tape_seal(&t, AMBIT_NO_SLOT);
  assert_int_equal(ambit_batch_open(&t.tape, &odd, NULL, &batch, &f), AMBIT_INVALID);
  assert_non_null(strstr(f.message, "12 bytes"));
  assert_null(batch);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(equals_a_block),
    cmocka_unit_test(the_same_batch_again),
    cmocka_unit_test(places_are_shared),
    cmocka_unit_test(elements_are_initialised_and_variables_named),
    cmocka_unit_test(bad_elements_are_refused),
  };
  return cmocka_run_group_tests_name("batch", tests, NULL, NULL);
}
