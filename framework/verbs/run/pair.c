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

static ambit_status refuse(
    ambit_registry *r, const char *solver_name, const ambit_solver *solver, const char *name, ambit_failure *f) {
  char fitting[512];
  if (solver->arithmetics)
    snprintf(fitting, sizeof fitting, "%s", solver->arithmetics);
  else
    list_rigorous(r, fitting, sizeof fitting);
  if (solver->arithmetics && !strchr(solver->arithmetics, ' '))
    return ambit_fail(f, AMBIT_INVALID,
        "solver `%s` does not work with arithmetic `%s`: it always computes in `%s`, so that another one would have no "
        "effect",
        solver_name, name, fitting);
  return ambit_fail(f, AMBIT_INVALID, "solver `%s` does not work with arithmetic `%s`%s; what fits: %s", solver_name,
      name, solver->needs_rigorous ? " (it proves its results)" : "", fitting[0] ? fitting : "none that is installed");
}

ambit_status ambit_pair_choose(ambit_registry *r, const char *solver_name, const ambit_solver *solver,
    const char *wanted, char name[AMBIT_NAME_MAX], ambit_failure *f) {
  snprintf(name, AMBIT_NAME_MAX, "%s", wanted ? wanted : AMBIT_DEFAULT_RANGES);
  if (!wanted && solver->arithmetics) next_word(solver->arithmetics, name);
  const ambit_arithmetic *a;
  ambit_status status = ambit_registry_arithmetic(r, name, &a, f);
  if (status != AMBIT_OK) return status;
  bool fits = !solver->arithmetics || is_listed(solver->arithmetics, name);
  if (solver->needs_rigorous || !solver->arithmetics) fits = fits && a->rigorous;
  return fits ? AMBIT_OK : refuse(r, solver_name, solver, name, f);
}
