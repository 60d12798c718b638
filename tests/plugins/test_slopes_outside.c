/* Slopes about a centre that lies outside the box, as integrators use them on pieces of a set: the interval plugin's
** own series and the kernel's general ones, against 300-bit arithmetic at random points. */
#include "kit/arithmetic_loader.h"
#include "kit/series_oracle.h"
#include "kit/tape_builder.h"
#include "graph/jet.h"
#include "oracle.h"
#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

#define ORDER 5
#define INPUTS 2
#define ROUNDS 60

static const uint32_t series_op[] = { AMBIT_OP_ADD, AMBIT_OP_SUB, AMBIT_OP_NEG, AMBIT_OP_MUL, AMBIT_OP_SQR,
  AMBIT_OP_DIV, AMBIT_OP_SQRT, AMBIT_OP_EXP, AMBIT_OP_LOG, AMBIT_OP_SIN, AMBIT_OP_COS, AMBIT_OP_ATAN, AMBIT_OP_ATAN2,
  AMBIT_OP_SINH, AMBIT_OP_COSH, AMBIT_OP_TANH, AMBIT_OP_ABS, AMBIT_OP_MIN, AMBIT_OP_MAX };

/* Input i at xi: (a_i + b_i xi) + c_i t: the box is xi in [from, to], the centre xi = 0. */
typedef struct scene {
  tape_builder tape;
  double a[INPUTS], b[INPUTS], c[INPUTS], from, to;
  bool unary;
} scene;

static void build(scene *s, uint32_t op, uint64_t *random) {
  tape_begin(&s->tape);
  uint32_t one = tape_constant(&s->tape, 1, 1), u = tape_input(&s->tape, AMBIT_DEGREE_ANY),
           v = tape_input(&s->tape, AMBIT_DEGREE_ANY);
  bool binary = op == AMBIT_OP_ADD || op == AMBIT_OP_SUB || op == AMBIT_OP_MUL || op == AMBIT_OP_DIV ||
                op == AMBIT_OP_ATAN2 || op == AMBIT_OP_MIN || op == AMBIT_OP_MAX;
  uint32_t y = tape_op(&s->tape, op, u, binary ? v : u);
  tape_op(&s->tape, AMBIT_OP_MUL, y, u); /* so that what follows is tested too */
  tape_seal(&s->tape, one);
  for (int i = 0; i < INPUTS; i++) {
    s->a[i] = oracle_uniform(random, i ? 1 : 2.5, i ? 2 : 4);
    s->b[i] =
        oracle_uniform(random, -0.9, 0.9); /* the operands keep their sign; whether they cross is left to chance */
    s->c[i] = oracle_uniform(random, -1, 1);
  }
  s->from = oracle_uniform(random, 0.1, 0.9), s->to = s->from + oracle_uniform(random, 0, 1 - s->from);
  if (oracle_random(random) % 2) { /* the other side */
    double from = s->from;
    s->from = -s->to, s->to = -from;
  }
}

static const ambit_jet_service *const service = &ambit_jet_service_v1;

static uint32_t solve(const scene *s, ambit_jet *centre, ambit_jet *box) {
  const double zero = 0;
  uint32_t flags = 0;
  for (uint32_t i = 0; i < INPUTS; i++) {
    double mid = s->a[i] + s->b[i] * 0.5 * (s->from + s->to), rad = fabs(s->b[i]) * 0.5 * (s->to - s->from) + 1e-14;
    service->put(centre, i, 0, s->a[i], 0, NULL, NULL), service->put(centre, i, 1, s->c[i], 0, NULL, NULL);
    service->put(box, i, 0, mid, rad, &s->b[i], &zero), service->put(box, i, 1, s->c[i], 0, NULL, NULL);
  }
  for (uint32_t k = 0; k <= ORDER; k++) {
    flags |= service->advance(centre, k);
    flags |= service->advance(box, k);
  }
  return flags;
}

