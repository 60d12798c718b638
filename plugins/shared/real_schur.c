/* real_schur.c -- Householder's Hessenberg form, Francis' double-shifted QR steps, a rotation for each block of two. */
#include "real_schur.h"
#include <float.h>
#include <math.h>

#define SWEEPS 60u      /* for each eigenvalue */
#define EXCEPTIONAL 10u /* sweeps after which shifts of another kind are tried once */

typedef struct schur {
  size_t n;
  double *t, *z;
} schur;

static double *row_of(const schur *s, size_t i) { return s->t + i * s->n; }
static double at(const schur *s, size_t i, size_t j) { return s->t[i * s->n + j]; }

/* -- reflections */

/* v and the returned beta with (I - beta v v') x = (*r, 0, ..., 0); v takes x's place */
static double reflector(size_t m, double *x, double *r) {
  double size = 0, sum = 0;
  for (size_t i = 0; i < m; i++) size = fmax(size, fabs(x[i]));
  *r = size;
  if (size == 0) return 0;
  for (size_t i = 0; i < m; i++) x[i] /= size, sum += x[i] * x[i];
  double length = -copysign(sqrt(sum), x[0]);
  *r = length * size;
  x[0] -= length;
  return -1 / (length * x[0]);
}

/* rows from `row` on, columns from `first` on */
static void reflect_rows(const schur *s, size_t row, size_t m, const double *v, double beta, size_t first) {
  for (size_t j = first; j < s->n; j++) {
    double sum = 0;
    for (size_t i = 0; i < m; i++) sum += v[i] * at(s, row + i, j);
    for (size_t i = 0; i < m; i++) row_of(s, row + i)[j] -= beta * sum * v[i];
  }
}

/* columns from `column` on of the first `rows` rows of a */
static void reflect_columns(size_t n, double *a, size_t rows, size_t column, size_t m, const double *v, double beta) {
  for (size_t i = 0; i < rows; i++) {
    double sum = 0, *x = a + i * n + column;
    for (size_t j = 0; j < m; j++) sum += v[j] * x[j];
    for (size_t j = 0; j < m; j++) x[j] -= beta * sum * v[j];
  }
}

static void to_hessenberg(const schur *s, double *v) {
  for (size_t k = 0; k + 2 < s->n; k++) {
    double r;
    size_t m = s->n - k - 1;
    for (size_t i = 0; i < m; i++) v[i] = at(s, k + 1 + i, k);
    double beta = reflector(m, v, &r);
    if (beta == 0) continue;
    reflect_rows(s, k + 1, m, v, beta, k + 1);
    reflect_columns(s->n, s->t, s->n, k + 1, m, v, beta);
    reflect_columns(s->n, s->z, s->n, k + 1, m, v, beta);
    row_of(s, k + 1)[k] = r;
    for (size_t i = 1; i < m; i++) row_of(s, k + 1 + i)[k] = 0;
  }
}

/* -- iteration on the rows first to last */

/* the first column of (T - x)(T - y) over the entry below the diagonal, x and y the shifts */
static void first_column(const schur *s, size_t first, size_t last, size_t sweep, double *v) {
  double a = at(s, last - 1, last - 1), d = at(s, last, last), sum = a + d,
         product = a * d - at(s, last - 1, last) * at(s, last, last - 1);
  if (sweep % EXCEPTIONAL == 0) {
    double w = fabs(at(s, last, last - 1)) + fabs(at(s, last - 1, last - 2));
    sum = 1.5 * w, product = w * w;
  }
  double x = at(s, first, first), below = at(s, first + 1, first);
  v[0] = (x * (x - sum) + product) / below + at(s, first, first + 1);
  v[1] = x + at(s, first + 1, first + 1) - sum;
  v[2] = at(s, first + 2, first + 1);
}

