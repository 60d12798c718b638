/* real_schur_vectors.c -- eigenvectors by back-substitution in the triangle, and balancing. */
#include "real_schur.h"
#include <complex.h>
#include <float.h>
#include <math.h>

#define TALL 1e100 /* components beyond it are scaled down before they overflow */

typedef double complex number;

typedef struct triangle {
  size_t n;
  const double *t;
  double least; /* divisors are at least so large */
} triangle;

static double at(const triangle *s, size_t i, size_t j) { return s->t[i * s->n + j]; }

static number no_less(number x, double least) { return cabs(x) < least ? least : x; }

/* row i of T y without the columns before `from` */
static number beside(const triangle *s, size_t i, size_t from, size_t to, const number *y) {
  number sum = 0;
  for (size_t j = from; j < to; j++) sum += at(s, i, j) * y[j];
  return sum;
}

/* y above its entry `above`, for (T - lambda) y = 0; `to` entries in all */
static void substitute_back(const triangle *s, number lambda, size_t above, size_t to, number *y) {
  for (size_t i = above; i-- > 0;) {
    if (i > 0 && at(s, i, i - 1) != 0) {
      number f = -beside(s, i - 1, i + 1, to, y), g = -beside(s, i, i + 1, to, y), a = at(s, i - 1, i - 1) - lambda,
             d = at(s, i, i) - lambda;
      number determinant = no_less(a * d - at(s, i - 1, i) * at(s, i, i - 1), s->least * s->least);
      y[i] = (a * g - at(s, i, i - 1) * f) / determinant;
      y[i - 1] = (d * f - at(s, i - 1, i) * g) / determinant;
      i--;
    } else
      y[i] = -beside(s, i, i + 1, to, y) / no_less(at(s, i, i) - lambda, s->least);
    double tall = fmax(cabs(y[i]), cabs(y[i + 1]));
    for (size_t j = i; tall > TALL && j < to; j++) y[j] /= tall;
  }
}

/* columns k and, for a pair, k + 1 of the vectors := Z y, the largest component 1 */
static void place(size_t n, const double *z, size_t to, const number *y, size_t k, int is_pair, double *vector) {
  number largest = 1;
  double size = 0;
  for (size_t i = 0; i < n; i++) {
    number sum = 0;
    for (size_t j = 0; j < to; j++) sum += z[i * n + j] * y[j];
    if (cabs(sum) > size) size = cabs(sum), largest = sum;
    vector[i * n + k] = creal(sum);
    if (is_pair) vector[i * n + k + 1] = cimag(sum);
  }
  for (size_t i = 0; i < n; i++) {
    number x = (vector[i * n + k] + (is_pair ? vector[i * n + k + 1] : 0) * I) / largest;
    vector[i * n + k] = creal(x);
    if (is_pair) vector[i * n + k + 1] = cimag(x);
  }
}

/* the rows k, k + 1 of y for a block of two, im the imaginary part of its eigenvalue */
static void start_pair(const triangle *s, size_t k, double im, number *y) {
  double b = at(s, k, k + 1);
  int is_upper = fabs(b) >= fabs(at(s, k + 1, k));
  y[k] = is_upper ? 1 : -I * (b / im);
  y[k + 1] = is_upper ? I * (im / b) : 1;
}

void real_schur_vectors(
    size_t n, const double *t, const double *z, double *re, double *im, double *vector, double *work) {
  triangle s = { n, t, 0 };
  number *y = (number *)(void *)work;
  for (size_t i = 0; i < n * n; i++) s.least = fmax(s.least, fabs(t[i]));
  s.least = fmax(DBL_EPSILON * s.least, DBL_MIN / DBL_EPSILON);
  for (size_t k = 0; k < n; k++) {
    int is_pair = k + 1 < n && at(&s, k + 1, k) != 0;
    re[k] = at(&s, k, k), im[k] = 0, y[k] = 1;
    if (is_pair) {
      im[k] = sqrt(fabs(at(&s, k, k + 1))) * sqrt(fabs(at(&s, k + 1, k)));
      re[k + 1] = re[k], im[k + 1] = -im[k];
      start_pair(&s, k, im[k], y);
    }
    substitute_back(&s, re[k] + im[k] * I, k, k + 1 + (size_t)is_pair, y);
    place(n, z, k + 1 + (size_t)is_pair, y, k, is_pair, vector);
    k += (size_t)is_pair;
  }
}

void balance_matrix(size_t n, double *a, double *scale) {
  for (size_t i = 0; i < n; i++) scale[i] = 1;
  for (int changed = 1, round = 0; changed && round < 50; round++) {
    changed = 0;
    for (size_t i = 0; i < n; i++) {
      double row = 0, column = 0;
      int exponent_row, exponent_column;
      for (size_t j = 0; j < n; j++)
        if (j != i) row = fmax(row, fabs(a[i * n + j])), column = fmax(column, fabs(a[j * n + i]));
      if (row == 0 || column == 0) continue;
      frexp(row, &exponent_row), frexp(column, &exponent_column);
      int half = (exponent_row - exponent_column) / 2;
      if (half == 0) continue;
      changed = 1;
      scale[i] = ldexp(scale[i], half);
      for (size_t j = 0; j < n; j++)
        a[i * n + j] = ldexp(a[i * n + j], -half), a[j * n + i] = ldexp(a[j * n + i], half);
    }
  }
}
