/* unknowns.h -- the uncertain data that expressions reach: only these become variables of an arithmetic or a solver. */
#ifndef AMBIT_UNKNOWNS_H
#define AMBIT_UNKNOWNS_H
#include <ambit/graph.h>

/* The leaves of e[0..ne) in the arena, in the order in which they were made. */
ambit_status ambit_unknowns_leaves(const ambit_graph *g, ambit_arena *arena, size_t ne, const ambit_expr *e, size_t *n,
    ambit_expr **leaf, ambit_failure *f);
/* An unknown whose range is one number is that number: replaced in place, so that no arithmetic carries it. */
ambit_status ambit_unknowns_fold_points(ambit_graph *g, ambit_arena *arena, size_t ne, ambit_expr *e, ambit_failure *f);
/* "`beta1`, `beta2` and 3 more": the leaves of that list which are not UNKNOWN or VARYING and not among `allowed`;
** returns how many. */
size_t ambit_unknowns_name_others(const ambit_graph *g, size_t n, const ambit_expr *leaf, size_t nallowed,
    const ambit_expr *allowed, char *out, size_t room);
#endif
