/* The affine plugin with the passes for each instruction set: conformance, bounds beside the kernel's intervals, what
** correlation must achieve, rounding environment, options. */
#include "affine_truth.h"
#include "num/interval.h"
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

static const char *const variant[] = { AMBIT_ARITHMETIC, "ambit.arithmetic.avx512/1", "ambit.arithmetic.avx2/1",
  "ambit.arithmetic.portable/1" };
enum { VARIANTS = 4 };

/* false: this processor lacks it */
static bool load_variant(arithmetic_loader *l, int which) {
  const char *problem = arithmetic_load_as(l, "affine", variant[which]);
  if (problem && (which == 1 || which == 2)) return false;
  if (problem) fail_msg("%s", problem);
  return true;
}

static void passes_the_kit(void **state) {
  (void)state;
  for (int v = 0; v < VARIANTS; v += VARIANTS - 1) {
    arithmetic_loader l;
    size_t fallbacks;
    load_variant(&l, v);
    assert_int_equal(l.plugin->rigorous, 1);
    assert_int_equal(case_run(&l, false, &fallbacks), 0);
    assert_int_equal(fallbacks, 0);
    arithmetic_unload(&l);
  }
}

static ambit_interval any_set(uint64_t *state) {
  double a = oracle_double(state), b = oracle_double(state);
  switch (oracle_random(state) % 12) {
  case 0: return AMBIT_EMPTY;
  case 1: return AMBIT_ENTIRE;
  case 2: return (ambit_interval) { -INFINITY, a };
  case 3: return (ambit_interval) { a, INFINITY };
  case 4: return (ambit_interval) { a, a };
  case 5: return a < 0 ? (ambit_interval) { a, 0 } : (ambit_interval) { 0, a };
  case 6: return (ambit_interval) { a, nextafter(a, INFINITY) };
  default: return a <= b ? (ambit_interval) { a, b } : (ambit_interval) { b, a };
  }
}

static bool is_binary(uint32_t op) {
  return op == AMBIT_OP_ADD || op == AMBIT_OP_SUB || op == AMBIT_OP_MUL || op == AMBIT_OP_DIV || op == AMBIT_OP_ATAN2 ||
         op == AMBIT_OP_MIN || op == AMBIT_OP_MAX;
}

/* Every operation on every kind of set, as independent variables: never outside the kernel's interval function, which
** contains the image, and PARTIAL exactly when that says so. */
static void never_wider_than_intervals(void **state) {
  (void)state;
  for (int v = 0; v < VARIANTS; v++) {
    arithmetic_loader l;
    uint64_t random = 17;
    if (!load_variant(&l, v)) continue;
    stage s = stage_open(&l, 2, NULL);
    for (int i = 0; i < 1500; i++)
      for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++) {
        ambit_interval a = any_set(&random), b = any_set(&random), want, r;
        int32_t n = (int32_t)(oracle_random(&random) % 25) - 12;
        stage_set(&s, 0, a.lo, a.hi, 0), stage_set(&s, 1, b.lo, b.hi, 1);
        uint32_t flags = op == AMBIT_OP_POWN ? ambit_interval_pown(&want, a, n) : ambit_interval_op(op, &want, a, b);
        uint32_t got = stage_run(&s, op, 2, 0, op == AMBIT_OP_POWN ? (uint32_t)n : is_binary(op) ? 1 : 0);
        r = stage_bounds(&s, 2);
        bool inside = ambit_interval_is_empty(r) || (want.lo <= r.lo && r.hi <= want.hi);
        bool lost = ambit_interval_is_empty(r) != ambit_interval_is_empty(want);
        if (!inside || lost || ((got ^ flags) & AMBIT_F_PARTIAL))
          fail_msg("op %u of [%a, %a], [%a, %a], n = %d: [%a, %a] flags %u, the kernel has [%a, %a] flags %u", op, a.lo,
              a.hi, b.lo, b.hi, n, r.lo, r.hi, got, want.lo, want.hi, flags);
      }
    stage_close(&s);
    arithmetic_unload(&l);
  }
}

/* one operation on one stage: slot 9 is the result */
static double width_of(const stage *s, uint32_t op, uint32_t a, uint32_t b) {
  stage_run(s, op, 9, a, b);
  ambit_interval r = stage_bounds(s, 9);
  return r.hi - r.lo;
}

