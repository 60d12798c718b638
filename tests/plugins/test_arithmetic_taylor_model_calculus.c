/* "ambit.taylor/1": access, ranges, products of nasty coefficients, composition, parts of the domain, integration and
** derivation, against MPFR. */
#include "taylor_case.h"

enum { A, B, C, R, W, SLOTS = 16 };

static uint64_t seed = 1618033;

static double step(void) { return ldexp((double)(oracle_random(&seed) % 129) - 64, -6); } /* in [-1, 1], few bits */

static uint32_t degree_of(const taylor_case *c, uint32_t i) {
  uint32_t exponent[256], degree = 0;
  c->t->exponents(c->ctx, i, exponent);
  for (uint32_t v = 0; v < c->nvar; v++) degree += exponent[v];
  return degree;
}

/* a random polynomial with a share of the monomials, of size 2^exponent * [-1, 1] */
static void random_model(const taylor_case *c, uint32_t slot, int exponent, int spread, uint32_t share, double rest) {
  static uint32_t index[1 << 16];
  static double value[1 << 16];
  uint32_t n = 0;
  for (uint32_t i = 0; i < c->count; i++) {
    if (oracle_random(&seed) % 100 >= share) continue;
    int e = exponent + (spread ? (int)(oracle_random(&seed) % (uint64_t)(2 * spread + 1)) - spread : 0);
    index[n] = i, value[n++] = ldexp(oracle_uniform(&seed, -1, 1), e);
  }
  c->t->build(c->ctx, taylor_at(c, slot, 0), n, index, value, -rest, rest);
}

static void names_monomials(void **state) {
  (void)state;
  static const uint32_t shape[][2] = { { 0, 3 }, { 1, 60 }, { 3, 0 }, { 4, 1 }, { 2, 9 }, { 5, 4 }, { 30, 2 } };
  for (size_t s = 0; s < sizeof shape / sizeof *shape; s++) {
    taylor_case c;
    uint32_t exponent[256], before = 0;
    taylor_open(&c, 0, shape[s][0], shape[s][1], 1, 1);
    double count = 1;
    for (uint32_t k = 1; k <= shape[s][1] && shape[s][0]; k++) count = count * (shape[s][0] + k) / k;
    assert_true(c.count == (uint32_t)(count + 0.5));
    for (uint32_t i = 0; i < c.count; i++) {
      c.t->exponents(c.ctx, i, exponent);
      assert_int_equal(c.t->index(c.ctx, exponent), i);
      assert_true(degree_of(&c, i) >= before);
      before = degree_of(&c, i);
    }
    for (uint32_t v = 0; v < c.nvar; v++) exponent[v] = v == 0 ? c.order + 1 : 0;
    if (c.nvar) assert_true(c.t->index(c.ctx, exponent) == UINT32_MAX);
    taylor_close(&c);
  }
}

/* -- products: the element must contain the product of any two functions that its operands contain */

/* r += rest, but not beyond the element's bounds */
static void to_end(const taylor_case *c, uint32_t slot, mpfr_t r, double rest) {
  double lo, hi;
  c->a->bounds(c->ctx, taylor_at(c, slot, 0), 1, &lo, &hi);
  if (isfinite(rest)) mpfr_add_d(r, r, rest, MPFR_RNDN);
  if (mpfr_cmp_d(r, lo) < 0) mpfr_set_d(r, fmax(lo, -DBL_MAX), MPFR_RNDN);
  if (mpfr_cmp_d(r, hi) > 0) mpfr_set_d(r, fmin(hi, DBL_MAX), MPFR_RNDN);
}

/* operands p +- r at x, all the way to an end of the remainder */
static void judge_product(const taylor_case *c, const double *x) {
  mpfr_t a, b;
  mpfr_inits2(TAYLOR_BITS, a, b, (mpfr_ptr)0);
  for (int ends = 0; ends < 4; ends++) {
    double ra = c->t->remainder(c->ctx, taylor_at(c, A, 0)), rb = c->t->remainder(c->ctx, taylor_at(c, B, 0));
    taylor_value(c, taylor_at(c, A, 0), x, a), taylor_value(c, taylor_at(c, B, 0), x, b);
    to_end(c, A, a, ends & 1 ? ra : -ra), to_end(c, B, b, ends & 2 ? rb : -rb);
    mpfr_mul(a, a, b, MPFR_RNDN);
    if (!taylor_holds(c, taylor_at(c, R, 0), x, a, 0)) fail_msg("order %u, %u variables: product", c->order, c->nvar);
  }
  mpfr_clears(a, b, (mpfr_ptr)0);
}

