/* substitute.c -- x := mid + rad y along the powers of one variable: Taylor shift by mid with Horner's scheme, then
** scaling by powers of rad.
**
** Coefficient j of the result is sum over k of binomial(k, j) t_k mid^(k-j) rad^j. In the scheme a value moves down by
** one power (a product) or on by one pass, each with one sum, order times at most; then it is multiplied by a power of
** rad, which took as many products. So t_k meets at most 4 order + 1 roundings, of a relative 2^-52 each (or 2^-1074
** below the normal range), and over all j the magnitudes add up to |t_k| (|mid| + rad)^k <= |t_k|: together at most (4
** order + 2) 2^-52 times the sum of |t_k|, with room for higher powers.
*/
#include "substitute.h"
#include <math.h>

#define ROUNDOFF 0x1.01p-52

/* the monomials i, i x_v, i x_v^2, ...; 0 if i contains x_v */
static uint32_t chain_of(const monomials *m, uint32_t i, uint32_t v, uint32_t *chain) {
  for (uint32_t j = i; j; j = m->parent[j])
    if (m->last[j] == v) return 0;
  uint32_t n = 1;
  chain[0] = i;
  for (; m->degree[i] + n <= m->order; n++) chain[n] = monomials_product(m, 1 + v, chain[n - 1]);
  return n;
}

static void shift_and_scale(double *t, uint32_t n, double mid, double rad) {
  for (uint32_t pass = 0; pass + 1 < (rad == 0 ? 2 : n); pass++)
    for (uint32_t k = n - 1; k-- > pass;) t[k] += mid * t[k + 1];
  double f = 1;
  for (uint32_t k = 0; k < n; k++) t[k] *= f, f *= rad;
}

void substitute_variable(const monomials *m, double *coef, uint32_t v, double mid, double rad) {
  uint32_t chain[MONOMIALS_ORDER_MAX + 1];
  double t[MONOMIALS_ORDER_MAX + 1];
  for (uint32_t i = 0; i < m->first[m->order]; i++) {
    uint32_t n = chain_of(m, i, v, chain), any = 0;
    for (uint32_t k = 1; k < n; k++) any |= coef[chain[k]] != 0;
    if (!any) continue;
    for (uint32_t k = 0; k < n; k++) t[k] = coef[chain[k]];
    shift_and_scale(t, n, mid, rad);
    for (uint32_t k = 0; k < n; k++) coef[chain[k]] = t[k];
  }
}

double substitute_error(const monomials *m, double size) {
  return (4 * m->order + 2) * ROUNDOFF * size + m->count * 0x1p-1060;
}
