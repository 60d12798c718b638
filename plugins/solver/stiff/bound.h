/* bound.h -- verified bounds for small matrices, in upward mode. Matrices of bounds are entrywise and nonnegative. */
#ifndef STIFF_BOUND_H
#define STIFF_BOUND_H
#include "interval.h"
#include "linear.h"

/* X >= K + K^2 + K^3 + ... for K >= 0; 0: not found, as if the sum had none */
int bound_neumann(size_t n, const double *K, double *X);
/* r [rows x cols] := bounds of a b, both nonnegative */
void bound_multiply(size_t rows, size_t inner, size_t cols, const double *a, const double *b, double *r);
/* r [n x m] >= |A^-1 X| for an approximate inverse C of A [n x n] and X [n x m]; 0: C is not good enough */
int bound_solution(size_t n, const double *C, const iv *A, size_t m, const iv *X, double *r);
/* r[k] >= 2-norm of the x_i with block[i] = k */
void bound_blocks(size_t n, const uint32_t *block, size_t blocks, const double *x, double *r);
#endif
