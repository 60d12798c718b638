/* solver_kit_problems.h -- problems with closed solutions, as expressions and as enclosures of the truth. */
#ifndef AMBIT_SOLVER_KIT_PROBLEMS_H
#define AMBIT_SOLVER_KIT_PROBLEMS_H
#include "model/problem.h"

#define KIT_STATES 4
#define KIT_TIMES 8

typedef struct kit_model {
  ambit_graph *graph;
  size_t nx;
  const char *name[KIT_STATES], *unit[KIT_STATES];
  ambit_expr state[KIT_STATES], rate[KIT_STATES], initial[KIT_STATES];
  size_t ninvariant;
  ambit_expr invariant[KIT_STATES];
  const char *invariant_name[KIT_STATES];
  ambit_system system;
} kit_model;

typedef struct kit_problem {
  const char *name;
  void (*build)(kit_model *m);
  /* x[nx] encloses the solution at t that started with the uncertain datum at u, tightly */
  void (*truth)(double t, double u, ambit_interval *x);
  double u_lo, u_hi; /* of the one uncertain datum; equal: there is none */
  double ends;       /* no solution exists from here on; infinite: the run must be complete */
  size_t ntime;
  double time[KIT_TIMES];
  double widest; /* at the end, for a solver that wants the initial set as a tape; infinite: no matter */
} kit_problem;

extern const kit_problem kit_problems[];
extern const size_t kit_problem_count;

void kit_model_open(kit_model *m, const kit_problem *p);
void kit_model_close(kit_model *m);
#endif
