/* pivot.h -- what is wrong with the mass felt along a speed, and how to say so. */
#ifndef AMBIT_PIVOT_H
#define AMBIT_PIVOT_H
#include <ambit/mechanism.h>

/* INVALID if a pivot is negative, or vanishes everywhere: its enclosures at random points all contain 0 (or say
** nothing), but for an event of probability 0 or a matrix too ill-conditioned to be solved. The first such one is
** named. scale[n]: what each pivot is a difference of; an enclosure that is not narrow against it counts as one without
** 0, because it only tells that rounding has piled up (long chains). */
ambit_status ambit_pivots_check(ambit_graph *g, size_t n, const ambit_speed *speed, const ambit_expr *pivot,
    const ambit_expr *scale, ambit_failure *f);
/* INVALID: this speed moves nothing that has mass */
ambit_status ambit_pivot_massless(const ambit_speed *speed, ambit_failure *f);
/* Number of the first of e[n] that is certainly not 0 at some random point; n: none */
size_t ambit_pivot_first_nonzero(ambit_graph *g, size_t n, const ambit_expr *e);
#endif
