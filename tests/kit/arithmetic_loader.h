/* arithmetic_loader.h -- an arithmetic plugin for a test, straight from its file. */
#ifndef AMBIT_ARITHMETIC_LOADER_H
#define AMBIT_ARITHMETIC_LOADER_H
#include "host/params.h"
#include "graph/interpreter.h"
#include <ambit/registry.h>
#include "host/services.h"
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct arithmetic_loader {
  void *library;
  const ambit_arithmetic *plugin; /* as exported */
  ambit_arithmetic full;          /* completed */
  ambit_scope *scope;
  void *ctx;          /* opened with every option at its fallback and no variables */
  double option[128]; /* its options */
} arithmetic_loader;

/* NULL, or what went wrong. `interface_id` is AMBIT_ARITHMETIC, or one that the plugin offers besides. */
static inline const char *arithmetic_load_as(arithmetic_loader *l, const char *name, const char *interface_id) {
  *l = (arithmetic_loader) { 0 };
  char file[4096];
  const char *path = getenv("AMBIT_PATH");
  snprintf(file, sizeof file, "%s/arithmetic/%s.so", path ? path : ".", name);
  l->library = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  if (!l->library) return dlerror();
  const ambit_plugin *entry = dlsym(l->library, "ambit_entry");
  l->plugin = entry ? entry->get(interface_id) : NULL;
  if (!l->plugin) return "no arithmetic in this file";
  if (ambit_arithmetic_complete(l->plugin, &l->full, NULL) != AMBIT_OK) return "incomplete arithmetic";
  if (ambit_scope_open(&l->scope, NULL, NULL) != AMBIT_OK) return "out of memory";
  if (ambit_params_doubles(l->full.param) > sizeof l->option / sizeof *l->option) return "too many options";
  if (ambit_params_resolve(l->full.param, name, 0, NULL, l->option, &l->scope->failure) != AMBIT_OK)
    return l->scope->failure.message;
  if (l->full.open && l->full.open(&l->scope->host, l->option, 0, &l->ctx) != AMBIT_OK)
    return l->scope->failure.message;
  return NULL;
}

static inline const char *arithmetic_load(arithmetic_loader *l, const char *name) {
  return arithmetic_load_as(l, name, AMBIT_ARITHMETIC);
}

static inline void arithmetic_unload(arithmetic_loader *l) {
  if (l->ctx && l->full.close) l->full.close(l->ctx);
  ambit_scope_close(l->scope); /* NULL is allowed */
  if (l->library) dlclose(l->library);
}
#endif