static void products(void **state) {
  (void)state;
  static const uint32_t shape[][2] = { { 0, 4 }, { 1, 0 }, { 1, 40 }, { 2, 1 }, { 2, 12 }, { 3, 5 }, { 4, 6 }, { 5, 3 },
    { 24, 2 }, { 60, 1 } };
  /* size of one operand, of the other, and how much their coefficients vary */
  static const int size[][3] = { { 0, 0, 0 }, { 0, 0, 40 }, { 900, -1000, 60 }, { -500, -560, 10 }, { -1060, -3, 12 },
    { 480, 490, 20 }, { 511, 511, 0 }, { -1074, 0, 0 }, { -530, -530, 4 } };
  for (size_t s = 0; s < sizeof shape / sizeof *shape; s++)
    for (int which = 0; which < 3; which++) {
      taylor_case c;
      taylor_open(&c, which, shape[s][0], shape[s][1], SLOTS, 1);
      for (size_t k = 0; k < sizeof size / sizeof *size; k++)
        for (uint32_t share = 5; share <= 105; share += 50) {
          random_model(&c, A, size[k][0], size[k][2], share, k % 2 ? ldexp(1, size[k][0] - 30) : 0);
          random_model(&c, B, size[k][1], size[k][2], share + 30, k % 3 ? ldexp(1, size[k][1] - 40) : 0);
          c.t->product(c.ctx, taylor_at(&c, R, 0), taylor_at(&c, A, 0), taylor_at(&c, B, 0));
          double x[64];
          for (int sample = 0; sample < 2; sample++) {
            for (uint32_t v = 0; v < c.nvar; v++) x[v] = sample ? step() : oracle_random(&seed) % 2 ? 1 : -1;
            judge_product(&c, x);
          }
        }
      taylor_close(&c);
    }
}

/* 3003 products, each of which is rounded to 0: at (1, 1, 1, 1) the losses add up */
static void underflows(void **state) {
  (void)state;
  static uint32_t index[210];
  static double value[210];
  const double corner[4] = { 1, 1, 1, 1 };
  for (int which = 0; which < 3; which++) {
    taylor_case c;
    taylor_open(&c, which, 4, 6, SLOTS, 1);
    assert_int_equal(c.count, 210);
    for (uint32_t i = 0; i < c.count; i++) index[i] = i, value[i] = 0x1.2p-538;
    for (uint32_t slot = A; slot <= B; slot++) c.t->build(c.ctx, taylor_at(&c, slot, 0), c.count, index, value, 0, 0);
    c.t->product(c.ctx, taylor_at(&c, R, 0), taylor_at(&c, A, 0), taylor_at(&c, B, 0));
    judge_product(&c, corner);
    taylor_close(&c);
  }
}

/* -- ranges */

static void ranges(void **state) {
  (void)state;
  static const uint32_t shape[][2] = { { 1, 12 }, { 2, 2 }, { 2, 7 }, { 3, 4 }, { 6, 3 }, { 20, 2 }, { 3, 1 } };
  for (size_t s = 0; s < sizeof shape / sizeof *shape; s++) {
    taylor_case c;
    taylor_open(&c, (int)(s % 3), shape[s][0], shape[s][1], SLOTS, 1);
    for (int round = 0; round < 60; round++) {
      double lo, hi, last_lo = -INFINITY, last_hi = INFINITY, x[64];
      random_model(&c, A, 0, round % 3 * 4, round % 2 ? 100 : 30, 0);
      for (uint32_t boxes = 0; boxes <= 16; boxes = boxes ? boxes * 4 : 1) {
        c.t->range(c.ctx, taylor_at(&c, A, 0), boxes, &lo, &hi);
        assert_true(last_lo <= lo && lo <= hi && hi <= last_hi); /* more boxes are never worse */
        last_lo = lo, last_hi = hi;
      }
      mpfr_t p;
      mpfr_init2(p, TAYLOR_BITS);
      for (int sample = 0; sample < 60; sample++) {
        for (uint32_t v = 0; v < c.nvar; v++)
          x[v] = oracle_random(&seed) % 3 ? step() : oracle_random(&seed) % 2 ? 1 : -1;
        taylor_value(&c, taylor_at(&c, A, 0), x, p);
        if (mpfr_cmp_d(p, lo) < 0 || mpfr_cmp_d(p, hi) > 0)
          fail_msg("%u variables, order %u: %.17g outside [%.17g, %.17g]", c.nvar, c.order, mpfr_get_d(p, MPFR_RNDN),
              lo, hi);
      }
      mpfr_clear(p);
    }
    taylor_close(&c);
  }
}

