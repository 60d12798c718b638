/* ellipsoid.c -- old errors, and what they become with the data, in an ellipsoid beside the generators.
**
** The set holds e with l'e <= sqrt(l'Q l) for all l. A box in its place forgets how errors of different states hang
** together, and a mechanism's errors then grow by its fastest motion, damped or not. Q moves with the mean slopes, so
** it shrinks as the motion does. Sums: l'e_i <= sqrt(l'X_i l) for each i implies, by Cauchy and Schwarz, l' sum e_i <=
** sqrt(l' Q l), Q = (sum s_i) sum X_i / s_i, for any s_i > 0; s_i = sqrt(tr X_i) in units of the states' sets makes the
** least trace [Durieu, Walter & Polyak 2001]. Rounding: docs/numerics/zonotope.md, section 7.
*/
#include "ellipsoid.h"
#include "quartic.h"

#define MATTERS 0.01     /* of its set: from errors of a state so large on, the ellipsoid is worth it */
#define NEGLIGIBLE 1e-70 /* components below this go into the box: their squares might underflow */
#define UNIT_MOST 1e60
#define LOST 1e-280 /* above all that products of a move may lose by underflow */
#define RANK 2      /* products of vectors that a datum's map is taken apart into */
#define DOUBLINGS 20
#define HUGE_GROWTH 1e12
#define WEIGH_AGAIN 16 /* steps, but at each of the first YOUNG ones */
#define YOUNG 64

static double clamp(double x) { return fmin(fmax(x, 1 / UNIT_MOST), UNIT_MOST); }

int ellipsoid_open(zono *z) {
  const ambit_host *h = z->host;
  size_t nx = z->nx, square = (nx * nx + 1) * sizeof(double), line = (nx + 1) * sizeof(double);
  ellipsoid *e = z->proof->ellipsoid = h->alloc(h, sizeof *e);
  if (!e) return 0;
  double **matrix[] = { &e->Q, &e->sum, &e->map, &e->half, &e->mean, &e->weight, &e->work, &e->work_new };
  double **vector[] = { &e->unit, &e->segment, &e->size, &e->reach, &e->column, &e->row, &e->turned };
  for (size_t n = 0; n < sizeof matrix / sizeof *matrix; n++)
    if (!(*matrix[n] = h->alloc(h, square))) return 0;
  for (size_t n = 0; n < sizeof vector / sizeof *vector; n++)
    if (!(*vector[n] = h->alloc(h, line))) return 0;
  e->mixed = h->alloc(h, (nx * (z->ngen_max + nx) + 1) * sizeof(double));
  return e->mixed != NULL;
}

void ellipsoid_start(zono *z) {
  ellipsoid *e = z->proof->ellipsoid;
  memset(e->Q, 0, (size_t)z->nx * z->nx * sizeof(double)), memset(e->size, 0, z->nx * sizeof(double));
  e->is_used = 0, e->age = 0;
}

/* -- weights: P = sum_k (T^k)' W T^k, what a distance will be in all the steps to come; no proof depends on them */

/* to := a b, or a' b; n x n */
static void multiply(uint32_t n, double *to, const double *a, const double *b, int transposed) {
  memset(to, 0, (size_t)n * n * sizeof *to);
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t l = 0; l < n; l++) {
      double x = transposed ? a[(size_t)l * n + i] : a[(size_t)i * n + l];
      if (x == 0) continue;
      for (uint32_t k = 0; k < n; k++) to[(size_t)i * n + k] += x * b[(size_t)l * n + k];
    }
}

static double weighed(const ellipsoid *e, uint32_t n, const double *v) {
  double sum = 0, least = 0;
  for (uint32_t i = 0; i < n; i++) {
    double part = 0, u = v[i] / e->unit[i];
    if (v[i] == 0) continue;
    for (uint32_t k = 0; k < n; k++) part += e->weight[(size_t)i * n + k] * v[k];
    sum += v[i] * part, least += u * u;
  }
  return sum > least ? sum : least;
}

static double trace_of(const ellipsoid *e, uint32_t n, const double *X) {
  double sum = 0, least = 0;
  for (uint32_t i = 0; i < n; i++) {
    for (uint32_t k = 0; k < i; k++) sum += 2 * e->weight[(size_t)i * n + k] * X[(size_t)i * n + k];
    sum += e->weight[(size_t)i * n + i] * X[(size_t)i * n + i];
    least += X[(size_t)i * n + i] / (e->unit[i] * e->unit[i]);
  }
  return sum > least ? sum : least;
}

