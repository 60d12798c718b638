/* zonotope.c -- generators: moving, adding and condensing them. */
#include "zonotope.h"
#include "shared/axes.h"
#include <string.h>

#define BLOCK 4
#define SMALLEST_ENTRY 0x1p-100 /* of a frame */
#define LARGEST_EXPONENT 900

int zonotope_open(const ambit_host *h, zonotope_shape *w, uint32_t n, uint32_t keep) {
  size_t room = (size_t)(keep + keep / 2 + 1) * n; /* young ones, and half as many groups that are kept */
  *w = (zonotope_shape) { .n = n, .keep = keep, .room = (room + BLOCK - 1) / BLOCK * BLOCK };
  w->size = (HEAD + n + w->room * n + BLOCK - 1) / BLOCK * BLOCK;
  w->work = h->alloc(h, (2 * (size_t)n * n + 4 * n + BLOCK) * sizeof(double));
  w->unit = h->alloc(h, n * sizeof(double));
  return w->work && w->unit;
}

void zonotope_clear(const zonotope_shape *w, zonotope r) { memset(r.head, 0, w->size * sizeof(double)); }

/* A sum of n products with relative error 2^-52 in each operation is off by gamma(n + 1) times the sum of magnitudes at
** most; per row that is gamma(n + 1) sum |M_ij| sum_c |d_cj|. */
void zonotope_multiply(const zonotope_shape *w, zonotope r, const double *M, double *pad) {
  uint32_t n = w->n;
  size_t used = ((size_t)r.head[USED] + BLOCK - 1) / BLOCK * BLOCK;
  double *block = w->work;
  for (uint32_t i = 0; i < n; i++) {
    double size = 0;
    for (uint32_t j = 0; j < n; j++) size += fabs(M[(size_t)i * n + j]) * r.sum[j];
    pad[i] += gamma_of(n + 2.0) * size + (size > 0 ? TINY : 0);
  }
  for (size_t c = 0; c < used; c += BLOCK) {
    for (uint32_t j = 0; j < n; j++)
      memcpy(block + (size_t)j * BLOCK, r.column + j * w->room + c, BLOCK * sizeof *block);
    for (uint32_t i = 0; i < n; i++) {
      four total = { 0, 0, 0, 0 };
      for (uint32_t j = 0; j < n; j++) total += M[(size_t)i * n + j] * *(const four *)(block + (size_t)j * BLOCK);
      memcpy(r.column + i * w->room + c, &total, sizeof total);
    }
  }
}

/* -- a frame: principal axes */

/* >= the row-sum norm of I - Q^T Q */
static double defect(uint32_t n, const double *Q) {
  double worst = 0;
  for (uint32_t i = 0; i < n; i++) {
    double row = 0;
    for (uint32_t j = 0; j < n; j++) {
      double above = -(i == j), below = i == j;
      for (uint32_t k = 0; k < n; k++) {
        double a = Q[(size_t)k * n + i], b = Q[(size_t)k * n + j];
        above += a * b;
        below += (-a) * b;
      }
      row += larger(above, below);
    }
    if (!(row < INFINITY)) return INFINITY;
    worst = larger(worst, row);
  }
  return worst;
}

/* Q from the shape A, which is destroyed; its defect, below 1/2 */
static double frame(uint32_t n, double *A, double *Q) {
  shared_axes(n, A, Q);
  for (size_t k = 0; k < (size_t)n * n; k++)
    if (fabs(Q[k]) < SMALLEST_ENTRY) Q[k] = 0;
  double eps = defect(n, Q);
  if (eps < 0.5) return eps;
  shared_identity(n, Q);
  return 0;
}

/* -- condensing */

static double power_of_two(double x) {
  int e = 0;
  if (!(x > 0) || !(x < INFINITY)) return 1;
  frexp(x, &e);
  return ldexp(1, e > LARGEST_EXPONENT ? LARGEST_EXPONENT : e < -LARGEST_EXPONENT ? -LARGEST_EXPONENT : e);
}

