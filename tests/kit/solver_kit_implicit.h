/* solver_kit_implicit.h -- the same random systems in implicit form, for solvers that ask for it.
**
** Unknowns are the derivatives of the states, a = x'. What is to be solved is triangular, r_i = x_i' - f_i(x, a_0 ..
** a_{i-1}) = 0, and is mixed: R_i = d_i r_i + R_{i+1} / 4 within a stage, d_i = 2 + sin(x_i). So dR/da is regular
** for all x, and eliminating from the last unknown to the first its pivots are d_i. Stage 2 has besides terms of the
** residuals of stage 1 that are not linear in its unknowns, and vanish.
*/
#ifndef AMBIT_SOLVER_KIT_IMPLICIT_H
#define AMBIT_SOLVER_KIT_IMPLICIT_H
#include "kit/solver_kit_problems.h"

/* A symbol for each unknown. */
void kit_form_open(kit_model *m, size_t nstage);
/* r[nx] in these symbols; f[nx], which F is to be where it is not a symbol: so for every second state. */
void kit_form_close(kit_model *m, const ambit_expr *r, const ambit_expr *f);
#endif