static void shared_data_cancel(void **state) {
  (void)state;
  arithmetic_loader l;
  load_variant(&l, 0);
  stage s = stage_open(&l, 2, NULL);
  stage_set(&s, 0, 1.25, 1.75, 0), stage_set(&s, 1, 1.25, 1.75, 0), stage_set(&s, 2, 1.25, 1.75, 1);
  assert_true(width_of(&s, AMBIT_OP_SUB, 0, 0) == 0);
  assert_true(width_of(&s, AMBIT_OP_SUB, 0, 1) == 0); /* the same datum */
  assert_true(width_of(&s, AMBIT_OP_SUB, 0, 2) == 1); /* another one */
  assert_true(width_of(&s, AMBIT_OP_DIV, 0, 1) < 1e-15);
  /* errors are symbols, too */
  stage_run(&s, AMBIT_OP_EXP, 3, 0, 0);
  assert_true(width_of(&s, AMBIT_OP_SUB, 3, 3) == 0);
  stage_set(&s, 8, 0.5, 0.75, 0);
  stage_run(&s, AMBIT_OP_SIN, 4, 8, 8), stage_run(&s, AMBIT_OP_SQR, 5, 4, 4);
  stage_run(&s, AMBIT_OP_COS, 6, 8, 8), stage_run(&s, AMBIT_OP_SQR, 7, 6, 6);
  assert_true(width_of(&s, AMBIT_OP_ADD, 5, 7) < 0.2 * width_of(&s, AMBIT_OP_SUB, 5, 7));
  stage_close(&s);
  arithmetic_unload(&l);
}

static void points_have_no_symbol(void **state) {
  (void)state;
  arithmetic_loader l;
  load_variant(&l, 0);
  stage s = stage_open(&l, 3, NULL);
  stage_set(&s, 0, 0.1, 0.1, 2), stage_set(&s, 1, 3, 3, 0);
  stage_run(&s, AMBIT_OP_MUL, 2, 0, 1), stage_run(&s, AMBIT_OP_SIN, 3, 2, 2);
  for (uint32_t slot = 0; slot < 4; slot++) assert_int_equal(stage_at(&s, slot)->blocks, 0);
  stage_close(&s);
  arithmetic_unload(&l);
}

/* A symbol that is given again is another one: what the old one was part of must not cancel. */
static void old_symbols_do_not_cancel(void **state) {
  (void)state;
  arithmetic_loader l;
  load_variant(&l, 0);
  stage s = stage_open(&l, 1, (const double[]) { 1, 0, 0 });
  stage_set(&s, 0, 0, 1, 0);
  stage_run(&s, AMBIT_OP_EXP, 1, 0, 0);
  stage_set(&s, 0, 0, 1, 0);
  stage_run(&s, AMBIT_OP_EXP, 2, 0, 0);
  const affine_element *old = stage_at(&s, 1), *new = stage_at(&s, 2), *r = stage_at(&s, 3);
  double first = old->coef[AFFINE_BLOCK], second = new->coef[AFFINE_BLOCK];
  assert_true(first > 0.05 && second > 0.05 && old->err == 0 && new->err == 0);
  stage_run(&s, AMBIT_OP_SUB, 3, 1, 2);
  assert_true(r->rad >= first + second);
  stage_run(&s, AMBIT_OP_SUB, 3, 2, 2);
  assert_true(r->rad == 0);
  stage_close(&s);
  arithmetic_unload(&l);
}

/* random multiples of n variables, radius `radius` */
static void random_sum(const stage *s, uint32_t slot, uint32_t n, double centre, double radius, uint64_t *r) {
  stage_set(s, slot, centre, centre, -1);
  for (uint32_t v = 0; v < n; v++) {
    double weight = oracle_uniform(r, -2, 2) * radius / n;
    stage_set(s, 20, -fabs(weight), fabs(weight), (int32_t)v);
    stage_run(s, weight < 0 ? AMBIT_OP_SUB : AMBIT_OP_ADD, 21, slot, 20);
    memcpy(stage_at(s, slot), stage_at(s, 21), s->elem);
  }
}

static void product_rules_are_ordered(void **state) {
  (void)state;
  for (int v = 0; v < VARIANTS; v++) {
    arithmetic_loader l;
    uint64_t seed = 3;
    if (!load_variant(&l, v)) continue;
    stage fast = stage_open(&l, 50, (const double[]) { 0, 0, 0 }),
          tight = stage_open(&l, 50, (const double[]) { 0, 1, 0 });
    double sum_tight = 0, sum_trivial = 0;
    for (int i = 0; i < 200; i++) {
      uint32_t n = i < 100 ? 50 : 1 + (uint32_t)i % 20;
      random_sum(&fast, 0, n, 10, 1, &seed), random_sum(&fast, 1, n, 10, 1, &seed);
      memcpy(stage_at(&tight, 0), stage_at(&fast, 0), 2 * fast.elem);
      stage_run(&fast, AMBIT_OP_MUL, 2, 0, 1), stage_run(&tight, AMBIT_OP_MUL, 2, 0, 1);
      double trivial = stage_at(&fast, 0)->rad * stage_at(&fast, 1)->rad;
      double a = stage_at(&fast, 2)->err, b = stage_at(&tight, 2)->err, room = 1e-13; /* err holds roundings, too */
      assert_true(a <= trivial + room && b <= a + room);
      if (n == 50) sum_tight += b, sum_trivial += trivial;
    }
    assert_true(sum_tight < 0.92 * sum_trivial);
    stage_close(&fast), stage_close(&tight);
    arithmetic_unload(&l);
  }
}

