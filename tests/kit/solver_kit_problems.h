/* solver_kit_problems.h -- problems with closed solutions, as expressions and as enclosures of the truth. */
#ifndef AMBIT_SOLVER_KIT_PROBLEMS_H
#define AMBIT_SOLVER_KIT_PROBLEMS_H
#include "verbs/simulate/problem.h"

#define KIT_STATES 12
#define KIT_TIMES 8
#define KIT_DATA 3

/* A system in implicit form: na unknowns in nstage stages. */
typedef struct kit_form {
  ambit_system_source source; /* first */
  size_t na, nstage;
  ambit_expr unknown[KIT_STATES], rate[KIT_STATES], residual[KIT_STATES];
  uint32_t stage_end[2], pivot[KIT_STATES];
} kit_form;

typedef struct kit_model {
  ambit_graph *graph;
  size_t nx;
  const char *name[KIT_STATES], *unit[KIT_STATES];
  ambit_expr state[KIT_STATES], rate[KIT_STATES], initial[KIT_STATES];
  size_t ninvariant;
  ambit_expr invariant[KIT_STATES];
  const char *invariant_name[KIT_STATES];
  size_t ndatum;
  ambit_expr datum[KIT_DATA];
  kit_form form; /* of random systems, solver_kit_implicit.h; na = 0: there is none */
  ambit_system system;
} kit_model;

typedef struct kit_problem {
  const char *name;
  void (*build)(kit_model *m);
  /* x[nx] encloses the solution at t that started with the uncertain datum at u, tightly */
  void (*truth)(double t, double u, ambit_interval *x);
  uint32_t nu; /* uncertain data */
  double u_lo[KIT_DATA], u_hi[KIT_DATA];
  double ends; /* no solution exists from here on; infinite: the run must be complete */
  size_t ntime;
  double time[KIT_TIMES];
  double widest; /* at the end, for a solver that wants the initial set as a tape; infinite: no matter */
  const struct kit_random_system *random; /* instead of build and truth: solver_kit_random.h */
} kit_problem;

extern const kit_problem kit_problems[];
extern const size_t kit_problem_count;

void kit_model_open(kit_model *m, const kit_problem *p);
void kit_model_close(kit_model *m);

/* x[nx] encloses the solution at t for the data u[nu], tightly */
void kit_truth(const kit_problem *p, double t, const double *u, ambit_interval *x);
/* The data of sample k; false: there is none. Corners come first, the middle last. */
bool kit_sample(const kit_problem *p, size_t k, double *u);
#endif
