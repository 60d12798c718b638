/* Cuts by invariants, each against what is exact: constraints that know time, curved ones bounded piece by piece, sets
** that touch the manifold in one point, the vertices of boxes cut by planes, constraints with a kink. */
#include "constrained_models.h"
#include "solver_track.h"

#define BITS 3000 /* coordinates that cancel to zero must do so */
#define COUNT(array) (sizeof(array) / sizeof *(array))
#define DIMENSIONS 4

/* -- g(x, t) is taken at the end of the step */

static void time_in_a_constraint_is_that_of_the_end(void **unused) {
  (void)unused;
  static const char *const name[] = { "x", "y" };
  static const double forward[] = { -0.7, 0x1.23p-50, 3 }, backward[] = { 2, 1e-20, -1 };
  for (int n = 0; n < 2; n++) {
    const double *time = n ? backward : forward;
    constrained c;
    constrained_open(&c, 2, name);
    model *m = &c.m;
    expr t = ambit_graph_time(m->graph), off = sub(m, m->state[0], sine(m, t));
    m->rate[0] = add(m, cosine(m, t), off), m->rate[1] = m->state[0]; /* off the manifold, x runs away */
    double at = sin(time[0]);
    m->initial[0] = unknown(m, "x", at - 1e-3, at + 1e-3), m->initial[1] = number(m, 0);
    constrained_add(&c, "x is sin t", off);
    track k = track_run(m, 3, time, 0, NULL);
    if (k.result.status != AMBIT_OK) fail_msg("%s", k.result.reason);
    mpfr_t x, y;
    mpfr_inits2(BITS, x, y, (mpfr_ptr)0);
    for (size_t i = 0; i < k.count; i++) { /* y = cos time[0] - cos t */
      const track_record *r = &k.record[i];
      mpfr_set_d(x, r->to, MPFR_RNDN), mpfr_sin_cos(x, y, x, MPFR_RNDN);
      assert_true(mpfr_cmp_d(x, r->lo[0]) >= 0 && mpfr_cmp_d(x, r->hi[0]) <= 0);
      assert_true(r->hi[0] - r->lo[0] < 1e-14);
      mpfr_set_d(x, time[0], MPFR_RNDN), mpfr_cos(x, x, MPFR_RNDN), mpfr_sub(y, x, y, MPFR_RNDN);
      assert_true(mpfr_cmp_d(y, r->lo[1]) >= 0 && mpfr_cmp_d(y, r->hi[1]) <= 0);
    }
    mpfr_clears(x, y, (mpfr_ptr)0);
    track_close(&k);
    model_close(m);
  }
}

/* -- y = x^2 for x = u/(1 - u t), u in [-0.1, 0.1]: what lies beside the parabola is driven away fast, so that every
** step ends with a cut, over pieces of u. For one u of each piece at least the truth is known. */

static void every_piece_of_a_curved_constraint_counts(void **unused) {
  (void)unused;
  static const char *const name[] = { "x", "y" }, *const pieces[] = { "1", "8", "16" };
  static const double time[] = { 0, 0.5 };
  for (size_t n = 0; n < COUNT(pieces); n++) {
    const ambit_option option[] = { { "pieces", pieces[n] } };
    constrained c;
    constrained_open(&c, 2, name);
    model *m = &c.m;
    const expr *s = m->state;
    expr off = sub(m, s[1], square(m, s[0]));
    m->rate[0] = square(m, s[0]);
    m->rate[1] = add(m, mul(m, number(m, 2), mul(m, s[0], square(m, s[0]))), mul(m, number(m, 50), off));
    m->initial[0] = unknown(m, "u", -0.1, 0.1), m->initial[1] = unknown(m, "y", -0.2, 0.2);
    constrained_add(&c, "parabola", off);
    track k = track_run(m, 2, time, 1, option);
    if (k.result.status != AMBIT_OK) fail_msg("%s pieces: %s", pieces[n], k.result.reason);
    for (size_t i = 0; i < k.count; i++)
      for (int j = -20; j <= 20; j++) {
        const track_record *r = &k.record[i];
        double u = 0.005 * j, x = u / (1 - u * r->to), y = x * x;
        if (!(r->lo[0] <= x + 1e-15 && x - 1e-15 <= r->hi[0] && r->lo[1] <= y + 1e-15 && y - 1e-15 <= r->hi[1]))
          fail_msg("%s pieces, u = %g, t = %g: y = %g in [%g, %g]", pieces[n], u, r->to, y, r->lo[1], r->hi[1]);
        assert_true(r->hi[1] - r->lo[1] < 0.3);
      }
    track_close(&k);
    model_close(m);
  }
}

/* -- a plane that touches the box in one corner: the hull becomes a point, the set that is kept does not, and the run
** goes on as it does without the constraint */

