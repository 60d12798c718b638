/* Ranges of polynomials over the cube: the bound is never below the value at a point, in 300-bit arithmetic, and within
** its tolerance where linear terms dominate. Where they do not, it is still a bound. */
#define sum_convolve_avx2 sum_convolve_portable /* needs flags of its own */
#include "solver/taylor_model/portable.c"
#include "solver/taylor_model/range.c"
#include "solver/taylor_model/restrict.c"
#include "solver/taylor_model/space.c"
#include "oracle.h"
#include "solver_case.h"
#include <mpfr.h>

#define BITS 300
#define ROOM 64
#define POINTS 40

typedef struct range_case {
  ambit_scope *scope;
  space space;
  search search;
  double *p, *middle, *whole;
} range_case;

static void open_case(range_case *c, uint32_t m, uint32_t d) {
  memset(c, 0, sizeof *c);
  assert_int_equal(ambit_scope_open(&c->scope, NULL, NULL), AMBIT_OK);
  const ambit_host *h = &c->scope->host;
  assert_int_equal(space_open(h, &c->space, m, d), AMBIT_OK);
  assert_true(search_open(h, &c->search, &c->space, ROOM));
  c->p = h->alloc(h, c->space.size * sizeof(double));
  c->middle = h->alloc(h, m * sizeof(double)), c->whole = h->alloc(h, m * sizeof(double));
  for (uint32_t v = 0; v < m; v++) c->middle[v] = 0, c->whole[v] = 1;
}

/* linear terms of size 1, others of size `bent` in all */
static void draw(range_case *c, uint64_t *random, double bent) {
  const space *s = &c->space;
  memset(c->p, 0, s->size * sizeof *c->p);
  for (uint32_t r = 0; r < s->nrow; r++)
    for (uint32_t j = 0; j < s->row[r].length; j++) {
      double size = s->row[r].degree + j < 2 ? 1 : bent / s->count;
      c->p[s->row[r].at + j] = oracle_uniform(random, -size, size);
    }
}

/* p(x) - bound, rounded to nearest from 300 bits */
static double excess(const range_case *c, const double *x, double bound) {
  const space *s = &c->space;
  mpfr_t sum, term;
  mpfr_inits2(BITS, sum, term, (mpfr_ptr)0);
  mpfr_set_d(sum, -bound, MPFR_RNDN);
  for (uint32_t r = 0; r < s->nrow; r++)
    for (uint32_t j = 0; j < s->row[r].length; j++) {
      mpfr_set_d(term, c->p[s->row[r].at + j], MPFR_RNDN);
      for (uint32_t v = 0; v < s->m; v++)
        for (uint32_t e = v ? s->exponent[(size_t)r * s->m + v] : j; e > 0; e--)
          mpfr_mul_d(term, term, x[v], MPFR_RNDN);
      mpfr_add(sum, sum, term, MPFR_RNDN);
    }
  double result = mpfr_get_d(sum, MPFR_RNDN);
  mpfr_clears(sum, term, (mpfr_ptr)0);
  return result;
}

/* the highest of random points, each improved one unknown at a time over a few values */
static double highest_found(const range_case *c, uint64_t *random, double bound) {
  static const double value[] = { -1, -0.75, -0.5, -0.25, 0, 0.25, 0.5, 0.75, 1 };
  double best = -INFINITY;
  for (int k = 0; k < POINTS; k++) {
    double x[UNKNOWNS_MAX], here;
    for (uint32_t v = 0; v < c->space.m; v++) x[v] = oracle_uniform(random, -1, 1);
    here = excess(c, x, bound);
    for (uint32_t v = 0; v < c->space.m; v++)
      for (size_t i = 0; i < sizeof value / sizeof *value; i++) {
        double old = x[v], there;
        x[v] = value[i];
        there = excess(c, x, bound);
        if (there > here)
          here = there;
        else
          x[v] = old;
      }
    best = fmax(best, here);
  }
  return best;
}

static double bound_of(range_case *c, double tolerance) {
  ambit_rounding old = ambit_round_up();
  search_begin(&c->search, c->p, 1);
  search_add(&c->search, c->middle, c->whole, 0);
  double bound = search_maximum(&c->search, tolerance, 0);
  ambit_rounding_restore(old);
  return bound;
}

static void bounds_are_never_below_a_value(void **unused) {
  (void)unused;
  static const struct { uint32_t m, d; } size[] = { { 1, 9 }, { 2, 5 }, { 3, 4 }, { 5, 3 } };
  static const double bent[] = { 0.1, 1, 10, 1000 };
  uint64_t random = 11;
  for (size_t i = 0; i < 4; i++) {
    range_case c;
    open_case(&c, size[i].m, size[i].d);
    for (int n = 0; n < 8; n++) {
      draw(&c, &random, bent[n % 4]);
      assert_true(highest_found(&c, &random, bound_of(&c, 1e-6)) <= 0);
    }
    ambit_scope_close(c.scope);
  }
}

/* so a bound that is too low by a thousandth would be noticed above, in seven unknowns too, and with little work */
static void linear_terms_lead_to_the_maximum(void **unused) {
  (void)unused;
  uint64_t random = 12;
  range_case c;
  open_case(&c, 7, 3);
  for (int n = 0; n < 6; n++) {
    draw(&c, &random, 0.2);
    double bound = bound_of(&c, 1e-9), best = highest_found(&c, &random, bound);
    assert_true(best <= 0 && best > -1e-3);
    assert_true(c.search.used <= 16); /* halving alone uses up all the room */
  }
  ambit_scope_close(c.scope);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(bounds_are_never_below_a_value),
    cmocka_unit_test(linear_terms_lead_to_the_maximum),
  };
  return cmocka_run_group_tests_name("solver taylor_model, ranges", tests, NULL, NULL);
}
