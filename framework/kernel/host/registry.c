/* registry.c -- loaded plugins and the kernel's completed copies of their interfaces. */
#include <ambit/registry.h>
#include <ambit/arena.h>
#include "base/meter.h"
#include "graph/interpreter.h"
#include "host/load.h"
#include "host/metered.h"
#include "host/slow.h"
#include <dlfcn.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* One loaded plugin; each interface is copied when it is first asked for. */
typedef struct entry {
  struct entry *next;
  const char *kind, *name; /* NULL when loaded by file */
  ambit_loaded loaded;
  const ambit_arithmetic *arithmetic;
  ambit_element *element;
  ambit_solver *solver;
  ambit_root_finder *root_finder;
  ambit_strategy *strategy;
  ambit_exports *exports;
} entry;

struct ambit_registry {
  ambit_arena *arena;
  ambit_arena *listed; /* texts of the newest listing */
  ambit_path path;
  entry *first; /* the latest */
  size_t count;
  void (*note)(void *user, const char *line);
  void *user;
};

ambit_registry *ambit_registry_open(const char *path) {
  ambit_registry *r = calloc(1, sizeof *r);
  if (!r) return NULL;
  r->arena = ambit_arena_open();
  if (!r->arena || ambit_path_open(r->arena, path, &r->path) != AMBIT_OK) {
    ambit_arena_close(r->arena);
    free(r);
    return NULL;
  }
  ambit_slow_offer(r, path);
  return r;
}

void ambit_registry_close(ambit_registry *r) {
  if (!r) return;
  ambit_slow_withdraw(r);
  for (entry *e = r->first; e; e = e->next) dlclose(e->loaded.handle);
  ambit_arena_close(r->listed);
  ambit_arena_close(r->arena);
  free(r);
}

void ambit_registry_set_note(ambit_registry *r, void (*note)(void *user, const char *line), void *user) {
  r->note = note;
  r->user = user;
}

void ambit_registry_note(ambit_registry *r, const char *line) {
  if (r->note) r->note(r->user, line);
}

static entry *find_named(const ambit_registry *r, const char *kind, const char *name) {
  for (entry *e = r->first; e; e = e->next)
    if (e->kind && strcmp(e->kind, kind) == 0 && strcmp(e->name, name) == 0) return e;
  return NULL;
}

/* Puts a loaded plugin on the list. */
static entry *keep(ambit_registry *r, const ambit_loaded *loaded, const char *kind, const char *name) {
  entry *e = ambit_arena_alloc(r->arena, sizeof *e);
  if (!e) return NULL;
  *e = (entry) { .next = r->first, .loaded = *loaded };
  if (kind) {
    e->kind = ambit_arena_text(r->arena, kind);
    e->name = ambit_arena_text(r->arena, name);
    if (!e->kind || !e->name) return NULL;
  }
  r->first = e;
  r->count++;
  return e;
}

static ambit_status load(ambit_registry *r, const char *kind, const char *name, entry **e, ambit_failure *f) {
  *e = find_named(r, kind, name);
  if (*e) return AMBIT_OK;
  ambit_loaded loaded;
  ambit_meter_enter(AMBIT_FRAME_LOAD, name);
  ambit_status status = ambit_load_named(r->arena, &r->path, kind, name, &loaded, f);
  ambit_meter_leave();
  if (status != AMBIT_OK) return status;
  *e = keep(r, &loaded, kind, name);
  if (*e) return AMBIT_OK;
  dlclose(loaded.handle);
  return ambit_no_memory(f);
}

ambit_status ambit_registry_plugin(
    ambit_registry *r, const char *kind, const char *name, const ambit_plugin **p, ambit_failure *f) {
  entry *e;
  *p = NULL;
  ambit_status status = load(r, kind, name, &e, f);
  if (status == AMBIT_OK) *p = &e->loaded.plugin;
  return status;
}

/* "solver.lohner" -> its kind and name in `id`, cut there; false: it is no such thing. */
static bool split_id(char *id, const char **kind, const char **name) {
  ambit_failure ignored = { 0 };
  char *dot = strchr(id, '.');
  if (!dot) return false;
  *dot = '\0';
  *kind = id, *name = dot + 1;
  return ambit_path_check(*kind, *name, &ignored) == AMBIT_OK;
}

ambit_status ambit_registry_load_file(ambit_registry *r, const char *file, const ambit_plugin **p, ambit_failure *f) {
  *p = NULL;
  char reason[AMBIT_REASON_MAX];
  ambit_loaded loaded;
  const char *kept_name = ambit_arena_text(r->arena, file);
  if (!kept_name) return ambit_no_memory(f);
  ambit_status status = ambit_load_file(kept_name, NULL, &loaded, reason);
  if (status != AMBIT_OK) return ambit_fail(f, status, "cannot use %s: %s", file, reason);
  char *id = ambit_arena_text(r->arena, loaded.plugin.id);
  const char *kind = NULL, *name = NULL;
  bool named = id && split_id(id, &kind, &name);
  entry *e = id ? keep(r, &loaded, named ? kind : NULL, name) : NULL;
  if (!e) {
    dlclose(loaded.handle);
    return ambit_no_memory(f);
  }
  *p = &e->loaded.plugin;
  return AMBIT_OK;
}

