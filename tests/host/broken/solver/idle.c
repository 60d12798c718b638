/* idle.c -- broken: a solver without run(). */
#include <ambit/solver.h>
#include <stddef.h>

static ambit_status start(const ambit_host *h, const ambit_problem *p, const double *option, void **self) {
  (void)h, (void)p, (void)option, (void)self;
  return AMBIT_OK;
}

static void finish(void *self) { (void)self; }

static const ambit_solver idle = { .size = sizeof idle, .open = start, .close = finish };
static const void *get(const char *id) { return id[6] == 's' ? &idle : NULL; }
const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "solver.idle", "1", "", get };
