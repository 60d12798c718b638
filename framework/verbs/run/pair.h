/* pair.h -- which arithmetic goes with which solver. */
#ifndef AMBIT_PAIR_H
#define AMBIT_PAIR_H
#include <ambit/registry.h>

#define AMBIT_NAME_MAX 64

/* The arithmetic that will serve: `wanted`, or (NULL) the solver's default, its name written to `name`. A pair that
** does not fit is INVALID; the failure names both and lists what fits. */
ambit_status ambit_pair_choose(ambit_registry *r, const char *solver_name, const ambit_solver *solver,
    const char *wanted, char name[AMBIT_NAME_MAX], ambit_failure *f);

/* AMBIT_WANT_* of this solver with these options: only that is built. */
static inline uint32_t ambit_pair_want(const ambit_solver *solver, const double *option) {
  return solver->want_for ? solver->want_for(option) : solver->want;
}

/* Independent variables of the arithmetic's context for a solver that wants this. */
static inline uint32_t ambit_pair_variables(const ambit_problem *p, uint32_t want) {
  return (want & AMBIT_WANT_INITIAL ? p->nu : p->nx + p->np) + (want & AMBIT_WANT_TIME ? 1 : 0);
}
#endif
