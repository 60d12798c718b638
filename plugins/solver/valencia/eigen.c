/* eigen.c -- a basis in which a matrix is nearly diagonal, with blocks of two columns for complex pairs.
**
** Eigenvectors are found in plain complex arithmetic: Hessenberg form and shifted QR by rotations, then back
** substitution (Golub & Van Loan, Matrix Computations, ch. 7), of the matrix in units of the states. They are only a
** good choice; what is proved is an enclosure of the inverse. With W near V^-1, E = I - W V and e = |E| < 1 in the
** row-sum norm, V^-1 = (I - E)^-1 W differs from W by at most e / (1 - e) max_k |W_kj| in column j.
*/
#include "valencia.h"
#include <complex.h>

#define SWEEPS 40
#define CONDITION_MAX 1e5
#define CLOSE_MAX 1e-4 /* of e */

typedef double complex number;

static number over(number a, number b) {
  double size = larger(fabs(creal(b)), fabs(cimag(b)));
  number c = b / size;
  return a * conj(c) / (creal(c) * creal(c) + cimag(c) * cimag(c)) / size;
}

typedef struct rotation {
  double c;
  number s;
} rotation;

/* [c s; -conj(s) c] (a, b) = (r, 0) */
static rotation rotation_of(number a, number b) {
  double size = hypot(cabs(a), cabs(b)), x = cabs(a);
  if (size == 0) return (rotation) { 1, 0 };
  if (x == 0) return (rotation) { 0, conj(b) / cabs(b) };
  return (rotation) { x / size, a / x * conj(b) / size };
}

static void turn_rows(rotation r, uint32_t n, uint32_t k, uint32_t from, number *t) {
  number *a = t + (size_t)k * n, *b = a + n;
  for (uint32_t j = from; j < n; j++) {
    number x = a[j], y = b[j];
    a[j] = r.c * x + r.s * y, b[j] = r.c * y - conj(r.s) * x;
  }
}

static void turn_columns(rotation r, uint32_t n, uint32_t k, uint32_t to, number *t) {
  for (uint32_t i = 0; i < to; i++) {
    number *a = t + (size_t)i * n + k, x = a[0], y = a[1];
    a[0] = r.c * x + conj(r.s) * y, a[1] = r.c * y - r.s * x;
  }
}

static void to_hessenberg(uint32_t n, number *t, number *q) {
  for (uint32_t k = 0; k + 2 < n; k++)
    for (uint32_t i = n - 1; i > k + 1; i--) {
      rotation r = rotation_of(t[(size_t)(i - 1) * n + k], t[(size_t)i * n + k]);
      turn_rows(r, n, i - 1, k, t);
      turn_columns(r, n, i - 1, n, t);
      turn_columns(r, n, i - 1, n, q);
    }
}

static int is_small(uint32_t n, const number *t, uint32_t i) {
  double beside = cabs(t[(size_t)i * n + i]) + cabs(t[(size_t)(i - 1) * n + i - 1]);
  return cabs(t[(size_t)i * n + i - 1]) <= 0x1p-52 * beside + 0x1p-1000;
}

/* the eigenvalue of the last two rows that is closer to the corner */
static number shift_of(uint32_t n, const number *t, uint32_t i) {
  number a = t[(size_t)(i - 1) * n + i - 1], b = t[(size_t)(i - 1) * n + i], c = t[(size_t)i * n + i - 1],
         d = t[(size_t)i * n + i];
  number half = (a - d) / 2, root = csqrt(half * half + b * c);
  number far = cabs(half + root) > cabs(half - root) ? half + root : half - root;
  return cabs(far) > 0 ? d - over(b * c, far) : d;
}

static void sweep(uint32_t n, uint32_t from, uint32_t to, number *t, number *q, rotation *r) {
  number shift = shift_of(n, t, to);
  for (uint32_t i = 0; i < n; i++) t[(size_t)i * n + i] -= shift;
  for (uint32_t k = from; k < to; k++) {
    r[k] = rotation_of(t[(size_t)k * n + k], t[(size_t)(k + 1) * n + k]);
    turn_rows(r[k], n, k, k, t);
  }
  for (uint32_t k = from; k < to; k++) {
    turn_columns(r[k], n, k, k + 2, t);
    turn_columns(r[k], n, k, n, q);
  }
  for (uint32_t i = 0; i < n; i++) t[(size_t)i * n + i] += shift;
}

static int to_schur(uint32_t n, number *t, number *q, rotation *r) {
  to_hessenberg(n, t, q);
  uint32_t to = n - 1, sweeps = 0;
  while (to > 0) {
    if (is_small(n, t, to)) {
      to--, sweeps = 0;
      continue;
    }
    uint32_t from = to - 1;
    while (from > 0 && !is_small(n, t, from)) from--;
    if (sweeps++ == SWEEPS) return 0;
    sweep(n, from, to, t, q, r);
  }
  return 1;
}

/* column k of q times the eigenvector of the triangle t */
static void eigenvector(uint32_t n, const number *t, const number *q, uint32_t k, number *y, number *v) {
  double scale = cabs(t[(size_t)k * n + k]) + 0x1p-1000;
  for (uint32_t i = k + 1; i-- > 0;) {
    number sum = i == k ? 1 : 0, gap = t[(size_t)i * n + i] - t[(size_t)k * n + k];
    for (uint32_t j = i + 1; j <= k; j++) sum -= t[(size_t)i * n + j] * y[j];
    if (cabs(gap) < 0x1p-50 * scale) gap = 0x1p-50 * scale;
    y[i] = i == k ? sum : over(sum, gap);
  }
  double best = 0;
  number largest = 1;
  for (uint32_t i = 0; i < n; i++) {
    v[i] = 0;
    for (uint32_t j = 0; j <= k; j++) v[i] += q[(size_t)i * n + j] * y[j];
    if (cabs(v[i]) > best) best = cabs(v[i]), largest = v[i];
  }
  for (uint32_t i = 0; i < n; i++) v[i] = over(v[i], largest);
}

