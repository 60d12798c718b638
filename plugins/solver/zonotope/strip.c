/* strip.c -- states of which bounds are known, and what these say of all states.
**
** Let lo <= d <= hi at all times for a state d. For any numbers l_i, x_i = x_i - l_i (d - delta) with delta = d, a
** number in [lo, hi]: what d and x_i have in common goes, and one generator comes (docs/numerics/zonotope.md, section
** 7f). l is Kalman's gain, as if generators were independent errors; no proof depends on it.
*/
#include "strip.h"
#include "depend.h"
#include "modes.h"
#include "proof.h"
#include "quartic.h"

typedef struct strip {
  uint32_t d, n;       /* the state; columns */
  double middle, half; /* of its bounds */
  double box;          /* what is in d's box */
  double *gain, *off;  /* [nx] l; sizes of what is rounded */
} strip;

static double *end_of(const zono *z, uint32_t i) { return z->proof->end + (size_t)i * z->shape.stride; }

int strip_bounds(const zono *z, uint32_t i) {
  const ambit_problem *p = &z->problem;
  return p->x_least && p->x_least[i] > -INFINITY && p->x_most[i] < INFINITY;
}

uint32_t strip_columns(const zono *z) {
  uint32_t count = 0;
  for (uint32_t i = 0; i < z->nx; i++) count += strip_bounds(z, i) ? 2 : 0;
  return count;
}

int strip_open(zono *z) {
  z->proof->gain = z->host->alloc(z->host, (2 * (size_t)z->nx + 1) * sizeof(double));
  return z->proof->gain != NULL;
}

/* is d a linear function of data and generators, but for its box? */
static int is_linear(const zono *z, const strip *t) {
  const double *row = end_of(z, t->d);
  if (row_q(&z->shape, row) > 0 || row_c(&z->shape, row) > 0) return 0;
  if (quartic_size(z, t->d) > 0 || discs_width(z, t->d) > 0) return 0;
  for (uint32_t c = 0; c < t->n; c++)
    if (depend_depth(z, c, t->d) > 0) return 0;
  return 1;
}

/* l, and does it make the set smaller, in units of what it is? */
static int choose(const zono *z, strip *t) {
  const proof *p = z->proof;
  const double *d = end_of(z, t->d);
  uint32_t nx = z->nx, m = z->shape.m;
  double own = t->box * t->box, gained = 0;
  for (uint32_t c = 0; c < t->n; c++) own += p->columns[(size_t)c * nx + t->d] * p->columns[(size_t)c * nx + t->d];
  for (uint32_t j = 1; j <= m; j++) own += d[j] * d[j];
  for (uint32_t i = 0; i < nx; i++) {
    const double *x = end_of(z, i);
    double both = i == t->d ? t->box * t->box : 0, before = i == t->d ? t->box : 0, after = 0;
    for (uint32_t c = 0; c < t->n; c++) both += p->columns[(size_t)c * nx + i] * p->columns[(size_t)c * nx + t->d];
    for (uint32_t j = 1; j <= m; j++) both += x[j] * d[j];
    double l = t->gain[i] = both / (own + t->half * t->half);
    after = i == t->d ? fabs(1 - l) * t->box : fabs(l) * t->box;
    for (uint32_t c = 0; c < t->n; c++) {
      const double *g = p->columns + (size_t)c * nx;
      before += fabs(g[i]), after += fabs(g[i] - l * g[t->d]);
    }
    for (uint32_t j = 1; j <= m; j++) before += fabs(x[j]), after += fabs(x[j] - l * d[j]);
    if (before > 0) gained += (before - after - fabs(l) * t->half) / before;
  }
  return gained > 0;
}

/* d's box as a column, so that it moves with d */
static void put_own_box(zono *z, strip *t) {
  proof *p = z->proof;
  double *column = p->columns + (size_t)t->n * z->nx, most = -1;
  memset(column, 0, z->nx * sizeof *column);
  column[t->d] = t->box;
  for (uint32_t o = 0; o < ORIGINS; o++) {
    if (*box(z, o, t->d) > most) most = *box(z, o, t->d), p->origin[t->n] = (uint8_t)o;
    *box(z, o, t->d) = 0;
  }
  p->source[t->n++] = 0;
}

static void put_symbol(zono *z, strip *t) {
  proof *p = z->proof;
  double *column = p->columns + (size_t)t->n * z->nx;
  for (uint32_t i = 0; i < z->nx; i++) column[i] = t->gain[i] * t->half, t->off[i] += fabs(column[i]);
  p->origin[t->n] = FROM_VARYING, p->source[t->n++] = 0;
}

static void move_columns(zono *z, strip *t) {
  for (uint32_t c = 0; c < t->n; c++) {
    double *g = z->proof->columns + (size_t)c * z->nx, d = g[t->d];
    for (uint32_t i = 0; i < z->nx; i++) {
      double part = t->gain[i] * d;
      t->off[i] += fabs(g[i]) + fabs(part), g[i] -= part;
    }
  }
}

static void move_rows(zono *z, strip *t) {
  const shape *s = &z->shape;
  double *d = s->scratch;
  row_copy(s, d, end_of(z, t->d));
  dd away = dd_sub(row_middle(s, d), dd_make(t->middle, 0));
  for (uint32_t i = 0; i < z->nx; i++) {
    double *x = end_of(z, i), l = t->gain[i];
    t->off[i] += row_moving(s, x) + fabs(l) * row_moving(s, d);
    t->off[i] += 16 * UNIT * (fabs(x[0]) + fabs(l) * (fabs(d[0]) + fabs(t->middle)));
    dd centre = dd_sub(row_middle(s, x), dd_scale(away, l));
    row_add(s, x, -l, d);
    row_norms(s, x);
    x[0] = centre.hi, x[s->norms + LOW] = centre.lo;
  }
}

static uint32_t cut(zono *z, strip *t) {
  t->box = 0;
  for (uint32_t o = 0; o < ORIGINS; o++) t->box += *box(z, o, t->d);
  t->box *= ABOVE;
  if (!is_linear(z, t) || !choose(z, t)) return t->n;
  memset(t->off, 0, z->nx * sizeof *t->off);
  put_own_box(z, t);
  move_columns(z, t);
  move_rows(z, t);
  put_symbol(z, t);
  for (uint32_t i = 0; i < z->nx; i++) *box(z, FROM_START, i) += 4 * UNIT * t->off[i] * ABOVE + LEAST;
  return t->n;
}

uint32_t strip_all(zono *z, uint32_t n) {
  const ambit_problem *p = &z->problem;
  for (uint32_t d = 0; d < z->nx; d++) {
    if (!strip_bounds(z, d)) continue;
    double middle = 0.5 * p->x_least[d] + 0.5 * p->x_most[d];
    double half = fmax(p->x_most[d] - middle, middle - p->x_least[d]) * ABOVE + LEAST;
    strip t = { .d = d, .n = n, .middle = middle, .half = half, .gain = z->proof->gain, .off = z->proof->gain + z->nx };
    n = cut(z, &t);
  }
  return n;
}

void strip_within(const zono *z, double *lo, double *hi) {
  for (uint32_t i = 0; i < z->nx; i++) {
    if (!strip_bounds(z, i)) continue;
    double least = fmax(lo[i], z->problem.x_least[i]), most = fmin(hi[i], z->problem.x_most[i]);
    if (least <= most) lo[i] = least, hi[i] = most;
  }
}