/* The kernel's zero-extended copy of the interface `id` of a plugin. */
static ambit_status copy_interface(
    ambit_registry *r, const entry *e, const char *id, size_t own, size_t required, void **copy, ambit_failure *f) {
  const void *theirs = e->loaded.plugin.get(id);
  if (!theirs)
    return ambit_fail(f, AMBIT_INVALID, "plugin `%s` (%s) does not offer the interface `%s`", e->loaded.plugin.id,
        e->loaded.file, id);
  *copy = ambit_arena_alloc(r->arena, own);
  if (!*copy) return ambit_no_memory(f);
  if (!ambit_load_struct(*copy, own, required, theirs)) {
    uint32_t size;
    memcpy(&size, theirs, sizeof size);
    return ambit_fail(f, AMBIT_INVALID, "plugin `%s` (%s): its `%s` says it has %u bytes, at least %zu are needed",
        e->loaded.plugin.id, e->loaded.file, id, (unsigned)size, required);
  }
  return AMBIT_OK;
}

static ambit_status lacks(const entry *e, const char *id, const char *member, ambit_failure *f) {
  return ambit_fail(
      f, AMBIT_INVALID, "plugin `%s` (%s): its `%s` lacks `%s`", e->loaded.plugin.id, e->loaded.file, id, member);
}

#define UPTO(type, member) (offsetof(type, member) + sizeof(((type *)0)->member))

/* The optional jets of an arithmetic carry a size of their own. */
static ambit_status copy_jets(ambit_registry *r, const entry *e, ambit_arithmetic *a, ambit_failure *f) {
  if (!a->jets) return AMBIT_OK;
  ambit_jets *jets = ambit_arena_alloc(r->arena, sizeof *jets);
  if (!jets) return ambit_no_memory(f);
  if (!ambit_load_struct(jets, sizeof *jets, UPTO(ambit_jets, magnitude), a->jets) || !jets->open || !jets->close ||
      !jets->put || !jets->advance || !jets->get || !jets->magnitude)
    return lacks(e, AMBIT_ARITHMETIC, "jets (complete)", f);
  a->jets = jets;
  return AMBIT_OK;
}

static ambit_status make_arithmetic(ambit_registry *r, entry *e, ambit_failure *f) {
  void *copy = NULL;
  ambit_status status =
      copy_interface(r, e, AMBIT_ARITHMETIC, sizeof(ambit_arithmetic), UPTO(ambit_arithmetic, bounds), &copy, f);
  if (status != AMBIT_OK) return status;
  ambit_arithmetic *a = copy;
  if (!a->elem || !a->set || !a->bounds)
    return lacks(e, AMBIT_ARITHMETIC, !a->elem ? "elem" : !a->set ? "set" : "bounds", f);
  status = copy_jets(r, e, a, f);
  if (status != AMBIT_OK) return status;
  ambit_arithmetic *full = ambit_arena_alloc(r->arena, sizeof *full);
  if (!full) return ambit_no_memory(f);
  status = ambit_arithmetic_complete(a, full, f);
  if (status != AMBIT_OK) return status;
  full->fault = ambit_arena_alloc(r->arena, sizeof *full->fault);
  if (!full->fault) return ambit_no_memory(f);
  *full->fault = (ambit_fault) { 0 };
  const ambit_arithmetic *lent =
      ambit_meter_is_on() ? ambit_metered_arithmetic(r->arena, full, e->name ? e->name : e->loaded.plugin.id) : full;
  if (!lent) return ambit_no_memory(f);
  e->arithmetic = lent;
  return AMBIT_OK;
}

static ambit_status make_element(ambit_registry *r, entry *e, ambit_failure *f) {
  void *copy = NULL;
  ambit_status status =
      copy_interface(r, e, AMBIT_ELEMENT, sizeof(ambit_element), UPTO(ambit_element, express), &copy, f);
  if (status != AMBIT_OK) return status;
  ambit_element *element = copy;
  if (!element->express) return lacks(e, AMBIT_ELEMENT, "express", f);
  if (element->nport && !element->port) return lacks(e, AMBIT_ELEMENT, "port", f);
  e->element = element;
  return AMBIT_OK;
}

