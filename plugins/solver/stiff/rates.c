/* rates.c -- how fast errors can grow on a piece: bounds of A(s) = U^-1 ((eta/2) J U - U') over s and the tube, and
** the Metzler matrix that they make for blocks of components of z = G^-1 U^-1 e. In upward mode.
**
** C ((eta/2) J U - U') is formed coefficient by coefficient before magnitudes are taken: for the slow columns, which
** move with the variational equation, nearly nothing is left of it.
*/
#include "stiff.h"
#include <string.h>

/* Q := coefficient l of (eta/2) J U - U', J without its remainder */
static void coefficient(const stiff *s, uint32_t l, iv *Q) {
  const frame *r = &s->frame;
  uint32_t n = s->n;
  for (uint32_t i = 0; i < n * n; i++) {
    double x = l < r->order ? r->U[l + 1][i] : 0;
    Q[i] = (iv) { (l + 1) * x, (l + 1) * -x };
  }
  for (uint32_t i = 0; i < s->nx; i++)
    for (uint32_t b = 0; b < n; b++) {
      const double *J = s->slopes.coefficient + (size_t)(i * n + b) * (SLOPE_ORDER + 1);
      for (uint32_t a = 0; a < s->slopes.count[i * n + b] && a <= l; a++) {
        if (J[a] == 0 || l - a > r->order) continue;
        const double *U = r->U[l - a] + b * n;
        for (uint32_t k = 0; k < n; k++) {
          Q[i * n + k].high += J[a] * U[k]; /* NOLINT(clang-analyzer-core.uninitialized.Assign) */
          Q[i * n + k].low += (-J[a]) * U[k];
        }
      }
    }
}

/* r := C Q */
static void through(const double *C, const iv *Q, uint32_t n, iv *r) {
  memset(r, 0, (size_t)n * n * sizeof *r);
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t b = 0; b < n; b++) iv_add_scaled(n, r + i * n, Q + b * n, C[i * n + b]);
}

void rates_bound(const stiff *s, matrix_bounds *r) {
  const frame *f = &s->frame;
  uint32_t n = s->n, top = f->order + SLOPE_ORDER;
  iv Q[N_MAX * N_MAX], Y[N_MAX * N_MAX];
  square size, rest, T;
  memset(T, 0, (size_t)n * n * sizeof *T);
  memcpy(T, s->slopes.tail, (size_t)s->nx * n * sizeof *T);
  bound_multiply(n, n, n, T, f->size, rest);
  for (uint32_t i = 0; i < n * n; i++) T[i] = fabs(f->C[i]);
  bound_multiply(n, n, n, T, rest, r->radius);
  for (uint32_t l = 0; l <= top; l++) {
    coefficient(s, l, Q);
    through(f->C, Q, n, l ? Y : r->middle);
    for (uint32_t i = 0; l && i < n * n; i++) r->radius[i] += iv_mag(Y[i]);
  }
  for (uint32_t i = 0; i < n * n; i++) size[i] = iv_mag(r->middle[i]) + r->radius[i];
  bound_multiply(n, n, n, f->E, size, rest);
  for (uint32_t i = 0; i < n * n; i++) {
    r->radius[i] += rest[i];
  }
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t k = 0; k < n && f->still[i]; k++) r->middle[i * n + k] = (iv) { 0, 0 }, r->radius[i * n + k] = 0;
}

/* -- blocks */

/* In z the rows and columns of slow components are G^-1 A G there, by magnitudes; a single slow one is multiplied and
** divided by the same number. */
static void to_z(const stiff *s, const matrix_bounds *r, double *size, double *upper) {
  const frame *f = &s->frame;
  uint32_t n = s->n, g = f->split.slow;
  square left, z;
  for (uint32_t i = 0; i < n * n; i++) {
    size[i] = iv_mag(r->middle[i]) + r->radius[i];
    upper[i] = r->middle[i].high + r->radius[i];
  }
  if (g == 0) return;
  bound_multiply(n, n, n, f->Gi_size, size, left);
  bound_multiply(n, n, n, left, f->G_size, z);
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t k = 0; k < n; k++) {
      int fast = i >= g && k >= g, single = g == 1 && i == 0 && k == 0;
      if (!fast && !single) size[i * n + k] = upper[i * n + k] = z[i * n + k];
    }
}

/* the logarithmic 2-norm of a block is at most the largest eigenvalue of its symmetric part: Gershgorin */
static double growth(const stiff *s, const matrix_bounds *r, const double *upper, uint32_t block) {
  uint32_t n = s->n;
  const uint32_t *of = s->frame.split.block;
  double most = -INFINITY;
  for (uint32_t i = 0; i < n; i++) {
    if (of[i] != block) continue;
    double sum = upper[i * n + i];
    for (uint32_t k = 0; k < n; k++)
      if (k != i && of[k] == block)
        sum += 0.5 * (iv_mag(iv_add(r->middle[i * n + k], r->middle[k * n + i])) + r->radius[i * n + k] +
                         r->radius[k * n + i]);
    most = larger(most, sum);
  }
  return most;
}

void rates_in_blocks(const stiff *s, const matrix_bounds *r, double *M) {
  const split *p = &s->frame.split;
  uint32_t n = s->n, m = p->blocks, count[N_MAX] = { 0 };
  square size, upper, squares, only;
  to_z(s, r, size, upper);
  memset(squares, 0, (size_t)m * m * sizeof *squares);
  for (uint32_t i = 0; i < n; i++) count[p->block[i]]++;
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t k = 0; k < n; k++) {
      uint32_t at = p->block[i] * m + p->block[k];
      /* NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult) */
      squares[at] += size[i * n + k] * size[i * n + k];
      only[at] = size[i * n + k];
    }
  for (uint32_t a = 0; a < m; a++)
    for (uint32_t b = 0; b < m; b++) {
      if (a == b)
        M[a * m + b] = growth(s, r, upper, a);
      else
        /* NOLINTNEXTLINE(clang-analyzer-core.uninitialized.Assign) */
        M[a * m + b] = count[a] * count[b] == 1 ? only[a * m + b] : sqrt(squares[a * m + b]);
    }
}