static void squares_are_not_negative(void **state) {
  (void)state;
  arithmetic_loader l;
  load_variant(&l, 0);
  stage s = stage_open(&l, 1, NULL);
  stage_set(&s, 0, -3, 1, 0);
  stage_run(&s, AMBIT_OP_SQR, 1, 0, 0);
  ambit_interval r = stage_bounds(&s, 1);
  assert_true(r.lo == 0 && r.hi == 9);
  /* the error is the least there is, (b - a)^2 / 8, in a symbol of its own */
  assert_true(fabs(stage_at(&s, 1)->coef[AFFINE_BLOCK] - 2) < 1e-15);
  stage_run(&s, AMBIT_OP_SQR, 1, 0, 0), stage_run(&s, AMBIT_OP_POWN, 2, 0, 2);
  assert_true(fabs(stage_at(&s, 2)->rad - stage_at(&s, 1)->rad) < 1e-14);
  stage_close(&s);
  arithmetic_unload(&l);
}

/* On a range of 0.1 the error of a line is of second order: some percent of what the function varies. */
static void lines_are_tight(void **state) {
  (void)state;
  arithmetic_loader l;
  load_variant(&l, 0);
  for (int mode = 0; mode < 2; mode++) {
    stage s = stage_open(&l, 2, (const double[]) { 4, 0, mode });
    for (uint32_t op = AMBIT_OP_SQR; op <= AMBIT_OP_TANH; op++)
      for (double centre = op == AMBIT_OP_SQRT || op == AMBIT_OP_LOG ? 0.5 : -0.5; centre < 1; centre += 1) {
        stage_set(&s, 0, centre - 0.05, centre + 0.05, 0), stage_set(&s, 1, 2, 2, 1);
        stage_run(&s, op, 2, 0, op == AMBIT_OP_POWN ? 5 : is_binary(op) ? 1 : 0);
        ambit_interval r = stage_bounds(&s, 2);
        const affine_element *x = stage_at(&s, 2);
        double error = x->err + (x->blocks > 1 ? x->coef[AFFINE_BLOCK] : 0);
        if (!(error < (mode ? 0.2 : 0.06) * (r.hi - r.lo)))
          fail_msg("op %u about %g, linearisation %d: error %g of [%g, %g]", op, centre, mode, error, r.lo, r.hi);
      }
    stage_close(&s);
  }
  arithmetic_unload(&l);
}

#if defined(__x86_64__)
/* A host that flushes subnormals and rounds elsewhere: the same results, and its settings kept. */
static void environment_of_the_caller(void **state) {
  (void)state;
  arithmetic_loader l;
  ambit_interval want[AMBIT_OP_COUNT], got;
  load_variant(&l, 0);
  stage s = stage_open(&l, 2, NULL);
  for (int flushing = 0; flushing < 2; flushing++) {
    unsigned old = _mm_getcsr(), mine = flushing ? 0x9fc0 | 0x6000 : old;
    for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++) {
      _mm_setcsr(mine);
      stage_set(&s, 0, -0x1p-1060, 0x1.8p-1061, 0), stage_set(&s, 1, 0x1p-1065, 0x1p-1064, 1);
      stage_run(&s, op, 2, 0, op == AMBIT_OP_POWN ? 3 : is_binary(op) ? 1 : 0);
      got = stage_bounds(&s, 2);
      bool kept = (_mm_getcsr() & 0xffc0) == (mine & 0xffc0);
      _mm_setcsr(old);
      assert_true(kept);
      if (!flushing)
        want[op] = got;
      else if (memcmp(&got, &want[op], sizeof got) != 0)
        fail_msg("op %u: [%a, %a] for a host that flushes subnormals, else [%a, %a]", op, got.lo, got.hi, want[op].lo,
            want[op].hi);
    }
  }
  stage_close(&s);
  arithmetic_unload(&l);
}
#endif

static void refuse(double symbols, uint32_t nvar, ambit_status status, const char *words) {
  arithmetic_loader l;
  void *ctx = NULL;
  const double option[3] = { symbols, 0, 0 };
  load_variant(&l, 0);
  assert_int_equal(l.full.open(&l.scope->host, option, nvar, &ctx), status);
  if (!strstr(l.scope->failure.message, words)) fail_msg("no `%s` in: %s", words, l.scope->failure.message);
  arithmetic_unload(&l);
}

static void absurd_sizes_are_refused(void **state) {
  (void)state;
  refuse(-1, 1, AMBIT_INVALID, "must not be negative");
  refuse(1e15, 1, AMBIT_NOMEM, "need 7.2e+16 bytes");
  refuse(2e9, UINT32_MAX, AMBIT_NOMEM, "bytes");
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(passes_the_kit),
    cmocka_unit_test(never_wider_than_intervals),
    cmocka_unit_test(shared_data_cancel),
    cmocka_unit_test(points_have_no_symbol),
    cmocka_unit_test(old_symbols_do_not_cancel),
    cmocka_unit_test(product_rules_are_ordered),
    cmocka_unit_test(squares_are_not_negative),
    cmocka_unit_test(lines_are_tight),
#if defined(__x86_64__)
    cmocka_unit_test(environment_of_the_caller),
#endif
    cmocka_unit_test(absurd_sizes_are_refused),
  };
  return cmocka_run_group_tests_name("arithmetic affine", tests, NULL, NULL);
}
