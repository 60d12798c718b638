/* solver_case.h -- the conformance kit of solvers as a cmocka test. */
#ifndef AMBIT_SOLVER_CASE_H
#define AMBIT_SOLVER_CASE_H
#include "kit/arithmetic_loader.h"
#include "kit/solver_kit.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

#ifdef SOLVER_COUNTS_ALLOCATIONS
#include "kit/allocations.h"
#define SOLVER_ALLOCATIONS ambit_allocation_count
#else
#define SOLVER_ALLOCATIONS NULL /* a sanitizer's malloc cannot be replaced */
#endif

static inline void case_show(void *user, const char *problem, const char *message) {
  (void)user;
  print_error("%s: %s\n", problem, message);
}

static inline void case_hide(void *user, const char *problem, const char *message) {
  (void)user, (void)problem, (void)message;
}

typedef struct solver_case {
  ambit_registry *registry;
  arithmetic_loader arithmetic;
  solver_kit kit;
} solver_case;

static inline void case_open(solver_case *c, const char *solver, const char *arithmetic) {
  ambit_failure f = { 0 };
  *c = (solver_case) { .registry = ambit_registry_open(NULL) };
  c->kit = (solver_kit) { .name = solver, .tolerance = 1e-8, .allocations = SOLVER_ALLOCATIONS, .finding = case_show };
  if (ambit_registry_solver(c->registry, solver, &c->kit.plugin, &f) != AMBIT_OK) fail_msg("%s", f.message);
  const char *problem = arithmetic_load(&c->arithmetic, arithmetic);
  if (problem) fail_msg("%s", problem);
  c->kit.arithmetic = &c->arithmetic.full;
  c->kit.actx = c->arithmetic.ctx;
}

static inline void case_close(solver_case *c) {
  arithmetic_unload(&c->arithmetic);
  ambit_registry_close(c->registry);
}

/* the findings with one option set; NULL: none */
static inline size_t case_findings(solver_case *c, const char *name, const char *text) {
  ambit_option option = { name, text };
  c->kit.noption = name ? 1 : 0;
  c->kit.option = &option;
  return solver_kit_run(&c->kit);
}
#endif