static void judge(series_oracle *o, const scene *s, double xi) {
  mpfr_set_d(*series_u(o, 0, 0), 1, MPFR_RNDN);
  for (uint32_t i = 0; i < INPUTS; i++) {
    mpfr_t *x = series_u(o, 1 + i, 0);
    mpfr_set_d(x[0], s->b[i], MPFR_RNDN);
    mpfr_mul_d(x[0], x[0], xi, MPFR_RNDN);
    mpfr_add_d(x[0], x[0], s->a[i], MPFR_RNDN);
    mpfr_set_d(x[1], s->c[i], MPFR_RNDN);
  }
  series_run(o);
}

/* u_k(xi) - u_k(0) within slope * xi */
static void check(const scene *s, uint32_t op, ambit_jet *box, size_t *points) {
  series_oracle at, zero;
  mpfr_t d;
  mpfr_init2(d, SERIES_BITS);
  series_open(&at, &s->tape.tape, ORDER), series_open(&zero, &s->tape.tape, ORDER);
  judge(&zero, s, 0);
  for (int n = 0; n <= 4; n++) {
    double xi = s->from + 0.25 * n * (s->to - s->from);
    judge(&at, s, xi);
    for (uint32_t slot = 3; slot < s->tape.tape.nslot; slot++)
      for (uint32_t k = 0; k <= ORDER; k++) {
        double mid, rad, dmid, drad;
        service->get(box, slot, k, &mid, &rad, &dmid, &drad);
        mpfr_sub(d, *series_u(&at, slot, k), *series_u(&zero, slot, k), MPFR_RNDN);
        mpfr_div_d(d, d, xi, MPFR_RNDN);
        mpfr_sub_d(d, d, dmid, MPFR_RNDN);
        /* the inputs were rounded to the box, not to this xi: some last places are the test's own */
        if (fabs(mpfr_get_d(d, MPFR_RNDN)) > drad * (1 + 1e-12) + 1e-12 * (1 + fabs(dmid)))
          fail_msg("op %u, slot %u, order %u, xi = %g: slope off by %g, radius %g", op, slot, k, xi,
              mpfr_get_d(d, MPFR_RNDN), drad);
        *points += drad < INFINITY;
      }
  }
  series_close(&at), series_close(&zero);
  mpfr_clear(d);
}

static void run(bool general) {
  arithmetic_loader l;
  const char *problem = arithmetic_load(&l, "interval");
  if (problem) fail_msg("%s", problem);
  if (general) l.full.jets = NULL;
  uint64_t random = 41;
  for (size_t o = 0; o < sizeof series_op / sizeof *series_op; o++) {
    size_t points = 0;
    for (int round = 0; round < ROUNDS; round++) {
      static scene s;
      ambit_scope *scope;
      ambit_jet *centre, *box;
      build(&s, series_op[o], &random);
      assert_int_equal(ambit_scope_open(&scope, NULL, NULL), AMBIT_OK);
      assert_int_equal(service->open(&scope->host, &s.tape.tape, &l.full, l.ctx, ORDER, 0, NULL, &centre), AMBIT_OK);
      assert_int_equal(service->open(&scope->host, &s.tape.tape, &l.full, l.ctx, ORDER, 1, centre, &box), AMBIT_OK);
      if (!(solve(&s, centre, box) & (AMBIT_F_PARTIAL | AMBIT_F_EMPTY))) check(&s, series_op[o], box, &points);
      service->close(centre), service->close(box);
      ambit_scope_close(scope);
    }
    if (points < 2000) fail_msg("op %u: only %zu points", series_op[o], points);
  }
  arithmetic_unload(&l);
}

static void of_the_interval_plugin(void **unused) {
  (void)unused;
  run(false);
}

static void of_the_kernel(void **unused) {
  (void)unused;
  run(true);
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(of_the_interval_plugin), cmocka_unit_test(of_the_kernel) };
  return cmocka_run_group_tests_name("slopes outside the box", tests, NULL, NULL);
}
