/* kernel.c -- how a lump acts on the state at the end of the step: K(s) = e^(J (h - s)), J the middle of the slopes.
**
** With T_k = (J h)^k / k! and tau = (h - s) / h, K = sum_k T_k tau^k. In Legendre polynomials on [0, 1],
** tau^k = 1 / (k + 1) + b_k (2 tau - 1) + rest, b_k = 3 k / ((k + 1) (k + 2)), and the integral of |rest| is at most
** the root of that of its square, 1 / (2 k + 1) - 1 / (k + 1)^2 - b_k^2 / 3. So mean = sum T_k / (k + 1), tilt = sum
** b_k T_k; reach, the integral of |K|, is at most |h| sum |T_k| / (k + 1), and wobble, that of |K - mean - tilt (2
** tau - 1)|, at most |h| sum |T_k| times that root. Rounding is bounded by powers of |J h|; what is beyond the last
** power by its norm in units in which J h is small.
*/
#include "proof.h"

#define TERMS_MAX 40
#define TURNS 12

static void multiply(uint32_t n, double *to, const double *a, const double *b, double scale) {
  for (uint32_t i = 0; i < n; i++) {
    double *row = to + (size_t)i * n;
    memset(row, 0, n * sizeof *row);
    for (uint32_t k = 0; k < n; k++) {
      double x = a[(size_t)i * n + k] * scale;
      const double *from = b + (size_t)k * n;
      if (x == 0) continue;
      for (uint32_t j = 0; j < n; j++) row[j] += x * from[j];
    }
  }
}

/* max over i of sum_j a_ij u_j / u_i */
static double norm(const zono *z, const double *a) {
  const double *u = z->proof->unit;
  double most = 0;
  for (uint32_t i = 0; i < z->nx; i++) {
    double sum = 0;
    for (uint32_t j = 0; j < z->nx; j++) sum += a[(size_t)i * z->nx + j] * u[j];
    most = fmax(most, sum / u[i]);
  }
  return most * ABOVE;
}

/* units in which |J h| is about as small as its spectral radius: what it makes of the states' sizes, again and again */
static void find_units(const zono *z, double length) {
  proof *p = z->proof;
  uint32_t n = z->nx;
  double *u = p->unit, *next = p->grow;
  memcpy(u, is_certain(z) ? p->natural : p->spread, n * sizeof *u);
  for (int turn = 0; turn < TURNS; turn++) {
    double most = 0;
    for (uint32_t i = 0; i < n; i++) {
      next[i] = u[i];
      for (uint32_t j = 0; j < n; j++) next[i] += p->jacobian_size[(size_t)i * n + j] * length * u[j];
      most = fmax(most, next[i]);
    }
    for (uint32_t i = 0; i < n; i++) u[i] = fmax(next[i] / most, 1e-150);
  }
}

/* adds T_k and a bound of its rounding */
static void add_power(proof *p, uint32_t n, uint32_t k, double length) {
  double b = 3.0 * k / ((k + 1.0) * (k + 2.0)), lost = k < 1 ? 0 : 2 * k * (n + 3.0) * UNIT;
  double off = k < 2 ? 0 : sqrt(1 / (2.0 * k + 1) - 1 / ((k + 1.0) * (k + 1.0)) - b * b / 3 + 16 * UNIT) * ABOVE;
  for (size_t e = 0; e < (size_t)n * n; e++) {
    double most = fabs(p->power[e]) + lost * p->size[e];
    p->mean[e] += p->power[e] / (k + 1.0);
    p->tilt[e] += p->power[e] * b;
    p->reach[e] += length * most / (k + 1.0);
    p->wobble[e] += length * (off * most + (lost + 64 * UNIT) * p->size[e]);
  }
}

/* powers of J are 0 in a row or column in which J is */
static void add_rest(const zono *z, double length, double rest) {
  proof *p = z->proof;
  double *row = p->grow, *column = p->grow_path;
  for (uint32_t i = 0; i < z->nx; i++) {
    row[i] = column[i] = 0;
    for (uint32_t j = 0; j < z->nx; j++) {
      row[i] += p->jacobian_size[(size_t)i * z->nx + j], column[i] += p->jacobian_size[(size_t)j * z->nx + i];
    }
  }
  for (uint32_t i = 0; i < z->nx; i++)
    for (uint32_t j = 0; j < z->nx; j++) {
      if (row[i] == 0 || column[j] == 0) continue;
      double most = length * rest * p->unit[i] / p->unit[j];
      p->reach[(size_t)i * z->nx + j] += most, p->wobble[(size_t)i * z->nx + j] += 2 * most;
    }
}

int kernel_units(zono *z) {
  proof *p = z->proof;
  size_t all = (size_t)z->nx * z->nx;
  for (size_t e = 0; e < all; e++) p->jacobian_size[e] = fabs(p->J[e]) * ABOVE;
  find_units(z, fabs(z->h) * ABOVE);
  return 1;
}

int kernel_find(zono *z) {
  proof *p = z->proof;
  uint32_t n = z->nx, k = 0;
  size_t all = (size_t)n * n, bytes = all * sizeof(double);
  double length = fabs(z->h) * ABOVE;
  kernel_units(z);
  memset(p->mean, 0, bytes), memset(p->tilt, 0, bytes), memset(p->reach, 0, bytes), memset(p->wobble, 0, bytes);
  memset(p->power, 0, bytes), memset(p->size, 0, bytes);
  for (uint32_t i = 0; i < n; i++) p->power[(size_t)i * n + i] = p->size[(size_t)i * n + i] = 1;
  double step = norm(z, p->jacobian_size) * length, now = 1;
  if (!(step < 4)) return z->why = WHY_GROWTH, 0;
  for (;; k++) {
    add_power(p, n, k, length);
    if (k > step && (now < 1e-14 || k >= TERMS_MAX)) break;
    multiply(n, p->power_new, p->power, p->J, z->h / (k + 1.0));
    multiply(n, p->size_new, p->size, p->jacobian_size, length / (k + 1.0));
    double *old = p->power, *old_size = p->size;
    p->power = p->power_new, p->power_new = old, p->size = p->size_new, p->size_new = old_size;
    now = norm(z, p->size);
  }
  add_rest(z, length, now * step / (k + 1) / (1 - step / (k + 2)) * ABOVE);
  for (size_t e = 0; e < all; e++) p->reach[e] *= ABOVE, p->wobble[e] *= ABOVE;
  return 1;
}
