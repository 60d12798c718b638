/* dense.c -- the last step as polynomials in time, and the set at its end as polynomials in the unknowns, for records
** that ask for them. Only while there is one piece.
**
** x(t + s) = sum_k X_k(xi) s^k and what is beside. A monomial of xi that matters gets a column, its coefficients by
** order of time; all of its powers even, it is in [0, 1]: half a column about the other half. The ranges of what is
** left, order by order, are the radii.
*/
#include "flow.h"
#include "start.h"
#include <string.h>

#define COLUMNS 24
#define WORTH 1e-3 /* share of a state's spread that makes a monomial a column of its own */

typedef struct dense_column {
  size_t at; /* of the monomial among the coefficients */
  int even;
} dense_column;

struct dense {
  double *mid, *rad, *column;   /* [nx x orders], [nx x orders], [nx x COLUMNS x orders] */
  double *share;                /* [size] what each monomial contributes to the spreads */
  unsigned char *even;          /* [size] */
  dense_column chosen[COLUMNS]; /* [count] */
  uint32_t count;
};

static double *doubles(const ambit_host *h, size_t n) { return h->alloc(h, n * sizeof(double)); }

static void find_even(const space *s, unsigned char *even) {
  for (uint32_t r = 0; r < s->nrow; r++) {
    int rest = 1;
    for (uint32_t v = 1; v < s->m; v++) rest &= s->exponent[(size_t)r * s->m + v] % 2 == 0;
    for (uint32_t j = 0; j < s->row[r].length; j++) even[s->row[r].at + j] = rest && j % 2 == 0;
  }
}

int flow_open_dense(flow *f) {
  const ambit_host *h = f->host;
  size_t nx = f->nx, n = nx * (f->options.time_order + 1u);
  struct dense *d = f->dense = h->alloc(h, sizeof *d);
  if (!d) return 0;
  *d = (struct dense) { .mid = doubles(h, n),
    .rad = doubles(h, n),
    .column = doubles(h, n * COLUMNS),
    .share = doubles(h, f->space.size),
    .even = h->alloc(h, f->space.size) };
  if (!d->mid || !d->rad || !d->column || !d->share || !d->even) return 0;
  find_even(&f->space, d->even);
  return 1;
}

static cell coefficient(const worker *w, uint32_t i, uint32_t k) {
  return series_cell(w->series, w->flow->problem.rhs->nconst + i, k);
}

/* shares of all states' spreads over the step; of linear terms: infinite */
static void share_out(worker *w) {
  const flow *f = w->flow;
  const space *s = &f->space;
  double *share = f->dense->share, *part = w->q;
  memset(share, 0, s->size * sizeof *share);
  for (uint32_t i = 0; i < f->nx; i++) {
    double power = 1, spread = 0;
    memset(part, 0, s->size * sizeof *part);
    for (uint32_t k = 0; k <= f->options.time_order; k++, power *= w->step.length)
      for (size_t j = 0; j < s->size; j++) part[j] += fabs(coefficient(w, i, k).c[j]) * power;
    part[s->row[0].at] = 0;
    for (size_t j = 0; j < s->size; j++) spread += part[j];
    for (size_t j = 0; j < s->size && spread > 0; j++) share[j] += part[j] / spread;
  }
  for (uint32_t v = 0; v < f->m && s->d > 0; v++)
    if (share[polynomial_linear(s, v)] > 0) share[polynomial_linear(s, v)] = INFINITY;
}

static void choose_columns(worker *w) {
  struct dense *d = w->flow->dense;
  share_out(w);
  for (d->count = 0; d->count < COLUMNS; d->count++) {
    size_t best = 0;
    for (size_t j = 1; j < w->flow->space.size; j++)
      if (d->share[j] > d->share[best]) best = j;
    if (!(d->share[best] > WORTH)) return;
    d->share[best] = 0;
    d->chosen[d->count] = (dense_column) { best, d->even[best] };
  }
}

/* order k of state i */
static void describe(worker *w, uint32_t i, uint32_t k, double *mid, double *rad) {
  const flow *f = w->flow;
  const struct dense *d = f->dense;
  uint32_t orders = f->options.time_order + 1u;
  double high = 0, low = 0, more_high, more_low, lost = 0; /* lows negated */
  memcpy(w->q, coefficient(w, i, k).c, f->space.size * sizeof(double));
  for (uint32_t c = 0; c < d->count; c++) {
    double *x = &w->q[d->chosen[c].at], column = *x;
    if (d->chosen[c].even) {
      column = 0.5 * *x;
      high += column, low -= column;
      lost += column + column != *x ? TINY : 0;
    }
    d->column[((size_t)i * d->count + c) * orders + k] = column;
    *x = 0;
  }
  polynomial_bounds(&f->space, w->q, &more_low, &more_high);
  high += more_high, low -= more_low;
  *mid = 0.5 * (high - low);
  *rad = larger(high - *mid, *mid + low) + lost;
}

static void describe_step(flow *f) {
  worker *w = &f->worker[0];
  struct dense *d = f->dense;
  uint32_t orders = f->options.time_order + 1u;
  choose_columns(w);
  for (uint32_t i = 0; i < f->nx; i++) {
    double rest = 0;
    for (uint32_t n = 0; n < w->groups; n++)
      rest = larger(rest, w->reach[(size_t)n * f->nx + i] + w->apart[(size_t)n * f->nx + i]);
    for (uint32_t k = 0; k < orders; k++) describe(w, i, k, &d->mid[i * orders + k], &d->rad[i * orders + k]);
    d->rad[(size_t)i * orders] += rest;
  }
}

void flow_describe(flow *f, ambit_record *r) {
  describe_step(f);
  r->ndense = r->ncoef_column = f->options.time_order + 1u;
  r->ncolumn = f->dense->count;
  r->dense_mid = f->dense->mid, r->dense_rad = f->dense->rad, r->dense_column = f->dense->column;
}

/* terms in unknowns of this solver alone go to the rest */
const ambit_set *flow_describe_set(flow *f, const piece *p) {
  const space *s = &f->space;
  uint32_t nu = f->problem.nu, terms = f->set.nterm, at = 0;
  for (uint32_t i = 0; i < f->nx; i++) {
    f->rest[i] = 0;
    for (uint32_t n = 0; n < f->ns; n++)
      f->rest[i] = larger(f->rest[i], zonotope_at(&f->worker[0].shape, p->zonotope, n).sum[i]);
  }
  for (uint32_t r = 0; r < s->nrow; r++) {
    int own = 0;
    for (uint32_t v = nu > 0 ? nu : 1; v < s->m; v++) own |= s->exponent[(size_t)r * s->m + v] != 0;
    for (uint32_t j = 0; j < s->row[r].length; j++) {
      int lost = own || (nu == 0 && j > 0);
      for (uint32_t i = 0; i < f->nx; i++) {
        double c = p->x[i * s->size + s->row[r].at + j];
        if (lost)
          f->rest[i] += fabs(c);
        else
          f->coefficient[(size_t)i * terms + at] = c;
      }
      at += !lost;
    }
  }
  return &f->set;
}