static void a_set_that_touches_the_manifold_goes_on(void **unused) {
  (void)unused;
  static const char *const name[] = { "a", "b" };
  static const double time[] = { 0, 1 };
  constrained c;
  constrained_open(&c, 2, name);
  model *m = &c.m;
  m->rate[0] = m->rate[1] = number(m, 0);
  m->initial[0] = unknown(m, "a", -471, 0.01), m->initial[1] = unknown(m, "b", 0.02, 8.5);
  expr a = sub(m, m->state[0], number(m, 0.01)), b = sub(m, m->state[1], number(m, 0.02));
  constrained_add(&c, "corner", sub(m, mul(m, number(m, 1.1), b), mul(m, number(m, 0.64), a)));
  track k = track_run(m, 2, time, 0, NULL);
  if (k.result.status != AMBIT_OK) fail_msg("%s", k.result.reason);
  const track_record *r = &k.record[k.count - 1];
  assert_true(r->lo[0] <= 0.01 && 0.01 <= r->hi[0] && r->lo[1] <= 0.02 && 0.02 <= r->hi[1]);
  track_close(&k);
  model_close(m);
}

/* -- random boxes, cut by one to three random planes through a point of them: no vertex of what is left is lost */

typedef struct planes {
  size_t n, k;
  double normal[DIMENSIONS][DIMENSIONS], at[DIMENSIONS], lo[DIMENSIONS], hi[DIMENSIONS];
} planes;

static planes any_planes(uint64_t *random) {
  planes p = { .n = 2 + oracle_random(random) % 3 };
  p.k = 1 + oracle_random(random) % (p.n - 1);
  double scale = exp2(oracle_uniform(random, -40, 0));
  for (size_t i = 0; i < p.n; i++) {
    double r = scale * exp2(oracle_uniform(random, -6, 3)) * (oracle_random(random) % 6 ? 1 : 1000);
    uint64_t end = oracle_random(random) % 3;
    p.at[i] = oracle_uniform(random, -8, 8);
    p.lo[i] = end == 1 ? p.at[i] : p.at[i] - r, p.hi[i] = end == 2 ? p.at[i] : p.at[i] + r;
    for (size_t j = 0; j < p.k; j++) p.normal[j][i] = oracle_random(random) % 5 ? oracle_uniform(random, -2, 2) : 0;
  }
  return p;
}

static void model_planes(constrained *c, const planes *p) {
  static const char *const name[] = { "a", "b", "c", "d" };
  constrained_open(c, p->n, name);
  model *m = &c->m;
  for (size_t i = 0; i < p->n; i++) {
    m->rate[i] = number(m, 0);
    m->initial[i] = unknown(m, name[i], p->lo[i], p->hi[i]);
  }
  for (size_t j = 0; j < p->k; j++) {
    expr sum = number(m, 0);
    for (size_t i = 0; i < p->n; i++)
      sum = add(m, sum, mul(m, number(m, p->normal[j][i]), sub(m, m->state[i], number(m, p->at[i]))));
    constrained_add(c, "plane", sum);
  }
}

/* The vertex whose coordinates in `solved` follow from the planes, the others being at ends of their ranges. 0: there
** is none, or it is badly conditioned. */
static int find_vertex(const planes *p, unsigned solved, unsigned high, mpfr_t *x, mpfr_t (*A)[DIMENSIONS + 1]) {
  size_t column[DIMENSIONS], k = 0;
  for (size_t i = 0; i < p->n; i++)
    if (solved >> i & 1)
      column[k++] = i;
    else
      mpfr_set_d(x[i], high >> i & 1 ? p->hi[i] : p->lo[i], MPFR_RNDN);
  mpfr_t *f = &A[DIMENSIONS - 1][DIMENSIONS]; /* k < DIMENSIONS: free */
  for (size_t r = 0; r < k; r++) {
    mpfr_set_zero(A[r][k], 1);
    for (size_t j = 0; j < k; j++) mpfr_set_d(A[r][j], p->normal[r][column[j]], MPFR_RNDN);
    for (size_t i = 0; i < p->n; i++) {
      if (solved >> i & 1) continue;
      mpfr_sub_d(*f, x[i], p->at[i], MPFR_RNDN), mpfr_mul_d(*f, *f, p->normal[r][i], MPFR_RNDN);
      mpfr_sub(A[r][k], A[r][k], *f, MPFR_RNDN);
    }
  }
  for (size_t c = 0; c < k; c++) {
    size_t best = c;
    for (size_t r = c; r < k; r++)
      if (mpfr_cmpabs(A[r][c], A[best][c]) > 0) best = r;
    if (fabs(mpfr_get_d(A[best][c], MPFR_RNDN)) < 1e-6) return 0;
    for (size_t j = 0; j <= k; j++) mpfr_swap(A[c][j], A[best][j]);
    for (size_t r = 0; r < k; r++)
      for (size_t j = k + 1; j-- > c && r != c;) { /* column c last: it is the factor */
        mpfr_div(*f, A[r][c], A[c][c], MPFR_RNDN), mpfr_mul(*f, *f, A[c][j], MPFR_RNDN);
        mpfr_sub(A[r][j], A[r][j], *f, MPFR_RNDN);
      }
  }
  for (size_t j = 0; j < k; j++) {
    mpfr_div(x[column[j]], A[j][k], A[j][j], MPFR_RNDN);
    mpfr_add_d(x[column[j]], x[column[j]], p->at[column[j]], MPFR_RNDN);
  }
  for (size_t i = 0; i < p->n; i++)
    if (mpfr_cmp_d(x[i], p->lo[i]) < 0 || mpfr_cmp_d(x[i], p->hi[i]) > 0) return 0;
  return 1;
}