static void weigh(zono *z) {
  ellipsoid *e = z->proof->ellipsoid;
  uint32_t n = z->nx;
  size_t square = (size_t)n * n;
  double end = z->problem.time[z->problem.ntime - 1], steps = fabs((end - z->t) / z->h);
  double *T = e->map, *P = e->weight;
  memcpy(T, e->mean, square * sizeof *T), memset(P, 0, square * sizeof *P);
  for (uint32_t i = 0; i < n; i++) P[(size_t)i * n + i] = 1 / (e->unit[i] * e->unit[i]);
  for (int k = 0; k < DOUBLINGS && ldexp(1, k) < steps; k++) {
    double trace = 0;
    multiply(n, e->work, P, T, 0);
    multiply(n, e->work_new, T, e->work, 1);
    for (uint32_t i = 0; i < n; i++) trace += e->work_new[(size_t)i * n + i] * e->unit[i] * e->unit[i];
    if (!(trace < HUGE_GROWTH * n)) return;
    for (size_t a = 0; a < square; a++) P[a] += e->work_new[a];
    multiply(n, e->work, T, T, 0);
    memcpy(T, e->work, square * sizeof *T);
  }
}

/* T := y / E, row by row from y + at on; is it anything? */
static int take_map(const zono *z, double *T, const double *y, size_t at) {
  uint32_t nx = z->nx;
  int any = 0;
  for (uint32_t i = 0; i < nx; i++)
    for (uint32_t k = 0; k < nx; k++) {
      double t = z->E[k] > 0 ? y[(size_t)i * z->shape.stride + at + k] / z->E[k] : 0;
      T[(size_t)i * nx + k] = t, any |= t != 0;
    }
  return any;
}

/* Is what the data have made of old errors most of the errors of a state, and are these no small part of its set? */
static int is_worth(const zono *z) {
  const proof *p = z->proof;
  for (uint32_t i = 0; i < z->nx; i++) {
    double mixed = 0, all = 0;
    if (!(z->E[i] - quartic_size(z, i) > MATTERS * p->spread[i])) continue;
    for (uint32_t c = 0; c < z->ngen; c++) {
      double part = fabs(z->G[(size_t)c * z->nx + i]);
      all += part, mixed += p->from[c] == FROM_MIXED ? part : 0;
    }
    if (mixed > 0.5 * all) return 1;
  }
  return 0;
}

/* Does this step put anything into it? Once it has, it does. */
void ellipsoid_begin(zono *z, const double *y) {
  const proof *p = z->proof;
  ellipsoid *e = p->ellipsoid;
  memset(e->sum, 0, (size_t)z->nx * z->nx * sizeof(double));
  e->total = 0, e->terms = 0;
  if (!e->is_used && z->m > 0) e->is_used = is_worth(z);
  if (!e->is_used) return;
  take_map(z, e->mean, y, z->shape.eps);
  if (e->age++ < YOUNG || e->age % WEIGH_AGAIN == 0) {
    for (uint32_t i = 0; i < z->nx; i++) e->unit[i] = clamp(p->spread[i]);
    weigh(z);
  }
}

double ellipsoid_size(const zono *z, uint32_t i) { return z->proof->ellipsoid->size[i]; }

/* |sum_k y_k e_k / E_k|, at most */
double ellipsoid_through(const zono *z, const double *y) {
  const ellipsoid *e = z->proof->ellipsoid;
  uint32_t nx = z->nx;
  double square = 0, size = 0;
  if (!e->is_used) return 0;
  for (uint32_t i = 0; i < nx; i++) {
    double sum = 0;
    if (y[i] == 0 || !(z->E[i] > 0)) continue;
    for (uint32_t k = 0; k < nx; k++) sum += z->E[k] > 0 ? e->Q[(size_t)i * nx + k] * (y[k] / z->E[k]) : 0;
    square += y[i] / z->E[i] * sum, size += fabs(y[i] / z->E[i]) * e->size[i];
  }
  return sqrt(fmax(square, 0) + (4.0 * nx + 32) * UNIT * size * size) * ABOVE + LEAST;
}

/* adds the ellipsoid of `half`; next to nothing goes into the box */
static void add_half(zono *z) {
  ellipsoid *e = z->proof->ellipsoid;
  uint32_t nx = z->nx;
  const double *X = e->half;
  double trace = trace_of(e, nx, X), s = sqrt(trace);
  if (!(trace > NEGLIGIBLE)) {
    for (uint32_t i = 0; i < nx; i++) *box(z, FROM_MIXED, i) += sqrt(X[(size_t)i * nx + i]) * ABOVE;
    return;
  }
  for (uint32_t i = 0; i < nx; i++)
    for (uint32_t k = 0; k <= i; k++) e->sum[(size_t)i * nx + k] += X[(size_t)i * nx + k] / s;
  e->total += s, e->terms++;
}

