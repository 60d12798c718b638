/* solver_kit_random.h -- random systems with closed solutions, of 1 to 12 states.
**
** y solves equations that can be solved by hand, each alone or in a pair; x = y + phi(x) with a triangular phi is what
** the solver sees: all states depend on each other, and the solution stays closed. Data enter the start and the rates;
** some systems depend on time; half of them run backwards.
*/
#ifndef AMBIT_SOLVER_KIT_RANDOM_H
#define AMBIT_SOLVER_KIT_RANDOM_H
#include "kit/solver_kit_problems.h"

typedef struct kit_block { /* of one state */
  uint32_t kind, couple, a, b;
  double start, rate, weight;
  int32_t start_datum, rate_datum; /* -1: none */
} kit_block;

typedef struct kit_random_system {
  size_t nx, stages; /* stages: of its implicit form; 0: it has none */
  double t0;
  kit_block block[KIT_STATES];
  kit_problem problem;
  char name[64];
} kit_random_system;

/* system number `item` of a seed: its size and direction follow from the number */
void kit_random_make(kit_random_system *r, uint64_t seed, size_t item);
void kit_random_build(kit_model *m, const kit_random_system *r);
void kit_random_truth(const kit_random_system *r, double t, const double *u, ambit_interval *x);
#endif
