/* spread.c -- the terms of the unknowns in a step's polynomial P(s, xi) = sum_a P_a(s) xi^a (stiff.h).
**
** The collocation system of all terms is solved with the factors of the centre's: each turn of Newton's method makes
** one more degree right, and the matrix need not be factored again. Nothing here needs a proof but what says so.
** Round-to-nearest.
*/
#include "stiff.h"
#include <ambit/matrix.h>
#include <string.h>

#define SLACK (1 + 0x1p-40)
#define MORE_TURNS 6
#define SETTLED 1e-18
#define SHARE 0.1 /* of a state's spread in its unit, next to how far it moves */

static uint32_t count_of(const stiff *s) { return s->terms.count; }

static double *row_of_P(const stiff *s, uint32_t i, uint32_t t) {
  return s->P_row + ((size_t)i * count_of(s) + t) * (s->q.N + 1);
}

/* -- the start */

int spread_open(stiff *s) {
  size_t count = count_of(s), N = s->q.N, nx = s->nx;
  const struct {
    double **array;
    size_t count;
  } list[] = { { &s->x_row, s->inputs * count }, { &s->Z_row, N * nx * count }, { &s->c_row, N * nx * count },
    { &s->residual_row, N * nx * count }, { &s->P_row, nx * count * (N + 1) }, { &s->end_row, nx * count },
    { &s->saved_row, nx * count }, { &s->set_coefficient, nx * count }, { &s->start_row, s->inputs * count } };
  for (size_t i = 0; i < sizeof list / sizeof *list; i++)
    if (!(*list[i].array = s->host->alloc(s->host, list[i].count * sizeof(double)))) return 0;
  return fields_open(s->host, &s->rhs, &s->terms, &s->rhs_field) &&
         fields_open(s->host, &s->jacobian, &s->terms, &s->jacobian_field);
}

ambit_status spread_read(stiff *s) {
  const ambit_problem *p = &s->problem;
  series base;
  fields f;
  uint32_t count = count_of(s);
  if (!series_open(s->host, s->num, p->initial, 1, &base) || !fields_open(s->host, &base, &s->terms, &f))
    return s->host->fail(s->host, AMBIT_NOMEM, "stiff: out of memory");
  for (uint32_t j = 0; j < p->nu; j++) {
    field *u = fields_input(&f, j);
    double lo = p->u_lo[j], hi = p->u_hi[j];
    s->about[j] = 0.5 * lo + 0.5 * hi;
    s->scale[j] = nextafter(fmax(hi - s->about[j], s->about[j] - lo), INFINITY);
    field_constant(&f, u, (dd) { s->about[j], 0 }, 0);
    for (uint32_t t = 1; t <= p->nu; t++) /* the terms of degree 1 */
      if (s->terms.exponent[t * p->nu + j] == 1) u->n[t] = 1, field_row(&f, u, t)[0] = s->scale[j];
  }
  fields_run(&f);
  for (uint32_t i = 0; i < s->inputs; i++) {
    const field *g = fields_output(&f, i);
    double rest = g->c.tail;
    s->start[i] = poly_get(&g->c, 0);
    for (uint32_t k = 1; k < g->c.n; k++) rest += fabs(g->c.hi[k]) * SLACK;
    for (uint32_t t = 1; t < count; t++) {
      const double *row = field_row(&f, g, t);
      s->start_row[i * count + t] = g->n[t] ? row[0] : 0;
      for (uint32_t k = 1; k < g->n[t]; k++) rest += fabs(row[k]);
    }
    s->start_rest[i] = rest * SLACK;
  }
  return AMBIT_OK;
}

void spread_start(stiff *s) {
  size_t count = count_of(s);
  memcpy(s->x_row, s->start_row, s->inputs * count * sizeof *s->x_row);
  memcpy(s->end_row, s->start_row, s->nx * count * sizeof *s->end_row);
}

void spread_keep(stiff *s, int back) {
  size_t bytes = (size_t)s->nx * count_of(s) * sizeof *s->end_row;
  memcpy(back ? s->end_row : s->saved_row, back ? s->saved_row : s->end_row, bytes);
}

/* -- collocation */

static void put_node(stiff *s, uint32_t node) {
  fields *f = &s->rhs_field;
  uint32_t count = count_of(s), nx = s->nx;
  for (uint32_t a = 0; a < s->inputs; a++) {
    field *u = fields_input(f, a);
    long double x = s->q.x[a] + (a < nx ? s->q.Z[node * nx + a] : 0);
    field_constant(f, u, dd_of(x), 0);
    for (uint32_t t = 1; t < count; t++) {
      double y = s->x_row[a * count + t] + (a < nx ? s->Z_row[((size_t)node * nx + a) * count + t] : 0);
      field_row(f, u, t)[0] = y;
      u->n[t] = y != 0;
    }
  }
  if (s->problem.uses_time) {
    long double t = s->t + 0.5L * s->h.hi * (s->q.node[node + 1] + 1);
    field_constant(f, fields_input(f, s->inputs), dd_of(t), 0);
  }
  fields_run(f);
}

