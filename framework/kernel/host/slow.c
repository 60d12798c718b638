/* slow.c -- loads service/elementary at the first call, from whichever thread makes it.
**
** The one piece of process-wide state in the kernel: a function pointer of num/elementary.h, which has no context,
** stands for a library that is pure code. A mutex guards the loading; the calls themselves take no lock. */
#include "host/slow.h"
#include "host/load.h"
#include "num/elementary.h"
#include <ambit/elementary.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static ambit_registry *owner; /* whose notes tell of a failure; may be NULL */
static char *search;          /* its path; NULL: the default one */
static ambit_elementary_point loaded_point;
static ambit_loaded plugin; /* whose it is */

static ambit_elementary_point point_of(const ambit_plugin *entry, ambit_failure *f) {
  const void *theirs = entry->get(AMBIT_ELEMENTARY_SERVICE);
  ambit_elementary_service service;
  if (theirs && ambit_load_struct(&service, sizeof service, sizeof service, theirs) && service.point)
    return service.point;
  ambit_fail(f, AMBIT_INVALID, "service plugin `elementary` does not offer `%s`", AMBIT_ELEMENTARY_SERVICE);
  return NULL;
}

/* Under the lock. The plugin is never unloaded, see slow.h, so its file name is kept too. */
static ambit_elementary_point load(ambit_failure *f) {
  ambit_arena *arena = ambit_arena_open();
  ambit_path path;
  ambit_elementary_point point = NULL;
  if (!arena || ambit_path_open(arena, search, &path) != AMBIT_OK)
    ambit_no_memory(f);
  else if (ambit_load_named(arena, &path, "service", "elementary", &plugin, f) == AMBIT_OK)
    point = point_of(&plugin.plugin, f);
  if (point) plugin.file = strdup(plugin.file);
  ambit_arena_close(arena);
  return point;
}

const ambit_loaded *ambit_slow_loaded(void) {
  pthread_mutex_lock(&lock);
  const ambit_loaded *found = loaded_point && plugin.file ? &plugin : NULL;
  pthread_mutex_unlock(&lock);
  return found;
}

static void note_failure(const ambit_failure *f) {
  char line[AMBIT_MESSAGE_MAX + 128];
  snprintf(
      line, sizeof line, "some elementary functions of huge arguments are bounded only by their range: %s", f->message);
  if (owner) ambit_registry_note(owner, line);
}

static ambit_fault fault;

/* What the plugin gives, if it is an enclosure. */
static void checked(uint32_t op, double x, double y, double *lo, double *hi) {
  loaded_point(op, x, y, lo, hi);
  if (*lo <= *hi) return;
  if (!__atomic_exchange_n(&fault.seen, 1, __ATOMIC_RELAXED)) fault.lo = *lo, fault.hi = *hi;
  ambit_elementary_coarse(op, x, y, lo, hi);
}

ambit_status ambit_slow_sound(ambit_failure *f) {
  if (!fault.seen) return AMBIT_OK;
  return ambit_fail(
      f, AMBIT_BROKEN, "service `elementary` is broken: it gave the bounds [%.17g, %.17g]", fault.lo, fault.hi);
}

static void first_call(uint32_t op, double x, double y, double *lo, double *hi) {
  ambit_failure f = { 0 };
  pthread_mutex_lock(&lock);
  if (!loaded_point) loaded_point = load(&f);
  bool found = loaded_point != NULL;
  ambit_elementary_point point = found ? checked : ambit_elementary_coarse;
  ambit_elementary_set_slow(point); /* before the note, whose receiver may compute */
  if (!found) note_failure(&f);
  pthread_mutex_unlock(&lock);
  point(op, x, y, lo, hi);
}

void ambit_slow_offer(ambit_registry *r, const char *path) {
  pthread_mutex_lock(&lock);
  owner = r;
  free(search);
  search = path ? strdup(path) : NULL;
  if (!loaded_point) ambit_elementary_set_slow(first_call);
  pthread_mutex_unlock(&lock);
}

void ambit_slow_withdraw(ambit_registry *r) {
  pthread_mutex_lock(&lock);
  if (owner == r) owner = NULL;
  pthread_mutex_unlock(&lock);
}
