/* equations.h -- equations made ready for evaluation: bindings put in, uncertain data found, tapes sealed. */
#ifndef AMBIT_EQUATIONS_H
#define AMBIT_EQUATIONS_H
#include <ambit/roots.h>

typedef struct ambit_ready {
  ambit_graph *graph;
  ambit_arena *arena;
  size_t ne, nx, np;
  ambit_expr *equation;    /* [ne] without those that are 0 = 0 */
  size_t *place;           /* [ne] their numbers in the request */
  ambit_expr *input;       /* [nx + np] unknowns, then the uncertain data that equations reach */
  const char *const *name; /* [nx + np] */
  ambit_interval *p;       /* [np] ranges */
} ambit_ready;

/* All in the arena. INVALID: an equation depends on a symbol that is neither unknown nor bound; named. */
ambit_status ambit_equations_prepare(const ambit_equations *q, ambit_arena *arena, ambit_ready *r, ambit_failure *f);
/* Tapes of f, and of its derivatives by inputs [first, first + n) by rows. */
ambit_status ambit_equations_seal(const ambit_ready *r, size_t ne, const ambit_expr *equation, uint32_t flags,
    const ambit_tape **tape, ambit_failure *f);
ambit_status ambit_equations_differentiate(const ambit_ready *r, size_t ne, const ambit_expr *equation, size_t first,
    size_t n, uint32_t flags, const ambit_tape **tape, ambit_failure *f);
/* Middles of the outputs at a point and at the middle of the data; false: not defined or not finite there. slot [nslot
** of the tape] is scratch. */
bool ambit_equations_at(
    const ambit_ready *r, const ambit_tape *tape, const double *x, ambit_interval *slot, double *out);
/* Are all equations defined, bounded and off their jumps and kinks wherever the unknowns are in the box? With data:
** also as functions of these, all over their ranges; else for each of their values. */
ambit_status ambit_equations_are_smooth(const ambit_equations *q, ambit_registry *registry, const ambit_interval *box,
    bool with_data, bool *smooth, ambit_failure *f);
#endif
