/* field.c -- sums and products of polynomials of s and the unknowns, and tapes over them (field.h).
**
** Rounding: a coefficient of a product is a sum of at most width products in each of at most `pairs` pairs of terms,
** one after the other: it is off by at most (width + pairs + 2) u S, S the sum of magnitudes, by the usual bound
** of sums; the low parts of the centre are left out, which is u S once more. All S together are at most the
** product of norms.
*/
#include "field.h"
#include <string.h>

#define SLACK (1 + 0x1p-40)
#define NEGLIGIBLE 0x1p-75 /* coefficients at a row's end below this share of the norm go to the tail */

static double row_norm(const double *x, uint32_t n) {
  double sum = 0;
  for (uint32_t k = 0; k < n; k++) sum += fabs(x[k]);
  return sum;
}

static double centre_norm(const field *a) { return row_norm(a->c.hi, a->c.n); }

double field_rest(const fields *f, const field *a) {
  double sum = 0;
  for (uint32_t t = 1; t < f->terms->count; t++) sum += row_norm(field_row(f, a, t), a->n[t]);
  return sum * SLACK;
}

void field_trim(const fields *f, field *a) {
  double least = (centre_norm(a) + field_rest(f, a)) * NEGLIGIBLE, rest = 0;
  for (uint32_t t = 1; t < f->terms->count; t++) {
    double *row = field_row(f, a, t);
    while (a->n[t] > 0 && fabs(row[a->n[t] - 1]) <= least) rest += fabs(row[--a->n[t]]);
  }
  if (rest > 0) a->c.tail = (a->c.tail + rest) * SLACK;
}

void field_constant(const fields *f, field *r, dd x, double tail) {
  poly_constant(&r->c, x, tail);
  memset(r->n, 0, f->terms->count);
}

void field_copy(const fields *f, field *r, const field *a) {
  poly_copy(&r->c, &a->c);
  memcpy(r->n, a->n, f->terms->count);
  for (uint32_t t = 1; t < f->terms->count; t++)
    memcpy(field_row(f, r, t), field_row(f, a, t), a->n[t] * sizeof(double));
}

void field_add(const fields *f, field *r, const field *a, const field *b, double sign) {
  double size = 0;
  poly_add(&r->c, &a->c, &b->c, sign);
  for (uint32_t t = 1; t < f->terms->count; t++) {
    const double *x = field_row(f, a, t), *y = field_row(f, b, t);
    double *z = field_row(f, r, t);
    uint32_t n = a->n[t], m = b->n[t];
    for (uint32_t k = 0; k < n || k < m; k++) {
      double p = k < n ? x[k] : 0, q = k < m ? y[k] : 0;
      if (p != 0 && q != 0) size += fabs(p) + fabs(q);
      z[k] = p + sign * q;
    }
    r->n[t] = (uint8_t)(n > m ? n : m);
  }
  if (size > 0) r->c.tail = (r->c.tail + 2 * DD_U * size) * SLACK;
}

/* sum[t] += x y */
static void convolve(fields *f, uint32_t t, const double *x, uint32_t n, const double *y, uint32_t m) {
  double *part = f->part, *sum = f->sum + (size_t)t * 2 * f->width;
  uint32_t top = n + m - 1;
  memset(part, 0, top * sizeof *part);
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t j = 0; j < m; j++) part[i + j] += x[i] * y[j];
  for (uint32_t k = f->sum_n[t]; k < top; k++) sum[k] = 0;
  if (f->sum_n[t] < top) f->sum_n[t] = (uint8_t)top;
  for (uint32_t k = 0; k < top; k++) sum[k] += part[k];
}

/* the rows of a product; returns what powers beyond the degree are at most */
static double multiply_rows(fields *f, const field *a, const field *b) {
  const terms *T = f->terms;
  double norm[TERMS_MAX], above[TERMS_MAX + 1] = { 0 }, lost = 0;
  above[T->count] = 0;
  for (uint32_t t = T->count; t-- > 0;) {
    norm[t] = t ? row_norm(field_row(f, b, t), b->n[t]) : centre_norm(b);
    above[t] = above[t + 1] + norm[t];
  }
  for (uint32_t i = 0; i < T->count; i++) {
    const double *x = i ? field_row(f, a, i) : a->c.hi;
    uint32_t n = i ? a->n[i] : a->c.n, end = T->below[T->degree - T->grade[i]];
    if (n == 0) continue;
    for (uint32_t j = i ? 0 : 1; j < end; j++) {
      const double *y = j ? field_row(f, b, j) : b->c.hi;
      uint32_t m = j ? b->n[j] : b->c.n;
      if (m) convolve(f, T->product[i * T->count + j], x, n, y, m);
    }
    lost += row_norm(x, n) * above[end];
  }
  return lost;
}

