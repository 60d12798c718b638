/* field.h -- what is followed, x' = f(x, p, t) with p = fixed + F xi, and how: the same in every step of a run. */
#ifndef LOHNER_FIELD_H
#define LOHNER_FIELD_H
#include "ball.h"
#include <ambit/jet.h>
#include <ambit/solver.h>

#define PIECES_MAX 16

/* How slopes get over a step (step.c) */
enum formula { FORMULA_AUTO, FORMULA_TAYLOR, FORMULA_HERMITE_OBRESCHKOFF };

typedef struct options {
  uint32_t order, slope_order, slope_order_max; /* slope orders: to start with, and most */
  uint32_t history, pieces, formula;
  double tolerance, step_max, step_min, width_max;
  int patient; /* step_min was given, and alone decides when steps are too short */
} options;

/* a part of the cube of xi */
typedef struct part {
  double *from, *to; /* [nc] */
} part;

typedef struct field {
  const ambit_host *host;
  ambit_problem problem;
  const ambit_jet_service *jet;
  options options;
  uint32_t nx, np, nc, ndir;    /* nc columns, one for each xi; directions of slopes: the columns, then the states */
  double *fixed, *fixed_column; /* [np] [np x nc] p_c, F */
  part whole;                   /* the cube [-1, 1]^nc */
  double *seed;                 /* [ndir] scratch */
} field;

typedef struct request {
  double **array;
  size_t count;
} request;

/* in start.c; 0: out of memory */
int field_allocate(const ambit_host *h, size_t n, const request *list);
ambit_status field_no_memory(const ambit_host *h);

static inline double field_end(const field *f) { return f->problem.time[f->problem.ntime - 1]; }
static inline double field_span(const field *f) { return fabs(field_end(f) - f->problem.time[0]); }
#endif