/* real columns from complex ones; 0: they do not fit together */
static int collect(valencia *s, const number *t, const number *q, number *y, number *v) {
  basis *z = &s->basis;
  uint32_t n = s->nx, column = 0;
  z->nblock = 0;
  for (uint32_t k = 0; k < n; k++) {
    number lambda = t[(size_t)k * n + k];
    int is_pair = fabs(cimag(lambda)) > 1e-9 * cabs(lambda);
    if (is_pair && cimag(lambda) < 0) continue;
    if (column + 1u + (uint32_t)is_pair > n) return 0;
    eigenvector(n, t, q, k, y, v);
    for (uint32_t i = 0; i < n; i++) {
      z->v[(size_t)i * n + column] = creal(v[i]) * s->size[i];
      if (is_pair) z->v[(size_t)i * n + column + 1] = cimag(v[i]) * s->size[i];
    }
    z->first[z->nblock++] = column;
    column += 1u + (uint32_t)is_pair;
  }
  z->first[z->nblock] = column;
  return column == n;
}

/* w := approximate inverse of v, by Gauss and Jordan; a is destroyed */
static int invert(uint32_t n, double *a, double *w) {
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t j = 0; j < n; j++) w[(size_t)i * n + j] = i == j;
  for (uint32_t k = 0; k < n; k++) {
    uint32_t best = k;
    for (uint32_t i = k; i < n; i++)
      if (fabs(a[(size_t)i * n + k]) > fabs(a[(size_t)best * n + k])) best = i;
    double pivot = a[(size_t)best * n + k];
    if (!(fabs(pivot) > 0)) return 0;
    for (uint32_t j = 0; j < n; j++) {
      double x = a[(size_t)best * n + j], y = w[(size_t)best * n + j];
      a[(size_t)best * n + j] = a[(size_t)k * n + j], w[(size_t)best * n + j] = w[(size_t)k * n + j];
      a[(size_t)k * n + j] = x / pivot, w[(size_t)k * n + j] = y / pivot;
    }
    for (uint32_t i = 0; i < n; i++) {
      double f = a[(size_t)i * n + k];
      for (uint32_t j = 0; j < n && i != k; j++) {
        a[(size_t)i * n + j] -= f * a[(size_t)k * n + j], w[(size_t)i * n + j] -= f * w[(size_t)k * n + j];
      }
    }
  }
  return 1;
}

static int enclose_inverse(basis *z, uint32_t n, const double *w) {
  double error = 0, largest = 0;
  for (uint32_t i = 0; i < n; i++) {
    double row = 0;
    for (uint32_t j = 0; j < n; j++) {
      interval sum = point(i == j);
      for (uint32_t k = 0; k < n; k++) sum = minus(sum, scaled(point(w[(size_t)i * n + k]), z->v[(size_t)k * n + j]));
      row += magnitude(sum);
    }
    error = larger_or_nan(error, row);
  }
  if (!(error < CLOSE_MAX)) return 0;
  double spread = error / -(error - 1);
  for (uint32_t j = 0; j < n; j++, largest = 0) {
    for (uint32_t k = 0; k < n; k++) largest = larger_or_nan(largest, fabs(w[(size_t)k * n + j]));
    for (uint32_t i = 0; i < n; i++)
      z->inverse[(size_t)i * n + j] = plus(point(w[(size_t)i * n + j]), within(spread * largest));
  }
  return 1;
}

/* in units of the states */
static int is_well_conditioned(const valencia *s, const double *w) {
  double v_norm = 0, w_norm = 0;
  for (uint32_t i = 0; i < s->nx; i++) {
    double v_row = 0, w_row = 0;
    for (uint32_t j = 0; j < s->nx; j++) {
      v_row += fabs(s->basis.v[(size_t)i * s->nx + j]) / s->size[i];
      w_row += fabs(w[(size_t)i * s->nx + j]) * s->size[j];
    }
    v_norm = larger(v_norm, v_row), w_norm = larger(w_norm, w_row);
  }
  return v_norm * w_norm < CONDITION_MAX;
}

int valencia_eigenbasis(valencia *s, const double *a) {
  uint32_t n = s->nx;
  size_t square = (size_t)n * n;
  number *t = (number *)(void *)s->complex_room, *q = t + square, *y = q + square, *v = y + n;
  rotation *r = (rotation *)(void *)(v + n);
  for (uint32_t i = 0; i < n; i++) s->size[i] = exp2(rint(log2(s->magnitude[i] + 1e-300)));
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t j = 0; j < n; j++) {
      t[(size_t)i * n + j] = a[(size_t)i * n + j] * s->size[j] / s->size[i];
      q[(size_t)i * n + j] = i == j;
    }
  if (!to_schur(n, t, q, r) || !collect(s, t, q, y, v)) return 0;
  double *copy = (double *)(void *)t, *w = copy + square;
  for (size_t k = 0; k < square; k++) copy[k] = s->basis.v[k];
  return invert(n, copy, w) && is_well_conditioned(s, w) && enclose_inverse(&s->basis, n, w);
}

void valencia_unit_basis(valencia *s) {
  basis *z = &s->basis;
  z->nblock = s->nx;
  for (uint32_t i = 0; i < s->nx; i++) {
    z->first[i] = i;
    for (uint32_t j = 0; j < s->nx; j++) {
      z->v[(size_t)i * s->nx + j] = i == j;
      z->inverse[(size_t)i * s->nx + j] = point(i == j);
    }
  }
  z->first[s->nx] = s->nx;
}