static void measure(const zonotope_shape *w, zonotope r, size_t from, size_t to, double *A) {
  uint32_t n = w->n;
  for (uint32_t i = 0; i < n; i++) {
    double size = 0;
    for (size_t c = from; c < to; c++) size += fabs(r.column[i * w->room + c]);
    w->unit[i] = power_of_two(size);
  }
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t j = 0; j <= i; j++) {
      const double *a = r.column + i * w->room, *b = r.column + j * w->room;
      double dot = 0, u = 1 / w->unit[i], v = 1 / w->unit[j];
      for (size_t c = from; c < to; c++) dot += (a[c] * u) * (b[c] * v);
      A[(size_t)i * n + j] = A[(size_t)j * n + i] = dot;
    }
}

/* v[j] >= sum over columns of |Q^T D^-1 d|_j; quotients by powers of two are exact or underflow by TINY */
static void project(
    const zonotope_shape *w, zonotope r, size_t from, size_t to, const double *Q, double *v, double *x) {
  uint32_t n = w->n;
  for (uint32_t j = 0; j < n; j++) v[j] = 0;
  for (size_t c = from; c < to; c++) {
    for (uint32_t i = 0; i < n; i++) x[i] = r.column[i * w->room + c] / w->unit[i];
    for (uint32_t j = 0; j < n; j++) {
      double above = 0, below = 0;
      for (uint32_t i = 0; i < n; i++) {
        above += Q[(size_t)i * n + j] * x[i];
        below += (-Q[(size_t)i * n + j]) * x[i];
      }
      v[j] += larger(above, below) + TINY;
    }
  }
}

/* Columns [from, to) become n; what rounding the new ones changes goes to pad[n]. */
static void condense(const zonotope_shape *w, zonotope r, size_t from, size_t to, double *pad) {
  uint32_t n = w->n;
  double *A = w->work, *Q = A + (size_t)n * n, *v = Q + (size_t)n * n, *x = v + n, most = 0;
  size_t used = (size_t)r.head[USED], gone = to - from - n;
  measure(w, r, from, to, A);
  double eps = frame(n, A, Q);
  project(w, r, from, to, Q, v, x);
  for (uint32_t j = 0; j < n; j++) most = larger(most, v[j]);
  double more = eps / -(eps - 1) * most;
  for (uint32_t i = 0; i < n; i++) {
    double *row = r.column + i * w->room;
    for (uint32_t j = 0; j < n; j++) {
      double entry = w->unit[i] * Q[(size_t)i * n + j] * (v[j] + more);
      row[from + j] = entry;
      pad[i] += fabs(entry) * 0x1p-51 + TINY;
    }
    memmove(row + from + n, row + to, (used - to) * sizeof *row);
    memset(row + used - gone, 0, gone * sizeof *row);
  }
  r.head[USED] -= (double)gone;
}

static void sum_up(const zonotope_shape *w, zonotope r) {
  for (uint32_t i = 0; i < w->n; i++) {
    const double *row = r.column + i * w->room;
    four total = { 0, 0, 0, 0 };
    for (size_t c = 0; c < (size_t)r.head[USED]; c += BLOCK) {
      four x = *(const four *)(row + c);
      for (int k = 0; k < BLOCK; k++) total[k] += fabs(x[k]);
    }
    r.sum[i] = (total[0] + total[1]) + (total[2] + total[3]);
  }
}

void zonotope_push(const zonotope_shape *w, zonotope r, const double *box) {
  uint32_t n = w->n;
  size_t at = (size_t)r.head[USED];
  for (uint32_t i = 0; i < n; i++) r.column[i * w->room + at + i] = box[i];
  r.head[USED] += n;
  double *pad = w->work + 2 * (size_t)n * n + 2 * n;
  if (r.head[USED] - r.head[FIXED] >= (double)w->keep * n) {
    memset(pad, 0, n * sizeof *pad);
    size_t fixed = (size_t)r.head[FIXED], half = (size_t)(w->keep / 2) * n;
    condense(w, r, fixed, fixed + half, pad);
    r.head[FIXED] += n;
    if ((size_t)r.head[FIXED] >= (size_t)(w->keep / 2) * n) {
      condense(w, r, 0, (size_t)r.head[FIXED], pad);
      r.head[FIXED] = n;
    }
    size_t last = (size_t)r.head[USED] - n; /* the youngest box is still one of axes */
    for (uint32_t i = 0; i < n; i++) r.column[i * w->room + last + i] += pad[i];
  }
  sum_up(w, r);
}
