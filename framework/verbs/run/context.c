/* context.c -- opening an arithmetic. */
#include "host/params.h"
#include "verbs/run/context.h"
#include "base/clock.h"
#include "base/meter.h"
#include "host/slow.h"
#include "num/environment.h"
#include "num/outward.h"
#include <stdio.h>
#include <string.h>

static void forward_note(void *user, const char *line) { ambit_registry_note(user, line); }

/* Every verb comes this way. Comparisons and conversions all over the kernel take the standard environment for granted.
*/
static ambit_status check_floating_point(ambit_failure *f) {
  if (!ambit_environment_is_standard())
    return ambit_fail(f, AMBIT_INVALID,
        "this thread does not round to nearest or flushes subnormal numbers to zero; call fesetenv(FE_DFL_ENV) first");
  if (!ambit_interval_rounds_outward())
    return ambit_fail_code(f, AMBIT_BROKEN, AMBIT_CODE_BROKEN_ROUNDING,
        "this build does not round outward (compiled without -frounding-math?)");
  return AMBIT_OK;
}

ambit_status ambit_context_scope(ambit_registry *r, ambit_scope **scope, ambit_failure *f) {
  *scope = NULL;
  ambit_status floating = check_floating_point(f);
  if (floating != AMBIT_OK) return floating;
  ambit_status status = ambit_scope_open(scope, forward_note, r);
  return status == AMBIT_OK ? status : ambit_fail(f, status, "out of memory");
}

double *ambit_context_options(ambit_scope *scope, const ambit_param *param, const char *kind, const char *name,
    size_t noption, const ambit_option *option, ambit_failure *f) {
  char owner[96];
  snprintf(owner, sizeof owner, "%s `%s`", kind, name);
  double *value = ambit_arena_alloc(scope->arena, ambit_params_doubles(param) * sizeof *value);
  if (!value) {
    ambit_no_memory(f);
    return NULL;
  }
  return ambit_params_resolve(param, owner, noption, option, value, f) == AMBIT_OK ? value : NULL;
}

/* What to turn where memory was short, unless the plugin says so itself. */
static const char *memory_advice(ambit_status status, const char *said) {
  if (status != AMBIT_NOMEM || strchr(said, '`') || strstr(said, "lower ")) return "";
  return "; make fewer data uncertain, split the model, lower `order` where it is an option, or allow more memory";
}

ambit_status ambit_context_failed(const ambit_scope *scope, ambit_status status, const char *who, ambit_failure *f) {
  const char *said = scope->failure.message, *advice = memory_advice(status, said);
  if (said[0]) return ambit_fail(f, status, "%s: %s%s", who, said, advice);
  return ambit_fail(f, status, "%s: %s, without a reason%s", who, ambit_status_name(status), advice);
}

static ambit_status open_arithmetic(ambit_context *c, ambit_failure *f) {
  char who[96];
  if (!c->arithmetic->open) return AMBIT_OK;
  ambit_meter_enter(AMBIT_FRAME_STAGE, "context");
  ambit_meter_enter(AMBIT_FRAME_ARITHMETIC, c->name);
  ambit_status status = c->arithmetic->open(&c->scope->host, c->option, c->nvar, &c->ctx);
  ambit_meter_leave();
  ambit_meter_leave();
  if (status == AMBIT_OK) return AMBIT_OK;
  snprintf(who, sizeof who, "arithmetic `%s`", c->name);
  return ambit_context_failed(c->scope, status, who, f);
}

ambit_status ambit_context_open(ambit_registry *r, const char *name, size_t noption, const ambit_option *option,
    uint32_t nvar, ambit_context *c, ambit_failure *f) {
  double begun = ambit_clock_cpu();
  *c = (ambit_context) { .nvar = nvar };
  snprintf(c->name, sizeof c->name, "%s", name);
  ambit_failure own = { 0 };
  ambit_status status = ambit_registry_arithmetic(r, name, &c->arithmetic, &own);
  if (status == AMBIT_OK) status = ambit_context_scope(r, &c->scope, &own);
  if (status == AMBIT_OK) {
    c->option = ambit_context_options(c->scope, c->arithmetic->param, "arithmetic", name, noption, option, &own);
    status = own.status;
  }
  if (status == AMBIT_OK) status = open_arithmetic(c, &own);
  c->seconds = ambit_clock_cpu() - begun;
  if (status == AMBIT_OK) return AMBIT_OK;
  ambit_scope_close(c->scope);
  *c = (ambit_context) { 0 };
  return ambit_fail(f, status, "%s", own.message);
}

ambit_status ambit_context_renew(ambit_registry *r, ambit_context *c, ambit_failure *f) {
  if (!c->arithmetic || !c->arithmetic->open) return AMBIT_OK;
  ambit_context fresh = { .arithmetic = c->arithmetic, .nvar = c->nvar, .seconds = c->seconds, .spent = c->spent };
  ambit_work before = ambit_scope_work(c->scope);
  ambit_work_add(&fresh.spent, &before);
  memcpy(fresh.name, c->name, sizeof fresh.name);
  ambit_failure own = { 0 };
  ambit_status status = ambit_context_scope(r, &fresh.scope, f);
  if (status != AMBIT_OK) return status;
  size_t n = ambit_params_doubles(c->arithmetic->param);
  fresh.option = ambit_arena_alloc(fresh.scope->arena, n * sizeof *fresh.option);
  if (fresh.option) {
    memcpy(fresh.option, c->option, n * sizeof *fresh.option);
    status = open_arithmetic(&fresh, &own);
  } else {
    status = ambit_fail(&own, AMBIT_NOMEM, "out of memory");
  }
  if (status != AMBIT_OK) {
    ambit_scope_close(fresh.scope);
    return ambit_fail(f, status, "%s", own.message);
  }
  ambit_context_close(c);
  *c = fresh;
  return AMBIT_OK;
}

void ambit_context_close(ambit_context *c) {
  if (c->ctx && c->arithmetic->close) c->arithmetic->close(c->ctx);
  ambit_scope_close(c->scope);
  *c = (ambit_context) { 0 };
}

ambit_status ambit_context_sound(const ambit_context *c, ambit_failure *f) {
  const ambit_fault *fault = c->arithmetic ? c->arithmetic->fault : NULL;
  if (!fault || !fault->seen) return ambit_slow_sound(f);
  static const char *const what[] = { "the bounds", "an empty set of what is defined everywhere,",
    "a derivative within", "a coefficient of a series with the midpoint and radius" };
  return ambit_fail_code(f, AMBIT_BROKEN, AMBIT_CODE_BROKEN_BOUNDS,
      "arithmetic `%s` is broken: it says that it is rigorous, and gave %s [%.17g, %.17g]", c->name,
      what[fault->what >= 0 && fault->what <= AMBIT_FAULT_SERIES ? fault->what : 0], fault->lo, fault->hi);
}

double ambit_context_seconds(void) { return ambit_clock_cpu(); }