void field_mul(fields *f, field *r, const field *a, const field *b) {
  const terms *T = f->terms;
  double ac = centre_norm(a), bc = centre_norm(b), ar = field_rest(f, a), br = field_rest(f, b);
  poly_mul(&r->c, f->width, &a->c, &b->c);
  memset(r->n, 0, T->count);
  if (ar == 0 && br == 0) return;
  memset(f->sum_n, 0, T->count);
  double rest = multiply_rows(f, a, b), tail = r->c.tail;
  for (uint32_t t = 1; t < T->count; t++) {
    const double *sum = f->sum + (size_t)t * 2 * f->width;
    double *row = field_row(f, r, t);
    r->n[t] = f->sum_n[t];
    for (uint32_t k = f->width; k < f->sum_n[t]; k++) rest += fabs(sum[k]);
    if (r->n[t] > f->width) r->n[t] = (uint8_t)f->width;
    memcpy(row, sum, r->n[t] * sizeof *row);
  }
  double size = ac * br + ar * bc + ar * br, count = (double)T->count * f->width;
  tail += rest + a->c.tail * br + b->c.tail * ar + (f->width + T->pairs + 6) * DD_U * size + count * count * DD_TINY;
  r->c.tail = tail * SLACK;
  field_trim(f, r);
}

/* -- tapes */

static int open_field(const ambit_host *h, const fields *f, field *a) {
  uint32_t count = f->terms->count;
  a->c.hi = h->alloc(h, 2 * f->width * sizeof(double));
  a->r = h->alloc(h, (size_t)count * f->width * sizeof(double));
  a->n = h->alloc(h, count);
  if (!a->c.hi || !a->r || !a->n) return 0;
  a->c.lo = a->c.hi + f->width;
  return 1;
}

int fields_open(const ambit_host *h, series *base, const terms *t, fields *f) {
  const ambit_tape *tape = base->tape;
  *f = (fields) { .tape = tape, .terms = t, .base = base, .width = base->order + 1 };
  f->slot = h->alloc(h, tape->nslot * sizeof *f->slot);
  f->sum = h->alloc(h, (size_t)t->count * 2 * f->width * sizeof(double));
  f->part = h->alloc(h, 2 * f->width * sizeof(double));
  f->sum_n = h->alloc(h, t->count);
  if (!f->slot || !f->sum || !f->part || !f->sum_n) return 0;
  for (uint32_t i = 0; i < tape->nslot; i++)
    if (!open_field(h, f, &f->slot[i])) return 0;
  for (uint32_t i = 0; i < FIELD_SCRATCH; i++)
    if (!open_field(h, f, &f->scratch[i])) return 0;
  for (uint32_t i = 0; i < tape->nconst; i++) {
    poly_copy(&f->slot[i].c, &base->slot[i]);
    memset(f->slot[i].n, 0, t->count);
  }
  return 1;
}

/* what is not bounded claims nothing; NaN too */
static void forget(const fields *f, field *r) {
  int good = r->c.tail < INFINITY && field_rest(f, r) < 1e300;
  for (uint32_t k = 0; k < r->c.n; k++) good &= fabs(r->c.hi[k]) < 1e300;
  if (good) return;
  r->c.n = 0, r->c.tail = INFINITY;
  memset(r->n, 0, f->terms->count);
}

static void step(fields *f, uint32_t op, field *r, const field *a, const field *b) {
  switch (op) {
  case AMBIT_OP_ADD: field_add(f, r, a, b, 1); break;
  case AMBIT_OP_SUB: field_add(f, r, a, b, -1); break;
  case AMBIT_OP_NEG:
    field_constant(f, &f->scratch[0], (dd) { 0, 0 }, 0);
    field_add(f, r, &f->scratch[0], a, -1);
    break;
  case AMBIT_OP_MUL: field_mul(f, r, a, b); break;
  case AMBIT_OP_SQR: field_mul(f, r, a, a); break;
  default: field_function(f, op, r, a, b);
  }
  forget(f, r);
}

void fields_run(fields *f) {
  const ambit_tape *t = f->tape;
  const ambit_meter_service *meter = f->base->meter;
  if (meter) meter->enter("tape in fields");
  ambit_work_evaluate(f->base->counted, t->ninstr, f->terms->count);
  for (uint32_t i = 0; i < t->ninstr; i++) {
    field *r = &f->slot[t->dst[i]];
    if (meter) meter->operation(t->op[i]);
    const field *a = &f->slot[t->a[i]];
    if (t->op[i] == AMBIT_OP_POWN)
      field_power(f, r, a, (int32_t)t->b[i]), forget(f, r);
    else
      step(f, t->op[i], r, a, &f->slot[t->b[i]]);
  }
  if (meter) meter->leave();
}