/* half := T Q T', its lower half, with what it rounds by: each entry by at most (4 nx + 32) 2^-53 c_i c_k, c = |T|
** size, which is left in `reach`; a symmetric F with |F_ik| <= c_i c_k is at most nx diag(c_i^2) */
static void turn(zono *z, const double *T) {
  ellipsoid *e = z->proof->ellipsoid;
  uint32_t nx = z->nx;
  for (uint32_t i = 0; i < nx; i++) {
    const double *t = T + (size_t)i * nx;
    double *to = e->segment, c = 0;
    memset(to, 0, nx * sizeof *to);
    for (uint32_t a = 0; a < nx; a++) {
      if (t[a] == 0) continue;
      const double *q = e->Q + (size_t)a * nx;
      for (uint32_t b = 0; b < nx; b++) to[b] += t[a] * q[b];
      c += fabs(t[a]) * e->size[a];
    }
    e->reach[i] = c * ABOVE;
    for (uint32_t k = 0; k <= i; k++) {
      double sum = 0;
      for (uint32_t b = 0; b < nx; b++) sum += to[b] * T[(size_t)k * nx + b];
      e->half[(size_t)i * nx + k] = sum;
    }
    double *own = e->half + (size_t)i * nx + i;
    *own = fmax(*own, 0) + (nx * (4.0 * nx + 32) * UNIT * e->reach[i] * e->reach[i] + LOST);
  }
}

/* The largest entry of T in units of the states; 0: there is none. */
static int find_pivot(const ellipsoid *e, uint32_t n, const double *T, uint32_t *row, uint32_t *column) {
  double most = 0;
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t k = 0; k < n; k++) {
      double size = fabs(T[(size_t)i * n + k]) * e->size[k] / e->unit[i];
      if (size > most) most = size, *row = i, *column = k;
    }
  return most > 0;
}

/* T -= u w', u and w left in `column` and `row`; box += what that rounds by */
static void split(zono *z, double *T, uint32_t i, uint32_t k) {
  ellipsoid *e = z->proof->ellipsoid;
  uint32_t n = z->nx;
  double pivot = T[(size_t)i * n + k];
  for (uint32_t l = 0; l < n; l++) e->column[l] = T[(size_t)l * n + k], e->row[l] = T[(size_t)i * n + l] / pivot;
  for (uint32_t a = 0; a < n; a++) {
    double rounded = 0;
    for (uint32_t b = 0; b < n; b++) {
      double part = e->column[a] * e->row[b], *t = T + (size_t)a * n + b;
      rounded += (fabs(*t) + fabs(part)) * (e->size[b] + quartic_size(z, b));
      *t = b == k ? 0 : *t - part;
    }
    *box(z, FROM_START, a) += 8 * UNIT * rounded;
  }
}

/* pairs of column `column` and row `row`: see ellipsoid_move */
static void add_pair(zono *z, double *square, const double *T0) {
  ellipsoid *e = z->proof->ellipsoid;
  uint32_t n = z->nx;
  double *b = e->segment, q = 0, size = 0, *u = e->column, *turned = e->turned;
  for (uint32_t i = 0; i < n; i++) {
    double sum = 0;
    for (uint32_t k = 0; k < n; k++) sum += e->Q[(size_t)i * n + k] * e->row[k];
    turned[i] = sum, q += e->row[i] * sum, size += fabs(e->row[i]) * e->size[i];
  }
  q = fmax(q, 0) + (4.0 * n + 32) * UNIT * size * size;
  for (uint32_t i = 0; i < n; i++) {
    b[i] = 0;
    for (uint32_t k = 0; k < n; k++) b[i] += T0[(size_t)i * n + k] * turned[k];
  }
  double of_u = weighed(e, n, u), of_b = weighed(e, n, b), sigma = sqrt(q * of_u);
  double kappa = sqrt(of_b / of_u), gamma = (4.0 * n + 32) * UNIT;
  if (!(q > LOST) || !(of_u > LOST) || !(kappa > LOST) || !(kappa < 1 / LOST)) {
    for (uint32_t i = 0; i < n; i++) *box(z, FROM_MIXED, i) += fabs(u[i]) * size * ABOVE;
    return;
  }
  for (uint32_t i = 0; i < n; i++) {
    double slack = gamma * e->reach[i] * size;
    for (uint32_t k = 0; k <= i; k++) {
      e->half[(size_t)i * n + k] += kappa * ABOVE * u[i] * u[k] + b[i] * b[k] / kappa;
      e->work[(size_t)i * n + k] += u[i] * u[k] * (q / sigma);
    }
    e->half[(size_t)i * n + i] += n * slack * slack / (1e-9 * kappa) * ABOVE + LOST;
  }
  *square += sigma;
}

