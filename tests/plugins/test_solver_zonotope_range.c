/* Hulls of polynomials over the cube (range.c): they hold values at points, and are exact for sums of parabolas. */
#include "zonotope_case.h"

static void hulls_hold_their_polynomials(void **unused) {
  (void)unused;
  static zono z;
  static maker k;
  double nearest = 1;
  for (uint32_t n = 0; n < 300; n++) {
    open_case(&z, &k, 2, 0, n % 2);
    assert_true(zono_open_proof(&z));
    const shape *s = &z.shape;
    z.lo = lend(&host, 16), z.hi = lend(&host, 16);
    double *x = z.P, high = -INFINITY, low = INFINITY;
    if (n % 3 == 0)
      for (uint32_t v = 0; v < s->m; v++) x[1 + v] *= 20; /* monotone */
    if (n % 3 == 1)                                       /* parabolas: the range is exact */
      for (uint32_t v = s->pair[0]; v < s->mix; v++) x[v] = 0;
    for (uint32_t v = 0; v < s->m && n % 3 == 1; v++)
      if (s->reach[v] > v) x[s->pair[v]] = draw(-1, 1);
    row_norms_all(s, x);
    zono_hull(&z);
    for (int m = 0; m < 400; m++) {
      point p;
      draw_point(&z, &p, 0);
      for (uint32_t v = 0; v < s->m && n % 3 == 1; v++) { /* where it is highest or lowest in each */
        double d = s->reach[v] > v ? x[s->pair[v]] : 0, top = d != 0 ? -x[1 + v] / (2 * d) : 2;
        p.xi[v] = fabs(top) <= 1 && (m & 1) == (d < 0) ? top : ((m & 1) == (x[1 + v] > 0) ? 1 : -1);
      }
      long double value = value_at(s, x, &p) + (m & 1 ? z.E[0] : -z.E[0]);
      if (!(value >= z.lo[0] && value <= z.hi[0])) fail_msg("%Lg is not in [%g, %g]", value, z.lo[0], z.hi[0]);
      high = fmax(high, (double)value), low = fmin(low, (double)value);
    }
    if (n % 3 == 1) nearest = fmin(nearest, (high - low) / (z.hi[0] - z.lo[0]));
    give_back();
  }
  if (nearest < 1 - 1e-9) fail_msg("only %.15g of ranges of parabolas is reached", nearest);
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(hulls_hold_their_polynomials) };
  return cmocka_run_group_tests_name("zonotope: ranges", tests, NULL, NULL);
}
