/* quartic.c -- what products leave out of degree 4, known at the middle of the step.
**
** A lump is a bound, and bounds do not cancel; but what lumps bound is for the most part terms of degree 4 in the data,
** functions of the same xi, which nearly cancel in the accelerations. So these terms are multiplied out at the middle
** of the step, and their sum with the weights of the lumps is one polynomial for each x', which the set keeps. Lumps
** bound what is left: other terms, and how the mean over the step differs from the middle (docs/numerics/zonotope.md,
** section 7). So are terms of degree 2 in the data and 1 in eps, but they are bounded at once, and products of errors
** where these are as large as what varies in time makes them.
*/
#include "modes.h"
#include "quartic.h"
#include "basis.h"
#include "residual.h"

/* to += power times what is at `at`; returns the sum of sizes */
static double gather(double *to, const double *row, const uint32_t *at, uint32_t n, double power) {
  double size = 0;
  for (uint32_t i = 0; i < n; i++) to[i] += power * row[at[i]], size += fabs(row[at[i]]);
  return size;
}

/* the operand in the middle of the step, times `power` */
static void take(const zono *z, operand *o, uint32_t slot, double power) {
  const quartic *q = z->proof->quartic;
  memset(o->l, 0, q->n * sizeof(double)), memset(o->q, 0, q->pairs * sizeof(double));
  memset(o->r, 0, z->nx * sizeof(double)), memset(o->x, 0, q->n * z->nx * sizeof(double));
  memset(o->c, 0, q->triples * sizeof(double));
  for (uint32_t k = 0; k < orders(z, slot); k++, power *= 0.5 * z->h) {
    const double *row = row_at(z, slot, k);
    o->size_l[k] = gather(o->l, row + 1, q->datum, q->n, power);
    o->size_q[k] = row_q(&z->shape, row) > 0 ? gather(o->q, row, q->pair_at, q->pairs, power) : 0;
    double *r = o->r, *x = o->x;
    const shape *s = &z->shape;
    o->size_r[k] = o->size_x[k] = 0;
    for (uint32_t v = 0; v < z->nx && row_r(s, row) > 0; v++)
      r[v] += power * row[s->eps + v], o->size_r[k] += fabs(row[s->eps + v]);
    for (uint32_t d = 0; d < q->n && q->datum[d] < s->mixed && row_x(s, row) > 0; d++)
      for (uint32_t v = 0; v < z->nx; v++) {
        double y = row[s->mix + q->datum[d] * z->nx + v];
        x[d * z->nx + v] += power * y, o->size_x[k] += fabs(y);
      }
    o->size_c[k] = row_c(&z->shape, row) > 0 ? gather(o->c, row, q->triple_at, q->triples, power) : 0;
  }
}

/* What is left of s^k without its value in the middle, by h^k: of its mean over the step, of its integral to any s, of
** its moment. */
static double left_mean(uint32_t k) { return fabs(1 / (k + 1.0) - ldexp(1, -(int)k)); }
static double left_path(uint32_t k) { return fmax(left_mean(k), ldexp(1, -1 - (int)k) * k / (k + 1.0)); }
static double left_moment(uint32_t k) { return k / ((k + 1.0) * (k + 2.0)); }

static double size_of(const quartic *q, uint32_t i, uint32_t j) {
  const operand *a = &q->a, *b = &q->b;
  return far_size(q, i, j) + q->squares * a->size_r[i] * b->size_r[j] + a->size_l[i] * b->size_c[j] +
         a->size_c[i] * b->size_l[j] + a->size_q[i] * b->size_q[j] + a->size_l[i] * b->size_x[j] +
         a->size_x[i] * b->size_l[j] + a->size_q[i] * b->size_r[j] + a->size_r[i] * b->size_q[j];
}

/* the lump of slot j without what is known; whole: size of the known over the step */
static lump reduce(const zono *z, uint32_t j, uint32_t last_a, uint32_t last_b, double *whole) {
  const quartic *q = z->proof->quartic;
  double mean = 0, moment = 0, rest = 0, path = 0, length = fabs(z->h), power = 1;
  *whole = 0;
  for (uint32_t k = 0; k <= last_a + last_b; k++, power *= length) {
    double size = 0;
    for (uint32_t i = 0; i <= k && i <= last_a; i++)
      if (k - i <= last_b) size += size_of(q, i, k - i);
    *whole += size * power;
    if (k > z->K) continue;
    mean += (1 - left_mean(k)) * size * power, moment += (0.5 - left_moment(k)) * size * power;
    rest += ldexp(1, -(int)k) * size * power, path += (1 - left_path(k)) * size * power;
  }
  double rr = z->rr[j], more = (8 * z->K + 100) * UNIT * *whole + 1e-8 * rr;
  return (lump) { rr, fmax(rr - rest, 0) + more, fmax(rr - path, 0) + more, fmax(rr - mean, 0) + more,
    fmax(0.5 * rr - moment, 0) + more };
}

