/* division.c -- DIV and ATAN2. Upward mode.
**
** x / y = q + (x - q y) / y for any double q, here near the quotient of the centres: what x and y have in common
** cancels in x - q y, whose centre is near 0, so the product with the line for 1/y adds almost no error of the
** latter [Rump & Kashiwagi 2015; the same idea as Hansen's generalised intervals, 1975].
**
** The angle of (x, y) is that of (u, v) plus that of (u x + v y, u y - v x), up to full turns: multiply the complex
** x + i y by u - i v. With (u, v) the middle of the box, the second angle is atan of a quotient with a small
** numerator, if u x + v y > 0 on the box. Both sides are continuous on a box that does not cross the cut (x < 0, from
** y >= 0 to y < 0) and does not hold the origin, and agree at (u, v), where the second angle is 0: so they agree
** everywhere.
*/
#include "linearise.h"
#include <float.h>

/* r := 1/y; y keeps its sign */
static void reciprocal(const affine_context *c, affine_element *r, const affine_element *y) {
  linearise_chunk k = { .op = LINEARISE_RECIPROCAL, .n = 1 };
  double nlo = -1 / y->hi, hi = -1 / y->nlo; /* of [-nlo, hi] = [1/y.hi, 1/-y.nlo] */
  r->nlo = nlo, r->hi = hi;
  k.a[0] = -y->nlo, k.b[0] = y->hi, k.flo[0] = -nlo, k.fhi[0] = hi;
  if (y->blocks && k.a[0] < k.b[0] && k.flo[0] >= -DBL_MAX && k.fhi[0] <= DBL_MAX) {
    linearise(c, &k);
    c->kernels->apply(c, r, y, k.slope[0], k.glo[0], k.ghi[0], AFFINE_NO_SYMBOL);
  } else
    affine_of_hull(r, nlo, hi);
}

/* r, whose hull is known, := x / y; y keeps its sign */
static uint32_t quotient(
    const affine_context *c, affine_element *r, const affine_element *x, const affine_element *y, int64_t symbol) {
  affine_element *rest = affine_unbounded(c->scratch[2]), *inverse = c->scratch[3], *part = c->scratch[4];
  int inside = y->centre >= -y->nlo && y->centre <= y->hi; /* else the centre may even be 0 */
  double q = x->centre / (inside ? y->centre : affine_middle(y)), nlo = r->nlo, hi = r->hi;
  if ((x->blocks | y->blocks) == 0 || !(fabs(q) <= DBL_MAX)) return affine_constant(c, r, nlo, hi, symbol);
  affine_combine(c, rest, 1, x, -q, y, AFFINE_NO_SYMBOL);
  reciprocal(c, inverse, y);
  if (!affine_has_form(rest) || !affine_has_form(inverse)) return affine_constant(c, r, nlo, hi, symbol);
  c->kernels->multiply(c, part, rest, inverse, AFFINE_NO_SYMBOL);
  if (!affine_has_form(part)) return affine_constant(c, r, nlo, hi, symbol);
  return c->kernels->apply(c, r, part, 1, q, q, symbol);
}

static int holds_zero(const affine_element *x) { return x->nlo >= 0 && x->hi >= 0; }

static uint32_t divide(
    const affine_context *c, affine_element *r, const affine_element *x, const affine_element *y, int64_t symbol) {
  uint32_t flags = affine_by_hull(c, AMBIT_OP_DIV, r, x, y, 0);
  return holds_zero(y) ? flags : flags | quotient(c, r, x, y, symbol);
}

/* the box holds the origin, or points on both sides of the cut; y = 0 belongs to the side y > 0 */
static int meets_cut(const affine_element *y, const affine_element *x) {
  return holds_zero(y) && (holds_zero(x) || (x->nlo > 0 && y->nlo > 0));
}

/* r, whose hull is known, := atan x + [lo, hi] */
static uint32_t turn(
    const affine_context *c, affine_element *r, const affine_element *x, double lo, double hi, int64_t symbol) {
  linearise_chunk k = { .op = AMBIT_OP_ATAN, .n = 1 };
  double a = -x->nlo, b = x->hi;
  if (!affine_has_form(x) || x->blocks == 0 || !(a < b)) return affine_constant(c, r, r->nlo, r->hi, symbol);
  k.a[0] = a, k.b[0] = b;
  c->num->elementary(AMBIT_OP_ATAN, 1, &a, &b, &a, &b, k.flo, k.fhi);
  linearise(c, &k);
  return c->kernels->apply(c, r, x, k.slope[0], -(-k.glo[0] - lo), k.ghi[0] + hi, symbol);
}

/* (u, v) by a power of 2 to about 1. Where that rounds, v keeps its sign, so the direction stays on its side of the
** cut, and what is said above holds. */
static void scale_direction(double *u, double *v) {
  int e;
  double old = *v;
  frexp(fabs(*u) > fabs(*v) ? *u : *v, &e);
  *u = ldexp(*u, -e), *v = ldexp(*v, -e);
  if (*v == 0 && old != 0) *v = copysign(0x1p-1074, old);
}

/* r, whose hull is known; the box does not meet the cut */
static uint32_t angle_about(
    const affine_context *c, affine_element *r, const affine_element *y, const affine_element *x, int64_t symbol) {
  affine_element *along = affine_unbounded(c->scratch[6]), *across = affine_unbounded(c->scratch[7]),
                 *ratio = c->scratch[5];
  double u = affine_middle(x), v = affine_middle(y), lo, hi;
  if ((x->blocks | y->blocks) == 0 || (u == 0 && v == 0)) return affine_constant(c, r, r->nlo, r->hi, symbol);
  scale_direction(&u, &v);
  affine_combine(c, along, u, x, v, y, AFFINE_NO_SYMBOL);
  affine_combine(c, across, u, y, -v, x, AFFINE_NO_SYMBOL);
  if (!affine_has_form(along) || !affine_has_form(across) || !(along->nlo < 0))
    return affine_constant(c, r, r->nlo, r->hi, symbol);
  affine_by_hull(c, AMBIT_OP_DIV, ratio, across, along, 0);
  quotient(c, ratio, across, along, AFFINE_NO_SYMBOL);
  c->num->elementary(AMBIT_OP_ATAN2, 1, &v, &v, &u, &u, &lo, &hi);
  return turn(c, r, ratio, lo, hi, symbol);
}

static uint32_t angle(
    const affine_context *c, affine_element *r, const affine_element *y, const affine_element *x, int64_t symbol) {
  uint32_t flags = affine_by_hull(c, AMBIT_OP_ATAN2, r, y, x, 0);
  return meets_cut(y, x) ? flags : flags | angle_about(c, r, y, x, symbol);
}

AFFINE_RUN(affine_run_DIV, DIV, divide, b)
AFFINE_RUN(affine_run_ATAN2, ATAN2, angle, b)
