/* solver_lies.h -- series services that lie: the kit of solvers must notice. */
#ifndef AMBIT_SOLVER_LIES_H
#define AMBIT_SOLVER_LIES_H
#include "solver_case.h"
#include <ambit/jet.h>

static const void *(*kernel_service)(const ambit_host *h, const char *id);
static ambit_jet_service truthful, lying; /* lies() makes them equal; then the test spoils a function of `lying` */

static const void *lie(const ambit_host *h, const char *id) {
  return strcmp(id, AMBIT_JET_SERVICE) == 0 ? &lying : kernel_service(h, id);
}

/* From now on the solver of the case gets `lying`. */
static void lies(solver_case *c) {
  ambit_scope *scope;
  assert_int_equal(ambit_scope_open(&scope, NULL, NULL), AMBIT_OK);
  kernel_service = scope->host.service;
  truthful = *(const ambit_jet_service *)kernel_service(&scope->host, AMBIT_JET_SERVICE);
  ambit_scope_close(scope);
  c->kit.service = lie;
  lying = truthful;
}
#endif
