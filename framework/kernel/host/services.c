/* services.c -- memory from an arena, one failure message, services of the lower layers by their id. */
#include "host/services.h"
#include "base/meter.h"
#include "graph/contract.h"
#include "graph/jet.h"
#include "host/metered.h"
#include "host/pool.h"
#include "num/service.h"
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NOTE_MAX 512

/* a record of counted work, one of the scope's */
typedef struct counted {
  ambit_work work; /* first */
  struct counted *next;
} counted;

/* fail() may come from any thread of a plugin, so the message is guarded. */
typedef struct guarded_scope {
  ambit_scope scope; /* first: host, scope and this share one address */
  pthread_mutex_t lock;
  ambit_pool *pools; /* those that are open */
  counted *counted;
} guarded_scope;

static void *alloc(const ambit_host *h, size_t bytes) {
  return ambit_arena_alloc(((const ambit_scope *)(const void *)h)->arena, bytes);
}

static void keep(const ambit_host *h, ambit_status status, const char *code, const char *message) {
  guarded_scope *guarded = (guarded_scope *)(uintptr_t)h;
  pthread_mutex_lock(&guarded->lock);
  ambit_fail_code(&guarded->scope.failure, status, code, "%s", message);
  pthread_mutex_unlock(&guarded->lock);
}

static ambit_status fail(const ambit_host *h, ambit_status status, const char *format, ...) {
  char message[AMBIT_MESSAGE_MAX];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  keep(h, status, NULL, message);
  return status;
}

static ambit_status fail_code(const ambit_host *h, ambit_status status, const char *code, const char *format, ...) {
  char message[AMBIT_MESSAGE_MAX];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  keep(h, status, code, message);
  return status;
}

static void note(const ambit_host *h, const char *format, ...) {
  const ambit_scope *scope = (const ambit_scope *)(const void *)h;
  if (!scope->note) return;
  char line[NOTE_MAX];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  scope->note(scope->user, line);
}

static ambit_status open_pool(const ambit_host *h, uint32_t threads, ambit_pool **pool) {
  guarded_scope *guarded = (guarded_scope *)(uintptr_t)h;
  return ambit_pool_open(&guarded->pools, threads, pool);
}

static ambit_work *open_work(const ambit_host *h) {
  if (h->alloc != alloc) return NULL; /* somebody's own host, which lends our services */
  guarded_scope *guarded = (guarded_scope *)(uintptr_t)h;
  counted *made = alloc(h, sizeof *made);
  if (!made) return NULL;
  made->next = guarded->counted;
  guarded->counted = made;
  return &made->work;
}

static const ambit_work_service work_service_v1 = { sizeof(ambit_work_service), open_work };

static const ambit_pool_service pool_service_v1 = { sizeof(ambit_pool_service), open_pool, ambit_pool_close,
  ambit_pool_run };

static const void *plain_service(const char *id) {
  if (strcmp(id, AMBIT_NUM_SERVICE) == 0) return &ambit_num_service_v1;
  if (strcmp(id, AMBIT_JET_SERVICE) == 0) return &ambit_jet_service_v1;
  if (strcmp(id, AMBIT_CONTRACT_SERVICE) == 0) return &ambit_contract_service_v1;
  if (strcmp(id, AMBIT_POOL_SERVICE) == 0) return &pool_service_v1;
  if (strcmp(id, AMBIT_WORK_SERVICE) == 0) return &work_service_v1;
  return NULL;
}

static const void *service(const ambit_host *h, const char *id) {
  (void)h;
  const void *plain = plain_service(id);
  return ambit_meter_is_on() ? ambit_metered_service(id, plain) : plain;
}

ambit_status ambit_scope_open(ambit_scope **scope, void (*sink)(void *user, const char *line), void *user) {
  *scope = NULL;
  guarded_scope *guarded = calloc(1, sizeof *guarded);
  if (!guarded) return AMBIT_NOMEM;
  guarded->scope = (ambit_scope) {
    .host = { sizeof(ambit_host), AMBIT_ABI, alloc, fail, note, service, fail_code },
    .arena = ambit_arena_open(),
    .note = sink,
    .user = user,
  };
  if (!guarded->scope.arena) {
    free(guarded);
    return AMBIT_NOMEM;
  }
  pthread_mutex_init(&guarded->lock, NULL);
  *scope = &guarded->scope;
  return AMBIT_OK;
}

void ambit_scope_close(ambit_scope *scope) {
  if (!scope) return;
  guarded_scope *guarded = (guarded_scope *)(void *)scope;
  while (guarded->pools) ambit_pool_close(guarded->pools);
  pthread_mutex_destroy(&guarded->lock);
  ambit_arena_close(scope->arena);
  free(guarded);
}

ambit_work ambit_scope_work(const ambit_scope *scope) {
  ambit_work sum = { 0 };
  if (!scope) return sum;
  for (const counted *c = ((const guarded_scope *)(const void *)scope)->counted; c; c = c->next)
    ambit_work_add(&sum, &c->work);
  sum.allocations += ambit_arena_count(scope->arena);
  sum.allocated += ambit_arena_bytes(scope->arena);
  return sum;
}
