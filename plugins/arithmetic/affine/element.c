/* element.c -- what every operation does to its operands and to its result. Upward mode.
**
** A result has two enclosures, the hull that the interval functions give and the range of its form; both contain the
** exact image, so their intersection does. The form is dropped for the hull's midpoint and radius where it is not
** finite, and where its err alone is no smaller than that radius.
*/
#include "affine.h"
#include <string.h>

static void without_form(affine_element *r) { r->centre = 0, r->err = INFINITY, r->rad = INFINITY, r->blocks = 0; }

void affine_of_hull(affine_element *r, double nlo, double hi) {
  r->nlo = nlo, r->hi = hi;
  without_form(r);
  double width = hi + nlo;
  if (!(width < INFINITY)) return; /* unbounded, or too wide */
  if (width < 0) {
    r->nlo = r->hi = -INFINITY;
    return;
  }
  r->centre = affine_middle(r); /* any number would do */
  r->err = r->rad = larger(hi - r->centre, r->centre + nlo);
}

void affine_fold(const affine_context *c, affine_element *r, const affine_element *x, uint64_t first) {
  uint64_t kept = x->blocks < first ? x->blocks : first;
  if (r != x) memcpy(r, x, sizeof *x + kept * AFFINE_BLOCK * sizeof *x->coef);
  r->err = x->err + c->kernels->size(x->coef + kept * AFFINE_BLOCK, x->blocks - kept);
  r->blocks = kept;
  r->rad = c->kernels->size(r->coef, kept) + r->err;
  if (!(r->rad < INFINITY)) affine_of_hull(r, r->nlo, r->hi);
}

const affine_element *affine_refresh(const affine_context *c, const affine_element *x, int place) {
  affine_element *copy = c->scratch[place];
  affine_fold(c, copy, x, c->vblocks);
  return copy;
}

/* Is err worth a symbol? Mere roundings are not. */
static int matters(const affine_element *r, int64_t symbol) {
  return symbol != AFFINE_NO_SYMBOL && affine_has_form(r) && r->err > AFFINE_MATTERS * r->rad &&
         r->err > 0x1p-40 * fabs(r->centre);
}

/* err -> the coefficient of a symbol that nobody else has */
static void give_symbol(const affine_context *c, affine_element *r, uint64_t symbol) {
  uint64_t index = c->vblocks * AFFINE_BLOCK + symbol, blocks = index / AFFINE_BLOCK + 1;
  if (r->blocks < blocks)
    memset(r->coef + r->blocks * AFFINE_BLOCK, 0, (blocks - r->blocks) * AFFINE_BLOCK * sizeof *r->coef);
  if (r->blocks < blocks) r->blocks = blocks;
  r->coef[index] = r->err;
  r->err = 0;
  r->epoch = c->epoch;
}

uint32_t affine_finish(const affine_context *c, affine_element *r, double size, double err, int64_t symbol) {
  double up = r->centre + (size + err), down = (size + err) - r->centre;
  r->err = err, r->rad = size + err, r->epoch = c->epoch;
  if (up < INFINITY && down < INFINITY) { /* false for NaN */
    r->hi = smaller(r->hi, up), r->nlo = smaller(r->nlo, down);
    if (!(err < 0.5 * (r->hi + r->nlo))) affine_of_hull(r, r->nlo, r->hi);
  } else
    affine_of_hull(r, r->nlo, r->hi);
  if (!matters(r, symbol)) return affine_flags(r);
  give_symbol(c, r, (uint64_t)symbol);
  return affine_flags(r) | AFFINE_TAKEN;
}

uint32_t affine_constant(const affine_context *c, affine_element *r, double nlo, double hi, int64_t symbol) {
  affine_of_hull(r, nlo, hi);
  r->epoch = c->epoch;
  if (!matters(r, symbol)) return affine_flags(r);
  give_symbol(c, r, (uint64_t)symbol);
  return affine_flags(r) | AFFINE_TAKEN;
}

uint32_t affine_by_hull(const affine_context *c, uint32_t op, affine_element *r, const affine_element *x,
    const affine_element *y, int32_t exponent) {
  const double a[2] = { -x->nlo, x->hi }, b[2] = { -y->nlo, y->hi };
  double bounds[2];
  uint32_t flags = c->num->map(op, 1, bounds, a, b, exponent);
  r->epoch = c->epoch;
  affine_of_hull(r, -bounds[0], bounds[1]);
  return flags;
}
