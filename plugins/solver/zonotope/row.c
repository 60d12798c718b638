/* row.c -- which monomials a row holds, and lists of what is to be summed. */
#include "row.h"

/* -- shape */

static void place_lean(shape *s) {
  s->norms = 1, s->eps = 1 + ENDS, s->cube = (s->eps + 3) / 4 * 4;
  s->pair[0] = s->mix = s->eps + s->nx;
  s->stride = (s->mix + 3 + 3) / 4 * 4;
}

void shape_place(shape *s) {
  if (s->lean) {
    place_lean(s);
    return;
  }
  uint32_t at = 1 + s->m + s->nx;
  s->eps = 1 + s->m;
  for (uint32_t i = 0; i < s->m; i++) {
    s->pair[i] = at;
    at += s->reach[i] > i ? s->reach[i] - i : 0;
  }
  s->pair[s->m] = at;
  s->mix = at;
  s->norms = s->mix + s->mixed * s->nx;
  for (uint32_t i = s->cubic; i-- > 0;)
    if (s->reach[i] < s->cubic) s->cubic = i;
  if (s->room == 0) s->cubic = 0;
  if (s->cubic == 0) s->cubed = s->room = 0;
  s->cube = (s->norms + ENDS + 4) / 4 * 4;
  s->triples = s->cubic * (s->cubic + 1) * (s->cubic + 2) / 6;
  s->stride = s->triples ? (s->cube + s->triples + 3 + 3) / 4 * 4 : s->cube; /* the last vector may run over */
}

#define CUBIC_ALL 34  /* data that have triples if there are no more, */
#define CUBIC_MOST 20 /* and if there are: far.c has others */
#define ERRING 16     /* orders that have room for eps, where there are no data */
#define CUBED 3       /* orders that have room for triples */

void shape_hold_all(shape *s) {
  s->paired = s->mixing = UINT32_MAX;
  s->erring = s->lean ? s->room : UINT32_MAX, s->cubed = s->lean ? 0 : s->room;
}

void shape_lean(shape *s) {
  s->lean = 1, s->room = ERRING;
  shape_hold_all(s), shape_place(s);
}

int shape_open(const ambit_host *h, shape *s, uint32_t m, uint32_t nx) {
  *s = (shape) { .m = m,
    .nx = nx,
    .mixed = m,
    .cubic = m <= CUBIC_ALL ? m : CUBIC_MOST,
    .room = CUBED,
    .sum = sum_portable,
    .counted = ambit_work_open(h) };
  shape_hold_all(s);
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) s->sum = sum_avx2;
#endif
  s->reach = h->alloc(h, (m + 1u) * sizeof *s->reach), s->pair = h->alloc(h, (m + 1u) * sizeof *s->pair);
  if (!s->reach || !s->pair) return 0;
  for (uint32_t i = 0; i < m; i++) s->reach[i] = m;
  shape_place(s);
  s->scratch = h->alloc(h, 3 * (s->stride + 8u) * sizeof *s->scratch); /* a lean row may be a bit longer */
  return s->scratch != NULL;
}

/* -- rows */

static double sizes(const double *x, uint32_t from, uint32_t to) {
  double sum = 0;
  for (uint32_t i = from; i < to; i++) sum += fabs(x[i]);
  return sum;
}

void row_norms(const shape *s, double *x) {
  double *norm = x + s->norms;
  norm[NORM_L] = sizes(x, 1, 1 + s->m), norm[NORM_R] = sizes(x, s->eps, s->pair[0]);
  norm[NORM_Q] = sizes(x, s->pair[0], s->mix), norm[NORM_X] = sizes(x, s->mix, s->norms);
  norm[NORM_L_FAR] = sizes(x, 1 + s->cubic, 1 + s->m), norm[NORM_Q_FAR] = sizes(x, s->pair[s->cubic], s->mix);
  for (uint32_t i = 0; i < s->cubic; i++) norm[NORM_Q_FAR] += sizes(x, s->pair[i] + s->cubic - i, s->pair[i + 1]);
}

void row_norms_all(const shape *s, double *x) {
  row_norms(s, x);
  x[s->norms + NORM_C] = sizes(x, s->cube, s->cube + s->triples);
}

void row_constant(const shape *s, double *to, double c) {
  if (!s->lean) memset(to, 0, s->pair[0] * sizeof *to);
  memset(to + s->norms, 0, ENDS * sizeof *to);
  to[0] = c;
}

/* -- parts: where they are */

typedef struct range {
  uint32_t from, to;
} range;

