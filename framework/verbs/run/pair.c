/* pair.c -- arithmetic and solver, refused by name when they do not fit. */
#include "verbs/run/pair.h"
#include "models/default.h"
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Copies the next blank-separated word; returns what follows, NULL at the end. */
static const char *next_word(const char *list, char word[AMBIT_NAME_MAX]) {
  list += strspn(list, " ");
  size_t length = strcspn(list, " ");
  if (length == 0) return NULL;
  snprintf(word, AMBIT_NAME_MAX, "%.*s", (int)length, list);
  return list + length;
}

static bool is_listed(const char *list, const char *name) {
  char word[AMBIT_NAME_MAX];
  while ((list = next_word(list, word)))
    if (strcmp(word, name) == 0) return true;
  return false;
}

/* The names of all rigorous arithmetics, blank-separated; only for a message, so that loading them costs nothing
** that matters. */
static void list_rigorous(ambit_registry *r, char *out, size_t room) {
  out[0] = '\0';
  size_t n = ambit_registry_list(r, 0, NULL), used = 0;
  ambit_listing *list = calloc(n + 1, sizeof *list);
  if (!list) return;
  n = ambit_registry_list(r, n, list);
  for (size_t i = 0; i < n && used < room; i++) {
    const ambit_arithmetic *a;
    ambit_failure ignored = { 0 };
    if (strcmp(list[i].kind, "arithmetic") != 0) continue;
    if (ambit_registry_arithmetic(r, list[i].name, &a, &ignored) != AMBIT_OK || !a->rigorous) continue;
    used += (size_t)snprintf(out + used, room - used, "%s%s", used ? " " : "", list[i].name);
  }
  free(list);
}

static ambit_status refuse(ambit_registry *r, ambit_method m, const char *name, ambit_failure *f) {
  char fitting[512];
  if (m.arithmetics)
    snprintf(fitting, sizeof fitting, "%s", m.arithmetics);
  else
    list_rigorous(r, fitting, sizeof fitting);
  if (m.arithmetics && !strchr(m.arithmetics, ' '))
    return ambit_fail(f, AMBIT_INVALID,
        "solver `%s` does not work with arithmetic `%s`: it always computes in `%s`, so that another one would have no "
        "effect",
        m.name, name, fitting);
  return ambit_fail(f, AMBIT_INVALID, "solver `%s` does not work with arithmetic `%s`%s; what fits: %s", m.name, name,
      m.needs_rigorous ? " (it proves its results)" : "", fitting[0] ? fitting : "none that is installed");
}

ambit_status ambit_pair_choose(
    ambit_registry *r, ambit_method m, const char *wanted, char name[AMBIT_NAME_MAX], ambit_failure *f) {
  snprintf(name, AMBIT_NAME_MAX, "%s", wanted ? wanted : AMBIT_DEFAULT_RANGES);
  if (!wanted && m.arithmetics) next_word(m.arithmetics, name);
  const ambit_arithmetic *a;
  ambit_status status = ambit_registry_arithmetic(r, name, &a, f);
  if (status != AMBIT_OK) return status;
  bool fits = !m.arithmetics || is_listed(m.arithmetics, name);
  if (m.needs_rigorous || !m.arithmetics) fits = fits && a->rigorous;
  return fits ? AMBIT_OK : refuse(r, m, name, f);
}

/* -- the interfaces of solvers */

static const struct {
  const char *id, *does, *need;
} task[] = { { AMBIT_SOLVER, "advances in time", "advance in time" },
  { AMBIT_ROOT_FINDER, "finds roots", "find roots" },
  { AMBIT_STRATEGY, "chooses what a model may leave out", "choose what a model may leave out" } };
enum { TASKS = sizeof task / sizeof *task };

/* The names of installed solvers with this interface; only for a message. */
static void list_offering(ambit_registry *r, const char *interface, char *out, size_t room) {
  size_t n = ambit_registry_list(r, 0, NULL), used = 0;
  ambit_listing *list = calloc(n + 1, sizeof *list);
  snprintf(out, room, "none that is installed");
  if (!list) return;
  n = ambit_registry_list(r, n, list);
  for (size_t i = 0; i < n && used < room; i++) {
    const ambit_plugin *p;
    ambit_failure ignored = { 0 };
    if (strcmp(list[i].kind, "solver") != 0) continue;
    if (ambit_registry_plugin(r, "solver", list[i].name, &p, &ignored) != AMBIT_OK || !p->get(interface)) continue;
    used += (size_t)snprintf(out + used, room - used, "%s`%s`", used ? ", " : "", list[i].name);
  }
  free(list);
}

ambit_status ambit_pair_offers(ambit_registry *r, const char *name, const char *interface, ambit_failure *f) {
  const ambit_plugin *p;
  const char *does = NULL, *need = "serve here";
  ambit_status status = ambit_registry_plugin(r, "solver", name, &p, f);
  if (status != AMBIT_OK || p->get(interface)) return status;
  for (size_t i = 0; i < TASKS; i++) {
    if (strcmp(task[i].id, interface) == 0) need = task[i].need;
    if (!does && p->get(task[i].id)) does = task[i].does;
  }
  if (!does) return AMBIT_OK; /* the registry says what it lacks */
  char fitting[256];
  list_offering(r, interface, fitting, sizeof fitting);
  return ambit_fail(f, AMBIT_INVALID, "solver `%s` %s; it does not %s; what does: %s", name, does, need, fitting);
}