/* The three interfaces of solvers have these members in common, and begin alike. */
#define MAKE(type, id, member)                                                                                         \
  static ambit_status make_##member(ambit_registry *r, entry *e, ambit_failure *f) {                                   \
    void *copy = NULL;                                                                                                 \
    ambit_status status = copy_interface(r, e, id, sizeof(type), UPTO(type, close), &copy, f);                         \
    if (status != AMBIT_OK) return status;                                                                             \
    type *s = copy;                                                                                                    \
    if (!s->open || !s->run || !s->close) return lacks(e, id, !s->open ? "open" : !s->run ? "run" : "close", f);       \
    e->member = s;                                                                                                     \
    return AMBIT_OK;                                                                                                   \
  }
MAKE(ambit_solver, AMBIT_SOLVER, solver)
MAKE(ambit_root_finder, AMBIT_ROOT_FINDER, root_finder)
MAKE(ambit_strategy, AMBIT_STRATEGY, strategy)

ambit_status ambit_registry_arithmetic(
    ambit_registry *r, const char *name, const ambit_arithmetic **a, ambit_failure *f) {
  entry *e;
  *a = NULL;
  ambit_status status = load(r, "arithmetic", name, &e, f);
  if (status == AMBIT_OK && !e->arithmetic) status = make_arithmetic(r, e, f);
  if (status == AMBIT_OK) *a = e->arithmetic;
  return status;
}

ambit_status ambit_registry_element(
    ambit_registry *r, const char *name, const ambit_element **element, ambit_failure *f) {
  entry *e;
  *element = NULL;
  ambit_status status = load(r, "element", name, &e, f);
  if (status == AMBIT_OK && !e->element) status = make_element(r, e, f);
  if (status == AMBIT_OK) *element = e->element;
  return status;
}

#define LEND(r, name, member, s, f)                                                                                    \
  entry *e;                                                                                                            \
  *(s) = NULL;                                                                                                         \
  ambit_status status = load(r, "solver", name, &e, f);                                                                \
  if (status == AMBIT_OK && !e->member) status = make_##member(r, e, f);                                               \
  if (status == AMBIT_OK) *(s) = e->member;                                                                            \
  return status

ambit_status ambit_registry_solver(ambit_registry *r, const char *name, const ambit_solver **s, ambit_failure *f) {
  LEND(r, name, solver, s, f);
}

ambit_status ambit_registry_root_finder(
    ambit_registry *r, const char *name, const ambit_root_finder **s, ambit_failure *f) {
  LEND(r, name, root_finder, s, f);
}

ambit_status ambit_registry_strategy(ambit_registry *r, const char *name, const ambit_strategy **s, ambit_failure *f) {
  LEND(r, name, strategy, s, f);
}

ambit_status ambit_registry_exports(
    ambit_registry *r, const ambit_plugin *p, const ambit_exports **exports, ambit_failure *f) {
  *exports = NULL;
  entry *e = r->first;
  while (e && &e->loaded.plugin != p) e = e->next;
  if (!e) return ambit_fail(f, AMBIT_INVALID, "the plugin was not loaded by this registry");
  if (!e->exports && p->get(AMBIT_EXPORTS)) {
    void *copy = NULL;
    ambit_status status =
        copy_interface(r, e, AMBIT_EXPORTS, sizeof(ambit_exports), UPTO(ambit_exports, function), &copy, f);
    if (status != AMBIT_OK) return status;
    ambit_exports *made = copy;
    if (made->count && !made->function) return lacks(e, AMBIT_EXPORTS, "function", f);
    e->exports = made;
  }
  *exports = e->exports;
  return AMBIT_OK;
}

size_t ambit_registry_count(const ambit_registry *r) { return r->count; }

const ambit_loaded *ambit_registry_loaded(const ambit_registry *r, size_t i, const char **kind, const char **name) {
  const entry *e = r->first;
  for (size_t k = r->count; k > i + 1; k--) e = e->next;
  *kind = e->kind ? e->kind : "";
  *name = e->name ? e->name : e->loaded.plugin.id;
  return &e->loaded;
}

size_t ambit_registry_list(ambit_registry *r, size_t room, ambit_listing *out) {
  size_t n = 0;
  ambit_arena *arena = ambit_arena_open();
  for (size_t k = 0; k < AMBIT_KINDS && arena; k++) {
    ambit_found *found;
    size_t count = ambit_path_list(arena, &r->path, ambit_plugin_kind[k], &found);
    for (size_t i = 0; i < count; i++, n++) {
      if (n >= room) continue;
      out[n] = (ambit_listing) { ambit_plugin_kind[k], found[i].name, found[i].file,
        find_named(r, ambit_plugin_kind[k], found[i].name) != NULL };
    }
  }
  ambit_arena *unused = room ? r->listed : arena;
  if (room) r->listed = arena;
  ambit_arena_close(unused);
  return n;
}