/* near := what the product has of xi_i xi_j eps_k */
static void multiply_near(quartic *q) {
  uint32_t n = q->n, nx = q->nx;
  const operand *a = &q->a, *b = &q->b;
  double *to = q->near;
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t j = i; j < n; j++, to += nx) {
      double ai = a->l[i], bi = b->l[i], aj = i == j ? 0 : a->l[j], bj = i == j ? 0 : b->l[j];
      double aq = a->q[q->pair[i] + j - i], bq = b->q[q->pair[i] + j - i];
      const double *xa = a->x + i * nx, *xb = b->x + i * nx, *ya = a->x + j * nx, *yb = b->x + j * nx;
      for (uint32_t k = 0; k < nx; k++)
        to[k] = ai * yb[k] + bi * ya[k] + aj * xb[k] + bj * xa[k] + aq * b->r[k] + bq * a->r[k];
    }
}

double *quartic_near(zono *z, uint32_t i, uint32_t n) {
  quartic *q = z->proof->quartic;
  return q->near_sum + ((size_t)i * q->pairs + n) * z->nx;
}

lump quartic_none(double size) { return (lump) { size, size, size, size, 0.5 * size }; }

static double sizes(const double *x, size_t n) {
  double sum = 0;
  for (size_t m = 0; m < n; m++) sum += fabs(x[m]);
  return sum;
}

/* adds the product to those of its group */
static lump multiply(zono *z, uint32_t j, double sign, double *whole) {
  const ambit_tape *t = z->program.tape;
  quartic *q = z->proof->quartic;
  uint32_t i = q->made[j], a = t->a[i], b = t->op[i] == AMBIT_OP_SQR ? a : t->b[i];
  take(z, &q->a, a, sign), take(z, &q->b, b, 1);
  if (q->far.nrun) far_take(z, &q->a, a, sign), far_take(z, &q->b, b, 1);
  lump left = reduce(z, j, orders(z, a) - 1, orders(z, b) - 1, whole);
  if (*whole == 0) return left;
  if (q->n) {
    q->multiply(q, q->product);
    if (q->far.nrun) q->multiply_far(q, q->product + q->fourth);
    multiply_near(q);
    q->add(q->group, 1, q->product, q->length);
    q->add(q->near_group, 1, q->near, (size_t)q->pairs * z->nx);
  }
  for (uint32_t k = 0; k < z->nx && q->squares; k++)
    if (q->a.r[k] != 0) q->add(q->square_group + (size_t)k * z->nx, q->a.r[k], q->b.r, z->nx);
  return left;
}

/* row n of the square sums += c times those of the group */
static void add_squares(const zono *z, uint32_t n, double c) {
  quartic *q = z->proof->quartic;
  size_t square = (size_t)z->nx * z->nx;
  if (c != 0) q->add(q->square_sum + n * square, c, q->square_group, square);
}

/* eps_i times the errors that its row makes: these are not independent of one another */
double quartic_square(zono *z, uint32_t n) {
  const quartic *q = z->proof->quartic;
  const double *x = q->square_sum + (size_t)n * z->nx * z->nx;
  double *row = z->proof->grow_path, sum = 0;
  for (uint32_t i = 0; i < z->nx && q->squares; i++) {
    double single = 0;
    for (uint32_t k = 0; k < z->nx; k++) row[k] = 0.5 * (x[i * z->nx + k] + x[k * z->nx + i]), single += fabs(row[k]);
    if (single == 0) continue;
    double rounding = 4 * UNIT * single, together = basis_resolve(z, row);
    sum += fmin(single, together + mixed_size(z, row)) + rounding;
  }
  return sum;
}

/* the sums of each x' += what is known of the group of slot j; returns its size */
static double add_known(zono *z, uint32_t j, double whole) {
  const proof *p = z->proof;
  quartic *q = p->quartic;
  size_t near = (size_t)q->pairs * z->nx;
  int by_equation = p->residual->used;
  for (uint32_t e = 0; e < z->na && by_equation; e++) {
    double c = p->residual->W[(size_t)e * z->nslot + j];
    add_squares(z, z->nx + e, c), q->rounding[z->nx + e] += fabs(c) * whole;
  }
  for (uint32_t x = 0; x < z->nx; x++) {
    double c = p->link[x] == LINK_STATE ? 0 : p->C[(size_t)p->link_to[x] * z->nslot + j];
    if (c == 0) continue;
    q->add(q->sum + (size_t)x * q->length, c, q->group, q->length);
    q->add(q->near_sum + (size_t)x * near, c, q->near_group, near);
    if (q->squares && !(by_equation && p->link[x] == LINK_UNKNOWN)) add_squares(z, x, c);
    q->rounding[x] += fabs(c) * whole;
  }
  double squares = q->squares ? sizes(q->square_group, (size_t)z->nx * z->nx) : 0;
  return sizes(q->group, q->length) + sizes(q->near_group, near) + squares + (2.0 * q->count + 8) * UNIT * whole;
}

