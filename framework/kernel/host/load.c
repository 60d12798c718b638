/* load.c -- dlopen with everything checked that can be checked. */
#include "host/load.h"
#include "host/object.h"
#include "host/trust.h"
#include <dlfcn.h>
#include <elf.h>
#include <errno.h>
#include <fenv.h>
#include <link.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

bool ambit_load_struct(void *into, size_t own, size_t required, const void *theirs) {
  uint32_t size;
  memcpy(&size, theirs, sizeof size);
  memset(into, 0, own);
  if (size < required) return false;
  memcpy(into, theirs, size < own ? size : own);
  return true;
}

static ambit_status refuse(void *handle, ambit_status status) {
  dlclose(handle);
  return status;
}

/* The entry as data of at least the size of its first version; NULL: `reason` says why. */
static const void *find_entry(void *handle, char reason[AMBIT_REASON_MAX]) {
  const void *entry = dlsym(handle, "ambit_entry");
  if (!entry) {
    snprintf(reason, AMBIT_REASON_MAX, "not an Ambit plugin: it exports no `ambit_entry`");
    return NULL;
  }
  Dl_info about;
  ElfW(Sym) *symbol = NULL;
  if (!dladdr1(entry, &about, (void **)&symbol, RTLD_DL_SYMENT) || !symbol) return entry;
  if (ELF64_ST_TYPE(symbol->st_info) != STT_OBJECT || symbol->st_size < 2 * sizeof(uint32_t)) {
    snprintf(reason, AMBIT_REASON_MAX, "its `ambit_entry` is not a struct ambit_plugin");
    return NULL;
  }
  uint32_t claimed;
  memcpy(&claimed, entry, sizeof claimed);
  if (claimed > symbol->st_size) {
    snprintf(reason, AMBIT_REASON_MAX, "its `ambit_entry` says it has %u bytes, but has %zu", (unsigned)claimed,
        (size_t)symbol->st_size);
    return NULL;
  }
  return entry;
}

static ambit_status check_entry(
    const void *entry, const char *id, ambit_plugin *plugin, char reason[AMBIT_REASON_MAX]) {
  uint32_t head[2]; /* size, abi */
  memcpy(head, entry, sizeof head);
  if (head[1] >> 16 != AMBIT_ABI_MAJOR) {
    snprintf(reason, AMBIT_REASON_MAX,
        "built for version %u.%u of the plugin ABI; this Ambit has %u.%u: rebuild the plugin",
        (unsigned)(head[1] >> 16), (unsigned)(head[1] & 0xffff), (unsigned)AMBIT_ABI_MAJOR, (unsigned)AMBIT_ABI_MINOR);
    return AMBIT_INVALID;
  }
  size_t required = offsetof(ambit_plugin, get) + sizeof plugin->get;
  if (!ambit_load_struct(plugin, sizeof *plugin, required, entry)) {
    snprintf(reason, AMBIT_REASON_MAX, "its ambit_plugin says it has %u bytes, at least %zu are needed",
        (unsigned)head[0], required);
    return AMBIT_INVALID;
  }
  if (!plugin->id || !plugin->get) {
    snprintf(reason, AMBIT_REASON_MAX, "its ambit_plugin lacks `%s`", plugin->id ? "get" : "id");
    return AMBIT_INVALID;
  }
  if (id && strcmp(plugin->id, id) != 0) {
    snprintf(reason, AMBIT_REASON_MAX, "it calls itself `%.100s`, expected `%s`", plugin->id, id);
    return AMBIT_INVALID;
  }
  return AMBIT_OK;
}

/* The floating-point environment is kept: a library linked with -ffast-math sets flush-to-zero when it is loaded. */
static void *open_library(const char *file, char reason[AMBIT_REASON_MAX]) {
  fenv_t floating;
  fegetenv(&floating);
  void *handle = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  fesetenv(&floating);
  if (handle) return handle;
  const char *why = dlerror();
  snprintf(reason, AMBIT_REASON_MAX, "the loader says: %s", why ? why : "no reason");
  return NULL;
}

/* The file that was looked at is the one that is mapped: the loader opens it by its real name once more. */
static void *open_unchanged(const char *file, struct stat *about, char reason[AMBIT_REASON_MAX]) {
  struct stat after;
  if (stat(file, about) != 0) {
    snprintf(reason, AMBIT_REASON_MAX, "%s", strerror(errno));
    return NULL;
  }
  if (!ambit_trust_file(file, reason, AMBIT_REASON_MAX)) return NULL;
  void *handle = open_library(file, reason);
  if (!handle) return NULL;
  if (stat(file, &after) == 0 && ambit_trust_same(about, &after)) return handle;
  snprintf(reason, AMBIT_REASON_MAX, "it was changed while it was loaded");
  dlclose(handle);
  return NULL;
}

