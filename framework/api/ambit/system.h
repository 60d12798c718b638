/* system.h -- a first-order system x' = f(x, u, t) as expressions, whatever it came from.
**
** Invariants come from closed loops and unit quaternions. Who starts the system promises that they vanish at the start
** (an initial set may be wider: then what is proved holds for the part of it on which they vanish).
*/
#ifndef AMBIT_SYSTEM_H
#define AMBIT_SYSTEM_H
#include <ambit/graph.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The same system with further unknowns a: along its solutions R(x, a, t) = 0 and x' = F(x, a, t), solved for in
** stages. What holds of them: ambit_implicit in <ambit/solver.h>. */
typedef struct ambit_implicit_form {
  size_t na, nstage;          /* na 0: there is no such form */
  const ambit_expr *unknown;  /* [na] symbols */
  const ambit_expr *rate;     /* [nx] F */
  const ambit_expr *residual; /* [na] R */
  const uint32_t *stage_end;  /* [nstage] */
  const uint32_t *pivot;      /* [na] */
} ambit_implicit_form;

/* Whoever makes a system may be able to write it in implicit form, and may leave its right-hand sides for later, too:
** both are done when somebody asks for them. Lives as long as the system. */
typedef struct ambit_system_source ambit_system_source;
struct ambit_system_source {
  bool written;
  ambit_implicit_form form; /* once it is written */
  ambit_status (*write)(ambit_system_source *self, ambit_failure *f);
  const ambit_expr *rate;                                                   /* [nx] once they are written */
  ambit_status (*write_rates)(ambit_system_source *self, ambit_failure *f); /* NULL: the system has them */
  void (*mark)(const ambit_system_source *self, ambit_graph *g); /* what it keeps besides form and rates, or NULL */
};

/* At `first` after the start of a run, and every `period` after that, the states become `to`, over states, data, what
** varies, and time. Both are constant expressions, s. */
typedef struct ambit_jump {
  ambit_expr period, first;
  const ambit_expr *to; /* [nx] */
} ambit_jump;

typedef struct ambit_system {
  ambit_graph *graph;
  size_t nx;
  const char *const *name; /* [nx] "beta1", "beta1'" */
  const char *const *unit; /* [nx] */
  const ambit_expr *state; /* [nx] symbols */
  /* [nx] right-hand sides; their unknowns are the uncertain parameters; NULL: see ambit_system_rates */
  const ambit_expr *rate;
  size_t ninvariant;
  const ambit_expr *invariant; /* [ninvariant] g(x, t), zero along every solution that starts with g = 0; see below */
  const char *const *invariant_name; /* [ninvariant] "close: row 1", for messages */
  /* of this very system: who changes states, rates or data drops it, or changes it in the same way; NULL: there is
  ** none, and no implicit form */
  ambit_system_source *source;
  size_t njump;
  const ambit_jump *jump; /* those of one instant in this order */
  /* [nx] only solutions are meant of which each state stays within these bounds at all times; NULL: all */
  const double *least, *most;
} ambit_system;

/* *rate := the right-hand sides, [nx]. */
static inline ambit_status ambit_system_rates(const ambit_system *s, const ambit_expr **rate, ambit_failure *f) {
  ambit_system_source *source = s->source;
  ambit_status status = s->rate || source->rate ? AMBIT_OK : source->write_rates(source, f);
  *rate = s->rate ? s->rate : source->rate;
  return status;
}

/* *form := the implicit form, NULL where there is none. */
static inline ambit_status ambit_system_implicit(
    const ambit_system *s, const ambit_implicit_form **form, ambit_failure *f) {
  ambit_system_source *source = s->source;
  *form = NULL;
  if (!source) return AMBIT_OK;
  ambit_status status = source->written ? AMBIT_OK : source->write(source, f);
  source->written = status == AMBIT_OK;
  if (status == AMBIT_OK && source->form.na) *form = &source->form;
  return status;
}

#ifdef __cplusplus
}
#endif
#endif
