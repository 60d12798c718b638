/* The forms of the affine plugin against MPFR (affine_truth.h): symbol by symbol after single runs, and by random
** combinations of slots after a whole tape, when symbols have been merged and reused. */
#include "affine_truth.h"

enum { NVAR = 11 };

static const char *const variant[] = { AMBIT_ARITHMETIC, "ambit.arithmetic.avx2/1", "ambit.arithmetic.portable/1" };

static bool load_variant(arithmetic_loader *l, size_t which) {
  const char *problem = arithmetic_load_as(l, "affine", variant[which]);
  if (problem && which == 1) return false; /* not every processor has it */
  if (problem) fail_msg("%s", problem);
  return true;
}

static void complain(const program *p, uint32_t slot, const affine_element *x, const truth *t, const char *what) {
  uint32_t first = p->tape->nconst + p->tape->nin, op = slot >= first ? p->tape->op[slot - first] : AMBIT_OP_COUNT;
  fail_msg("slot %u, op %u of %u, %u: %s: value %.20g, rest %.20g; [%a, %a], centre %a, err %a, rad %a", slot, op,
      slot >= first ? p->tape->a[slot - first] : 0, slot >= first ? p->tape->b[slot - first] : 0, what,
      mpfr_get_d(t->value[slot], MPFR_RNDN), mpfr_get_d(t->rest, MPFR_RNDN), -x->nlo, x->hi, x->centre, x->err, x->rad);
}

/* the sums that the element claims */
static void check_shape(const program *p, const affine_element *x, uint32_t slot, truth *t) {
  if (!(x->rad < INFINITY)) {
    if (x->blocks) complain(p, slot, x, t, "coefficients without a form");
    return;
  }
  mpfr_set_d(t->rest, x->err, MPFR_RNDN);
  for (uint64_t i = 0; i < x->blocks * AFFINE_BLOCK; i++) mpfr_add_d(t->rest, t->rest, fabs(x->coef[i]), MPFR_RNDN);
  if (mpfr_cmp_d(t->rest, x->rad) > 0 || !(x->err >= 0)) complain(p, slot, x, t, "rad too small");
  mpfr_set_d(t->rest, x->centre, MPFR_RNDN), mpfr_add_d(t->rest, t->rest, x->rad, MPFR_RNDN);
  for (uint32_t v = (uint32_t)p->tape->nin; v < 2 * AFFINE_BLOCK && v < x->blocks * AFFINE_BLOCK; v++)
    if (x->coef[v] != 0) complain(p, slot, x, t, "a coefficient that is no variable's");
}

/* Symbol k of the errors gets its value from the first slot that has it, and all others must agree. */
static void check_slot(const program *p, const stage *s, truth *t, uint32_t slot) {
  const affine_element *x = stage_at(s, slot);
  const uint64_t first = 2 * AFFINE_BLOCK; /* NVAR = 11 variables */
  if (mpfr_nan_p(t->value[slot])) return;
  if (!truth_in_hull(t, stage_bounds(s, slot), slot)) complain(p, slot, x, t, "outside the hull");
  truth_rest(t, p, x, slot);
  if (!(x->rad < INFINITY)) return;
  uint64_t fresh = UINT64_MAX;
  for (uint64_t i = first; i < x->blocks * AFFINE_BLOCK; i++) {
    uint64_t k = i - first;
    if (x->coef[i] == 0) continue;
    if (!t->known[k]) {
      if (fresh != UINT64_MAX) complain(p, slot, x, t, "two new symbols");
      fresh = k;
      continue;
    }
    mpfr_mul_d(t->term, t->error[k], x->coef[i], MPFR_RNDN);
    mpfr_sub(t->rest, t->rest, t->term, MPFR_RNDN);
  }
  if (fresh == UINT64_MAX) {
    if (!truth_within(t, x->err, fabs(x->centre) + x->rad)) complain(p, slot, x, t, "outside the form");
    return;
  }
  if (x->err != 0) complain(p, slot, x, t, "a new symbol beside an error");
  if (!truth_within(t, fabs(x->coef[first + fresh]), fabs(x->centre) + x->rad))
    complain(p, slot, x, t, "outside the form, new symbol");
  mpfr_div_d(t->error[fresh], t->rest, x->coef[first + fresh], MPFR_RNDN);
  t->known[fresh] = true;
}