/* known ranges: how tight */
static void tight_ranges(void **state) {
  (void)state;
  taylor_case c;
  double lo, hi;
  taylor_open(&c, 0, 2, 4, SLOTS, 1);
  const uint32_t x[] = { 1, 0 }, xx[] = { 2, 0 }, xy[] = { 1, 1 }, yy[] = { 0, 2 };
  uint32_t index[] = { c.t->index(c.ctx, x), c.t->index(c.ctx, xx), c.t->index(c.ctx, xy), c.t->index(c.ctx, yy) };
  c.t->build(c.ctx, taylor_at(&c, A, 0), 2, index, (const double[]) { 1, 1 }, 0, 0); /* x + x^2 in [-1/4, 2] */
  c.t->range(c.ctx, taylor_at(&c, A, 0), 0, &lo, &hi);
  assert_true(lo <= -0.25 && lo > -0.25 - 1e-12 && hi >= 2 && hi < 2 + 1e-12);
  c.t->build(c.ctx, taylor_at(&c, A, 0), 3, index + 1, (const double[]) { 1, 2, 1 }, 0, 0); /* (x + y)^2 in [0, 4] */
  c.t->range(c.ctx, taylor_at(&c, A, 0), 16, &lo, &hi);
  assert_true(lo <= 0 && lo > -0.6 && hi >= 4 && hi < 4 + 1e-12);
  c.t->build(c.ctx, taylor_at(&c, A, 0), 3, index, (const double[]) { 1, 0.125, 0.25 }, 0, 0); /* monotone in x */
  c.t->range(c.ctx, taylor_at(&c, A, 0), 1, &lo, &hi);
  assert_true(lo <= -1.125 && lo > -1.125 - 1e-12 && hi >= 1.375 && hi < 1.375 + 1e-12);
  taylor_close(&c);
}

static void evaluates(void **state) {
  (void)state;
  taylor_case c;
  taylor_open(&c, 0, 3, 5, SLOTS, 1);
  for (int round = 0; round < 200; round++) {
    double at_lo[3], at_hi[3], x[3], lo, hi;
    random_model(&c, A, 0, 3, 60, 0x1p-20);
    for (int v = 0; v < 3; v++) {
      double a = step(), b = round % 3 ? step() : a;
      at_lo[v] = fmin(a, b), at_hi[v] = fmax(a, b);
      x[v] = (at_lo[v] + at_hi[v]) / 2;
    }
    c.t->evaluate(c.ctx, taylor_at(&c, A, 0), at_lo, at_hi, &lo, &hi);
    mpfr_t p;
    mpfr_init2(p, TAYLOR_BITS);
    taylor_value(&c, taylor_at(&c, A, 0), x, p);
    mpfr_add_d(p, p, round % 2 ? 0x1p-20 : -0x1p-20, MPFR_RNDN);
    assert_true(mpfr_cmp_d(p, lo) >= 0 && mpfr_cmp_d(p, hi) <= 0);
    if (round % 3 == 0) assert_true(hi - lo < 0x1.0001p-19);
    mpfr_clear(p);
  }
  taylor_close(&c);
}

