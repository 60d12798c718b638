/* row.c -- which monomials a row holds, and lists of what is to be summed. */
#include "row.h"

/* -- shape */

void shape_place(shape *s) {
  uint32_t at = 1 + s->m + s->nx;
  s->eps = 1 + s->m;
  for (uint32_t i = 0; i < s->m; i++) {
    s->pair[i] = at;
    at += s->reach[i] > i ? s->reach[i] - i : 0;
  }
  s->pair[s->m] = at;
  s->mix = at;
  s->norms = s->mix + s->mixed * s->nx;
  s->stride = (s->norms + 4 + 3) / 4 * 4;
}

int shape_open(const ambit_host *h, shape *s, uint32_t m, uint32_t nx) {
  *s = (shape) { .m = m, .nx = nx, .mixed = m, .sum = sum_portable };
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) s->sum = sum_avx2;
#endif
  s->reach = h->alloc(h, (m + 1u) * sizeof *s->reach), s->pair = h->alloc(h, (m + 1u) * sizeof *s->pair);
  if (!s->reach || !s->pair) return 0;
  for (uint32_t i = 0; i < m; i++) s->reach[i] = m;
  shape_place(s);
  return 1;
}

/* -- rows */

static double sizes(const double *x, uint32_t from, uint32_t to) {
  double sum = 0;
  for (uint32_t i = from; i < to; i++) sum += fabs(x[i]);
  return sum;
}

void row_norms(const shape *s, double *x) {
  x[s->norms] = sizes(x, 1, s->eps), x[s->norms + 1] = sizes(x, s->eps, s->pair[0]);
  x[s->norms + 2] = sizes(x, s->pair[0], s->mix), x[s->norms + 3] = sizes(x, s->mix, s->norms);
}

void row_constant(const shape *s, double *to, double c) {
  memset(to, 0, s->stride * sizeof *to);
  to[0] = c;
}

void row_scale(const shape *s, double *to, double scale, const double *a) {
  for (uint32_t i = 0; i < s->norms; i++) to[i] = scale * a[i];
  for (uint32_t i = s->norms; i < s->norms + 4; i++) to[i] = fabs(scale) * a[i];
}

/* pairs of linear terms that are not held: what row i misses is at its end */
static double dropped_pairs(const shape *s, const double *a, const double *b) {
  double sum = 0, far_a = 0, far_b = 0;
  uint32_t from = s->m; /* far_*: data from here on */
  for (uint32_t i = 0; i < s->m; i++) {
    uint32_t first = s->reach[i] > i ? s->reach[i] : i;
    if (i == 0 || first != from) {
      far_a = sizes(a, 1 + first, 1 + s->m), far_b = sizes(b, 1 + first, 1 + s->m);
      from = first;
    }
    double own = first == i ? fabs(a[1 + i] * b[1 + i]) : 0, rest_a = far_a, rest_b = far_b;
    if (first == i) rest_a = sizes(a, 2 + i, 1 + s->m), rest_b = sizes(b, 2 + i, 1 + s->m);
    sum += own + fabs(a[1 + i]) * rest_b + fabs(b[1 + i]) * rest_a;
  }
  return sum;
}

double row_dropped(const shape *s, const double *a, const double *b) {
  double la = row_l(s, a), ra = row_r(s, a), high_a = row_q(s, a) + row_x(s, a);
  double lb = row_l(s, b), rb = row_r(s, b), high_b = row_q(s, b) + row_x(s, b);
  double sum = la * high_b + ra * (rb + high_b) + high_a * (lb + rb + high_b);
  if (s->mixed < s->m) sum += sizes(a, 1 + s->mixed, 1 + s->m) * rb + sizes(b, 1 + s->mixed, 1 + s->m) * ra;
  if (s->m && s->reach[s->m - 1] < s->m) sum += dropped_pairs(s, a, b);
  return sum;
}

/* -- sums */

void terms_moving(const shape *s, terms *t, double scale, const double *x) {
  if (scale == 0 || row_moving(s, x) == 0) return;
  t->row[t->nrow].scale = scale, t->row[t->nrow++].x = x;
}

void terms_row(const shape *s, terms *t, double scale, const double *x) {
  t->c += scale * x[0];
  terms_moving(s, t, scale, x);
}

void terms_outer(const shape *s, terms *t, double scale, const double *a, const double *b) {
  int has = row_l(s, a) * (row_l(s, b) + row_r(s, b)) + row_r(s, a) * row_l(s, b) > 0;
  if (scale == 0 || !has) return;
  t->outer[t->nouter].scale = scale, t->outer[t->nouter].a = a, t->outer[t->nouter++].b = b;
}

void terms_product(const shape *s, terms *t, double scale, const double *a, const double *b) {
  t->c += scale * a[0] * b[0];
  terms_moving(s, t, scale * a[0], b);
  terms_moving(s, t, scale * b[0], a);
  terms_outer(s, t, scale, a, b);
}

void terms_sum(const shape *s, const terms *t, double *to) {
  if (!t->nrow && !t->nouter)
    row_constant(s, to, t->c);
  else
    s->sum(s, t, to);
}

void row_function(const shape *s, double *to, const double *a, double g, double g1, double g2) {
  terms t;
  terms_clear(&t);
  t.c = g;
  terms_moving(s, &t, g1, a);
  terms_outer(s, &t, g2 / 2, a, a);
  terms_sum(s, &t, to);
}
