/* solver_mutant.h -- the frame of mutants that wrap a solver: the host that they lend to it, the solver that they
** export.
 */
#ifndef AMBIT_SOLVER_MUTANT_H
#define AMBIT_SOLVER_MUTANT_H
#include "kit/mutants/mutant.h"
#include <ambit/solver.h>
#include <stdarg.h>
#include <stdbool.h>

/* -- the host: lends what the kernel lends */

typedef struct mutant_host {
  ambit_host host; /* first */
  const ambit_host *outer;
  bool is_mute;                                                    /* forgets messages */
  const void *(*service)(const ambit_host *outer, const char *id); /* other services, or NULL */
} mutant_host;

static inline const mutant_host *mutant_of(const ambit_host *h) { return (const mutant_host *)(const void *)h; }

static inline const void *mutant_service(const ambit_host *h, const char *id) {
  const mutant_host *own = mutant_of(h);
  return own->service ? own->service(own->outer, id) : own->outer->service(own->outer, id);
}

static inline void *mutant_alloc(const ambit_host *h, size_t bytes) {
  const ambit_host *outer = mutant_of(h)->outer;
  return outer->alloc(outer, bytes);
}

/* the last failure only: a wrapper cannot pass `...` on */
static inline ambit_status mutant_fail(const ambit_host *h, ambit_status status, const char *format, ...) {
  const mutant_host *own = mutant_of(h);
  char text[400];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return own->is_mute ? status : own->outer->fail(own->outer, status, "%s", text);
}

static inline ambit_status mutant_fail_code(
    const ambit_host *h, ambit_status status, const char *code, const char *format, ...) {
  const mutant_host *own = mutant_of(h);
  char text[400];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return own->is_mute ? status : own->outer->fail_code(own->outer, status, code, "%s", text);
}

static inline void mutant_note(const ambit_host *h, const char *format, ...) { (void)h, (void)format; }

/* NULL: out of memory */
static inline mutant_host *mutant_lend(const ambit_host *h) {
  mutant_host *own = h->alloc(h, sizeof *own);
  if (!own) return NULL;
  const ambit_host lent = { sizeof lent, h->abi, mutant_alloc, mutant_fail, mutant_note, mutant_service,
    mutant_fail_code };
  *own = (mutant_host) { .host = lent, .outer = h };
  return own;
}

/* -- the interface */

static const char *mutant_interface;
static void *mutant_offered; /* set once, when the object is loaded */

static inline const void *mutant_get(const char *id) {
  return strcmp(id, mutant_interface) == 0 ? mutant_offered : NULL;
}

/* The interface `id` of the shipped solver of that name, copied to base [size]; another copy is what the mutant offers:
** it is returned, for the faults. Ends the process if there is none. */
static inline void *mutant_wrap(const char *id, const char *name, void *base, size_t size) {
  const void *honest = mutant_base(name, id);
  uint32_t own = 0;
  mutant_interface = id, mutant_offered = calloc(1, size);
  if (!honest || !mutant_offered) exit(1);
  memcpy(&own, honest, sizeof own);
  memcpy(base, honest, own < size ? own : size);
  return memcpy(mutant_offered, base, size);
}
#endif
