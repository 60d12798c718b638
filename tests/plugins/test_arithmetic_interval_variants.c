/* The variants of the interval plugin by instruction set: the same bits from every operation, from dot, and from a tape
** run by run or in one call, whatever the number of lanes. (Series differ in the last bits: fused or not.) */
#include "kit/arithmetic_loader.h"
#include "kit/tape_builder.h"
#include <ambit/interval.h>
#include "oracle.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

#define VARIANTS 3
#define ROOM 300
#define GUARD 4711.0

static const char *const name[VARIANTS] = { "ambit.arithmetic.portable/1", "ambit.arithmetic.avx2/1",
  "ambit.arithmetic.avx512/1" };
static arithmetic_loader loader[VARIANTS]; /* plugin NULL: not for this processor */

static int load_all(void **unused) {
  (void)unused;
  for (int v = 0; v < VARIANTS; v++)
    if (arithmetic_load_as(&loader[v], "interval", name[v])) {
      arithmetic_unload(&loader[v]);
      loader[v].plugin = NULL;
    }
  return loader[0].plugin == NULL;
}

static int unload_all(void **unused) {
  (void)unused;
  for (int v = 0; v < VARIANTS; v++)
    if (loader[v].plugin) arithmetic_unload(&loader[v]);
  return 0;
}

/* the default is one of the variants, and the widest there is */
static void the_best_is_chosen(void **unused) {
  (void)unused;
  arithmetic_loader l;
  assert_null(arithmetic_load(&l, "interval"));
  int best = loader[2].plugin ? 2 : loader[1].plugin ? 1 : 0;
  const ambit_plugin *entry = dlsym(l.library, "ambit_entry");
  assert_ptr_equal(l.plugin, entry->get(name[best]));
  assert_null(entry->get("ambit.arithmetic.sse9/1"));
  arithmetic_unload(&l);
}

static void any_sets(double *x, size_t n, uint64_t *state) {
  for (size_t i = 0; i < n; i++) {
    double a = oracle_double(state), b = oracle_double(state), lo = fmin(a, b), hi = fmax(a, b);
    switch (oracle_random(state) % 12) {
    case 0: lo = INFINITY, hi = -INFINITY; break;
    case 1: lo = -INFINITY; break;
    case 2: hi = INFINITY; break;
    case 3: lo = hi; break;
    case 4: lo = 0, hi = fabs(hi); break;
    default: break;
    }
    loader[0].full.set(NULL, x + 2 * i, 1, &lo, &hi, -1);
  }
}

/* operations: `count` instructions, `lanes` in rows of `pitch`; nothing but the results is touched */
static void runs_agree(void **unused) {
  (void)unused;
  static double block[VARIANTS][2 * ROOM * 12];
  uint64_t state = 41;
  for (int pass = 0; pass < 3000; pass++) {
    size_t lanes = 1 + oracle_random(&state) % (pass % 3 ? 9 : ROOM / 2), pitch = lanes + oracle_random(&state) % 3;
    size_t count = 1 + oracle_random(&state) % (pass % 3 ? 11 : 2), slots = 3 * count;
    uint32_t op = (uint32_t)(oracle_random(&state) % AMBIT_OP_COUNT), dst[12], a[12], b[12], flags[VARIANTS];
    if (slots * pitch > ROOM * 12 / 2) continue;
    any_sets(block[0], slots * pitch, &state);
    for (uint32_t i = 0; i < count; i++) {
      dst[i] = 3 * i + 1, a[i] = 3 * (uint32_t)(oracle_random(&state) % count), b[i] = 3 * i + 2;
      if (op == AMBIT_OP_POWN) b[i] = (uint32_t)(oracle_random(&state) % 9) - 4u;
      for (size_t l = 0; l < pitch; l++)
        block[0][2 * (dst[i] * pitch + l)] = block[0][2 * (dst[i] * pitch + l) + 1] = GUARD;
    }
    for (int v = 1; v < VARIANTS; v++) memcpy(block[v], block[0], 16 * slots * pitch);
    for (int v = 0; v < VARIANTS; v++) {
      const arithmetic_loader *l = &loader[v];
      if (!l->plugin) continue;
      l->full.enter(l->ctx);
      flags[v] = l->full.run[op](&l->full, l->ctx, block[v], pitch, lanes, count, dst, a, b);
      l->full.leave(l->ctx);
      assert_int_equal(flags[v], flags[0]);
      if (memcmp(block[v], block[0], 16 * slots * pitch))
        fail_msg("%s: op %u, %zu lanes, %zu instructions", name[v], op, lanes, count);
    }
    for (size_t i = 0; i < count; i++)
      for (size_t l = lanes; l < pitch; l++) assert_true(block[0][2 * (dst[i] * pitch + l)] == GUARD);
  }
}

