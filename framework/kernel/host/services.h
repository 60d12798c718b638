/* services.h -- the ambit_host that plugins see: memory, messages, services by id. */
#ifndef AMBIT_SERVICES_H
#define AMBIT_SERVICES_H
#include <ambit/arena.h>
#include <ambit/status.h>
#include <ambit/work.h>

/* One host object per opened context or solver; freed together with it. */
typedef struct ambit_scope {
  ambit_host host;
  ambit_arena *arena;
  ambit_failure failure;
  void (*note)(void *user, const char *line);
  void *user;
} ambit_scope;

ambit_status ambit_scope_open(ambit_scope **scope, void (*note)(void *user, const char *line), void *user);
void ambit_scope_close(ambit_scope *scope);

/* What was counted on this scope until now (zeros for NULL); nobody counts meanwhile. */
ambit_work ambit_scope_work(const ambit_scope *scope);
#endif
