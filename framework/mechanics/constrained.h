/* constrained.h -- equations of motion of a mechanism with constraints, without multipliers among the states.
**
** M(q) u' = h(q, u, t) + G^T lambda with g = 0. With u = N u_i + b, u' = N u_i' + a (loop_motion.h) and N^T G^T = 0:
**   (N^T M N) u_i' = N^T (h - M a)
** States are all coordinates and the independent speeds, q' = rate(q, N u_i + b): position is integrated as a whole, so
** g stays 0 along every solution that starts there, and g is handed on as invariants. Afterwards
** G_d^T lambda = (M u' - h)_d; multipliers of redundant rows are not determined and count as 0.
** [Wehage & Haug 1982; why this has the solutions of the original as long as G_d is regular: docs/numerics/loops.md]
*/
#ifndef AMBIT_CONSTRAINED_H
#define AMBIT_CONSTRAINED_H
#include "mechanics/balance.h"
#include "mechanics/loops.h"

/* ambit_constrained_system without right-hand sides, which are written when they are asked for: what is wrong with
** them is said then. */
ambit_status ambit_constrained_outline(
    ambit_mechanism *m, uint32_t form, ambit_arena *arena, ambit_system *system, ambit_failure *f);
/* They alone, (*rate)[nx]; loops: those of the outline, or NULL */
ambit_status ambit_constrained_rates(ambit_mechanism *m, const ambit_loops *loops, uint32_t form, ambit_arena *arena,
    const ambit_expr **rate, ambit_failure *f);

/* Everything that the states determine, in terms of the states. */
typedef struct ambit_constrained {
  ambit_loops loops;
  const ambit_expr *speed;      /* [nu] u */
  const ambit_expr *du;         /* [nu] u' */
  const ambit_expr *multiplier; /* [n] lambda by rows of loops.constraints; 0 for redundant ones */
} ambit_constrained;
ambit_status ambit_constrained_build(ambit_mechanism *m, ambit_arena *arena, ambit_constrained *c, ambit_failure *f);
/* e[ne] with dependent speeds, accelerations and multipliers replaced by what they are in terms of the states, in place
*/
ambit_status ambit_constrained_express(
    const ambit_constrained *c, ambit_arena *arena, size_t ne, ambit_expr *e, ambit_failure *f);
#endif