/* Evaluation and products share a context, but nothing of what one writes may show in the other. */
static void evaluating_leaves_products_alone(void **state) {
  (void)state;
  static const uint32_t shape[][2] = { { 1, 9 }, { 1, 60 }, { 2, 12 }, { 4, 6 }, { 12, 3 } };
  for (size_t s = 0; s < sizeof shape / sizeof *shape; s++)
    for (int which = 0; which < 3; which++) {
      taylor_case c;
      double x[16], lo, hi;
      taylor_open(&c, which, shape[s][0], shape[s][1], SLOTS, 1);
      random_model(&c, A, 0, 0, 100, 0), random_model(&c, B, 0, 0, 100, 0);
      for (uint32_t v = 0; v < c.nvar; v++) x[v] = 0.75;
      for (uint32_t right = A; right <= B; right++) { /* a square, too */
        c.t->product(c.ctx, taylor_at(&c, R, 0), taylor_at(&c, A, 0), taylor_at(&c, right, 0));
        c.t->evaluate(c.ctx, taylor_at(&c, A, 0), x, x, &lo, &hi);
        c.t->product(c.ctx, taylor_at(&c, C, 0), taylor_at(&c, A, 0), taylor_at(&c, right, 0));
        assert_true(c.t->remainder(c.ctx, taylor_at(&c, C, 0)) == c.t->remainder(c.ctx, taylor_at(&c, R, 0)));
        for (uint32_t i = 0; i < c.count; i++)
          assert_true(
              c.t->coefficient(c.ctx, taylor_at(&c, C, 0), i) == c.t->coefficient(c.ctx, taylor_at(&c, R, 0), i));
      }
      taylor_close(&c);
    }
}

/* Coefficients so large that moving the domain may overflow: 1 - x + x^2 - ... about -1/2 */
static void overflows(void **state) {
  (void)state;
  enum { ORDER = 60 };
  taylor_case c;
  uint32_t index[ORDER + 1];
  double value[ORDER + 1];
  taylor_open(&c, 0, 1, ORDER, SLOTS, 1);
  for (int exponent = 984; exponent < 1002; exponent++)
    for (int round = 0; round < 20; round++) {
      const double part_lo = -0.96875, part_hi = -0.03125;
      double lo, hi, part[2];
      for (uint32_t i = 0; i <= ORDER; i++)
        index[i] = i, value[i] = ldexp(oracle_uniform(&seed, 0, i % 2 ? -1 : 1), exponent);
      if (round % 2) value[ORDER - 1] *= -1;
      c.t->build(c.ctx, taylor_at(&c, A, 0), ORDER + 1, index, value, 0, 0);
      c.a->bounds(c.ctx, taylor_at(&c, A, 0), 1, &lo, &hi);
      c.t->restrict_to(c.ctx, taylor_at(&c, R, 0), taylor_at(&c, A, 0), &part_lo, &part_hi);
      c.a->bounds(c.ctx, taylor_at(&c, R, 0), 1, &part[0], &part[1]);
      mpfr_t p;
      mpfr_init2(p, TAYLOR_BITS);
      for (int k = -32; k <= 32; k += 4) {
        double y = k / 32.0, x = -0.5 + 0.46875 * y;
        mpfr_set_d(p, 0, MPFR_RNDN);
        for (uint32_t i = ORDER + 1; i-- > 0;) mpfr_mul_d(p, p, x, MPFR_RNDN), mpfr_add_d(p, p, value[i], MPFR_RNDN);
        assert_true(mpfr_cmp_d(p, lo) >= 0 && mpfr_cmp_d(p, hi) <= 0);
        assert_true(mpfr_cmp_d(p, part[0]) >= 0 && mpfr_cmp_d(p, part[1]) <= 0);
        assert_true(taylor_holds(&c, taylor_at(&c, R, 0), &y, p, 0));
        mpfr_set_d(p, 0, MPFR_RNDN);
        for (uint32_t i = ORDER + 1; i-- > 0;) mpfr_mul_d(p, p, y, MPFR_RNDN), mpfr_add_d(p, p, value[i], MPFR_RNDN);
        assert_true(taylor_holds(&c, taylor_at(&c, A, 0), &y, p, 0));
      }
      mpfr_clear(p);
    }
  taylor_close(&c);
}

/* -- composition and parts of the domain */

