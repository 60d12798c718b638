/* linear.h -- unverified linear algebra on small dense matrices, by rows: what it returns may be anything without harm,
** proofs only use it as a guess. Round-to-nearest. */
#ifndef STIFF_LINEAR_H
#define STIFF_LINEAR_H
#include <stddef.h>
#include <stdint.h>

#define N_MAX 64 /* states and parameters: matrices have their place on the stack, about 3 MB in all */

typedef double square[N_MAX * N_MAX]; /* any matrix of at most N_MAX rows and columns; the pitch is what is stated */

int matrix_inverse(size_t n, const double *A, double *inverse);
/* r [rows x cols] := a [rows x inner] b [inner x cols] */
void matrix_multiply(size_t rows, size_t inner, size_t cols, const double *a, const double *b, double *r);
/* r += x a, `count` entries */
static inline void matrix_add_scaled(size_t count, double *r, double x, const double *a) {
  /* NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult) */
  for (size_t i = 0; i < count; i++) r[i] += x * a[i];
}
/* the spectral radius of |A|, to a factor n^(1/64): by the trace of its power 64, which no change of units changes; A
** is destroyed */
double matrix_radius(size_t n, double *A);
double matrix_row_sum_norm(size_t rows, size_t cols, const double *a);

/* Columns i of A [n x m] become orthonormal in the scaled product sum_i x_i y_i / scale_i^2, in order; R [m x m], if
** not
** NULL, is what they are multiplied with to get A back. 0: dependent. */
int orthonormalise(size_t n, size_t m, double *A, const double *scale, double *R);
/* ||A|| ||A^-1|| in the Frobenius norm, rows divided by `scale` and columns normalised; infinite if singular */
double scaled_condition(size_t n, const double *A, const double *scale);
/* r [n x (ma + mb)] := [a b] */
void join_columns(size_t n, size_t ma, const double *a, size_t mb, const double *b, double *r);
#endif