/* options: symbols, product, linearisation */
static void form_holds(size_t which, const double *option, int programs, uint64_t seed) {
  arithmetic_loader l;
  truth t;
  if (!load_variant(&l, which)) return;
  truth_open(&t);
  static program p;
  for (int i = 0; i < programs; i++) {
    stage s = stage_open(&l, NVAR, option);
    program_inputs(&p, NVAR, &seed);
    program_build(&p, &s, 60, &seed);
    for (uint32_t slot = 0; slot < p.tape->nslot; slot++) check_shape(&p, stage_at(&s, slot), slot, &t);
    for (int k = 0; k < 8; k++) {
      truth_sample(&t, &p, &s, &seed);
      for (uint32_t slot = 0; slot < p.tape->nslot; slot++) check_slot(&p, &s, &t, slot);
    }
    stage_close(&s);
  }
  truth_close(&t);
  arithmetic_unload(&l);
}

static void chebyshev_fast(void **state) {
  (void)state;
  for (size_t v = 0; v < 3; v++) form_holds(v, NULL, 40, 4711 + v);
}

static void chebyshev_tight(void **state) {
  (void)state;
  for (size_t v = 0; v < 3; v++) form_holds(v, (const double[]) { 100, 1, 0 }, 40, 1234 + v);
}

static void min_range(void **state) {
  (void)state;
  form_holds(0, (const double[]) { 100, 0, 1 }, 60, 99);
}

static void few_symbols(void **state) {
  (void)state;
  form_holds(0, (const double[]) { 0, 0, 0 }, 40, 5);
  form_holds(0, (const double[]) { 5, 1, 0 }, 40, 6);
}

/* a range of every kind: around points where functions bend, one ulp, subnormal, wide, huge */
static void nasty_range(uint64_t *r, double *lo, double *hi) {
  static const double centre[] = { 0, 1, -1, 0.5, 2, 0x1.921fb54442d18p+0, 0x1.921fb54442d18p+1, -0x1.2d97c7f3321d2p+2,
    100, 0x1.921fb54442d18p+7, 1e9, -1e15, 1e-5, 1e-300, 1e100, 700, -700 };
  double m = oracle_random(r) % 3 ? centre[oracle_random(r) % (sizeof centre / sizeof *centre)] : oracle_double(r);
  double w = ldexp(oracle_uniform(r, 0, 1), 3 - (int)(oracle_random(r) % 60)) * (oracle_random(r) % 4 ? 1 : fabs(m));
  switch (oracle_random(r) % 6) {
  case 0: *lo = m, *hi = nextafter(m, INFINITY); break;
  case 1: *lo = m, *hi = m + w; break;
  case 2: *lo = m - w, *hi = m; break;
  case 3: *lo = fmin(m, oracle_double(r)), *hi = m; break;
  default: *lo = m - w * oracle_uniform(r, 0, 1), *hi = m + w; break;
  }
  if (!(fabs(*lo) <= DBL_MAX && fabs(*hi) <= DBL_MAX)) *lo = -1, *hi = 1;
}

static void one_operation(const stage *s, truth *t, uint32_t op, uint64_t *seed) {
  static program p;
  tape_begin(&p.builder);
  for (uint32_t i = 0; i < 2; i++) {
    uint32_t slot = tape_input(&p.builder, 0);
    nasty_range(seed, &p.lo[slot], &p.hi[slot]);
  }
  uint32_t word = op == AMBIT_OP_POWN ? (uint32_t)((int32_t)(oracle_random(seed) % 19) - 9) : 1;
  tape_op(&p.builder, op, 0, word);
  p.tape = tape_seal(&p.builder, AMBIT_NO_SLOT);
  stage_inputs(s, &p);
  stage_run(s, op, 2, 0, word);
  for (uint32_t slot = 0; slot < 3; slot++) check_shape(&p, stage_at(s, slot), slot, t);
  for (int k = 0; k < 5; k++) {
    truth_sample(t, &p, s, seed);
    for (uint32_t slot = 0; slot < 3; slot++) check_slot(&p, s, t, slot);
  }
}

static void functions_on_nasty_ranges(void **state) {
  (void)state;
  arithmetic_loader l;
  truth t;
  uint64_t seed = 271828;
  load_variant(&l, 0);
  truth_open(&t);
  for (int i = 0; i < 3; i++) {
    stage s = stage_open(&l, NVAR, (const double[]) { 8, i == 1, i == 2 });
    for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++)
      for (int k = 0; k < 150; k++) one_operation(&s, &t, op, &seed);
    stage_close(&s);
  }
  truth_close(&t);
  arithmetic_unload(&l);
}

