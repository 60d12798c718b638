/* conformance.c -- loads a plugin and finds the kit for it. */
#include "host/params.h"
#include "kit/conformance.h"
#include "host/services.h"
#include "kit/arithmetic_kit.h"
#include "kit/conduct.h"
#include "kit/element_kit.h"
#include "kit/reduction_kit.h"
#include "kit/roots_kit.h"
#include "kit/service_kit.h"
#include "kit/solver_kit.h"
#include "oracle.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static void tell(const conformance *c, const char *what, const char *name, const char *text) {
  c->tell(c->user, what, name, text);
}

static int refuse(const conformance *c, const ambit_failure *f) {
  tell(c, "refused", "", f->message);
  return NOT_LOADED;
}

static void tell_finding(void *user, const char *promise, const char *message) {
  tell(user, "finding", promise, message);
}

static void tell_done(const conformance *c, const char *section, size_t judged, size_t broken) {
  char text[64];
  snprintf(text, sizeof text, "%zu %zu", judged, broken);
  tell(c, "done", section, text);
}

/* -- arithmetics */

static double judge(uint32_t op, double x, double y, int32_t n, bool up) {
  return oracle_rounded(op, x, y, n, up ? MPFR_RNDU : MPFR_RNDD);
}

static void tell_begin_section(void *user, const char *section) { tell(user, "begin", section, ""); }
static void tell_done_section(void *user, const char *section, size_t judged, size_t broken) {
  tell_done(user, section, judged, broken);
}
static void tell_fallback(void *user, const char *operation) { tell(user, "fallback", operation, ""); }

static int check_arithmetic(const conformance *c, ambit_registry *r, const ambit_plugin *p, const char *name) {
  ambit_failure f = { 0 };
  const ambit_arithmetic *full;
  ambit_scope *scope;
  ambit_status status = ambit_registry_arithmetic(r, name, &full, &f);
  if (status == AMBIT_OK && (status = ambit_scope_open(&scope, NULL, NULL)) != AMBIT_OK)
    ambit_fail(&f, status, "out of memory");
  if (status != AMBIT_OK) return refuse(c, &f);
  if (!full->rigorous) tell(c, "note", "", "it proves nothing (rigorous = 0): only its values at points are judged");
  arithmetic_kit kit = { .plugin = p->get(AMBIT_ARITHMETIC),
    .full = full,
    .host = &scope->host,
    .isotonic = c->isotonic,
    .seed = c->seed,
    .oracle = judge,
    .finding = tell_finding,
    .fallback = tell_fallback,
    .user = (void *)(uintptr_t)c,
    .noption = c->noption,
    .option = c->option,
    .effort = c->effort,
    .begin = tell_begin_section,
    .done = tell_done_section };
  size_t broken = arithmetic_kit_run(&kit);
  ambit_scope_close(scope);
  return broken ? BROKEN : CONFORMS;
}

/* -- elements */

static int check_element(const conformance *c, ambit_registry *r, const char *name) {
  ambit_failure f = { 0 };
  const ambit_element *element;
  if (ambit_registry_element(r, name, &element, &f) != AMBIT_OK) return refuse(c, &f);
  unsigned failures = 0, runs = c->effort > 1 ? (unsigned)(3 * c->effort) : 3;
  char text[160];
  tell(c, "begin", "quantities", "");
  element_kit_report all = { 0 };
  for (unsigned i = 0; i < runs; i++) {
    element_kit_report one = element_kit_run(element, name, c->seed + i);
    all.stages += one.stages, all.expressed += one.expressed, all.refused += one.refused;
    all.compared += one.compared, all.powers += one.powers, all.reactions += one.reactions, all.own += one.own;
    failures += one.failures;
    if (one.failures) tell(c, "finding", "element", one.first);
  }
  tell_done(c, "quantities", all.compared, failures);
  snprintf(text, sizeof text,
      "%u stages, %u quantities written, %u refused with a message, %u balances of power closed, %u of momentum",
      all.stages, all.own, all.refused, all.powers, all.reactions);
  tell(c, "note", "", text);
  return failures ? BROKEN : CONFORMS;
}

/* -- solvers */

enum { ARITHMETIC_OPTIONS = 128 };

/* the first arithmetic that fits, opened as a scene would */
static bool open_arithmetic(
    ambit_registry *r, ambit_scope *scope, double option[ARITHMETIC_OPTIONS], solver_kit *kit, ambit_failure *f) {
  char name[64];
  const char *list = kit->plugin->arithmetics ? kit->plugin->arithmetics : "interval";
  snprintf(name, sizeof name, "%.*s", (int)strcspn(list, " "), list);
  if (ambit_registry_arithmetic(r, name, &kit->arithmetic, f) != AMBIT_OK) return false;
  const ambit_arithmetic *a = kit->arithmetic;
  if (ambit_params_doubles(a->param) > ARITHMETIC_OPTIONS) return false;
  if (ambit_params_resolve(a->param, name, 0, NULL, option, f) != AMBIT_OK) return false;
  return !a->open || a->open(&scope->host, option, 0, &kit->actx) == AMBIT_OK;
}