/* adds u |w' P_4| */
static void add_quartic(zono *z) {
  ellipsoid *e = z->proof->ellipsoid;
  double size = quartic_through(z, e->row);
  for (uint32_t i = 0; i < z->nx; i++) e->turned[i] = e->column[i] * size * ABOVE;
  if (size > 0) ellipsoid_add(z, e->turned, FROM_MIXED);
}

/* adds R P_4, column by column */
static void add_quartics(zono *z, const double *R) {
  ellipsoid *e = z->proof->ellipsoid;
  for (uint32_t k = 0; k < z->nx; k++) {
    double size = quartic_size(z, k) * ABOVE;
    for (uint32_t i = 0; i < z->nx; i++) e->turned[i] = R[(size_t)i * z->nx + k] * size;
    if (size > 0) ellipsoid_add(z, e->turned, FROM_MIXED);
  }
}

/* The ellipsoid by T0 + sum_j xi_j T_j, y [nx x stride]. With T_j = sum_r u_r w_r' + R_j,
**   (T0 + C) Q (T0 + C)' <= T0 Q T0' + sum (kappa u u' + b b' / kappa) + C Q C',  b = T0 Q w, C = sum xi_r u_r w_r':
** what is not turned by the data is not made larger, as it would be by a sum of ellipsoids. R_j goes by such a sum. */
void ellipsoid_move(zono *z, const double *y) { /* P_4's as well */
  ellipsoid *e = z->proof->ellipsoid;
  const shape *s = &z->shape;
  uint32_t n = z->nx;
  double square = 0;
  uint32_t pairs = 0, i = 0, k = 0;
  if (!e->is_used) return;
  for (uint32_t j = 0; j < s->mixed; j++) /* R_j: `half` is free */
    if (take_map(z, e->map, y, s->mix + (size_t)j * n)) {
      for (int r = 0; r < RANK && find_pivot(e, n, e->map, &i, &k); r++) split(z, e->map, i, k);
      turn(z, e->map), add_half(z), add_quartics(z, e->map);
    }
  turn(z, e->mean);
  memset(e->work, 0, (size_t)n * n * sizeof(double));
  for (uint32_t j = 0; j < s->mixed; j++) /* the same u and w again */
    if (take_map(z, e->map, y, s->mix + (size_t)j * n))
      for (int r = 0; r < RANK && find_pivot(e, n, e->map, &i, &k); r++)
        split(z, e->map, i, k), add_pair(z, &square, e->mean), add_quartic(z), pairs++;
  for (size_t a = 0; a < (size_t)n * n; a++) e->half[a] += square * ABOVE * e->work[a];
  for (uint32_t a = 0; a < n; a++) e->half[(size_t)a * n + a] *= 1 + 16.0 * n * (pairs + 8) * UNIT;
  add_half(z);
}

/* adds v r, |r| <= 1 */
void ellipsoid_add(zono *z, const double *v, enum origin from) {
  ellipsoid *e = z->proof->ellipsoid;
  uint32_t nx = z->nx;
  double any = 0, *to = e->segment;
  for (uint32_t i = 0; i < nx; i++) {
    int is_box = !e->is_used || fabs(v[i]) < NEGLIGIBLE;
    to[i] = is_box ? 0 : v[i];
    if (is_box) *box(z, from, i) += fabs(v[i]);
    any += fabs(to[i]);
  }
  if (any == 0) return;
  double s = sqrt(weighed(e, nx, to));
  for (uint32_t i = 0; i < nx; i++) {
    double share = to[i] / s, *row = e->sum + (size_t)i * nx;
    if (share == 0) continue;
    for (uint32_t k = 0; k <= i; k++) row[k] += share * to[k];
  }
  e->total += s, e->terms++;
}

/* Each sum of n entries X_ik rounds by at most n 2^-52 sqrt(X_ii X_kk), X their sum: nx times that on the diagonal. */
void ellipsoid_finish(zono *z) {
  ellipsoid *e = z->proof->ellipsoid;
  uint32_t nx = z->nx;
  double total = e->total * ABOVE;
  if (!e->is_used) return;
  for (uint32_t i = 0; i < nx; i++) {
    double *row = e->Q + (size_t)i * nx;
    for (uint32_t k = 0; k < i; k++) row[k] = e->Q[(size_t)k * nx + i] = total * e->sum[(size_t)i * nx + k];
    row[i] = total * e->sum[(size_t)i * nx + i] * (1 + 4 * nx * (e->terms + 16.0) * UNIT);
    e->size[i] = sqrt(row[i]) * ABOVE;
  }
}