static void composes(void **state) {
  (void)state;
  static const uint32_t shape[][2] = { { 1, 9 }, { 2, 4 }, { 3, 3 }, { 6, 2 } };
  for (size_t s = 0; s < sizeof shape / sizeof *shape; s++) {
    taylor_case c;
    taylor_open(&c, (int)(s % 3), shape[s][0], shape[s][1], SLOTS, 1);
    for (int round = 0; round < 40; round++) {
      random_model(&c, A, 0, 2, 70, 0x1p-25);
      for (uint32_t v = 0; v < c.nvar; v++) random_model(&c, W + v, -7 - (int)c.order, 1, 60, 0x1p-30);
      uint32_t flags = c.t->compose(c.ctx, taylor_at(&c, R, 0), taylor_at(&c, A, 0), taylor_at(&c, W, 0));
      assert_int_equal(flags, 0);
      double x[8], w[8];
      mpfr_t p, inner;
      mpfr_inits2(TAYLOR_BITS, p, inner, (mpfr_ptr)0);
      for (uint32_t v = 0; v < c.nvar; v++) x[v] = step();
      for (uint32_t v = 0; v < c.nvar; v++) { /* a double within w_v at x, so that the outer value is exact */
        taylor_value(&c, taylor_at(&c, W + v, 0), x, inner);
        w[v] = mpfr_get_d(inner, MPFR_RNDN) + (round % 2 ? 0x1p-31 : -0x1p-31);
      }
      taylor_value(&c, taylor_at(&c, A, 0), w, p);
      mpfr_add_d(p, p, round % 3 ? 0x1p-25 : -0x1p-25, MPFR_RNDN);
      assert_true(taylor_holds(&c, taylor_at(&c, R, 0), x, p, 0));
      mpfr_clears(p, inner, (mpfr_ptr)0);
    }
    double three = 3;
    c.a->set(c.ctx, taylor_at(&c, W, 0), 1, &three, &three, -1);
    uint32_t flags = c.t->compose(c.ctx, taylor_at(&c, R, 0), taylor_at(&c, A, 0), taylor_at(&c, W, 0));
    assert_int_equal(flags, AMBIT_F_PARTIAL | AMBIT_F_EMPTY); /* 3 is outside the domain */
    taylor_close(&c);
  }
}

static void restricts(void **state) {
  (void)state;
  static const uint32_t shape[][2] = { { 1, 20 }, { 2, 6 }, { 5, 3 } };
  for (size_t s = 0; s < sizeof shape / sizeof *shape; s++) {
    taylor_case c;
    taylor_open(&c, 0, shape[s][0], shape[s][1], SLOTS, 1);
    for (int round = 0; round < 60; round++) {
      double lo[8], hi[8], x[8], y[8];
      random_model(&c, A, 0, 3, 70, 0x1p-40);
      for (uint32_t v = 0; v < c.nvar; v++) {
        double a = step(), b = step();
        lo[v] = fmin(a, b), hi[v] = fmax(a, b), y[v] = step();
        x[v] = (lo[v] + hi[v]) / 2 + (hi[v] - lo[v]) / 2 * y[v];
      }
      assert_int_equal(c.t->restrict_to(c.ctx, taylor_at(&c, R, 0), taylor_at(&c, A, 0), lo, hi), 0);
      mpfr_t p;
      mpfr_init2(p, TAYLOR_BITS);
      taylor_value(&c, taylor_at(&c, A, 0), x, p);
      mpfr_add_d(p, p, round % 2 ? 0x1p-40 : -0x1p-40, MPFR_RNDN);
      assert_true(taylor_holds(&c, taylor_at(&c, R, 0), y, p, 0));
      assert_true(c.t->remainder(c.ctx, taylor_at(&c, R, 0)) < 0x1p-36);
      mpfr_clear(p);
    }
    const double bad = 2, good = 0;
    double all_bad[8], all_good[8];
    for (int v = 0; v < 8; v++) all_bad[v] = bad, all_good[v] = good;
    assert_int_equal(
        c.t->restrict_to(c.ctx, taylor_at(&c, R, 0), taylor_at(&c, A, 0), all_good, all_bad), AMBIT_F_UNBOUNDED);
    taylor_close(&c);
  }
}

/* -- integration and derivation: the exact integral, from its coefficients */

static void exact_integral(const taylor_case *c, uint32_t slot, uint32_t var, const double *x, mpfr_t r) {
  static uint32_t index[1 << 12];
  static double value[1 << 12];
  uint32_t exponent[64], n = c->t->terms(c->ctx, taylor_at(c, slot, 0), index, value);
  mpfr_t term;
  mpfr_init2(term, TAYLOR_BITS);
  mpfr_set_d(r, 0, MPFR_RNDN);
  for (uint32_t i = 0; i < n; i++) {
    c->t->exponents(c->ctx, index[i], exponent);
    mpfr_set_d(term, value[i], MPFR_RNDN);
    mpfr_div_ui(term, term, exponent[var] + 1, MPFR_RNDN);
    exponent[var]++;
    for (uint32_t v = 0; v < c->nvar; v++)
      for (uint32_t k = 0; k < exponent[v]; k++) mpfr_mul_d(term, term, x[v], MPFR_RNDN);
    mpfr_add(r, r, term, MPFR_RNDN);
  }
  mpfr_clear(term);
}

