/* elementary.h -- rigorous elementary functions over arrays of intervals, once for the whole of Ambit.
**
** Recipe: table-driven double-double kernels with proved relative error bounds (docs/numerics/elementary.md), outward
** steps on integer bits; at most 1 ulp wider than the tightest doubles on each side, exact where the value is a double.
** Angles outside the fast range go to the slow path, a library loaded by the host at the first such argument
** (ambit_elementary_set_slow); without it, sound but coarse bounds are used. Any rounding mode on entry, also with
** flush-to-zero. Empty in, empty out. Parts outside the domain are dropped; the caller sets PARTIAL flags.
*/
#ifndef AMBIT_ELEMENTARY_H
#define AMBIT_ELEMENTARY_H
#include <ambit/interval.h>

/* r[i] encloses op(a[i]) (ATAN2: op(a[i], b[i])) for op in EXP LOG SIN COS TAN ASIN ACOS ATAN ATAN2 SINH COSH TANH;
** structure of arrays. */
void ambit_elementary(uint32_t op, size_t n, const double *alo, const double *ahi, const double *blo, const double *bhi,
    double *rlo, double *rhi);

/* The slow path: bounds of op at the finite point (x, y) of its domain, tightest doubles (lo == hi if exact); the
** member `point` of ambit_elementary_service (<ambit/elementary.h>) is one. Called in round-to-nearest, from any
** thread. */
typedef void (*ambit_elementary_point)(uint32_t op, double x, double y, double *lo, double *hi);
/* [any] Atomic; NULL: back to ambit_elementary_coarse, the slow path as long as none is set. A host sets a function
** that loads the service at its first call, sets the service's `point` in its place (or ambit_elementary_coarse if
** there is none) and calls it. */
void ambit_elementary_set_slow(ambit_elementary_point point);
/* The range of the function on its whole domain: sound at every point, and good for nothing else. */
void ambit_elementary_coarse(uint32_t op, double x, double y, double *lo, double *hi);
#endif