/* half f - D Z in units; 0: not defined */
static int judge(stiff *s) {
  const collocation *q = &s->q;
  uint32_t count = count_of(s), nx = s->nx, N = q->N;
  double half = 0.5 * s->h.hi;
  for (uint32_t i = 0; i < N; i++) {
    put_node(s, i);
    for (uint32_t a = 0; a < nx; a++) {
      const field *f = fields_output(&s->rhs_field, a);
      double *r = s->residual_row + ((size_t)i * nx + a) * count;
      if (!(f->c.tail < INFINITY)) return 0;
      for (uint32_t t = 0; t < count; t++) r[t] = f->n[t] ? half * field_row(&s->rhs_field, f, t)[0] : 0;
      for (uint32_t j = 0; j < N; j++)
        matrix_add_scaled(count, r, -(double)q->D[i][j + 1], s->Z_row + ((size_t)j * nx + a) * count);
      for (uint32_t t = 0; t < count; t++) r[t] /= q->unit[a];
    }
  }
  return 1;
}

static void to_chebyshev(stiff *s) {
  collocation *q = &s->q;
  uint32_t count = count_of(s), nx = s->nx, N = q->N;
  for (uint32_t a = 0; a < nx; a++) {
    double last = 0, before = 0;
    for (uint32_t k = 0; k < N; k++) {
      double *c = s->c_row + ((size_t)k * nx + a) * count;
      for (uint32_t t = 1; t < count; t++) {
        long double sum = 0;
        for (uint32_t j = 0; j < N; j++) sum += q->V[k][j] * s->Z_row[((size_t)j * nx + a) * count + t];
        c[t] = (double)sum;
        last += k + 1 == N ? fabs(c[t]) : 0;
        before += k + 2 == N ? fabs(c[t]) : 0;
      }
    }
    q->error = fmax(q->error, fmax(last, 0.3 * before) / q->unit[a]);
  }
}

/* How far the unknowns spread each state, and how far what they do to it moves in the step: where the centre stays at 0
** it has no unit of its own. */
static void measure(const stiff *s, double *unit) {
  uint32_t count = count_of(s), nx = s->nx;
  for (uint32_t a = 0; a < nx; a++) {
    double moved = 0;
    for (uint32_t i = 0; i < s->q.N; i++)
      moved = fmax(moved, matrix_row_sum_norm(1, count - 1, s->Z_row + ((size_t)i * nx + a) * count + 1));
    unit[a] = moved + SHARE * matrix_row_sum_norm(1, count - 1, s->x_row + a * count + 1);
  }
}

int spread_solve(stiff *s) {
  collocation *q = &s->q;
  uint32_t count = count_of(s), nx = s->nx, N = q->N;
  double unit[N_MAX] = { 0 };
  if (!collocation_linearise(q, s->t, s->h.hi)) return 0;
  memset(s->Z_row, 0, (size_t)N * nx * count * sizeof *s->Z_row);
  for (uint32_t turn = 0; turn < s->terms.degree + MORE_TURNS; turn++) {
    double most = 0;
    if (!judge(s)) return 0;
    ambit_matrix_solve((size_t)N * nx, q->A, q->row, count, s->residual_row);
    for (uint32_t i = 0; i < N * nx; i++)
      for (uint32_t t = 1; t < count; t++)
        s->Z_row[(size_t)i * count + t] += s->residual_row[(size_t)i * count + t] * q->unit[i % nx];
    measure(s, unit);
    for (uint32_t i = 0; i < N * nx; i++) {
      double share = q->unit[i % nx] / (q->unit[i % nx] + unit[i % nx]);
      for (uint32_t t = 1; t < count; t++) {
        double step = s->residual_row[(size_t)i * count + t] * share;
        if (!(fabs(step) <= most)) most = fabs(step);
      }
    }
    if (!(most < 1e3)) return 0;
    if (most < SETTLED) break;
  }
  for (uint32_t a = 0; a < nx; a++) q->unit[a] += unit[a], q->scale[a] += unit[a];
  to_chebyshev(s);
  return 1;
}

void spread_place(stiff *s) {
  uint32_t count = count_of(s), nx = s->nx;
  for (uint32_t k = 0; k < s->q.N; k += 2) /* T_(k+1)(1) - T_(k+1)(-1) */
    matrix_add_scaled((size_t)nx * count, s->x_row, 2, s->c_row + (size_t)k * nx * count);
}

/* -- a piece */