/* Random systems: one of each size in the usual check. */
#define SYSTEMS 12
#define ROOT_SYSTEMS 36
#define MODELS 24

static size_t check_flow(const conformance *c, const solver_kit *kit) {
  char text[200];
  solver_kit_counts n = { 0 };
  tell(c, "begin", "problems", "");
  size_t first = solver_kit_run(kit, &n), seen = n.compared;
  tell_done(c, "problems", seen, first);
  tell(c, "begin", "random systems", "");
  size_t second = solver_kit_run_random(kit, (size_t)fmax(1, SYSTEMS * c->effort), &n);
  tell_done(c, "random systems", n.compared - seen, second);
  snprintf(text, sizeof text,
      "%zu runs, %zu complete; %zu enclosures, %zu tubes, %zu dense enclosures and %zu sets compared; %zu stops",
      n.runs, n.complete, n.enclosures, n.tubes, n.dense, n.sets, n.stops);
  tell(c, "note", "", text);
  return first + second;
}

static int check_roots(const conformance *c, ambit_registry *r, const char *name) {
  char text[200];
  roots_kit k = { .registry = r,
    .name = name,
    .seed = c->seed,
    .noption = c->noption,
    .option = c->option,
    .allocations = conduct_allocations,
    .finding = tell_finding,
    .user = (void *)(uintptr_t)c };
  tell(c, "begin", "equations", "");
  size_t broken = roots_kit_run(&k, (size_t)fmax(6, ROOT_SYSTEMS * c->effort));
  tell_done(c, "equations", k.judged, broken);
  snprintf(text, sizeof text, "%zu searches, %zu complete; %zu boxes, %zu planted roots looked for", k.searches,
      k.complete, k.boxes, k.roots);
  tell(c, "note", "", text);
  return broken ? BROKEN : CONFORMS;
}

static int check_reduction(const conformance *c, ambit_registry *r, const char *name) {
  char text[120];
  reduction_kit k = { .registry = r,
    .name = name,
    .seed = c->seed,
    .noption = c->noption,
    .option = c->option,
    .allocations = conduct_allocations,
    .finding = tell_finding,
    .user = (void *)(uintptr_t)c };
  tell(c, "begin", "models", "");
  size_t broken = reduction_kit_run(&k, (size_t)fmax(6, MODELS * c->effort));
  tell_done(c, "models", k.judged, broken);
  snprintf(text, sizeof text, "%zu reductions, %zu proofs", k.runs, k.proofs);
  tell(c, "note", "", text);
  return broken ? BROKEN : CONFORMS;
}

static int check_in_time(const conformance *c, ambit_registry *r, const char *name) {
  ambit_failure f = { 0 };
  solver_kit kit = { .name = name,
    .tolerance = 1e-3,
    .noption = c->noption,
    .option = c->option,
    .allocations = conduct_allocations,
    .seed = c->seed,
    .finding = tell_finding,
    .user = (void *)(uintptr_t)c };
  ambit_scope *scope;
  double option[ARITHMETIC_OPTIONS];
  if (ambit_scope_open(&scope, NULL, NULL) != AMBIT_OK) ambit_fail(&f, AMBIT_NOMEM, "out of memory");
  bool ready = !f.message[0] && ambit_registry_solver(r, name, &kit.plugin, &f) == AMBIT_OK &&
               open_arithmetic(r, scope, option, &kit, &f);
  size_t broken = ready ? check_flow(c, &kit) : 0;
  if (ready && kit.actx && kit.arithmetic->close) kit.arithmetic->close(kit.actx);
  ambit_scope_close(scope);
  if (!ready) {
    ambit_fail(&f, AMBIT_UNABLE, "no arithmetic for it could be opened"); /* unless something else is said already */
    return refuse(c, &f);
  }
  return broken ? BROKEN : CONFORMS;
}

/* every interface that it offers; one without any is refused by the first */
static int check_solver(const conformance *c, ambit_registry *r, const ambit_plugin *p, const char *name) {
  int worst = CONFORMS;
  bool roots = p->get(AMBIT_ROOT_FINDER) != NULL, strategy = p->get(AMBIT_STRATEGY) != NULL;
  if (p->get(AMBIT_SOLVER) || !(roots || strategy)) worst = check_in_time(c, r, name);
  if (worst == CONFORMS && roots) worst = check_roots(c, r, name);
  if (worst == CONFORMS && strategy) worst = check_reduction(c, r, name);
  return worst;
}

/* -- services: functions for Lua, or interfaces that only their users know */

static double judge_elementary(uint32_t op, double x, double y, int32_t n, int up) { return judge(op, x, y, n, up); }

/* one section for each interface that it offers */
static void check_interface(const conformance *c, service_kit *k, const char *section, const void *offered,
    void (*check)(service_kit *k, const void *offered)) {
  size_t judged = k->judged, findings = k->findings;
  if (!offered) return;
  tell(c, "begin", section, "");
  check(k, offered);
  tell_done(c, section, k->judged - judged, k->findings - findings);
}

