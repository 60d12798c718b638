/* suggest.h -- facts about a run that has not been made, by which a solver is chosen
** (framework/verbs/simulate/suggest.lua, docs/choosing.md). They cost far less than the run: a tape of the right-hand
** side and three short ordinary runs (probe.h), for the middle of the uncertain data and for the corners in which all
** are least or greatest.
*/
#ifndef AMBIT_SUGGEST_H
#define AMBIT_SUGGEST_H
#include <ambit/simulate.h>

typedef struct ambit_suggest_facts {
  uint32_t states, parameters, unknowns, invariants, kinks; /* kinks: operations that are not smooth, crossed or not */
  uint32_t varying;                                         /* parameters that are functions of time */
  double horizon;                                           /* s, of the whole run */
  double seen;                                              /* share of it that the ordinary run covered, 0..1 */
  double width;  /* of the data: the widest of the initial states in parts of the state's size along the run, and of the
                  ** parameters in parts of their magnitude */
  double spread; /* how far apart the corners end up, each state in parts of its size: the worst over the run */
  double bend;   /* how far the middle is from half way between them, likewise: what a linear map cannot follow */
  double decay;  /* e-folds of the fastest decaying motion over the run seen */
  double swing;  /* rad of the fastest oscillation over the run seen */
  uint32_t steps; /* of the ordinary run, whose steps follow the solution, not the fastest decay */
  char kink[160]; /* the first operation of whose kink the runs saw both sides, or "" */
} ambit_suggest_facts;

/* system, initial, time and the narrow ranges of the request; nothing else of it is looked at. INVALID: as
** ambit_problem_build. */
ambit_status ambit_suggest_look(const ambit_simulate_request *q, ambit_suggest_facts *facts, ambit_failure *f);
#endif
