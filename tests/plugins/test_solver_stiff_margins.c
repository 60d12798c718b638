/* What the stiff integrator adds to its bounds for rounding, and the rounding modes of a step. Values are made so that
** each of these is needed; in runs they hide behind larger ones. Two functions are replaced by ones that note in which
** mode they were called. */
#define evaluate_slopes seen_evaluate_slopes
#define prove_piece seen_prove_piece
#include "solver/stiff/series.c"
#include "solver/stiff/step.c"
#undef prove_piece
enum why prove_piece(stiff *s, uint32_t j, uint32_t pieces);
#define enclose enclose_piece
#include "solver/stiff/prove.c"
#undef enclose
#include "host/services.h"
#include "kit/tape_builder.h"
#include "oracle.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

enum { NEAREST, UPWARD, OTHER };

/* Of this thread's arithmetic in doubles. */
static AMBIT_WORKER int mode(void) {
  volatile double one = 1, tiny = 0x1p-60;
  return one + tiny > 1 ? UPWARD : -one - tiny < -1 || one - tiny < 1 ? OTHER : NEAREST;
}

static int slopes_mode = -1, prove_mode = -1;

int seen_evaluate_slopes(stiff *s, uint32_t j, uint32_t m) {
  (void)s, (void)j, (void)m;
  slopes_mode = mode();
  return 1;
}

enum why seen_prove_piece(stiff *s, uint32_t j, uint32_t m) {
  (void)s, (void)j, (void)m;
  prove_mode = mode();
  return (enum why)0;
}

static void modes_of_a_step(void **state) {
  static stiff s;
  (void)state;
  prove(&s, 0, 1);
  assert_int_equal(prove_mode, UPWARD);
  ambit_rounding old = ambit_round_up();
  slopes_anew(&s, 0, 1);
  int after = mode();
  ambit_rounding_restore(old);
  assert_int_equal(slopes_mode, NEAREST);
  assert_int_equal(after, UPWARD);
}

/* -- polynomials */

#define KEPT 8

typedef struct own {
  poly p;
  double hi[KEPT], lo[KEPT];
} own;

static poly *open(own *x) {
  memset(x, 0, sizeof *x);
  x->p.hi = x->hi, x->p.lo = x->lo;
  return &x->p;
}

/* What rounds away in a derivative: 3 (hi + lo) has at most 108 bits, which __float128 holds. */
static void derivatives(void **state) {
  own a, r;
  uint64_t random = 5;
  double worst = 0;
  (void)state;
  for (int try = 0; try < 2000; try++) {
    poly *p = open(&a), *d = open(&r);
    double hi = oracle_uniform(&random, 1, 2);
    double lo = oracle_uniform(&random, -0x1p-54, 0x1p-54);
    p->n = 4;
    poly_set(p, 3, two_sum(hi, lo));
    poly_derive(d, p);
    __float128 exact = 3 * ((__float128)p->hi[3] + p->lo[3]), error = exact - ((__float128)d->hi[2] + d->lo[2]);
    double size = (double)(error < 0 ? -error : error);
    assert_true(size <= d->tail);
    worst = fmax(worst, size / d->tail);
  }
  assert_true(worst > 1e-3); /* the bound is no accident */
}

static void sums_of_small_numbers(void **state) {
  own a, b, r;
  (void)state;
  poly *p = open(&a), *q = open(&b), *sum = open(&r);
  p->n = q->n = 1;
  poly_set(p, 0, (dd) { 1e-280, 0 }), poly_set(q, 0, (dd) { 3e-281, 0 });
  poly_add(sum, p, q, 1);
  assert_true(sum->tail > 0);
}

