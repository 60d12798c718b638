/* context.h -- an arithmetic opened with its options: what a verb needs before it can compute. */
#ifndef AMBIT_CONTEXT_H
#define AMBIT_CONTEXT_H
#include <ambit/registry.h>
#include "host/services.h"

typedef struct ambit_context {
  char name[64];                      /* for messages */
  const ambit_arithmetic *arithmetic; /* completed */
  void *ctx;
  ambit_scope *scope;
  double *option; /* as open() got them, in the scope's arena */
  uint32_t nvar;
  double seconds;   /* of CPU time, to open it */
  ambit_work spent; /* counted before it was renewed */
} ambit_context;

/* Loads the arithmetic and opens a context for nvar independent variables. On failure nothing is left open. */
ambit_status ambit_context_open(ambit_registry *r, const char *name, size_t noption, const ambit_option *option,
    uint32_t nvar, ambit_context *c, ambit_failure *f);
/* Opens it afresh, without traces of what was computed before; on failure it is as it was. Its own thread may do
** this. */
ambit_status ambit_context_renew(ambit_registry *r, ambit_context *c, ambit_failure *f);
void ambit_context_close(ambit_context *c); /* a zeroed one is allowed */
/* BROKEN if a rigorous arithmetic ever gave what is no enclosure; asked when the work is done, before its results are
** believed. A zeroed context is sound. */
ambit_status ambit_context_sound(const ambit_context *c, ambit_failure *f);

/* A scope whose notes go to the registry. */
ambit_status ambit_context_scope(ambit_registry *r, ambit_scope **scope, ambit_failure *f);
/* Options by name -> the array for open(), in the scope's arena; NULL: f says why. */
double *ambit_context_options(ambit_scope *scope, const ambit_param *param, const char *kind, const char *name,
    size_t noption, const ambit_option *option, ambit_failure *f);
/* The failure of a plugin's call: its own message if it left one, else `who` and the status. */
ambit_status ambit_context_failed(const ambit_scope *scope, ambit_status status, const char *who, ambit_failure *f);

double ambit_context_seconds(void); /* CPU time of this process */
#endif
