/* spectrum.h -- where the eigenvalues of every matrix of an interval matrix lie, and whether all lie on the left.
**
** Approximations come from outside (ambit/eigen.h) and are not believed. Proofs: docs/numerics/stability.md.
*/
#ifndef AMBIT_SPECTRUM_H
#define AMBIT_SPECTRUM_H
#include <ambit/arena.h>
#include <ambit/interval.h>
#include <stddef.h>
#include <stdint.h>

/* For every matrix of the set: entries with the same group number, `count` of them, hold together exactly `count`
** eigenvalues, with multiplicity; each of them lies in the (common) box of the group. */
typedef struct ambit_eigenvalue {
  ambit_interval re, im;
  uint32_t group, count;
} ambit_eigenvalue;

/* a [n x n] by rows, bounded. vector [n x n]: roughly, by columns, eigenvectors of its middle, the real and the
** imaginary part of one of a pair side by side; is_first[j]: column j is such a real part. *spread: sum of the boxes'
** widths.
** False: nothing is enclosed (vectors too dependent for a set so wide, or no memory). */
bool ambit_spectrum_enclose(size_t n, const ambit_interval *a, const double *vector, const bool *is_first,
    ambit_eigenvalue *value, double *spread, ambit_arena *arena);

/* Is every symmetric matrix of the set positive definite? false: not proved. */
bool ambit_is_positive_definite(size_t n, const ambit_interval *a, ambit_arena *arena);

/* Lyapunov's equation: p [n x n] roughly solves A'P + PA = -I, A the middle of a; symmetric. False: singular, no memory
** or n above AMBIT_LYAPUNOV_MAX. */
#define AMBIT_LYAPUNOV_MAX 24u
bool ambit_lyapunov_solve(size_t n, const ambit_interval *a, double *p, ambit_arena *arena);
/* Is A'P + PA negative definite for every A of the set? p symmetric. Then, for each A, as many eigenvalues have
** negative real parts as P has positive eigenvalues, and the others positive ones (Ostrowski & Schneider 1962). */
bool ambit_lyapunov_holds(size_t n, const ambit_interval *a, const double *p, ambit_arena *arena);
/* Is v'Pv < 0? */
bool ambit_is_negative_along(size_t n, const double *p, const double *v);
#endif