static void no_vertex_is_lost(void **unused) {
  (void)unused;
  static const double time[] = { 0, 1 };
  static const ambit_option option[] = { { "set", "qr" } };
  uint64_t random = 2024;
  size_t vertices = 0, cut = 0;
  mpfr_t x[DIMENSIONS], A[DIMENSIONS][DIMENSIONS + 1];
  for (size_t i = 0; i < DIMENSIONS; i++) {
    mpfr_init2(x[i], BITS);
    for (size_t j = 0; j <= DIMENSIONS; j++) mpfr_init2(A[i][j], BITS);
  }
  for (int n = 0; n < 600; n++) {
    planes p = any_planes(&random);
    constrained c;
    model_planes(&c, &p);
    track k = track_run(&c.m, 2, time, n % 3 == 0, option);
    if (k.result.status != AMBIT_OK) fail_msg("planes %d: %s", n, k.result.reason);
    const track_record *r = &k.record[k.count - 1];
    for (unsigned solved = 0; solved < 1u << p.n; solved++)
      for (unsigned high = 0; high < 1u << p.n; high++) {
        if ((size_t)__builtin_popcount(solved) != p.k || (high & solved) || !find_vertex(&p, solved, high, x, A))
          continue;
        vertices++;
        for (size_t i = 0; i < p.n; i++)
          if (mpfr_cmp_d(x[i], r->lo[i]) < 0 || mpfr_cmp_d(x[i], r->hi[i]) > 0) fail_msg("planes %d, state %zu", n, i);
      }
    for (size_t i = 0; i < p.n; i++) cut += r->hi[i] - r->lo[i] < 0.99 * (p.hi[i] - p.lo[i]);
    track_close(&k);
    model_close(&c.m);
  }
  assert_true(vertices > 1000 && cut > 500);
  for (size_t i = 0; i < DIMENSIONS; i++) {
    mpfr_clear(x[i]);
    for (size_t j = 0; j <= DIMENSIONS; j++) mpfr_clear(A[i][j]);
  }
}

/* -- dependent rows leave the cut of a wide box as it is; a kink on the manifold switches it off, and loses nothing */

static void kinks_switch_cuts_off(void **unused) {
  (void)unused;
  static const double at[] = { 1, 0, 0, 0 }, time[] = { 0, 10 };
  double widest[4];
  for (int n = 0; n < 4; n++) { /* none; norm; norm and its square; norm and its size */
    constrained c;
    model_quaternion(&c, 1, 0);
    model *m = &c.m;
    expr norm = c.invariant[0];
    for (size_t i = 0; i < 4; i++) m->initial[i] = unknown(m, m->name[i], at[i] - 1e-3, at[i] + 1e-3);
    if (n == 0) m->system.ninvariant = 0;
    if (n == 2) constrained_add(&c, "its square", square(m, norm));
    if (n == 3) constrained_add(&c, "its size", ambit_graph_op(m->graph, AMBIT_OP_ABS, norm, norm));
    track k = track_run(m, 2, time, 0, NULL);
    assert_int_equal(k.result.status, AMBIT_OK);
    widest[n] = track_widest(&k, &k.record[k.count - 1]);
    track_close(&k);
    model_close(m);
  }
  assert_true(widest[1] < 0.95 * widest[0] && widest[2] <= 1.01 * widest[1] && widest[3] == widest[0]);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(time_in_a_constraint_is_that_of_the_end),
    cmocka_unit_test(every_piece_of_a_curved_constraint_counts),
    cmocka_unit_test(a_set_that_touches_the_manifold_goes_on),
    cmocka_unit_test(no_vertex_is_lost),
    cmocka_unit_test(kinks_switch_cuts_off),
  };
  return cmocka_run_group_tests_name("solver lohner cut", tests, NULL, NULL);
}
