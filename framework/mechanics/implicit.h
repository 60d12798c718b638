/* implicit.h -- equations of motion as they are written by the elements, without solving for accelerations.
**
** An open chain: unknowns u', equations r(q, u, u', t) = 0 (balance.h), which is the recursive Newton-Euler method: as
** long as the chain, and nothing is divided. With closed loops, in the states of constrained.h:
**   stage 1: the dependent speeds, by the kept rows of dg/dt = G u + c = 0;
**   stage 2: all u', then the multipliers of the kept rows, by the balances and d(G u + c)/dt = 0.
** Multipliers of other rows count as 0, as in constrained.h. docs/numerics/dynamics.md
*/
#ifndef AMBIT_MECHANISM_IMPLICIT_H
#define AMBIT_MECHANISM_IMPLICIT_H
#include <ambit/system.h>
#include "mechanics/loops.h"

/* Lets `system`, the equations of motion of m, be written in implicit form later, and its right-hand sides if it has
** none yet, as long as no part has been added by then. loops: of a mechanism with closed loops, in the arena of the
** system; else NULL. form: AMBIT_FORM_*. The mechanism must outlive the system. */
ambit_status ambit_implicit_offer(ambit_mechanism *m, const ambit_loops *loops, uint32_t form, ambit_arena *arena,
    ambit_system *system, ambit_failure *f);
#endif
