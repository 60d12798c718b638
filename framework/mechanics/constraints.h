/* constraints.h -- what closes the loops of a mechanism: the residuals g(q, t) of all constraint ports, and their
** velocity form dg/dt = G(q, t) u + c(q, t).
**
** With q' = rate(q, u), linear in u: dg/dt = sum of dg/dq_j rate_j + dg/dt at fixed q; G = d(dg/dt)/du, c the rest
** (nonzero only where given motions depend on time). Everything is symbolic: G is exact.
*/
#ifndef AMBIT_CONSTRAINTS_H
#define AMBIT_CONSTRAINTS_H
#include <ambit/mechanism.h>

typedef struct ambit_constraint {
  const char *loop;     /* the element */
  const char *name;     /* "close", or "close.2" if the element has several rows */
  uint32_t part, index; /* row `index` of the part, counted through its constraint ports: as ambit_multiplier */
  ambit_expr g;
} ambit_constraint;

typedef struct ambit_constraints {
  ambit_mechanism *mechanism;
  size_t nq, nu;
  const ambit_coordinate *coordinate; /* [nq] */
  const ambit_speed *speed;           /* [nu] */
  /* row[0 .. n): they restrict the speeds; then npure whose time derivative vanishes identically (the norm of a
  ** quaternion); then ntrivial that are 0 = 0 (what leaves the plane of a planar mechanism) */
  size_t n, npure, ntrivial;
  const ambit_constraint *row;
  const ambit_expr *slope;    /* [(n + npure) * nq] dg/dq by rows */
  const ambit_expr *rate;     /* [n] dg/dt */
  const ambit_expr *velocity; /* [n * nu] G by rows */
  const ambit_expr *drive;    /* [n] c */
} ambit_constraints;

/* Has the mechanism any element with a constraint port? Costs nothing. */
bool ambit_constraints_exist(const ambit_mechanism *m);
/* INVALID: a row that can never vanish, or that only some values of the data fulfil, or that depends on speeds; named.
*/
ambit_status ambit_constraints_build(ambit_mechanism *m, ambit_arena *arena, ambit_constraints *c, ambit_failure *f);
#endif
