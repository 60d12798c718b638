/* forward.h -- forward dynamics: the accelerations u' as functions of q, u, t and, on request, of a generalised force
** along each speed.
**
** Which form? Both are exact identities of the same function, so the shorter one is the better one: fewer operations to
** evaluate, and fewer to lose tightness in. For up to FEW joints the mass matrix was always shorter; beyond MANY the
** articulated-body form always is; between them both are written and counted (docs/numerics/dynamics.md has the
** table). Mechanisms that the articulated-body form does not fit get the mass matrix.
*/
#ifndef AMBIT_FORWARD_H
#define AMBIT_FORWARD_H
#include "mechanics/balance.h"

typedef struct ambit_forward {
  ambit_variables variables;
  uint32_t form;           /* AMBIT_FORM_*, never AUTO */
  const ambit_expr *du;    /* [n] */
  const ambit_expr *force; /* [n] symbols "tau_NAME", N m or N; NULL unless asked for */
} ambit_forward;

ambit_status ambit_forward_build(
    ambit_mechanism *m, uint32_t form, bool with_force, ambit_arena *arena, ambit_forward *forward, ambit_failure *f);
#endif
