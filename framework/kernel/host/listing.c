/* listing.c -- which plugins are there, by file name. */
#include "base/names.h"
#include "host/path.h"
#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* "lohner.so" -> "lohner" in the arena; NULL if the file is none of ours. */
static char *plugin_name(ambit_arena *arena, const char *file) {
  size_t length = strlen(file);
  if (length <= 3 || file[0] == '.' || strcmp(file + length - 3, ".so") != 0) return NULL;
  char *name = ambit_arena_text(arena, file);
  if (name) name[length - 3] = '\0';
  return name;
}

static DIR *open_kind(const char *directory, const char *kind) {
  size_t bytes = strlen(directory) + strlen(kind) + sizeof "/";
  char *place = malloc(bytes);
  if (!place) return NULL;
  snprintf(place, bytes, "%s/%s", directory, kind);
  DIR *open = opendir(place);
  free(place);
  return open;
}

static int by_name(const void *a, const void *b) {
  return strcmp(((const ambit_found *)a)->name, ((const ambit_found *)b)->name);
}

static size_t count_entries(const ambit_path *path, const char *kind) {
  size_t n = 0;
  for (size_t i = 0; i < path->count; i++) {
    DIR *d = open_kind(path->directory[i], kind);
    if (!d) continue;
    while (readdir(d)) n++;
    closedir(d);
  }
  return n;
}

static bool is_known(const ambit_found *list, size_t n, const char *name) {
  for (size_t i = 0; i < n; i++)
    if (strcmp(list[i].name, name) == 0) return true;
  return false;
}

/* Appends the new names of one directory, at most `room` in all. */
static size_t list_directory(
    ambit_arena *arena, const char *directory, const char *kind, ambit_found *list, size_t n, size_t room) {
  DIR *d = open_kind(directory, kind);
  if (!d) return n;
  for (struct dirent *entry; n < room && (entry = readdir(d));) {
    char *name = plugin_name(arena, entry->d_name);
    if (!name || is_known(list, n, name)) continue;
    list[n] = (ambit_found) { name, ambit_path_file(arena, directory, kind, name) };
    if (list[n].file) n++;
  }
  closedir(d);
  return n;
}

size_t ambit_path_list(ambit_arena *arena, const ambit_path *path, const char *kind, ambit_found **found) {
  size_t room = count_entries(path, kind), n = 0;
  *found = room ? ambit_arena_alloc(arena, room * sizeof **found) : NULL;
  if (!*found) return 0;
  for (size_t i = 0; i < path->count; i++) n = list_directory(arena, path->directory[i], kind, *found, n, room);
  qsort(*found, n, sizeof **found, by_name);
  return n;
}

const char *ambit_path_nearest(ambit_arena *arena, const ambit_path *path, const char *kind, const char *name) {
  ambit_found *list;
  size_t n = ambit_path_list(arena, path, kind, &list);
  const char **names = n ? ambit_arena_alloc(arena, n * sizeof *names) : NULL;
  if (!names) return NULL;
  for (size_t i = 0; i < n; i++) names[i] = list[i].name;
  return ambit_names_nearest(name, names, n);
}
