/* Functions of polynomials with a radius, from inside: for every xi of the cube and every point within the radii of the
** operands the value is within the radius of the result's polynomial. Intervals of constants are held, too. Small
** coefficients leave the radii to decide, large ones the residual. MPFR is the judge. */
#define sum_convolve_avx2 sum_convolve_portable /* needs flags of its own */
#include "solver/taylor_model/portable.c"
#include "solver/taylor_model/space.c"
#include "solver/taylor_model/series.h"
#include "host/services.h"
#include "kit/tape_builder.h"
#include "num/random.h"
#include <mpfr.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define UNKNOWNS 2
#define DEGREE 4
#define BITS 300

static ambit_random draws = { 1 };
static double between(double lo, double hi) { return ambit_random_in(&draws, (ambit_interval) { lo, hi }); }
static uint32_t below(uint32_t n) { return (uint32_t)(ambit_random_bits(&draws) >> 32) % n; }

typedef struct sample {
  ambit_scope *scope;
  space space;
  series_source source;
  tape_builder tape;
  uint32_t a, b, result;
  void *self;
} sample;

/* one operation on two inputs, or on the first */
static void sample_open(sample *s, uint32_t op) {
  assert_int_equal(ambit_scope_open(&s->scope, NULL, NULL), AMBIT_OK);
  const ambit_host *h = &s->scope->host;
  assert_int_equal(space_open(h, &s->space, UNKNOWNS, DEGREE), AMBIT_OK);
  s->source = (series_source) { &s->space, h->service(h, AMBIT_NUM_SERVICE), NULL };
  tape_builder *t = &s->tape;
  tape_begin(t);
  uint32_t one = tape_constant(t, 1, 1);
  s->a = tape_input(t, AMBIT_DEGREE_ANY), s->b = tape_input(t, AMBIT_DEGREE_ANY);
  s->result = tape_op(t, op, s->a, op == AMBIT_OP_ATAN2 || op == AMBIT_OP_DIV ? s->b : s->a);
  const ambit_tape *tape = tape_seal(t, one);
  assert_int_equal(series_jets.open(h, &s->source, tape, 0, 0, NULL, &s->self), AMBIT_OK);
}

static void sample_close(sample *s) {
  series_jets.close(s->self);
  ambit_scope_close(s->scope);
}

/* `about` and monomials of the given size in all, +- rad */
static AMBIT_WORKER void put(sample *s, uint32_t in, double about, double size, double rad) {
  double c[MONOMIALS_MAX * 2] = { 0 };
  for (uint32_t r = 0; r < s->space.nrow; r++)
    for (uint32_t j = 0; j < s->space.row[r].length; j++)
      c[s->space.row[r].at + j] = between(-size, size) / s->space.count;
  c[s->space.row[0].at] = about;
  series_put(s->source.made, in, c, rad);
}

/* r := the polynomial at xi */
static void value(mpfr_t r, const sample *s, cell x, const double *xi) {
  mpfr_t term;
  mpfr_init2(term, BITS);
  mpfr_set_zero(r, 1);
  for (uint32_t n = 0; n < s->space.nrow; n++)
    for (uint32_t j = 0; j < s->space.row[n].length; j++) {
      mpfr_set_d(term, x.c[s->space.row[n].at + j], MPFR_RNDN);
      for (uint32_t k = 0; k < j; k++) mpfr_mul_d(term, term, xi[0], MPFR_RNDN);
      for (uint32_t v = 1; v < UNKNOWNS; v++)
        for (uint32_t k = 0; k < s->space.exponent[n * UNKNOWNS + v]; k++) mpfr_mul_d(term, term, xi[v], MPFR_RNDN);
      mpfr_add(r, r, term, MPFR_RNDN);
    }
  mpfr_clear(term);
}

static void apply(uint32_t op, mpfr_t r, mpfr_t a, mpfr_t b) {
  switch (op) {
  case AMBIT_OP_DIV: mpfr_div(r, a, b, MPFR_RNDN); break;
  case AMBIT_OP_SQRT: mpfr_sqrt(r, a, MPFR_RNDN); break;
  case AMBIT_OP_EXP: mpfr_exp(r, a, MPFR_RNDN); break;
  case AMBIT_OP_LOG: mpfr_log(r, a, MPFR_RNDN); break;
  case AMBIT_OP_SIN: mpfr_sin(r, a, MPFR_RNDN); break;
  case AMBIT_OP_COS: mpfr_cos(r, a, MPFR_RNDN); break;
  case AMBIT_OP_SINH: mpfr_sinh(r, a, MPFR_RNDN); break;
  case AMBIT_OP_COSH: mpfr_cosh(r, a, MPFR_RNDN); break;
  case AMBIT_OP_TANH: mpfr_tanh(r, a, MPFR_RNDN); break;
  case AMBIT_OP_ATAN: mpfr_atan(r, a, MPFR_RNDN); break;
  case AMBIT_OP_ATAN2: mpfr_atan2(r, a, b, MPFR_RNDN); break;
  case AMBIT_OP_SQR: mpfr_sqr(r, a, MPFR_RNDN); break;
  default: fail();
  }
}

