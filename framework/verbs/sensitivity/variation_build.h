/* variation_build.h -- what the files of this folder share while a system is joined by its variational equations. */
#ifndef AMBIT_VARIATION_BUILD_H
#define AMBIT_VARIATION_BUILD_H
#include <ambit/variation.h>

typedef struct ambit_variation_column {
  ambit_expr unknown, scale;   /* of the datum; unknown is AMBIT_NO_EXPR for an initial value */
  ambit_expr *start, *forcing; /* [nx] dx0/dq, df/dq */
  bool *reached;               /* [nx] */
  bool *reached_unknown;       /* [na] of the implicit form */
} ambit_variation_column;

typedef struct ambit_variation_build_state {
  const ambit_variation_request *q;
  const ambit_system *s;
  ambit_graph *graph;
  ambit_arena *arena;
  ambit_failure *f;
  const ambit_implicit_form *form; /* of s; NULL: there is none that is taken */
  const ambit_expr *rate;          /* [nx] of s, once they are needed */
  ambit_expr *slope;               /* [nx x nx] A by rows */
  ambit_variation_column *column;  /* [nby] */
  ambit_variation *v;
} ambit_variation_build_state;

typedef struct ambit_variation_source {
  ambit_system_source base; /* first */
  ambit_variation_build_state *build;
} ambit_variation_source;

/* Which entries of each column can differ from zero, by what the implicit form depends on. */
ambit_status ambit_variation_reach(ambit_variation_build_state *b);
/* Gives v->system, whose states are there, its implicit form; later: what writes its right-hand sides. */
ambit_status ambit_variation_implicit(
    ambit_variation_build_state *b, ambit_status (*later)(ambit_system_source *self, ambit_failure *f));
#endif
