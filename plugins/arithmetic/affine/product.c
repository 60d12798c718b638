/* product.c -- MUL: the linear part exactly as x0 y0 + sum (x0 y_i + y0 x_i) e_i, and a bound of the rest.
**
** With dx = sum x_i e_i + xe e' and dy = sum y_i e_i + ye e'', radii X and Y, the rest is dx dy. Let D = sum x_i y_i
** and P = sum |x_i y_i|, over the symbols (not xe, ye, which are independent).
**
** trivial: |dx dy| <= X Y.
** fast:    sum x_i y_i e_i^2 lies in D/2 +- P/2, as e_i^2 does in [0, 1], and all other terms of dx dy are at most
**          X Y - P. So dx dy lies in D/2 +- (X Y - P/2). [Kolev, Reliable Computing 10, 2004]
** tight:   the others one by one: D/2 +- (sum over i < j of |x_i y_j + x_j y_i| + P/2 + xe Y + ye X).
**          [Rump & Kashiwagi, Nonlinear Theory and Its Applications 6(3), 2015]
**
** Rounding. In upward mode the computed P is at least P and at most P (1 + 2^-52)^n + n 2^-1074, n the length of the
** longest chain of additions, less than the number of coefficients; the computed D is within n 2^-51 P + n 2^-1073 of
** D, as every partial sum is below the computed P. One allowance covers both: slack = 4 n 2^-52 P + n 2^-1022 (a normal
** number: subnormal ones are slow); P = 0 means that all terms are 0 exactly. The terms of `tight` are rounded each: by
** 2^-52 of |x_i y_j| + |x_j y_i| (twice without FMA), together less than (2^-51 + 2^-66) X Y + n^2 2^-1022.
*/
#include "affine.h"

double affine_pairwise(const affine_context *c, const affine_element *x, const affine_element *y, double xy,
    double squares, double radius) {
  uint64_t blocks = x->blocks < y->blocks ? x->blocks : y->blocks;
  double n = (double)(blocks * AFFINE_BLOCK), common = c->kernels->pairs(x->coef, y->coef, blocks);
  /* symbols of one operand only, with all of the other */
  double lone = 0;
  if (x->blocks > blocks) lone = c->kernels->size(x->coef + blocks * AFFINE_BLOCK, x->blocks - blocks) * y->rad;
  if (y->blocks > blocks) lone = c->kernels->size(y->coef + blocks * AFFINE_BLOCK, y->blocks - blocks) * x->rad;
  double sum = common + lone + (x->err * y->rad + y->err * x->rad) + (0x1.0001p-51 * xy + n * n * 0x1p-1022) + squares;
  return sum < radius ? sum : radius; /* NaN: radius */
}