static double corner_or_inside(double most) {
  uint32_t way = below(4);
  return way == 0 ? -most : way == 1 ? between(-most, most) : most;
}

static void check(sample *s, uint32_t op) {
  series *made = s->source.made;
  cell y = series_cell(made, s->result, 0), a = series_cell(made, s->a, 0), b = series_cell(made, s->b, 0);
  mpfr_t x[2], r, p;
  mpfr_inits2(BITS, x[0], x[1], r, p, (mpfr_ptr)0);
  for (int n = 0; n < 8; n++) {
    double xi[UNKNOWNS];
    for (size_t v = 0; v < UNKNOWNS; v++) xi[v] = corner_or_inside(1);
    value(x[0], s, a, xi), value(x[1], s, b, xi), value(p, s, y, xi);
    mpfr_add_d(x[0], x[0], corner_or_inside(cell_rad(a)), MPFR_RNDN);
    mpfr_add_d(x[1], x[1], corner_or_inside(cell_rad(b)), MPFR_RNDN);
    apply(op, r, x[0], x[1]);
    mpfr_sub(r, r, p, MPFR_RNDN);
    mpfr_abs(r, r, MPFR_RNDN);
    assert_true(mpfr_cmp_d(r, cell_rad(y)) <= 0);
  }
  mpfr_clears(x[0], x[1], r, p, (mpfr_ptr)0);
}

static AMBIT_WORKER int advance(sample *s) { return series_jets.advance(s->self, 0) == 0; }

static void functions_hold_all_values(void **unused) {
  (void)unused;
  static const uint32_t op[] = { AMBIT_OP_DIV, AMBIT_OP_SQRT, AMBIT_OP_EXP, AMBIT_OP_LOG, AMBIT_OP_SIN, AMBIT_OP_COS,
    AMBIT_OP_SINH, AMBIT_OP_COSH, AMBIT_OP_TANH, AMBIT_OP_ATAN, AMBIT_OP_ATAN2, AMBIT_OP_SQR };
  static const double size[] = { 1e-5, 1e-2, 0.3 }, radius[] = { 0, 1e-12, 1e-3, 0.05 };
  sample s;
  for (size_t k = 0; k < sizeof op / sizeof *op; k++) {
    int known = 0;
    sample_open(&s, op[k]);
    for (int n = 0; n < 600; n++) {
      int any_sign = op[k] == AMBIT_OP_ATAN2 || (op[k] != AMBIT_OP_SQRT && op[k] != AMBIT_OP_LOG);
      ambit_rounding old = ambit_round_up();
      put(&s, 0, between(any_sign ? -2 : 0.5, 2), size[n % 3], radius[below(4)]);
      put(&s, 1, between(op[k] == AMBIT_OP_ATAN2 ? -2 : 0.5, 2), size[n % 3], radius[below(4)]);
      int is_known = advance(&s);
      ambit_rounding_restore(old);
      if (is_known) known++, check(&s, op[k]);
    }
    assert_true(known > 400);
    sample_close(&s);
  }
}

static void constants_hold_their_intervals(void **unused) {
  (void)unused;
  sample s;
  for (int n = 0; n < 2000; n++) {
    assert_int_equal(ambit_scope_open(&s.scope, NULL, NULL), AMBIT_OK);
    const ambit_host *h = &s.scope->host;
    double lo = between(-2, 2), hi = lo;
    for (uint32_t k = below(6); k-- > 0;) hi = nextafter(hi, INFINITY);
    if (n % 2) lo = between(-1e-16, 1e-16), hi = between(0.5, 1); /* half the width is no double */
    tape_begin(&s.tape);
    uint32_t constant = tape_constant(&s.tape, lo, hi);
    const ambit_tape *tape = tape_seal(&s.tape, AMBIT_NO_SLOT);
    assert_int_equal(space_open(h, &s.space, UNKNOWNS, DEGREE), AMBIT_OK);
    s.source = (series_source) { &s.space, h->service(h, AMBIT_NUM_SERVICE), NULL };
    assert_int_equal(series_jets.open(h, &s.source, tape, 0, 0, NULL, &s.self), AMBIT_OK);
    cell x = series_cell(s.source.made, constant, 0);
    mpfr_t off;
    mpfr_init2(off, BITS);
    for (int side = 0; side < 2; side++) {
      mpfr_set_d(off, side ? hi : lo, MPFR_RNDN);
      mpfr_sub_d(off, off, x.c[s.space.row[0].at], MPFR_RNDN);
      mpfr_abs(off, off, MPFR_RNDN);
      assert_true(mpfr_cmp_d(off, cell_rad(x)) <= 0);
    }
    mpfr_clear(off);
    sample_close(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(functions_hold_all_values),
    cmocka_unit_test(constants_hold_their_intervals) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
