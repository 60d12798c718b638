/* path.c -- the search path for plugins. */
#include "host/path.h"
#include "base/names.h"
#include "host/trust.h"
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define LONGEST_NAME 63

const char *const ambit_plugin_kind[AMBIT_KINDS] = { "arithmetic", "element", "solver", "service" };

static bool is_directory(const char *name) {
  struct stat about;
  return stat(name, &about) == 0 && S_ISDIR(about.st_mode);
}

static void append(ambit_path *path, const char *directory) {
  for (size_t i = 0; i < path->count; i++)
    if (strcmp(path->directory[i], directory) == 0) return;
  path->directory[path->count++] = directory;
}

static size_t count_parts(const char *list) {
  size_t n = 1;
  for (; *list; list++) n += *list == ':';
  return n;
}

/* The same folder wherever the process goes, and in records that are read elsewhere. */
static const char *absolute(ambit_arena *arena, const char *directory) {
  char here[PATH_MAX];
  if (directory[0] == '/' || !getcwd(here, sizeof here)) return directory;
  size_t bytes = strlen(here) + strlen(directory) + sizeof "/";
  char *text = ambit_arena_alloc(arena, bytes);
  if (text) snprintf(text, bytes, "%s/%s", strcmp(here, "/") == 0 ? "" : here, directory);
  return text;
}

/* Appends the nonempty parts of a colon-separated list, which is cut up in place; false: out of memory. */
static bool append_list(ambit_arena *arena, ambit_path *path, char *list) {
  for (char *rest = list; rest;) {
    const char *part = strsep(&rest, ":"), *directory = *part ? absolute(arena, part) : part;
    if (!directory) return false;
    if (*directory) append(path, directory);
  }
  return true;
}

/* The folder of Ambit's own plugins, or NULL. */
static char *find_own(ambit_arena *arena) {
  char *kernel = ambit_trust_kernel();
  char *slash = kernel ? strrchr(kernel, '/') : NULL;
  size_t bytes = slash ? (size_t)(slash - kernel) + strlen(ambit_place) + sizeof "/" : 0;
  char *text = slash ? ambit_arena_alloc(arena, bytes) : NULL;
  if (text) snprintf(text, bytes, "%.*s/%s", (int)(slash - kernel), kernel, ambit_place);
  char *real = text ? realpath(text, NULL) : NULL;
  char *own = real ? ambit_arena_text(arena, real) : NULL;
  free(real);
  free(kernel);
  return own;
}

ambit_status ambit_path_open(ambit_arena *arena, const char *given, ambit_path *path) {
  if (!given) given = getenv("AMBIT_PATH");
  if (!given) given = "";
  char *list = ambit_arena_text(arena, given);
  path->count = 0, path->own = NULL;
  path->directory = ambit_arena_alloc(arena, (count_parts(given) + 3) * sizeof *path->directory);
  if (!list || !path->directory) return AMBIT_NOMEM;
  if (!append_list(arena, path, list)) return AMBIT_NOMEM;
  const char *own = find_own(arena);
  if (own && is_directory(own)) append(path, path->own = own);
  return AMBIT_OK;
}

char *ambit_path_file(ambit_arena *arena, const char *directory, const char *kind, const char *name) {
  size_t bytes = strlen(directory) + strlen(kind) + strlen(name) + sizeof "//.so";
  char *text = ambit_arena_alloc(arena, bytes);
  if (text) snprintf(text, bytes, "%s/%s/%s.so", directory, kind, name);
  return text;
}

static bool is_name(const char *name) {
  static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.";
  size_t length = strlen(name);
  return length > 0 && length <= LONGEST_NAME && name[0] != '.' && strspn(name, letters) == length;
}

ambit_status ambit_path_check(const char *kind, const char *name, ambit_failure *f) {
  bool known = false;
  for (size_t i = 0; i < AMBIT_KINDS; i++) known = known || strcmp(kind, ambit_plugin_kind[i]) == 0;
  if (!known) {
    const char *near = ambit_names_nearest(kind, ambit_plugin_kind, AMBIT_KINDS);
    return ambit_fail(f, AMBIT_INVALID,
        "there is no kind of plugin called `%s`%s%s%s (arithmetic, element, solver, service)", kind,
        near ? "; did you mean `" : "", near ? near : "", near ? "`?" : "");
  }
  if (!is_name(name))
    return ambit_fail(f, AMBIT_INVALID,
        "`%s` cannot be the name of a plugin: letters, digits, '_', '-' and '.' (not first), at most %d of them", name,
        LONGEST_NAME);
  return AMBIT_OK;
}