lump quartic_lump(zono *z, uint32_t j) {
  quartic *q = z->proof->quartic;
  lump all = { 0, 0, 0, 0, 0 };
  double bound = 0, whole = 0;
  if (q->count == 0 || !q->chosen[j]) return quartic_none(z->rr[j]);
  if (q->chosen[j] > 1) return all;
  memset(q->group, 0, q->length * sizeof(double));
  memset(q->near_group, 0, (size_t)q->pairs * z->nx * sizeof(double));
  if (q->squares) memset(q->square_group, 0, (size_t)z->nx * z->nx * sizeof(double));
  for (uint32_t k = j; k != AMBIT_NO_SLOT; k = q->next[k]) {
    double size;
    if (q->chosen[k] != 1) continue;
    lump one = multiply(z, k, q->sign[k] * q->sign[j], &size);
    q->chosen[k] = 2;
    all.rest += one.rest, all.path += one.path, all.mean += one.mean, all.moment += one.moment, bound += z->rr[k],
        whole += size;
  }
  all.most = fmin(bound, all.rest + add_known(z, j, whole)) * ABOVE;
  return all;
}

/* -- the terms that the set has */

static double *term_at(const zono *z, double *terms, uint32_t i) {
  return terms + (size_t)i * z->proof->quartic->length;
}

double quartic_size(const zono *z, uint32_t i) { return z->proof->quartic->size[i]; }

/* bound of the sum of this step for x'_i */
double quartic_sum(const zono *z, uint32_t i) {
  const quartic *q = z->proof->quartic;
  return (sizes(term_at(z, q->sum, i), q->length) + (2.0 * q->count + 8) * UNIT * q->rounding[i]) * ABOVE;
}

/* to_i := sum_k matrix_ik from_k, matrix [nx x nx], by a row stride of its own; added to what is there */
static void add_product(const zono *z, double *to, const double *by, const double *from) {
  uint32_t length = z->proof->quartic->length;
  for (uint32_t k = 0; k < z->nx; k++) {
    const double *x = from + (size_t)k * length;
    if (by[k] == 0) continue;
    z->proof->quartic->add(to, by[k], x, length);
  }
}

/* at most |sum_k by_k P_4,k| */
double quartic_through(zono *z, const double *by) {
  quartic *q = z->proof->quartic;
  double size = 0;
  if (!q->held) return 0;
  memset(q->product, 0, q->length * sizeof *q->product);
  add_product(z, q->product, by, q->term);
  for (uint32_t k = 0; k < z->nx; k++) size += fabs(by[k]) * q->size[k];
  return (sizes(q->product, q->length) + (2.0 * z->nx + 8) * UNIT * size) * ABOVE;
}

/* at most |sum_k by_k P_4,k| without what is moved: of what came up in this step; after quartic_finish() */
double quartic_fresh(zono *z, const double *by) {
  quartic *q = z->proof->quartic;
  double size = 0;
  if (!q->held || q->count == 0) return 0;
  memset(q->product, 0, q->length * sizeof *q->product);
  add_product(z, q->product, by, q->term);
  for (uint32_t k = 0; k < z->nx; k++) {
    const double *moved = term_at(z, q->moved, k);
    if (by[k] == 0) continue;
    q->add(q->product, -by[k], moved, q->length);
    size += fabs(by[k]) * (q->size[k] + sizes(moved, q->length));
  }
  return (sizes(q->product, q->length) + (4.0 * z->nx + 8) * UNIT * size) * ABOVE;
}

void quartic_move(zono *z, uint32_t i, const double *by) {
  quartic *q = z->proof->quartic;
  if (!q->held) return;
  double *to = term_at(z, q->moved, i);
  memset(to, 0, q->length * sizeof *to);
  add_product(z, to, by, q->term);
}

double quartic_end(zono *z, uint32_t i, const double *by, const double *reach) {
  quartic *q = z->proof->quartic;
  double size = 0;
  if (q->count == 0) return 0;
  memcpy(term_at(z, q->term, i), term_at(z, q->moved, i), q->length * sizeof(double));
  add_product(z, term_at(z, q->moved, i), by, q->sum);
  for (uint32_t l = 0; l < z->nx; l++) size += reach[l] * q->rounding[l];
  return (2.0 * q->count + 4 * z->nx + 32) * UNIT * size * ABOVE;
}

void quartic_drop(zono *z) {
  quartic *q = z->proof->quartic;
  if (!q->held || q->count > 0) return;
  for (uint32_t i = 0; i < z->nx; i++)
    if (q->size[i] > z->proof->budget[i] * fabs(z->h)) return;
  for (uint32_t i = 0; i < z->nx; i++) *box(z, FROM_DEGREE, i) += q->size[i] + discs_turned(z, i), q->size[i] = 0;
  memset(z->modes->now.a, 0, z->nx * sizeof(double));
  q->held = 0;
}

void quartic_finish(zono *z) {
  quartic *q = z->proof->quartic;
  double *old = q->term;
  if (!q->held && q->count == 0) return;
  q->term = q->moved, q->moved = old, q->held = 1;
  for (uint32_t i = 0; i < z->nx; i++) q->size[i] = sizes(term_at(z, q->term, i), q->length) * ABOVE;
}
