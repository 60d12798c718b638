/* Linear equations A x = -b from inside: a set with a singular matrix is never called regular, however it rounds, and
** the enclosure of all solutions holds those of the corners, which MPFR solves; none is in a gap. Matrices about the
** identity have their extreme solutions there, so that little more would be too wide. */
#include "solver/krawczyk/krawczyk.h"
#include "host/services.h"
#include "num/random.h"
#include <math.h>
#include <mpfr.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define N 2
#define BITS 300

typedef struct sample {
  ambit_scope *scope;
  krawczyk k;
  double lo[N * N], hi[N * N], off_lo[N * N], off_hi[N * N], scale[N], margin[N], best[N], B[N * N], work[N * N];
  span diagonal[N], b[N], row[N], f[N], hull[N], z[N], mid[N];
} sample;

static ambit_random draws = { 1 };
static double between(double lo, double hi) { return ambit_random_in(&draws, (ambit_interval) { lo, hi }); }
static uint32_t below(uint32_t n) { return (uint32_t)(ambit_random_bits(&draws) >> 32) % n; }

static void sample_open(sample *s) {
  *s = (sample) { 0 };
  assert_int_equal(ambit_scope_open(&s->scope, NULL, NULL), AMBIT_OK);
  s->k = (krawczyk) { .host = &s->scope->host, .n = N, .b = s->b, .row = s->row, .f = s->f, .hull = s->hull };
  s->k.num = s->scope->host.service(&s->scope->host, AMBIT_NUM_SERVICE);
  s->k.off = (matrix) { s->off_lo, s->off_hi }, s->k.diagonal = s->diagonal, s->k.scale = s->scale;
  s->k.mid = s->mid, s->k.margin = s->margin, s->k.best = s->best, s->k.B = s->B, s->k.work = s->work;
}

static void set(sample *s) {
  for (size_t i = 0; i < N; i++)
    for (size_t j = 0; j < N; j++) {
      size_t at = i * N + j;
      s->off_lo[at] = i == j ? 0 : s->lo[at], s->off_hi[at] = i == j ? 0 : s->hi[at];
      if (i == j) s->diagonal[i] = (span) { s->lo[at], s->hi[at] };
    }
}

/* rows in proportion, by integers: exactly singular */
static void singular_matrices_are_not_regular(void **unused) {
  (void)unused;
  sample s;
  sample_open(&s);
  for (int n = 0; n < 20000; n++) {
    double row[N], column[N];
    for (size_t i = 0; i < N; i++) row[i] = 1 + below(4000), column[i] = 1 + below(4000);
    for (size_t i = 0; i < N; i++)
      for (size_t j = 0; j < N; j++) s.lo[i * N + j] = s.hi[i * N + j] = row[i] * column[j] * (below(2) ? 1 : -1);
    for (size_t k = 0; k < N; k++) s.lo[k * N + 1 - k] = s.hi[k * N + 1 - k] = row[k] * column[1 - k];
    for (size_t k = 0; k < N; k++) s.lo[k * N + k] = s.hi[k * N + k] = row[k] * column[k];
    set(&s);
    assert_false(krawczyk_is_regular(&s.k));
  }
  ambit_scope_close(s.scope);
}

/* x := component i of the solution of a x = -b, by Cramer's rule */
static void solve(mpfr_t x, const double *a, const double *b, size_t i) {
  mpfr_t whole, part;
  mpfr_inits2(BITS, whole, part, (mpfr_ptr)0);
  mpfr_set_d(whole, a[0], MPFR_RNDN), mpfr_mul_d(whole, whole, a[3], MPFR_RNDN);
  mpfr_set_d(part, a[1], MPFR_RNDN), mpfr_mul_d(part, part, a[2], MPFR_RNDN);
  mpfr_sub(whole, whole, part, MPFR_RNDN);
  size_t j = 1 - i;
  mpfr_set_d(x, a[i * N + j], MPFR_RNDN), mpfr_mul_d(x, x, b[j], MPFR_RNDN);
  mpfr_set_d(part, a[j * N + j], MPFR_RNDN), mpfr_mul_d(part, part, b[i], MPFR_RNDN);
  mpfr_sub(x, x, part, MPFR_RNDN);
  mpfr_div(x, x, whole, MPFR_RNDN);
  mpfr_clears(whole, part, (mpfr_ptr)0);
}