/* the ranges of a row's parts that are there */
static uint32_t ranges_of(const shape *s, const double *x, range at[5]) {
  uint32_t n = 0;
  at[n++] = (range) { 0, 1 + s->m };
  if (row_r(s, x) > 0) at[n++] = (range) { s->eps, s->pair[0] };
  if (row_q(s, x) > 0) at[n++] = (range) { s->pair[0], s->mix };
  if (row_x(s, x) > 0) at[n++] = (range) { s->mix, s->norms };
  if (row_c(s, x) > 0) at[n++] = (range) { s->cube, s->cube + s->triples };
  return n;
}

double row_lost(const shape *s, const double *x, uint32_t parts) {
  return (parts & PAIRS ? 0 : row_q(s, x)) + (parts & MIXED ? 0 : row_x(s, x)) + (parts & TRIPLES ? 0 : row_c(s, x)) +
         (parts & ERRORS ? 0 : row_r(s, x));
}

/* norms of parts that `to` does not hold := 0 */
static void leave_out(const shape *s, double *to, uint32_t parts) {
  if (!(parts & PAIRS)) to[s->norms + NORM_Q] = to[s->norms + NORM_Q_FAR] = 0;
  if (!(parts & MIXED)) to[s->norms + NORM_X] = 0;
  if (!(parts & TRIPLES)) to[s->norms + NORM_C] = 0;
  if (!(parts & ERRORS)) to[s->norms + NORM_R] = 0;
}

void row_over(const shape *s, double *to, double over, const double *a, uint32_t parts) {
  range at[5];
  double scale = 1 / over;
  dd middle = over == 1 ? row_middle(s, a) : dd_div(row_middle(s, a), dd_make(over, 0));
  for (uint32_t i = s->norms; i < s->norms + NORMS; i++) to[i] = scale * a[i];
  leave_out(s, to, parts);
  if (row_r(s, to) == 0 && !s->lean) memset(to + s->eps, 0, s->nx * sizeof *to);
  uint32_t n = ranges_of(s, to, at);
  for (uint32_t r = 0; r < n; r++)
    for (uint32_t i = at[r].from; i < at[r].to; i++) to[i] = scale * a[i];
  to[0] = middle.hi, to[s->norms + LOW] = middle.lo;
}

void row_add(const shape *s, double *to, double scale, const double *a) {
  range at[5];
  uint32_t n = ranges_of(s, a, at);
  for (uint32_t r = 0; r < n; r++)
    for (uint32_t i = at[r].from; i < at[r].to; i++) to[i] += scale * a[i];
}