/* x^n about 1, where 2^31 factors are of some size: n - 1 need not be an int32 */
static void extreme_powers(void **state) {
  (void)state;
  static const int32_t power[] = { INT32_MIN, INT32_MIN + 1, INT32_MAX };
  arithmetic_loader l;
  truth t;
  static program p;
  uint64_t seed = 161803;
  load_variant(&l, 0);
  truth_open(&t);
  for (int i = 0; i < 600; i++) {
    stage s = stage_open(&l, NVAR, (const double[]) { 8, 0, i % 2 });
    double sign = i % 4 < 2 ? 1 : -1, centre = sign + ldexp(oracle_uniform(&seed, -1, 1), -29), width = 0x1p-30;
    tape_begin(&p.builder);
    p.lo[0] = centre - width, p.hi[0] = centre + width;
    tape_op(&p.builder, AMBIT_OP_POWN, tape_input(&p.builder, 0), (uint32_t)power[i % 3]);
    p.tape = tape_seal(&p.builder, AMBIT_NO_SLOT);
    stage_inputs(&s, &p);
    stage_run(&s, AMBIT_OP_POWN, 1, 0, (uint32_t)power[i % 3]);
    check_shape(&p, stage_at(&s, 1), 1, &t);
    for (int k = 0; k < 5; k++) truth_sample(&t, &p, &s, &seed), check_slot(&p, &s, &t, 1);
    stage_close(&s);
  }
  truth_close(&t);
  arithmetic_unload(&l);
}

/* Symbols of the last epoch are shared, those of older ones are each slot's own. For all weights w there must be
** values of the symbols: |sum w_s rest_s| <= sum_k |sum_s w_s coef_s,k| + sum_s |w_s| own_s (the separating form of a
** linear feasibility problem). */
static void check_combination(
    const program *p, const stage *s, truth *t, uint64_t epoch, const uint32_t *slot, const double *weight, size_t n) {
  static double shared[TRUTH_ERRORS];
  const uint64_t first = 2 * AFFINE_BLOCK;
  double own = 0;
  mpfr_t sum;
  mpfr_init2(sum, TRUTH_BITS), mpfr_set_zero(sum, 1);
  memset(shared, 0, sizeof shared);
  for (size_t j = 0; j < n; j++) {
    const affine_element *x = stage_at(s, slot[j]);
    truth_rest(t, p, x, slot[j]);
    mpfr_mul_d(t->rest, t->rest, weight[j], MPFR_RNDN), mpfr_add(sum, sum, t->rest, MPFR_RNDN);
    own += fabs(weight[j]) * x->err;
    for (uint64_t i = first; i < x->blocks * AFFINE_BLOCK; i++) {
      if (x->epoch == epoch)
        shared[i - first] += weight[j] * x->coef[i];
      else
        own += fabs(weight[j] * x->coef[i]);
    }
  }
  for (size_t k = 0; k < TRUTH_ERRORS; k++) own += fabs(shared[k]);
  mpfr_set(t->rest, sum, MPFR_RNDN), mpfr_clear(sum);
  double scale = 0, size = 0; /* the bound is computed in plain doubles, nearest */
  for (size_t j = 0; j < n; j++) {
    const affine_element *x = stage_at(s, slot[j]);
    scale += fabs(weight[j]) * x->rad, size += fabs(weight[j]) * (x->rad + fabs(x->centre));
  }
  if (!truth_within(t, own + 0x1p-44 * scale + 0x1p-1000, size))
    complain(p, slot[0], stage_at(s, slot[0]), t, "slots contradict");
}

static void run_tape(const stage *s, const program *p) {
  stage_inputs(s, p);
  s->l->full.enter(s->ctx);
  s->l->full.eval_tape(s->ctx, p->tape, s->base, 1, 1);
  s->l->full.leave(s->ctx);
}

static void check_tape(const program *p, const stage *s, truth *t, uint64_t *seed) {
  uint64_t epoch = 0;
  uint32_t usable[TRUTH_SLOTS], n = 0;
  truth_sample(t, p, s, seed);
  for (uint32_t slot = 0; slot < p->tape->nslot; slot++) {
    const affine_element *x = stage_at(s, slot);
    if (mpfr_nan_p(t->value[slot])) continue;
    if (!truth_in_hull(t, stage_bounds(s, slot), slot)) complain(p, slot, x, t, "outside the hull");
    if (!(x->rad < INFINITY)) continue;
    usable[n++] = slot;
    if (x->blocks > 2 && x->epoch > epoch) epoch = x->epoch;
  }
  for (int i = 0; i < 100 && n; i++) {
    uint32_t slot[3];
    double weight[3];
    size_t m = 1 + oracle_random(seed) % 3;
    for (size_t j = 0; j < m; j++) {
      slot[j] = usable[oracle_random(seed) % n];
      double rad = stage_at(s, slot[j])->rad;
      weight[j] = oracle_uniform(seed, -1, 1) / (rad > 0x1p-500 ? rad : 1);
    }
    check_combination(p, s, t, epoch, slot, weight, m);
  }
}