static void sweep_through(const schur *s, size_t first, size_t last, size_t sweep) {
  double v[3], r;
  first_column(s, first, last, sweep, v);
  for (size_t k = first; k < last; k++) {
    size_t m = last - k < 2 ? 2 : 3, rows = (k + 3 < last ? k + 3 : last) + 1;
    for (size_t i = 0; k > first && i < m; i++) v[i] = at(s, k + i, k - 1);
    double beta = reflector(m, v, &r);
    if (beta == 0) continue;
    reflect_rows(s, k, m, v, beta, k);
    reflect_columns(s->n, s->t, rows, k, m, v, beta);
    reflect_columns(s->n, s->z, s->n, k, m, v, beta);
    if (k == first) continue;
    row_of(s, k)[k - 1] = r;
    for (size_t i = 1; i < m; i++) row_of(s, k + i)[k - 1] = 0;
  }
}

static int is_small(const schur *s, size_t i, double norm) {
  double beside = fabs(at(s, i - 1, i - 1)) + fabs(at(s, i, i));
  return fabs(at(s, i, i - 1)) <= DBL_EPSILON * (beside > 0 ? beside : norm);
}

/* columns k, k + 1 of t and z by (c, s), rows of t as well */
static void rotate(const schur *s, size_t k, double cosine, double sine) {
  for (size_t j = 0; j < s->n; j++) {
    double x = at(s, k, j), y = at(s, k + 1, j);
    row_of(s, k)[j] = cosine * x + sine * y, row_of(s, k + 1)[j] = cosine * y - sine * x;
  }
  for (size_t i = 0; i < 2 * s->n; i++) {
    double *entry = (i < s->n ? row_of(s, i) : s->z + (i - s->n) * s->n) + k, x = entry[0], y = entry[1];
    entry[0] = cosine * x + sine * y, entry[1] = cosine * y - sine * x;
  }
}

/* Rows k, k + 1: real eigenvalues move to the diagonal, complex ones get two equal diagonal entries. */
static void settle_pair(const schur *s, size_t k) {
  double b = at(s, k, k + 1), c = at(s, k + 1, k), p = (at(s, k, k) - at(s, k + 1, k + 1)) / 2, q = p * p + b * c;
  if (q >= 0) {
    double z = p + copysign(sqrt(q), p), length = hypot(z, c);
    if (length > 0) rotate(s, k, z / length, c / length);
    row_of(s, k + 1)[k] = 0;
    return;
  }
  double half_angle = b + c == 0 ? copysign(atan(1), -p) : atan(-2 * p / (b + c)) / 2;
  if (p != 0) rotate(s, k, cos(half_angle), sin(half_angle));
  row_of(s, k)[k] = row_of(s, k + 1)[k + 1] = (at(s, k, k) + at(s, k + 1, k + 1)) / 2;
  if (!(at(s, k, k + 1) * at(s, k + 1, k) < 0)) row_of(s, k + 1)[k] = 0;
}

static int iterate(const schur *s, double norm) {
  size_t last = s->n - 1, sweep = 0;
  while (last > 0 && last < s->n) {
    size_t first = last;
    while (first > 0 && !is_small(s, first, norm)) first--;
    if (first > 0) row_of(s, first)[first - 1] = 0;
    if (first + 1 < last) {
      if (sweep++ == SWEEPS) return 0;
      sweep_through(s, first, last, sweep);
      continue;
    }
    if (first + 1 == last) settle_pair(s, first);
    if (first == 0) return 1;
    last = first - 1, sweep = 0;
  }
  return 1;
}

static double largest_of(size_t count, const double *x) {
  double largest = 0;
  for (size_t i = 0; i < count; i++) largest = fmax(largest, fabs(x[i]));
  return largest;
}

int real_schur(size_t n, double *a, double *z, double *work) {
  const schur s = { n, a, z };
  int exponent;
  for (size_t i = 0; i < n * n; i++) z[i] = i % (n + 1) == 0;
  double largest = largest_of(n * n, a);
  if (n == 0 || largest == 0) return 1;
  frexp(largest, &exponent); /* products of entries neither overflow nor vanish */
  for (size_t i = 0; i < n * n; i++) a[i] = ldexp(a[i], -exponent);
  to_hessenberg(&s, work);
  int found = iterate(&s, 1);
  for (size_t i = 0; i < n * n; i++) a[i] = ldexp(a[i], exponent);
  return found;
}
