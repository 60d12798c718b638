/* sample_draws.h -- single draws through a solver plugin, one after the other, on the threads of a pool. The tapes are
** built once; only the data change.
*/
#ifndef AMBIT_SAMPLE_DRAWS_H
#define AMBIT_SAMPLE_DRAWS_H
#include <ambit/simulate.h>
#include <stdbool.h>

typedef struct ambit_draws ambit_draws;

typedef struct ambit_draws_request {
  const ambit_simulate_request *q; /* its solver and options unless these are given */
  const char *solver;
  size_t noption;
  const ambit_option *option;
  uint32_t threads;
} ambit_draws_request;

/* INVALID: the solver does not fit, or its options do not. */
ambit_status ambit_draws_open(const ambit_draws_request *request, ambit_draws **draws, ambit_failure *f);
void ambit_draws_close(ambit_draws *draws); /* NULL is allowed */
const ambit_problem *ambit_draws_problem(const ambit_draws *draws);
void ambit_draws_work(const ambit_draws *draws, ambit_work *sum); /* adds what was counted until now */
const char *ambit_draws_arithmetic(const ambit_draws *draws);
/* From now on the options `relative` and `absolute` are multiplied, and `step_max`, if there is one, is no more than
** `longest`; false: the solver has not both. */
bool ambit_draws_tighten(ambit_draws *draws, double by, double longest);

typedef struct ambit_draws_one {
  const double *point; /* datum i at point[i * stride] */
  size_t stride;
  /* the middle of the states x [nx] at time[k] */
  void (*see)(void *user, uint32_t k, const double *x);
  int32_t (*pause)(void *user); /* nonzero: stop */
  void *user;
  char *reason; /* [room] why it did not reach the end, or "" */
  size_t room;
} ambit_draws_one;

/* [worker's thread] *reached: did it reach the end? Other than OK: the solver can't even begin. */
ambit_status ambit_draws_make(ambit_draws *draws, uint32_t worker, const ambit_draws_one *one, bool *reached);
#endif