static void integrates_and_derives(void **state) {
  (void)state;
  static const uint32_t shape[][2] = { { 1, 15 }, { 2, 5 }, { 4, 3 }, { 3, 0 } };
  for (size_t s = 0; s < sizeof shape / sizeof *shape; s++) {
    taylor_case c;
    taylor_open(&c, 0, shape[s][0], shape[s][1], SLOTS, 1);
    for (int round = 0; round < 60; round++) {
      uint32_t var = (uint32_t)(oracle_random(&seed) % c.nvar);
      double x[8];
      mpfr_t p;
      mpfr_init2(p, TAYLOR_BITS);
      random_model(&c, A, 0, round % 4 * 20, 60, 0x1p-30);
      for (uint32_t v = 0; v < c.nvar; v++) x[v] = step();
      assert_int_equal(c.t->integrate(c.ctx, taylor_at(&c, R, 0), taylor_at(&c, A, 0), var), 0);
      exact_integral(&c, A, var, x, p);
      mpfr_add_d(p, p, 0x1p-30 * x[var], MPFR_RNDN); /* the integral of the remainder's upper end */
      assert_true(taylor_holds(&c, taylor_at(&c, R, 0), x, p, 0));
      if (c.order > 0) { /* the derivative of the integral's polynomial is the integrand without its highest degree */
        c.t->derive(c.ctx, taylor_at(&c, B, 0), taylor_at(&c, R, 0), var);
        for (uint32_t i = 0; i < c.count; i++) {
          double was = degree_of(&c, i) < c.order ? c.t->coefficient(c.ctx, taylor_at(&c, A, 0), i) : 0;
          double is = c.t->coefficient(c.ctx, taylor_at(&c, B, 0), i);
          assert_true(fabs(is - was) <= 0x1p-50 * fabs(was) + 0x1p-30);
        }
      }
      mpfr_clear(p);
    }
    assert_int_equal(c.t->integrate(c.ctx, taylor_at(&c, R, 0), taylor_at(&c, A, 0), c.nvar), AMBIT_F_UNBOUNDED);
    assert_int_equal(c.t->derive(c.ctx, taylor_at(&c, R, 0), taylor_at(&c, A, 0), c.nvar), AMBIT_F_UNBOUNDED);
    taylor_close(&c);
  }
}

static void widens(void **state) {
  (void)state;
  taylor_case c;
  double lo, hi;
  taylor_open(&c, 0, 2, 3, SLOTS, 1);
  random_model(&c, A, 0, 0, 100, 0);
  c.a->bounds(c.ctx, taylor_at(&c, A, 0), 1, &lo, &hi);
  assert_int_equal(c.t->widen(c.ctx, taylor_at(&c, A, 0), 1, 3), 0);
  double r = c.t->remainder(c.ctx, taylor_at(&c, A, 0)), wide_lo, wide_hi;
  c.a->bounds(c.ctx, taylor_at(&c, A, 0), 1, &wide_lo, &wide_hi);
  assert_true(r >= 1 && r < 1.0001 && wide_lo <= lo + 1 && wide_hi >= hi + 3 && wide_lo > lo + 0.99);
  assert_int_equal(c.t->widen(c.ctx, taylor_at(&c, A, 0), -INFINITY, 0), AMBIT_F_UNBOUNDED);
  c.t->build(c.ctx, taylor_at(&c, A, 0), 0, NULL, NULL, 2, 1);
  c.a->bounds(c.ctx, taylor_at(&c, A, 0), 1, &lo, &hi);
  assert_true(lo > hi);
  taylor_close(&c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(names_monomials),
    cmocka_unit_test(products),
    cmocka_unit_test(underflows),
    cmocka_unit_test(ranges),
    cmocka_unit_test(tight_ranges),
    cmocka_unit_test(evaluates),
    cmocka_unit_test(evaluating_leaves_products_alone),
    cmocka_unit_test(overflows),
    cmocka_unit_test(composes),
    cmocka_unit_test(restricts),
    cmocka_unit_test(integrates_and_derives),
    cmocka_unit_test(widens),
  };
  return cmocka_run_group_tests_name("ambit.taylor", tests, NULL, NULL);
}