void spread_cut(stiff *s, const dd *table) {
  uint32_t count = count_of(s), nx = s->nx, N = s->q.N, w = N + 1;
  for (uint32_t a = 0; a < nx; a++)
    for (uint32_t t = 1; t < count; t++) {
      double *row = row_of_P(s, a, t);
      for (uint32_t l = 0; l <= N; l++) {
        long double sum = l == 0 ? s->x_row[a * count + t] : 0;
        for (uint32_t k = l ? l : 1; k <= N; k++) {
          long double x = dd_long(table[k * w + l]);
          if (l == 0) x += k % 2 ? 1 : -1;
          sum += x * s->c_row[((size_t)(k - 1) * nx + a) * count + t];
        }
        row[l] = (double)sum;
      }
    }
}

/* sum_k (+-1)^k row_k; adds to *error what it is off, as in evaluate.c: proved */
static dd value(const double *row, uint32_t w, int at, double *error) {
  dd sum = { 0, 0 };
  double size = 0;
  for (uint32_t k = w; k-- > 0;) {
    sum = dd_add(sum, (dd) { at < 0 && k % 2 ? -row[k] : row[k], 0 });
    size += fabs(row[k]);
  }
  *error += (9.0 * w * DD_U * DD_U * size + DD_TINY) * SLACK;
  return sum;
}

double spread_gap(const stiff *s, uint32_t i) {
  uint32_t count = count_of(s);
  double error = 0;
  for (uint32_t t = 1; t < count; t++) {
    double last = s->end_row[i * count + t];
    dd at = value(row_of_P(s, i, t), s->q.N + 1, -1, &error), gap = dd_add(at, (dd) { -last, 0 });
    error += fabs(gap.hi) + fabs(gap.lo) + 5 * DD_U * DD_U * (fabs(at.hi) + fabs(last));
  }
  return error * SLACK;
}

double spread_end(stiff *s, uint32_t i) {
  uint32_t count = count_of(s);
  double error = 0;
  for (uint32_t t = 1; t < count; t++) {
    dd at = value(row_of_P(s, i, t), s->q.N + 1, 1, &error);
    s->end_row[i * count + t] = at.hi;
    error += fabs(at.lo);
  }
  return error * SLACK;
}

double spread_reach(const stiff *s, uint32_t i) {
  double sum = 0;
  size_t from = (s->q.N + 1), to = (size_t)count_of(s) * (s->q.N + 1);
  const double *row = row_of_P(s, i, 0);
  for (size_t k = from; k < to; k++) sum += fabs(row[k]);
  return sum * SLACK;
}

/* proved: what rows of `to` have no room for is in the tail */
void spread_put(const stiff *s, fields *to, const double *box) {
  uint32_t count = count_of(s), w = s->q.N + 1;
  for (uint32_t a = 0; a < s->inputs; a++) {
    field *u = fields_input(to, a);
    const poly *P = &s->P[a];
    double rest = P->tail + (a >= s->nx ? s->start_rest[a] : box ? box[a] : 0);
    field_constant(to, u, (dd) { 0, 0 }, 0);
    u->c.n = P->n < to->width ? P->n : to->width;
    for (uint32_t k = 0; k < u->c.n; k++) poly_set(&u->c, k, poly_get(P, k));
    for (uint32_t k = to->width; k < P->n; k++) rest += fabs(P->hi[k]) * (1 + 2 * DD_U);
    for (uint32_t t = 1; t < count; t++) {
      const double *from = a < s->nx ? row_of_P(s, a, t) : &s->start_row[a * count + t];
      uint32_t n = a < s->nx ? w : 1, room = n < to->width ? n : to->width;
      memcpy(field_row(to, u, t), from, room * sizeof *from);
      u->n[t] = (uint8_t)room;
      for (uint32_t k = room; k < n; k++) rest += fabs(from[k]);
    }
    u->c.tail = rest > 0 ? rest * SLACK : 0;
    field_trim(to, u);
  }
}

/* proved: a coefficient (k + 1) P_(k+1) - half f_k is rounded three times, and half.lo is left out */
void spread_defect(stiff *s, uint32_t i, const field *f, double *rest) {
  uint32_t count = count_of(s), w = s->q.N + 1;
  double size = 0;
  for (uint32_t t = 1; t < count; t++) {
    const double *P = row_of_P(s, i, t), *g = field_row(&s->rhs_field, f, t);
    double *d = s->defect + ((size_t)i * count + t) * w;
    for (uint32_t k = 0; k < w; k++) {
      double slope = k + 1 < w ? (k + 1) * P[k + 1] : 0, rate = k < f->n[t] ? s->half.hi * g[k] : 0;
      d[k] = slope - rate;
      size += fabs(slope) + fabs(rate);
    }
  }
  *rest += (4 * DD_U * size + DD_TINY * count * w) * SLACK;
}
