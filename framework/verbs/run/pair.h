/* pair.h -- which arithmetic goes with which solver. */
#ifndef AMBIT_PAIR_H
#define AMBIT_PAIR_H
#include <ambit/registry.h>

#define AMBIT_NAME_MAX 64

/* What a plugin of the kind "solver" says of itself, whichever of its three interfaces is used. */
typedef struct ambit_method {
  const char *name;
  uint32_t want, needs_rigorous;
  const char *arithmetics;
  uint32_t (*want_for)(const double *option);
} ambit_method;
#define AMBIT_METHOD(name, s) ((ambit_method) { name, (s)->want, (s)->needs_rigorous, (s)->arithmetics, (s)->want_for })

/* INVALID: solver `name` has not this interface (AMBIT_SOLVER, AMBIT_ROOT_FINDER, AMBIT_STRATEGY) but another one; the
** failure says what it does, and lists the installed ones that would serve. */
ambit_status ambit_pair_offers(ambit_registry *r, const char *name, const char *interface, ambit_failure *f);

/* The arithmetic that will serve: `wanted`, or (NULL) the solver's default, its name written to `name`. A pair that
** does not fit is INVALID; the failure names both and lists what fits. */
ambit_status ambit_pair_choose(
    ambit_registry *r, ambit_method method, const char *wanted, char name[AMBIT_NAME_MAX], ambit_failure *f);

/* What it wants with these options: only that is built. */
static inline uint32_t ambit_pair_want(ambit_method m, const double *option) {
  return m.want_for ? m.want_for(option) : m.want;
}

/* Independent variables of the arithmetic's context for a solver that wants this. */
static inline uint32_t ambit_pair_variables(const ambit_problem *p, uint32_t want) {
  return (want & AMBIT_WANT_INITIAL ? p->nu : p->nx + p->np) + (want & AMBIT_WANT_TIME ? 1 : 0);
}
#endif