void row_copy(const shape *s, double *to, const double *a) {
  memset(to, 0, s->stride * sizeof *to);
  row_add(s, to, 1, a);
  memcpy(to + s->norms, a + s->norms, ENDS * sizeof *to);
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

/* triples of linear terms of a and pairs of b that are not held: one is far. 10^-15 is for the difference. */
static double dropped_triples(const shape *s, const double *a, const double *b) {
  double far_l = a[s->norms + NORM_L_FAR], q = row_q(s, b), far_q = b[s->norms + NORM_Q_FAR];
  return far_l * fmax(q - far_q + 1e-15 * s->stride * q, 0) + row_l(s, a) * far_q;
}

double row_dropped(const shape *s, const double *a, const double *b, uint32_t parts) {
  double la = row_l(s, a), ra = row_r(s, a), qa = row_q(s, a), last_a = row_x(s, a) + row_c(s, a);
  double lb = row_l(s, b), rb = row_r(s, b), qb = row_q(s, b), last_b = row_x(s, b) + row_c(s, b);
  double sum = la * last_b + ra * (rb + qb + last_b) + qa * (rb + qb + last_b) + last_a * (lb + rb + qb + last_b);
  sum += fabs(a[0]) * row_lost(s, b, parts) + fabs(b[0]) * row_lost(s, a, parts);
  if (parts & TRIPLES)
    sum += dropped_triples(s, a, b) + dropped_triples(s, b, a);
  else
    sum += la * qb + qa * lb;
  if (!(parts & MIXED))
    sum += la * rb + ra * lb;
  else if (s->mixed < s->m)
    sum += sizes(a, 1 + s->mixed, 1 + s->m) * rb + sizes(b, 1 + s->mixed, 1 + s->m) * ra;
  if (!(parts & PAIRS))
    sum += la * lb;
  else if (s->m && s->reach[s->m - 1] < s->m)
    sum += dropped_pairs(s, a, b);
  return sum;
}

/* a^3 - b^3 <= 3 a^2 (a - b): b the linear terms that have triples; without triples all of a^3 */
double row_dropped_cube(const shape *s, const double *x) {
  double all = row_moving(s, x);
  if (!(row_parts(s, 0) & TRIPLES)) return all * all * all;
  return 3 * all * all * (x[s->norms + NORM_L_FAR] + row_r(s, x) + row_bent(s, x));
}

/* -- sums */

#define LANES 8 /* as an operation is counted, whatever vectors the machine has */

void terms_moving(const shape *s, terms *t, double scale, const double *x) {
  if (scale == 0 || row_moving(s, x) == 0) return;
  t->row[t->nrow].scale = scale, t->row[t->nrow++].x = x;
}

/* what is left of a times b when its high part is taken: all errors of it are of order 2^-106 */
static double product_low(dd a, dd b, double rest) { return rest + (a.hi * b.lo + a.lo * b.hi); }

/* the constant += scale a b: twice the digits [Ogita, Rump, Oishi 2005] */
static void add_constant(terms *t, dd scale, dd a, dd b) {
  dd product = two_product(a.hi, b.hi);
  product.lo = product_low(a, b, product.lo);
  if (scale.hi != 1) {
    dd scaled = two_product(product.hi, scale.hi);
    product = dd_make(scaled.hi, product_low(product, scale, scaled.lo));
  }
  dd sum = two_sum(t->c, product.hi);
  t->c = sum.hi, t->low += sum.lo + product.lo;
}

void terms_row(const shape *s, terms *t, double scale, const double *x) {
  add_constant(t, dd_make(1, 0), dd_make(scale, 0), row_middle(s, x));
  terms_moving(s, t, scale, x);
}

void terms_outer(const shape *s, terms *t, double scale, const double *a, const double *b) {
  double la = row_l(s, a), lb = row_l(s, b);
  if (scale == 0) return;
  if (la * (lb + row_r(s, b)) + row_r(s, a) * lb > 0)
    t->outer[t->nouter].scale = scale, t->outer[t->nouter].a = a, t->outer[t->nouter++].b = b;
  if (la * row_q(s, b) > 0) t->bend[t->nbend].scale = scale, t->bend[t->nbend].a = a, t->bend[t->nbend++].b = b;
  if (lb * row_q(s, a) > 0) t->bend[t->nbend].scale = scale, t->bend[t->nbend].a = b, t->bend[t->nbend++].b = a;
}

static void add_product(const shape *s, terms *t, dd scale, const double *a, const double *b) {
  add_constant(t, scale, row_middle(s, a), row_middle(s, b));
  terms_moving(s, t, scale.hi * a[0], b);
  terms_moving(s, t, scale.hi * b[0], a);
  terms_outer(s, t, scale.hi, a, b);
}

void terms_product(const shape *s, terms *t, double scale, const double *a, const double *b) {
  add_product(s, t, dd_make(scale, 0), a, b);
}

void terms_share(const shape *s, terms *t, double scale, uint32_t j, uint32_t k, const double *a, const double *b) {
  add_product(s, t, j == k ? dd_make(scale, 0) : dd_div(dd_make(scale * j, 0), dd_make(k, 0)), a, b);
}

/* vectors of LANES doubles that are multiplied and added */
static uint64_t vectors_of(const shape *s, const terms *t, uint32_t parts) {
  uint64_t pairs = parts & PAIRS ? s->mix - s->pair[0] : 0, mixed = parts & MIXED ? s->norms - s->mix : 0;
  uint64_t triples = parts & TRIPLES ? s->triples : 0, all = 1 + s->m + s->nx + pairs + mixed + triples;
  return (t->nrow * all + t->nouter * (pairs + mixed) + t->nbend * triples) / LANES + 1;
}

void terms_sum(const shape *s, const terms *t, double *to, uint32_t parts) {
  dd middle = two_sum(t->c, t->low);
  if (!t->nrow && !t->nouter && !t->nbend)
    row_constant(s, to, 0);
  else
    s->sum(s, t, to, parts);
  if (s->counted) s->counted->operations += vectors_of(s, t, parts);
  to[0] = middle.hi, to[s->norms + LOW] = middle.lo;
}

/* d = a - its constant: g0 + g1 d + g2 / 2 d^2 + g3 / 6 d^3 */
void row_function(const shape *s, double *to, const double *a, dd value, const double g[4]) {
  double *square = s->scratch;
  uint32_t parts = row_parts(s, 0);
  terms t;
  terms_clear(&t);
  terms_outer(s, &t, 1, a, a);
  terms_sum(s, &t, square, parts);
  terms_clear(&t);
  t.c = value.hi, t.low = value.lo;
  terms_moving(s, &t, g[1], a), terms_moving(s, &t, g[2] / 2, square);
  terms_outer(s, &t, g[3] / 6, a, square);
  terms_sum(s, &t, to, parts);
}

void row_inverse(const shape *s, double *to, const double *a) {
  double i = 1 / a[0], g[4] = { i, -i * i, 2 * i * i * i, -6 * i * i * i * i };
  row_function(s, to, a, dd_div(dd_make(1, 0), row_middle(s, a)), g);
}
