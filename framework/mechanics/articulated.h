/* articulated.h -- accelerations by the articulated-body method: the work grows linearly with the number of parts
** (Featherstone 2008, ch. 7), whatever the elements are.
**
** What it needs: a tree. Elements with one IN and one OUT frame carry motion on; the wrench at a frame is affine in the
** acceleration of that frame once the joints beyond have been solved for. Joints that follow others, and forces that
** depend on accelerations elsewhere, are refused: the mass matrix takes them.
*/
#ifndef AMBIT_ARTICULATED_H
#define AMBIT_ARTICULATED_H
#include "mechanics/balance.h"

/* du[n] of the variables; applied [n]: generalised forces along the speeds, or NULL. INVALID: the mechanism is no such
** tree, or a mass is missing (named). */
ambit_status ambit_articulated_accelerations(
    ambit_mechanism *m, const ambit_variables *v, const ambit_expr *applied, ambit_expr *du, ambit_failure *f);
#endif
