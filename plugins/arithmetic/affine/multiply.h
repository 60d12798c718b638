/* multiply.h -- products; included by variant.h. product.c has the mathematics. Upward mode.
**
** A run goes in groups, first the coefficients of all products of a group, then everything else of all: a single
** product ends in a long chain of dependent additions, and so the processor can work on several at once.
*/
#include "kernels.h"

#define GROUP 8

/* a product on its way: everything that the coefficients tell */
typedef struct halfway {
  affine_element *r;
  const affine_element *x, *y;
  pair hull;   /* minus the lower bound, the upper bound */
  totals sums; /* over the coefficients: gap, size, dot, absdot */
} halfway;

/* both bounded */
INLINE pair multiply_hulls(const affine_element *x, const affine_element *y) {
  double a = -x->nlo, A = x->hi;
  pair from = { x->nlo, a }, to = { -A, A }, b = both(-y->nlo), B = both(y->hi);
  return larger_pair(larger_pair(from * b, to * B), larger_pair(from * B, to * b));
}

INLINE void begin_product(halfway *h) {
  const affine_element *x = h->x, *y = h->y;
  h->hull = multiply_hulls(x, y);
  h->sums = product(h->r->coef, y->centre, x->coef, x->blocks, x->centre, y->coef, y->blocks);
}

/* What n common coefficients lose, from sums instead of one by one: fma(y0, x_i, x0 y_i) is rounded twice, by at most
** 2^-52 (|x0 y_i| + (|y0 x_i| + |x0 y_i|)(1 + 2^-52)) + 2^-1073 (without FMA three times, by at most
** 2^-52 (|x0 y_i| + |y0 x_i|)(2 + 2^-51) + 2^-1072); the sums of |x_i| and |y_i| are at most X and Y. */
INLINE double roundings(double n, double x0, double y0, double X, double Y) {
  return n > 0 ? 0x1.0001p-51 * (fabs(x0) * Y + fabs(y0) * X) + n * 0x1p-1022 : 0;
}

INLINE uint32_t end_product(const affine_context *c, const halfway *h, int64_t symbol) {
  const affine_element *x = h->x, *y = h->y;
  affine_element *r = h->r;
  totals s = h->sums;
  size_t common = x->blocks < y->blocks ? x->blocks : y->blocks;
  double x0 = x->centre, y0 = y->centre, xy = x->rad * y->rad, n = (double)(int64_t)(AFFINE_BLOCK * common);
  double own = (fabs(x0) * y->err + fabs(y0) * x->err) + roundings(n, x0, y0, x->rad, y->rad);
  double half = 0.5 * s.d, slack = s.d > 0 ? s.d * (n * 0x1p-50) + n * 0x1p-1022 : 0, shift = 0.5 * s.c;
  double radius = (xy - half) + slack;
  if (c->tight) radius = affine_pairwise(c, x, y, xy, half + slack, radius);
  r->blocks = x->blocks > y->blocks ? x->blocks : y->blocks;
  r->centre = x0 * y0 + shift;
  double below = (-x0) * y0 - shift; /* minus the centre's lower bound */
  return finish(c, r, h->hull, s.b, (radius + (own + s.a)) + (r->centre + below), symbol);
}

static uint32_t multiply(
    const affine_context *c, affine_element *r, const affine_element *x, const affine_element *y, int64_t symbol) {
  halfway h = { .r = r, .x = x, .y = y };
  begin_product(&h);
  return end_product(c, &h, symbol);
}

typedef struct batch {
  affine_context *c;
  uint32_t flags, outcome; /* of whole instructions, of the lanes so far of the one being completed */
  size_t n, lane, lanes;   /* products on their way; the next lane to be completed */
  const uint32_t *dst;     /* its instruction's slot */
  halfway pending[GROUP];
} batch;

/* one lane more: the next instruction takes the next symbol */
INLINE void settle(batch *g, uint32_t outcome) {
  g->outcome |= outcome;
  if (++g->lane < g->lanes) return;
  g->c->next += g->outcome >> 31;
  g->flags |= g->outcome & ~AFFINE_TAKEN;
  g->outcome = 0, g->lane = 0, g->dst++;
}

INLINE void complete(batch *g) {
  for (size_t i = 0; i < g->n; i++) settle(g, end_product(g->c, &g->pending[i], affine_symbol(g->c, *g->dst)));
  g->n = 0;
}

INLINE int is_usual(const affine_context *c, const affine_element *x) {
  return affine_has_form(x) && (x->blocks <= c->vblocks || x->epoch == c->epoch);
}

/* The last entry has operands of another epoch, or without a form: it waits for nobody. */
static void multiply_rare(batch *g) {
  const halfway *h = &g->pending[g->n];
  complete(g);
  const affine_element *x = affine_operand(g->c, h->x, 0), *y = affine_operand(g->c, h->y, 1);
  int forms = affine_has_form(x) && affine_has_form(y);
  settle(g, forms ? multiply(g->c, h->r, x, y, affine_symbol(g->c, *g->dst))
                  : affine_by_hull(g->c, AMBIT_OP_MUL, h->r, x, y, 0));
}

static uint32_t run_mul(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes, size_t count,
    const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  (void)self;
  batch g = { .c = ctx, .lanes = lanes, .dst = dst };
  size_t elem = g.c->elem, stride = pitch * elem, row = lanes * elem;
  for (size_t i = 0; i < count; i++)
    for (size_t l = 0; l < row; l += elem) {
      char *place = (char *)base + l;
      halfway *h = &g.pending[g.n];
      h->r = (void *)(place + dst[i] * stride);
      h->x = (void *)(place + a[i] * stride), h->y = (void *)(place + b[i] * stride);
      if (is_usual(g.c, h->x) && is_usual(g.c, h->y)) {
        begin_product(h);
        if (++g.n == GROUP) complete(&g);
      } else
        multiply_rare(&g);
    }
  complete(&g);
  return g.flags;
}