/* and lane l of many is what one lane gives */
static void dots_agree(void **unused) {
  (void)unused;
  static double x[2 * ROOM], y[2 * ROOM], r[VARIANTS][40], single[2];
  uint64_t state = 42;
  for (int pass = 0; pass < 4000; pass++) {
    size_t lanes = 1 + oracle_random(&state) % 9, m = oracle_random(&state) % 25;
    any_sets(x, ROOM, &state), any_sets(y, ROOM, &state);
    if (pass % 2) /* bounded operands take the fast way */
      for (size_t i = 0; i < 2 * ROOM; i++) {
        double a = oracle_uniform(&state, -4, 4);
        x[i] = i % 2 ? 0x1p-30 - x[i - 1] : a, y[i] = i % 2 ? 0.5 - y[i - 1] : a;
      }
    ptrdiff_t sa = pass % 4 < 2 ? (ptrdiff_t)lanes : 1, sb = pass % 3 ? -sa : sa;
    const double *last = sb < 0 ? y + 2 * sa * (ptrdiff_t)(m ? m - 1 : 0) : y;
    for (int v = 0; v < VARIANTS; v++) {
      const arithmetic_loader *l = &loader[v];
      if (!l->plugin) continue;
      for (int i = 0; i < 40; i++) r[v][i] = GUARD;
      uint32_t flags = l->full.dot(l->ctx, r[v], x, sa, last, sb, m, lanes), all = 0;
      assert_memory_equal(r[v], r[0], sizeof r[0]);
      assert_true(r[v][2 * lanes] == GUARD);
      for (size_t lane = 0; lane < lanes; lane++) {
        all |= l->full.dot(l->ctx, single, x + 2 * lane, sa, last + 2 * lane, sb, m, 1);
        assert_memory_equal(single, r[v] + 2 * lane, sizeof single);
      }
      assert_int_equal(flags, all);
    }
  }
}

static const ambit_tape *any_tape(tape_builder *t, uint64_t *state) {
  tape_begin(t);
  for (int i = 0; i < 4; i++) tape_input(t, 0);
  for (int i = 0; i < 40; i++) {
    uint32_t op = (uint32_t)(oracle_random(state) % AMBIT_OP_COUNT), n = t->tape.nslot;
    uint32_t b = op == AMBIT_OP_POWN ? (uint32_t)(oracle_random(state) % 9) - 4u : (uint32_t)(oracle_random(state) % n);
    tape_op(t, op, (uint32_t)(oracle_random(state) % n), b);
  }
  return tape_seal(t, AMBIT_NO_SLOT);
}

static void tapes_agree(void **unused) {
  (void)unused;
  static tape_builder t;
  static double whole[2 * 50 * 20], by_runs[2 * 50 * 20], first[2 * 50 * 20];
  uint64_t state = 43;
  for (int pass = 0; pass < 300; pass++) {
    const ambit_tape *tape = any_tape(&t, &state);
    size_t lanes = 1 + oracle_random(&state) % 19, pitch = lanes + (size_t)pass % 2, n = 2 * tape->nslot * pitch;
    memset(whole, 0, sizeof whole);
    any_sets(whole, 4 * pitch, &state);
    memcpy(first, whole, sizeof whole);
    for (int v = 0; v < VARIANTS; v++) {
      const arithmetic_loader *l = &loader[v];
      if (!l->plugin) continue;
      memcpy(whole, first, v ? 2 * 4 * pitch * sizeof *whole : sizeof whole);
      memcpy(by_runs, whole, sizeof whole);
      uint32_t flags = 0;
      l->full.enter(l->ctx);
      uint32_t fused = l->plugin->eval_tape(l->ctx, tape, whole, pitch, lanes);
      for (uint32_t i = 0; i < tape->nrun; i++) {
        const ambit_run *r = &tape->run[i];
        flags |= l->full.run[r->op](&l->full, l->ctx, by_runs, pitch, lanes, r->count, tape->dst + r->first,
            tape->a + r->first, tape->b + r->first);
      }
      l->full.leave(l->ctx);
      assert_int_equal(fused, flags);
      assert_memory_equal(whole, by_runs, n * sizeof *whole);
      if (v == 0) memcpy(first, whole, sizeof whole);
      assert_memory_equal(whole, first, n * sizeof *whole);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_best_is_chosen),
    cmocka_unit_test(runs_agree),
    cmocka_unit_test(dots_agree),
    cmocka_unit_test(tapes_agree),
  };
  return cmocka_run_group_tests_name("interval variants", tests, load_all, unload_all);
}
