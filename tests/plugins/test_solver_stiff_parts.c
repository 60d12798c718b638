/* Parts of the stiff integrator by themselves: the exponential of Metzler matrices from above against 300 bits, from
** Chebyshev polynomials to powers, Neumann series, constants in double-double. */
#include "solver/stiff/bound.c"
#include "shared/constant.c"
#include "solver/stiff/invariant.c"
#include "solver/stiff/linear.c"
#include "solver/stiff/metzler.c"
#include "solver/stiff/metzler_stiff.c"
#include "solver/stiff/pieces.c"
#include "host/services.h"
#include "kit/tape_builder.h"
#include "oracle.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <cmocka.h>
#include <mpfr.h>

#define BITS 400

/* -- u' = M u + d in 400 bits, by the series of exp(M t / 2^k), squared k times with the constant as a state */

static void truth(size_t n, const double *M, const double *d, double length, const double *first, mpfr_t *u) {
  size_t q = n + 1;
  static mpfr_t A[N_MAX * N_MAX], S[N_MAX * N_MAX], R[N_MAX * N_MAX], X[N_MAX * N_MAX], x;
  int halvings = 60;
  mpfr_init2(x, BITS);
  for (size_t i = 0; i < q * q; i++) {
    mpfr_init2(A[i], BITS), mpfr_init2(S[i], BITS), mpfr_init2(R[i], BITS), mpfr_init2(X[i], BITS);
    double entry = i / q == n ? 0 : i % q == n ? d[i / q] : M[i / q * n + i % q];
    mpfr_set_d(A[i], entry, MPFR_RNDN);
    mpfr_mul_d(A[i], A[i], length, MPFR_RNDN);
    mpfr_div_2ui(A[i], A[i], (unsigned long)halvings, MPFR_RNDN);
    mpfr_set_ui(S[i], i % (q + 1) == 0, MPFR_RNDN), mpfr_set(R[i], S[i], MPFR_RNDN);
  }
  for (unsigned long t = 1; t <= 40 + (unsigned long)halvings; t++) { /* terms, then squarings */
    mpfr_t *left = t <= 40 ? R : S, *right = t <= 40 ? A : S;
    for (size_t i = 0; i < q * q; i++) {
      mpfr_set_zero(X[i], 1);
      for (size_t l = 0; l < q; l++) {
        mpfr_mul(x, left[i / q * q + l], right[l * q + i % q], MPFR_RNDN);
        mpfr_add(X[i], X[i], x, MPFR_RNDN);
      }
      if (t <= 40) mpfr_div_ui(X[i], X[i], t, MPFR_RNDN);
    }
    for (size_t i = 0; i < q * q; i++) {
      mpfr_set(left[i], X[i], MPFR_RNDN);
      if (t <= 40) mpfr_add(S[i], S[i], X[i], MPFR_RNDN);
    }
  }
  for (size_t i = 0; i < n; i++) {
    mpfr_init2(u[i], BITS);
    mpfr_set(u[i], S[i * q + n], MPFR_RNDN);
    for (size_t j = 0; j < n; j++) {
      mpfr_mul_d(x, S[i * q + j], first[j], MPFR_RNDN);
      mpfr_add(u[i], u[i], x, MPFR_RNDN);
    }
  }
  for (size_t i = 0; i < q * q; i++) mpfr_clear(A[i]), mpfr_clear(S[i]), mpfr_clear(R[i]), mpfr_clear(X[i]);
  mpfr_clear(x);
}

static const ambit_num_service *num_service(void) {
  static const ambit_num_service *num;
  ambit_scope *scope;
  assert_int_equal(ambit_scope_open(&scope, NULL, NULL), AMBIT_OK);
  num = scope->host.service(&scope->host, AMBIT_NUM_SERVICE);
  ambit_scope_close(scope);
  return num;
}

static AMBIT_WORKER int propagate(const metzler *m, double *last) { return metzler_propagate(m, last); }

