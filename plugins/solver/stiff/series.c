/* series.c -- a tape over polynomials with remainders (series.h). */
#include "series.h"
#include "shared/constant.h"
#include <string.h>

/* -- memory and constants */

static int open_poly(const ambit_host *h, poly *p, size_t n) {
  p->hi = h->alloc(h, 2 * n * sizeof(double));
  p->lo = p->hi ? p->hi + n : NULL;
  return p->hi != NULL;
}

int series_open(const ambit_host *h, const ambit_num_service *num, const ambit_tape *t, uint32_t order, series *s) {
  *s = (series) { .tape = t, .num = num, .order = order, .counted = ambit_work_open(h) };
  s->meter = h->service(h, AMBIT_METER_SERVICE);
  s->slot = h->alloc(h, t->nslot * sizeof *s->slot);
  if (!s->slot) return 0;
  for (uint32_t i = 0; i < t->nslot; i++)
    if (!open_poly(h, &s->slot[i], order + 1u)) return 0;
  for (uint32_t i = 0; i < POLY_SCRATCH; i++)
    if (!open_poly(h, &s->scratch[i], 2u * order + 3u)) return 0;
  for (uint32_t i = 0; i < t->nconst; i++) {
    dd x;
    double error = constant_at(t, i, &x);
    poly_constant(&s->slot[i], x, error);
  }
  return 1;
}

/* -- running */

static void forget(poly *r) {
  if (!(r->tail < INFINITY)) r->n = 0, r->tail = INFINITY; /* NaN too */
  for (uint32_t k = 0; k < r->n; k++)
    if (!(fabs(r->hi[k]) < 1e300)) r->n = 0, r->tail = INFINITY;
}

static void step(series *s, uint32_t op, poly *r, const poly *a, const poly *b) {
  switch (op) {
  case AMBIT_OP_ADD: poly_add(r, a, b, 1); break;
  case AMBIT_OP_SUB: poly_add(r, a, b, -1); break;
  case AMBIT_OP_NEG:
    poly_copy(r, a);
    for (uint32_t k = 0; k < r->n; k++) r->hi[k] = -r->hi[k], r->lo[k] = -r->lo[k];
    break;
  case AMBIT_OP_MUL: poly_mul(r, s->order + 1, a, b); break;
  case AMBIT_OP_SQR: poly_mul(r, s->order + 1, a, a); break;
  default: series_function(s, op, r, a, b);
  }
  forget(r);
}

void series_run(series *s) {
  const ambit_tape *t = s->tape;
  ambit_work_evaluate(s->counted, t->ninstr, 1);
  if (s->meter) s->meter->enter("tape in polynomials");
  for (uint32_t i = 0; i < t->ninstr; i++) {
    poly *r = &s->slot[t->dst[i]];
    if (s->meter) s->meter->operation(t->op[i]);
    const poly *a = &s->slot[t->a[i]];
    if (t->op[i] == AMBIT_OP_POWN)
      series_power(s, r, a, (int32_t)t->b[i]), forget(r);
    else
      step(s, t->op[i], r, a, &s->slot[t->b[i]]);
  }
  if (s->meter) s->meter->leave();
}
