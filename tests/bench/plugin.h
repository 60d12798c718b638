/* plugin.h -- an arithmetic plugin for a benchmark: found as a scene finds it, with its own context; and the clock. */
#ifndef AMBIT_BENCH_PLUGIN_H
#define AMBIT_BENCH_PLUGIN_H
#include "graph/interpreter.h"
#include <ambit/registry.h>
#include "host/services.h"
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

typedef struct bench_arithmetic {
  ambit_arithmetic full; /* completed by the kernel */
  ambit_scope *scope;
  void *ctx;
} bench_arithmetic;

/* `id`: AMBIT_ARITHMETIC, or another interface of the plugin; exits with the reason if there is none */
static inline bench_arithmetic bench_open(ambit_registry *r, const char *name, const char *id) {
  bench_arithmetic b = { 0 };
  ambit_failure f = { 0 };
  const ambit_plugin *plugin = NULL;
  ambit_status status = r ? ambit_registry_plugin(r, "arithmetic", name, &plugin, &f) : AMBIT_NOMEM;
  const ambit_arithmetic *offered = status == AMBIT_OK ? plugin->get(id) : NULL;
  if (offered && status == AMBIT_OK) status = ambit_arithmetic_complete(offered, &b.full, &f);
  if (offered && status == AMBIT_OK) status = ambit_scope_open(&b.scope, NULL, NULL);
  if (offered && status == AMBIT_OK && b.full.open) status = b.full.open(&b.scope->host, NULL, 0, &b.ctx);
  if (offered && status == AMBIT_OK) return b;
  fprintf(stderr, "%s %s: %s\n", name, id, f.status ? f.message : "not offered");
  exit(1);
}

static inline void bench_close(bench_arithmetic *b) {
  if (b->full.close) b->full.close(b->ctx);
  ambit_scope_close(b->scope);
}

static inline double bench_now(void) { /* ns */
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}
#endif