static void metzler_bounds(void **unused) {
  (void)unused;
  const ambit_num_service *num = num_service();
  uint64_t random = 3;
  for (int round = 0; round < 60; round++) {
    size_t n = 1 + (size_t)round % 4;
    double M[16], d[4], first[4], most[4], last[4];
    for (size_t i = 0; i < n * n; i++) M[i] = oracle_uniform(&random, 0, 1) * pow(10, -(round % 5));
    for (size_t i = 0; i < n; i++) {
      double rate = pow(10, oracle_uniform(&random, -2, round % 3 ? 1 : 12));
      M[i * n + i] = i % 2 == (size_t)round % 2 ? -rate : oracle_uniform(&random, -1, 1);
      d[i] = oracle_uniform(&random, 0, 1e-3), first[i] = oracle_uniform(&random, 0, 1), most[i] = 1e6;
    }
    mpfr_t u[4];
    truth(n, M, d, 2, first, u);
    const metzler m = { num, n, M, d, first, 2, most };
    ambit_rounding old = ambit_round_up();
    int good = propagate(&m, last);
    ambit_rounding_restore(old);
    assert_true(good);
    for (size_t i = 0; i < n; i++) {
      double exact = mpfr_get_d(u[i], MPFR_RNDU);
      if (!(mpfr_cmp_d(u[i], last[i]) <= 0)) fail_msg("round %d: %.17g is no bound of %.17g", round, last[i], exact);
      if (round % 3 && !(last[i] <= exact * (1 + 1e-9) + 1e-300)) fail_msg("%.17g for %.17g", last[i], exact);
      mpfr_clear(u[i]);
    }
  }
}

static AMBIT_WORKER int neumann(size_t n, const double *K, double *X) { return bound_neumann(n, K, X); }

static void neumann_series(void **unused) {
  (void)unused;
  const double good[] = { 0.25, 0.5, 0.125, 0.25 }, bad[] = { 0.5, 1, 0.5, 0.5 };
  double X[4];
  ambit_rounding old = ambit_round_up();
  int first = neumann(2, good, X), second = neumann(2, bad, (double[4]) { 0 });
  ambit_rounding_restore(old);
  /* (I - K)^-1 - I for K = [1/4 1/2; 1/8 1/4]: determinant 1/2 */
  const double exact[] = { 0.5, 1, 0.25, 0.5 };
  assert_true(first && !second);
  for (int i = 0; i < 4; i++) assert_true(X[i] >= exact[i] && X[i] < exact[i] * 1.01);
}

static void chebyshev_to_powers(void **unused) {
  (void)unused;
  enum { N = 16 };
  dd *table = calloc(pieces_table_size(N), sizeof *table);
  pieces_fill(table, N);
  for (uint32_t level = 0; level < LEVELS; level++)
    for (uint32_t j = 0; j < 4u << level; j += 3)
      for (uint32_t k = 0; k <= N; k++) {
        const dd *T = entry(table, N, level, j) + k * (N + 1);
        for (int i = -4; i <= 4; i++) {
          long double s = i / 4.0L, tau = (2.0L * j + 1 - (4u << level) + s) / (4u << level), sum = 0;
          for (uint32_t l = N + 1; l-- > 0;) sum = sum * s + dd_long(T[l]);
          assert_true(fabsl(sum - cosl(k * acosl(tau))) < 1e-15L);
        }
      }
  free(table);
}

