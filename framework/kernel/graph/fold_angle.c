/* fold_angle.c -- the addition theorems, read from right to left, under a common factor G:
**
**   G sin^2 a + G cos^2 a = G                    G cos^2 a - G sin^2 a = G cos(a + a)
**   G cos a cos b -+ G sin a sin b = G cos(a +- b)
**   G sin a cos b +- G cos a sin b = G sin(a +- b)
**
** They make a chain of rotations about one axis the rotation by the sum of the angles. G is total or not on both
** sides alike.
*/
#include "graph/fold.h"

#define FACTORS 10u

typedef struct factors {
  size_t count;
  ambit_expr factor[FACTORS];
} factors;

static bool add_factor(factors *f, ambit_expr e, uint32_t times) {
  if (f->count + times > FACTORS) return false;
  for (uint32_t i = 0; i < times; i++) f->factor[f->count++] = e;
  return true;
}

/* body as a list of factors, powers written out; false: too many. */
static bool read_factors(const ambit_graph *g, ambit_expr body, factors *f) {
  ambit_item item[FACTORS];
  size_t n = ambit_fold_items(g, AMBIT_OP_MUL, body, FACTORS, item);
  if (n == FACTORS) return false; /* perhaps cut */
  f->count = 0;
  for (size_t i = 0; i < n; i++) {
    const ambit_node *x = ambit_at(g, item[i].e);
    bool power = x->op == AMBIT_OP_POWN && (int32_t)x->b > 0;
    bool fits = x->op == AMBIT_OP_SQR ? add_factor(f, x->a, 2)
                : power               ? add_factor(f, x->a, x->b)
                                      : add_factor(f, item[i].e, 1);
    if (!fits) return false;
  }
  return true;
}

static bool take(factors *f, ambit_expr e) {
  for (size_t i = 0; i < f->count; i++)
    if (f->factor[i] == e) {
      f->factor[i] = f->factor[--f->count];
      return true;
    }
  return false;
}

/* Moves the common factors of s and t to `common`. */
static void take_common(factors *s, factors *t, factors *common) {
  factors left = { 0 };
  common->count = 0;
  for (size_t i = 0; i < s->count; i++)
    if (take(t, s->factor[i]))
      common->factor[common->count++] = s->factor[i];
    else
      left.factor[left.count++] = s->factor[i];
  *s = left;
}

static uint32_t op_of(const ambit_graph *g, ambit_expr e) { return ambit_at(g, e)->op; }
static ambit_expr angle_of(const ambit_graph *g, ambit_expr e) { return ambit_at(g, e)->a; }

/* Are the two factors functions p and q? Then their angles, that of p first. */
static bool read_pair(const ambit_graph *g, const factors *f, uint32_t p, uint32_t q, ambit_expr *a, ambit_expr *b) {
  for (size_t i = 0; i < 2; i++)
    if (op_of(g, f->factor[i]) == p && op_of(g, f->factor[1 - i]) == q) {
      *a = angle_of(g, f->factor[i]);
      *b = angle_of(g, f->factor[1 - i]);
      return true;
    }
  return false;
}

/* s + t, or s - t unless same_sign, as a function of one angle; false: they are no such pair. s has the cosines, or
** gives the sign. */
static bool add_angles(ambit_graph *g, const factors *s, const factors *t, bool same_sign, ambit_expr *r) {
  ambit_expr a, b, p, q;
  if (read_pair(g, s, AMBIT_OP_COS, AMBIT_OP_COS, &a, &b) && read_pair(g, t, AMBIT_OP_SIN, AMBIT_OP_SIN, &p, &q)) {
    if (!((a == p && b == q) || (a == q && b == p))) return false;
    bool one = a == b && same_sign;
    if (one && !ambit_at(g, a)->total) return false; /* 1 would be defined where a is not */
    *r = one ? AMBIT_ONE : ambit_graph_op(g, AMBIT_OP_COS, ambit_fold_sum(g, a, b, same_sign), 0);
    return true;
  }
  if (read_pair(g, s, AMBIT_OP_SIN, AMBIT_OP_COS, &a, &b) && read_pair(g, t, AMBIT_OP_SIN, AMBIT_OP_COS, &p, &q)) {
    if (a != q || b != p) return false;
    *r = ambit_graph_op(g, AMBIT_OP_SIN, ambit_fold_sum(g, a, b, !same_sign), 0);
    return true;
  }
  return false;
}

static ambit_expr collect(ambit_graph *g, double c, const factors *common, ambit_expr last) {
  ambit_expr r = AMBIT_ONE;
  for (size_t i = 0; i < common->count; i++) r = ambit_fold_product(g, r, common->factor[i]);
  return ambit_fold_scale(g, c, ambit_fold_product(g, r, last));
}

/* c body + c body = c G sin(a + a) where body = G sin a cos a */
static bool double_angle(ambit_graph *g, double c, factors *f, ambit_expr *r) {
  for (size_t i = 0; i < f->count; i++)
    for (size_t j = 0; j < f->count; j++) {
      ambit_expr s = f->factor[i], k = f->factor[j];
      if (op_of(g, s) != AMBIT_OP_SIN || op_of(g, k) != AMBIT_OP_COS || angle_of(g, s) != angle_of(g, k)) continue;
      ambit_expr a = angle_of(g, s);
      take(f, s);
      take(f, k);
      *r = collect(g, c, f, ambit_graph_op(g, AMBIT_OP_SIN, ambit_fold_sum(g, a, a, false), 0));
      return true;
    }
  return false;
}

bool ambit_fold_angles(ambit_graph *g, ambit_term s, ambit_term t, ambit_expr *r) {
  if (fabs(s.c) != fabs(t.c)) return false;
  factors p, q, common;
  if (!read_factors(g, s.body, &p) || !read_factors(g, t.body, &q)) return false;
  if (s.body == t.body) return s.c == t.c && double_angle(g, s.c, &p, r);
  take_common(&p, &q, &common);
  if (p.count != 2 || q.count != 2) return false;
  ambit_expr sum;
  if (add_angles(g, &p, &q, s.c == t.c, &sum))
    *r = collect(g, s.c, &common, sum);
  else if (add_angles(g, &q, &p, s.c == t.c, &sum))
    *r = collect(g, t.c, &common, sum);
  else
    return false;
  return true;
}
