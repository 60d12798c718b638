/* services.h -- the ambit_host that plugins see: memory, messages, services by id. */
#ifndef AMBIT_SERVICES_H
#define AMBIT_SERVICES_H
#include <ambit/arena.h>
#include <ambit/status.h>
#include <ambit/work.h>

/* One host object per opened context or solver; freed together with it. */
typedef struct ambit_lease {
  ambit_host host;
  ambit_arena *arena;
  ambit_failure failure;
  void (*note)(void *user, const char *line);
  void *user;
} ambit_lease;

ambit_status ambit_lease_open(ambit_lease **lease, void (*note)(void *user, const char *line), void *user);
void ambit_lease_close(ambit_lease *lease);

/* What was counted on this lease until now (zeros for NULL); nobody counts meanwhile. */
ambit_work ambit_lease_work(const ambit_lease *lease);
#endif
