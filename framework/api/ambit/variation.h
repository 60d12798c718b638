/* variation.h -- a system with its variational equations: how the states depend on where they start and on the data.
**
** For x' = f(x, p, t), x(t0) = x0, the derivatives S = dx/dq by a quantity q obey S' = (df/dx) S + df/dq with
** S(t0) = dx0/dq (Hartman, Ordinary Differential Equations, theorem V.3.1: f continuously differentiable). The
** entries of S that are not identically zero become further states behind those of the system; any solver then
** encloses them together with x. docs/numerics/sensitivity.md.
*/
#ifndef AMBIT_VARIATION_H
#define AMBIT_VARIATION_H
#include <ambit/arena.h>
#include <ambit/system.h>

#ifdef __cplusplus
extern "C" {
#endif

#define AMBIT_VARIATION_ZERO UINT32_MAX

/* A quantity to differentiate by. */
typedef struct ambit_variation_by {
  const char *name;    /* "beta1", "k": the new states are called "d x/d k" */
  const char *unit;    /* of the quantity; NULL: not known, taken as 1 */
  uint32_t initial_of; /* the initial value of this state, the data being fixed; or AMBIT_VARIATION_ZERO: */
  ambit_expr datum;    /* an expression q of one unknown u with a constant dq/du that is not zero: an uncertain */
                       /* datum as it was written. Derivatives are those by u, divided by dq/du. */
} ambit_variation_by;

typedef struct ambit_variation_request {
  const ambit_system *system;
  const ambit_expr *initial; /* [nx] over unknowns */
  size_t nby;
  const ambit_variation_by *by;
} ambit_variation_request;

typedef struct ambit_variation {
  ambit_system system;       /* [nx + further states]; invariants as before */
  const ambit_expr *initial; /* [system.nx] */
  const uint32_t *place;     /* [nx x nby] by rows: number of the state dx_i/dq_j, or AMBIT_VARIATION_ZERO */
} ambit_variation;

/* All in the arena. INVALID, and f says what is wrong: a right-hand side or an initial value without a derivative, a
** datum that is not one, or a quantity that moves the start off an invariant (closed loops): a derivative of the states
** along the manifold is then not determined by the initial values. */
AMBIT_EXPORT ambit_status ambit_variation_build(
    const ambit_variation_request *q, ambit_arena *arena, ambit_variation *v, ambit_failure *f);

#ifdef __cplusplus
}
#endif
#endif