ambit_status ambit_load_file(const char *file, const char *id, ambit_loaded *loaded, char reason[AMBIT_REASON_MAX]) {
  /* Resolved once: a link that somebody turns elsewhere in between leads nowhere else. */
  char *real = realpath(file, NULL);
  if (!real) {
    snprintf(reason, AMBIT_REASON_MAX, "%s", errno == ENOENT ? "no such file" : strerror(errno));
    return AMBIT_INVALID;
  }
  bool good = ambit_object_check(real, reason, AMBIT_REASON_MAX);
  void *handle = good ? open_unchanged(real, &loaded->about, reason) : NULL;
  free(real);
  if (!handle) return AMBIT_INVALID;
  const void *entry = find_entry(handle, reason);
  if (!entry) return refuse(handle, AMBIT_INVALID);
  ambit_status status = check_entry(entry, id, &loaded->plugin, reason);
  if (status != AMBIT_OK) return refuse(handle, status);
  loaded->handle = handle;
  loaded->file = file;
  loaded->shadows = false;
  return AMBIT_OK;
}

/* Appends a line to the list of what was tried; a list that does not fit is cut. */
static void append(char *list, size_t room, const char *file, const char *reason) {
  size_t used = strlen(list);
  if (used + 1 < room) snprintf(list + used, room - used, "\n  %s: %s", file, reason);
}

/* "; did you mean `lohner`?", or that the name is one of another kind, or "" */
static void suggest(
    ambit_arena *arena, const ambit_path *path, const char *kind, const char *name, char *out, size_t room) {
  out[0] = '\0';
  for (size_t k = 0; k < AMBIT_KINDS; k++) {
    const char *other = ambit_path_nearest(arena, path, ambit_plugin_kind[k], name);
    if (other && strcmp(other, name) == 0 && strcmp(ambit_plugin_kind[k], kind) != 0) {
      snprintf(out, room, " (there is a plugin of that name, of kind %s)", ambit_plugin_kind[k]);
      return;
    }
  }
  const char *near = ambit_path_nearest(arena, path, kind, name);
  if (near) snprintf(out, room, " (did you mean `%s`?)", near);
}

/* Ambit's own file of that kind and name, if `file` is another; NULL. */
static const char *find_shadowed(
    ambit_arena *arena, const ambit_path *path, const char *kind, const char *name, const char *file) {
  struct stat own, other;
  const char *shadowed = path->own ? ambit_path_file(arena, path->own, kind, name) : NULL;
  if (!shadowed || stat(shadowed, &own) != 0 || stat(file, &other) != 0) return NULL;
  return own.st_dev == other.st_dev && own.st_ino == other.st_ino ? NULL : shadowed;
}

ambit_status ambit_load_named(ambit_arena *arena, const ambit_path *path, const char *kind, const char *name,
    ambit_loaded *loaded, ambit_failure *f) {
  ambit_status status = ambit_path_check(kind, name, f);
  if (status != AMBIT_OK) return status;
  char id[96], tried[AMBIT_MESSAGE_MAX] = "", reason[AMBIT_REASON_MAX];
  snprintf(id, sizeof id, "%s.%s", kind, name);
  for (size_t i = 0; i < path->count; i++) {
    const char *file = ambit_path_file(arena, path->directory[i], kind, name);
    if (!file) return ambit_no_memory(f);
    const char *shadowed = find_shadowed(arena, path, kind, name, file);
    if (shadowed && !ambit_trust_has_shadows())
      return ambit_fail(f, AMBIT_INVALID,
          "%s plugin `%s`: %s would take the place of Ambit's own %s; give it another name, or allow it "
          "(--allow-shadow)",
          kind, name, file, shadowed);
    status = ambit_load_file(file, id, loaded, reason);
    loaded->shadows = shadowed != NULL;
    if (status == AMBIT_OK) return AMBIT_OK;
    append(tried, sizeof tried, file, reason);
    if (access(file, F_OK) == 0) return ambit_fail(f, status, "cannot use %s plugin `%s`:%s", kind, name, tried);
  }
  char hint[160];
  suggest(arena, path, kind, name, hint, sizeof hint);
  return ambit_fail(f, AMBIT_INVALID, "there is no %s plugin `%s`%s; tried:%s", kind, name, hint, tried);
}