static void tapes_hold(void **state) {
  (void)state;
  arithmetic_loader l;
  truth t;
  uint64_t seed = 31415;
  static program p;
  load_variant(&l, 0);
  truth_open(&t);
  for (int i = 0; i < 60; i++) {
    const double option[3] = { (double[]) { 0, 1, 3, 6, 12, 60 }[i % 6], i % 2, i % 5 == 0 };
    stage build = stage_open(&l, NVAR, NULL), s = stage_open(&l, NVAR, option);
    program_inputs(&p, NVAR, &seed);
    program_build(&p, &build, 80, &seed);
    for (int again = 0; again < 2; again++) run_tape(&s, &p); /* symbols are reused */
    for (int k = 0; k < 5; k++) check_tape(&p, &s, &t, &seed);
    stage_close(&build), stage_close(&s);
  }
  truth_close(&t);
  arithmetic_unload(&l);
}

/* Eight slots s_k = x_k^2 + k x_8, each used twice, with error symbols of 1/2 in a radius of 1/2 + k; capacity 8, so a
** ninth symbol makes the two least important go, those of k = 6 and 7. The sum of all slots minus the same sum, 0 but
** for roundings, may then have a radius of 2 L (w_6 + w_7), L the largest radius, w the weights of condense.c. */
static double condensed_radius(arithmetic_loader *l, double symbols) {
  static tape_builder b;
  stage s = stage_open(l, 10, (const double[]) { symbols, 0, 0 });
  uint32_t factor[8], slot[8];
  tape_begin(&b);
  for (uint32_t k = 0; k < 8; k++) factor[k] = tape_constant(&b, k, k);
  for (uint32_t v = 0; v < 10; v++) tape_input(&b, 0);
  for (uint32_t k = 0; k < 8; k++)
    slot[k] = tape_op(&b, AMBIT_OP_ADD, tape_unary(&b, AMBIT_OP_SQR, 8 + k), tape_op(&b, AMBIT_OP_MUL, factor[k], 16));
  uint32_t ninth = tape_unary(&b, AMBIT_OP_EXP, 17), up = slot[0], down = slot[7];
  tape_op(&b, AMBIT_OP_ADD, ninth, ninth);
  for (uint32_t k = 1; k < 8; k++)
    up = tape_op(&b, AMBIT_OP_ADD, up, slot[k]), down = tape_op(&b, AMBIT_OP_ADD, down, slot[7 - k]);
  uint32_t out = tape_op(&b, AMBIT_OP_SUB, up, down);
  const ambit_tape *t = tape_seal(&b, AMBIT_NO_SLOT);
  b.tape.nout = 1, b.out[0] = out;
  for (uint32_t k = 0; k < 8; k++) stage_set(&s, k, k, k, -1);
  for (uint32_t v = 0; v < 10; v++) stage_set(&s, 8 + v, -1, 1, (int32_t)v);
  l->full.enter(s.ctx), l->full.eval_tape(s.ctx, t, s.base, 1, 1), l->full.leave(s.ctx);
  double radius = stage_at(&s, out)->rad;
  stage_close(&s);
  return radius;
}

static void condensation_loses_what_is_said(void **state) {
  (void)state;
  arithmetic_loader l;
  load_variant(&l, 0);
  double all = condensed_radius(&l, 20), some = condensed_radius(&l, 8), none = condensed_radius(&l, 0);
  double w6 = 0.5 / 6.5, w7 = 0.5 / 7.5, largest = 7.5;
  assert_true(all < 1e-12);
  assert_true(some > 1.99 && some <= 2 * largest * (w6 + w7));
  assert_true(none > 7.99 && none < 8.01);
  arithmetic_unload(&l);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(chebyshev_fast),
    cmocka_unit_test(chebyshev_tight),
    cmocka_unit_test(min_range),
    cmocka_unit_test(few_symbols),
    cmocka_unit_test(functions_on_nasty_ranges),
    cmocka_unit_test(extreme_powers),
    cmocka_unit_test(tapes_hold),
    cmocka_unit_test(condensation_loses_what_is_said),
  };
  return cmocka_run_group_tests_name("arithmetic affine: forms", tests, NULL, NULL);
}
