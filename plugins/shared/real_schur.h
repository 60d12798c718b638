/* real_schur.h -- eigenvalues and eigenvectors of a real matrix, approximately: whoever proves something with them
** encloses the truth around them. Matrices are stored by rows and finite. Nothing is allocated.
*/
#ifndef AMBIT_REAL_SCHUR_H
#define AMBIT_REAL_SCHUR_H
#include <stddef.h>

/* Real Schur form (Golub & Van Loan, Matrix Computations, 7.4 to 7.6): turns a [n x n] into T = Z'AZ with z [n x n]
** orthogonal. T is zero below the diagonal but for blocks of two rows, which have conjugate complex eigenvalues and two
** equal diagonal entries. work [n]. 0: the iteration did not converge. */
int real_schur(size_t n, double *a, double *z, double *work);

/* Eigenvalues and eigenvectors from a Schur form t, z [n x n]. Value j is re[j] + i im[j]; of a conjugate pair the one
** with im > 0 comes first. Column j of vector [n x n] is the eigenvector of a real value; columns j, j + 1 are the real
** and the imaginary part of that of the first of a pair. The largest component of a vector is 1. work [2 n]. */
void real_schur_vectors(
    size_t n, const double *t, const double *z, double *re, double *im, double *vector, double *work);

/* Makes norms of rows and columns of a [n x n] alike by powers of 2 (Parlett & Reinsch 1969): a becomes D^-1 A D,
** scale [n] the diagonal of D. */
void balance_matrix(size_t n, double *a, double *scale);
#endif