static void check_corner(const sample *s, uint32_t corner) {
  double a[N * N], b[N];
  mpfr_t x;
  mpfr_init2(x, BITS);
  for (size_t k = 0; k < N * N; k++) a[k] = corner >> k & 1 ? s->hi[k] : s->lo[k];
  for (size_t i = 0; i < N; i++) b[i] = corner >> (N * N + i) & 1 ? s->b[i].hi : s->b[i].lo;
  for (size_t i = 0; i < N; i++) {
    solve(x, a, b, i);
    assert_true(mpfr_cmp_d(x, s->z[i].lo) >= 0);
    assert_true(mpfr_cmp_d(x, s->z[i].hi) <= 0);
  }
  mpfr_clear(x);
}

static void solutions_of_corners_are_held(void **unused) {
  (void)unused;
  static const double reach[] = { 0, 0x1p-50, 1e-3, 0.4 };
  sample s;
  sample_open(&s);
  for (int n = 0; n < 6000; n++) {
    double radius = reach[n % 4];
    for (size_t k = 0; k < N * N; k++) {
      double r = radius * between(0, 1), one = k % (N + 1) ? 0 : n / 4 % 2 ? 1 : between(1, 2);
      s.lo[k] = one - r, s.hi[k] = one + r;
      if (k % (N + 1) && n / 8 % 2) s.lo[k] += 0.1;
      if (s.lo[k] > s.hi[k]) s.hi[k] = s.lo[k];
    }
    for (size_t i = 0; i < N; i++) s.b[i].lo = between(-1, 1), s.b[i].hi = s.b[i].lo + (n % 3 ? between(0, 1) : 0);
    set(&s);
    if (!krawczyk_is_regular(&s.k)) continue;
    if (n / 16 % 4)
      krawczyk_hull_solution(&s.k, s.z);
    else
      krawczyk_bound_solution(&s.k, s.z);
    for (uint32_t corner = 0; corner < 1u << (N * N + N); corner++) check_corner(&s, corner);
  }
  ambit_scope_close(s.scope);
}

/* one row a z = -b for a around 0: solutions of the corners are in z, and none of them between the ends of the gap */
static void gaps_hold_no_solution(void **unused) {
  (void)unused;
  sample s;
  uint32_t gaps = 0;
  sample_open(&s);
  s.k.n = 1;
  mpfr_t x;
  mpfr_init2(x, BITS);
  for (int n = 0; n < 5000; n++) {
    double a[2] = { -between(0.01, 2), between(0.01, 2) }, side = below(2) ? 1 : -1, least = side * between(0.01, 1);
    double b[2] = { least, least + (below(2) ? 0 : side * between(0, 1)) };
    s.diagonal[0] = (span) { a[0], a[1] }, s.b[0] = (span) { fmin(b[0], b[1]), fmax(b[0], b[1]) };
    s.z[0] = (span) { -between(0.1, 9), between(0.1, 9) }, s.mid[0].lo = s.mid[0].hi = between(-3, 3);
    span before = s.z[0];
    s.k.gap = (gap) { 0 };
    int some = krawczyk_sweep(&s.k, s.z);
    gaps += s.k.gap.hi > s.k.gap.lo;
    for (int corner = 0; corner < 4; corner++) {
      mpfr_set_d(x, -b[corner / 2], MPFR_RNDN), mpfr_div_d(x, x, a[corner % 2], MPFR_RNDN);
      if (mpfr_cmp_d(x, before.lo) < 0 || mpfr_cmp_d(x, before.hi) > 0) continue;
      assert_true(some && mpfr_cmp_d(x, s.z[0].lo) >= 0 && mpfr_cmp_d(x, s.z[0].hi) <= 0);
      mpfr_add_d(x, x, s.mid[0].lo, MPFR_RNDN);
      if (s.k.gap.hi > s.k.gap.lo) assert_true(mpfr_cmp_d(x, s.k.gap.lo) <= 0 || mpfr_cmp_d(x, s.k.gap.hi) >= 0);
    }
  }
  assert_true(gaps > 1000);
  mpfr_clear(x);
  ambit_scope_close(s.scope);
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(singular_matrices_are_not_regular),
    cmocka_unit_test(solutions_of_corners_are_held), cmocka_unit_test(gaps_hold_no_solution) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