static void check_exports(service_kit *k, const void *s) { service_kit_exports(k, s); }
static void check_eigen(service_kit *k, const void *s) { service_kit_eigen(k, s); }
static void check_quasi_random(service_kit *k, const void *s) { service_kit_quasi_random(k, s); }
static void check_elementary(service_kit *k, const void *s) { service_kit_elementary(k, s); }

static int check_service(const conformance *c, ambit_registry *r, const ambit_plugin *p) {
  ambit_failure f = { 0 };
  const ambit_exports *exports;
  if (ambit_registry_exports(r, p, &exports, &f) != AMBIT_OK) return refuse(c, &f);
  service_kit k = { .seed = c->seed,
    .effort = c->effort,
    .oracle = judge_elementary,
    .finding = tell_finding,
    .user = (void *)(uintptr_t)c };
  check_interface(c, &k, "exports", exports, check_exports);
  check_interface(c, &k, "eigen", p->get(AMBIT_EIGEN_SERVICE), check_eigen);
  check_interface(c, &k, "quasi_random", p->get(AMBIT_QUASI_RANDOM_SERVICE), check_quasi_random);
  check_interface(c, &k, "elementary", p->get(AMBIT_ELEMENTARY_SERVICE), check_elementary);
  return k.findings ? BROKEN : CONFORMS;
}

static void note_file_name(const conformance *c, const char *name) {
  const char *slash = strrchr(c->file, '/'), *base = slash ? slash + 1 : c->file;
  size_t length = strlen(name);
  char text[200];
  if (strncmp(base, name, length) == 0 && strcmp(base + length, ".so") == 0) return;
  snprintf(text, sizeof text, "to be found by its name the file must be called %.80s.so", name);
  tell(c, "note", "", text);
}

static int check_kind(const conformance *c, ambit_registry *r, const ambit_plugin *p) {
  const char *dot = strchr(p->id, '.'), *name = dot ? dot + 1 : "";
  size_t kind = dot ? (size_t)(dot - p->id) : 0;
  tell(c, "plugin", p->id, p->doc ? p->doc : "");
  note_file_name(c, name);
  if (kind == 10 && strncmp(p->id, "arithmetic", kind) == 0) return check_arithmetic(c, r, p, name);
  if (kind == 7 && strncmp(p->id, "element", kind) == 0) return check_element(c, r, name);
  if (kind == 6 && strncmp(p->id, "solver", kind) == 0) return check_solver(c, r, p, name);
  if (kind == 7 && strncmp(p->id, "service", kind) == 0) return check_service(c, r, p);
  ambit_failure f = { 0 };
  ambit_fail(&f, AMBIT_INVALID,
      "it calls itself `%.100s`, expected arithmetic.NAME, element.NAME, solver.NAME or "
      "service.NAME",
      p->id);
  return refuse(c, &f);
}

/* Adds up what the sections judged on their way to the one who listens. */
typedef struct counter {
  const conformance *outer;
  size_t judged, broken;
} counter;

static void count(void *user, const char *what, const char *name, const char *text) {
  counter *n = user;
  size_t judged = 0;
  if (strcmp(what, "done") == 0 && sscanf(text, "%zu", &judged) == 1) n->judged += judged;
  if (strcmp(what, "finding") == 0) n->broken++;
  n->outer->tell(n->outer->user, what, name, text);
}

/* The rules of its kind, then those of every kind. What nothing was checked of does not conform. */
static int check_plugin(const conformance *c, ambit_registry *r, const ambit_plugin *p) {
  counter n = { c, 0, 0 };
  conformance counted = *c;
  counted.tell = count, counted.user = &n;
  conduct *watch = conduct_open((const void *)(uintptr_t)p->get);
  if (!watch) {
    tell(c, "refused", "", "out of memory");
    return NOT_LOADED;
  }
  int verdict = check_kind(&counted, r, p);
  if (verdict != NOT_LOADED && n.judged == 0) {
    tell(&counted, "finding", "kit", "nothing could be checked: it offers no interface that the kit knows");
    verdict = BROKEN;
  }
  if (verdict != NOT_LOADED) {
    size_t before = n.broken;
    tell(c, "begin", "conduct", "");
    size_t judged = conduct_judge(watch, tell_finding, &counted);
    tell_done(c, "conduct", judged, n.broken - before);
    if (n.broken > before) verdict = BROKEN;
  }
  conduct_close(watch);
  return verdict;
}

int conformance_run(const conformance *c) {
  ambit_failure f = { 0 };
  const ambit_plugin *p;
  ambit_registry *r = ambit_registry_open(NULL);
  if (!r) {
    ambit_fail(&f, AMBIT_NOMEM, "out of memory");
    return refuse(c, &f);
  }
  int verdict = ambit_registry_load_file(r, c->file, &p, &f) == AMBIT_OK ? check_plugin(c, r, p) : refuse(c, &f);
  ambit_registry_close(r);
  return verdict;
}
