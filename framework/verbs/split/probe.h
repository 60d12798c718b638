/* probe.h -- a cheap look at what a solution does: an ordinary, non-validated run in doubles. It proves nothing; it
** serves to choose (which data to cut, which solver to suggest), so that being wrong costs time, never soundness.
**
** The method follows stiff solutions as easily as others: the modified Rosenbrock pair of orders 2 and 3, L-stable,
** with a Jacobian of differences (Shampine & Reichelt, The MATLAB ODE suite, SIAM J. Sci. Comput. 18, 1997, ode23s).
** The fastest motion of the linearised equations comes from a few power iterations: v, Jv, J^2 v near the dominant
** invariant subspace satisfy J^2 v = a Jv + b v, and the roots of s^2 = a s + b are its one or two eigenvalues.
** Deterministic; the work is bounded by a number of instructions, not by a clock.
*/
#ifndef AMBIT_PROBE_H
#define AMBIT_PROBE_H
#include <ambit/arena.h>
#include <ambit/solver.h>
#include <stdbool.h>

/* A state below this share of the largest one is rounding, whatever the units of both. */
#define AMBIT_PROBE_NOISE 0x1p-80

typedef struct ambit_probe_facts {
  uint32_t steps;
  double reached; /* s; as far as the work allowed */
  double decay; /* integral of -Re of the fastest decaying eigenvalue over time: how many e-folds of the fastest mode */
  double swing; /* integral of |Im| of the dominant eigenvalue, rad */
} ambit_probe_facts;

typedef struct ambit_probe ambit_probe;

/* For a problem with a right-hand side; NULL: out of memory */
ambit_probe *ambit_probe_make(const ambit_problem *p, ambit_arena *arena);
/* From the first instant: x [nx], parameter [np]; work: instructions of the right-hand side that may be executed;
** repeats: with the steps of the last run that chose its own, so that what differs comes from the data alone. */
void ambit_probe_start(ambit_probe *probe, const double *x, const double *parameter, uint64_t work, bool repeats);
/* Goes on to t; false: it could not (work used up, equations not defined, values not finite). */
bool ambit_probe_advance(ambit_probe *probe, double t);
const double *ambit_probe_state(const ambit_probe *probe); /* [nx] */
const double *ambit_probe_size(const ambit_probe *probe);  /* [nx] largest magnitude of each state so far */
/* How many ABS, MIN and MAX the right-hand side has. */
uint32_t ambit_probe_kinks(const ambit_probe *probe);
/* The first ABS, MIN or MAX of the right-hand side that runs of this probe met on both sides; UINT32_MAX: none. */
uint32_t ambit_probe_kink(const ambit_probe *probe);
ambit_probe_facts ambit_probe_tell(const ambit_probe *probe);

/* influence[j] >= 0 of each unknown: how far apart its least and its greatest value put the solution, each state in
** parts of its own size, at the worst instant of the problem; all other data in the middle. NOMEM or OK. */
ambit_status ambit_probe_influence(
    const ambit_problem *p, const ambit_tape *initial, ambit_arena *arena, double *influence);
#endif
