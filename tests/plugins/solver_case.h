/* solver_case.h -- the conformance kit of solvers as a cmocka test. */
#ifndef AMBIT_SOLVER_CASE_H
#define AMBIT_SOLVER_CASE_H
#include "host/params.h"
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
  return solver_kit_run(&c->kit, NULL);
}

/* The kit passes with each of these options. */
static inline void case_passes(solver_case *c, size_t n, const ambit_option *option) {
  assert_int_equal(c->kit.plugin->needs_rigorous, 1);
  for (size_t i = 0; i < n; i++) {
    size_t findings = case_findings(c, option[i].name, option[i].text);
    if (findings) fail_msg("%s = %s: %zu findings", option[i].name, option[i].text, findings);
  }
}

/* -- options out of range */

typedef struct case_option {
  const char *name;
  double value;
} case_option;

static inline ambit_status case_try(const solver_case *c, case_option bad, char message[AMBIT_MESSAGE_MAX]) {
  const ambit_param *param = c->kit.plugin->param;
  double option[32];
  size_t at = 0;
  ambit_scope *scope;
  void *self = NULL;
  const ambit_problem problem = { .size = sizeof problem };
  while (strcmp(param[at].name, bad.name) != 0) at++;
  assert_int_equal(ambit_params_resolve(param, c->kit.name, 0, NULL, option, NULL), AMBIT_OK);
  option[at] = bad.value;
  assert_int_equal(ambit_scope_open(&scope, NULL, NULL), AMBIT_OK);
  ambit_status status = c->kit.plugin->open(&scope->host, &problem, option, &self);
  snprintf(message, AMBIT_MESSAGE_MAX, "%s", scope->failure.message);
  ambit_scope_close(scope);
  return status;
}

/* Each is refused, by its name. */
static inline void case_refuses(const solver_case *c, size_t n, const case_option *bad) {
  for (size_t i = 0; i < n; i++) {
    char message[AMBIT_MESSAGE_MAX];
    assert_int_equal(case_try(c, bad[i], message), AMBIT_INVALID);
    if (!strstr(message, bad[i].name)) fail_msg("`%s` is not named by: %s", bad[i].name, message);
  }
}
#endif