/* -- dense enclosures: the sum of a radius and of what polynomials differ by, which rounds to the radius */
static void dense_sums(void **state) {
  static stiff s;
  own P, scratch[4];
  double middle[2] = { 0, 0 }, worst[2] = { 0, 0 }, radius = 1;
  (void)state;
  memset(&s, 0, sizeof s);
  for (int i = 0; i < 4; i++) s.rhs.scratch[i] = *open(&scratch[i]);
  s.P = open(&P), s.P->n = 1, poly_set(s.P, 0, (dd) { 0x1p-54, 0 });
  s.nx = 1, s.q.N = 1, s.half = (dd) { 0.5, 0 };
  s.dense_mid = middle, s.dense_rad = worst, s.radius = &radius;
  dense_piece(&s, 0);
  assert_true(worst[0] >= 1 + (long double)0x1p-54);
  assert_true(worst[0] < 1 + 1e-9);
}

/* -- frames: an inverse that is far off, so that what bounds its error counts */
static AMBIT_WORKER int verify(stiff *s) { return frame_verify(s); }

static void inverse_of_a_frame(void **state) {
  static stiff s;
  frame *r = &s.frame;
  (void)state;
  s.n = 2, s.nx = 2;
  const double one[] = { 1, 0, 0, 1 }, G[] = { 2, 1, 0, 4 }, Gi[] = { 0.5 * 0.97, -0.125 * 0.9, 0, 0.25 * 0.96 };
  memcpy(r->U[0], one, sizeof one), memcpy(r->C, one, sizeof one);
  memcpy(r->G, G, sizeof G), memcpy(r->Gi, Gi, sizeof Gi);
  ambit_rounding old = ambit_round_up();
  int good = verify(&s);
  ambit_rounding_restore(old);
  assert_true(good);
  const double exact[] = { 0.5, 0.125, 0, 0.25 }; /* |G^-1| */
  for (int i = 0; i < 4; i++) assert_true(r->Gi_size[i] >= exact[i] && r->Gi_size[i] < exact[i] * 1.2 + 0.05);
}

/* -- how far a piece moves: 1 + 1 + 2^-54, which rounds to 2 */
static void moved_pieces(void **state) {
  static stiff s;
  own P;
  double defect[3] = { 1, 0x1p-53, 0 }, shift = 0;
  (void)state;
  memset(&s, 0, sizeof s);
  s.n = s.nx = 1, s.q.N = 2, s.defect = defect, s.shift = &shift, s.P = open(&P), s.P->n = 3;
  s.frame.split.slow = 1, s.frame.U[0][0] = s.frame.C[0] = 1;
  improve_piece(&s);
  long double moved = 0;
  for (uint32_t k = 0; k < 3; k++) moved += fabsl((long double)P.hi[k] + P.lo[k]);
  assert_true(moved > 2 && shift >= moved && shift < 2.1);
}

/* -- powers for which a function has no room count as its tail */
static void powers_without_room(void **state) {
  static stiff s;
  own P;
  tape_builder b;
  fields to;
  series base;
  terms alone = { .count = 1, .degree = 0 };
  ambit_scope *scope;
  (void)state;
  memset(&s, 0, sizeof s);
  assert_int_equal(ambit_scope_open(&scope, NULL, NULL), AMBIT_OK);
  const ambit_host *h = &scope->host;
  tape_begin(&b);
  tape_input(&b, 1);
  const ambit_tape *t = tape_seal(&b, AMBIT_NO_SLOT);
  assert_true(series_open(h, h->service(h, AMBIT_NUM_SERVICE), t, 1, &base));
  assert_true(fields_open(h, &base, &alone, &to));
  s.inputs = s.nx = 1, s.terms = alone, s.q.N = 3, s.P = open(&P), s.P->n = 4;
  for (uint32_t k = 0; k < 4; k++) poly_set(s.P, k, (dd) { 1.0 / (1 << k), 0 });
  spread_put(&s, &to, NULL);
  const field *u = fields_input(&to, 0);
  assert_int_equal(u->c.n, 2);
  assert_true(u->c.tail >= 0.375 && u->c.tail < 0.376);
  ambit_scope_close(scope);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(modes_of_a_step),
    cmocka_unit_test(derivatives),
    cmocka_unit_test(sums_of_small_numbers),
    cmocka_unit_test(dense_sums),
    cmocka_unit_test(inverse_of_a_frame),
    cmocka_unit_test(moved_pieces),
    cmocka_unit_test(powers_without_room),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
