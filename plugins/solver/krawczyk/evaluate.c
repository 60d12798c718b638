/* evaluate.c -- the problem's tapes over boxes, and interval vectors and matrices by ambit.num/1. */
#include "krawczyk.h"
#include <math.h>

static void set_input(ambit_lane *lane, uint32_t in, span x) {
  int32_t variable = x.lo < x.hi ? (int32_t)in : -1;
  lane->arithmetic->set(lane->ctx, ambit_lane_at(lane, lane->tape->nconst + in), 1, &x.lo, &x.hi, variable);
}

static int evaluate(const krawczyk *k, ambit_lane *lane, const span *x, double *lo, double *hi, ptrdiff_t stride) {
  for (uint32_t i = 0; i < k->m; i++) set_input(lane, i, x[i]);
  if (ambit_lane_run(lane) & (AMBIT_F_PARTIAL | AMBIT_F_EMPTY)) return 0;
  for (uint32_t i = 0; i < lane->tape->nout; i++) {
    double *l = lo + i * stride, *h = hi + i * stride;
    ambit_lane_get(lane, i, l, h);
    if (!(*l <= *h) || !isfinite(*l) || !isfinite(*h)) return 0;
  }
  return 1;
}

int krawczyk_matrix(const krawczyk *k, ambit_lane *lane, const span *x, matrix M) {
  return evaluate(k, lane, x, M.lo, M.hi, 1);
}

int krawczyk_vector(krawczyk *k, const span *x, span *f) { return evaluate(k, &k->equations, x, &f->lo, &f->hi, 2); }

uint32_t krawczyk_inspect(const krawczyk *k, const span *x) {
  for (uint32_t i = 0; i < k->m; i++) k->in_lo[i] = x[i].lo, k->in_hi[i] = x[i].hi;
  return k->contract->inspect_in(k->shape, k->in_lo, k->in_hi, k->n);
}

void krawczyk_map(const krawczyk *k, uint32_t op, span *r, const span *a, const span *b, uint32_t n) {
  k->num->map(op, n, &r->lo, &a->lo, b ? &b->lo : NULL, 0);
}

void krawczyk_multiply(const krawczyk *k, span *r, const double *Mlo, const double *Mhi, uint32_t cols, const span *v) {
  for (uint32_t j = 0; j < cols; j++) k->in.lo[j] = v[j].lo, k->in.hi[j] = v[j].hi;
  ambit_work_multiply(k->counted);
  k->num->matmul(k->n, cols, 1, k->out.lo, k->out.hi, Mlo, Mhi, k->in.lo, k->in.hi);
  for (uint32_t i = 0; i < k->n; i++) r[i] = (span) { k->out.lo[i], k->out.hi[i] };
}