static void constants(void **unused) {
  (void)unused;
  static const char *const text[] = { "0.04", "3e7", "8/3", "-1.25e-6", "0.161", "123456789.123456789e-20", "1/3e5" };
  mpfr_t x, y;
  mpfr_init2(x, 300), mpfr_init2(y, 300);
  for (size_t i = 0; i < sizeof text / sizeof *text; i++) {
    dd a;
    double error;
    char head[64];
    assert_true(constant_read(text[i], &a, &error));
    snprintf(head, sizeof head, "%s", text[i]);
    char *slash = strchr(head, '/');
    if (slash) *slash = '\0', mpfr_set_str(y, slash + 1, 10, MPFR_RNDN);
    mpfr_set_str(x, head, 10, MPFR_RNDN);
    if (slash) mpfr_div(x, x, y, MPFR_RNDN);
    double size = fabs(mpfr_get_d(x, MPFR_RNDN));
    mpfr_sub_d(x, x, a.hi, MPFR_RNDN), mpfr_sub_d(x, x, a.lo, MPFR_RNDN);
    assert_true(fabs(mpfr_get_d(x, MPFR_RNDN)) <= error);
    assert_true(error <= size * 1e-27);
  }
  mpfr_clear(x), mpfr_clear(y);
  dd a;
  double error;
  assert_false(constant_read("", &a, &error) || constant_read("e", &a, &error) || constant_read("1/0", &a, &error) ||
               constant_read("0.1x", &a, &error));
}

/* middle + radius, rounded, is more than either end; what a text says is known to twice the digits, unless it lies */
static void constants_of_tapes(void **state) {
  static const double lo[] = { -1e-20, -1, -1e-17, 1, 2, 0x1.3333333333333p-2, 5 },
                      hi[] = { 1, 1e-20, 3, 1 + 0x1p-52, 2, 0x1.3333333333334p-2, 6 };
  static const char *text[] = { NULL, NULL, NULL, NULL, "2", "0.3", "0.3" };
  const ambit_tape t = { .nconst = 7, .lo = lo, .hi = hi, .text = text };
  (void)state;
  for (uint32_t i = 0; i < t.nconst; i++) {
    dd x;
    double off = constant_at(&t, i, &x);
    long double middle = (long double)x.hi + x.lo;
    if (i == 5)
      assert_true(fabsl(middle - 0.3L) <= 0x1p-66L && off < 1e-30);
    else
      assert_true(middle - off <= lo[i] && middle + off >= hi[i]);
    assert_true(i != 4 || off == 0);
  }
}

/* -- x' = z + a, y' = -z - a - g, where a is g added to itself `doublings` times */

static uint32_t invariants_of_doubled(int doublings, int with_g, double *w) {
  tape_builder t;
  double rows[2 * TAPE_ROOM];
  tape_begin(&t);
  uint32_t x = tape_input(&t, 1), y = tape_input(&t, 1);
  uint32_t z = tape_op(&t, AMBIT_OP_MUL, x, y), g = tape_op(&t, AMBIT_OP_SQR, y, y), a = g;
  for (int i = 0; i < doublings; i++) a = tape_op(&t, AMBIT_OP_ADD, a, a);
  uint32_t first = tape_op(&t, AMBIT_OP_ADD, z, a), second = tape_op(&t, AMBIT_OP_NEG, first, first);
  if (with_g) second = tape_op(&t, AMBIT_OP_SUB, second, g);
  t.out[0] = first, t.out[1] = second;
  t.tape.op = t.op, t.tape.dst = t.dst, t.tape.a = t.a, t.tape.b = t.b, t.tape.out = t.out;
  t.tape.lo = t.lo, t.tape.hi = t.hi;
  return invariant_find(&t.tape, 2, rows, w);
}

/* 2^54 + 1 is no double: what would be rounded away is not taken for zero */
static void invariants_are_exact(void **unused) {
  (void)unused;
  double w[4];
  assert_int_equal(invariants_of_doubled(3, 0, w), 1);
  assert_true(w[0] != 0 && w[0] == w[1]);
  assert_int_equal(invariants_of_doubled(3, 1, w), 0);
  assert_int_equal(invariants_of_doubled(54, 1, w), 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(metzler_bounds),
    cmocka_unit_test(neumann_series),
    cmocka_unit_test(chebyshev_to_powers),
    cmocka_unit_test(constants),
    cmocka_unit_test(constants_of_tapes),
    cmocka_unit_test(invariants_are_exact),
  };
  return cmocka_run_group_tests_name("solver stiff: parts", tests, NULL, NULL);
}
