/* symbols.c -- a list of names and a table of places in it. */
#include "graph/symbols.h"
#include "base/vector.h"
#include <stdlib.h>
#include <string.h>

#define FIRST_TABLE 64u
#define FREE UINT32_MAX

static uint64_t hash_of(const char *name) { /* FNV-1a */
  uint64_t h = 0xcbf29ce484222325u;
  for (const char *c = name; *c; c++) h = (h ^ (unsigned char)*c) * 0x100000001b3u;
  return h ^ h >> 32;
}

/* Where the name is, or would be. */
static size_t find(const ambit_symbols *s, const char *name) {
  size_t at = hash_of(name) & (s->table_size - 1);
  while (s->table[at] != FREE && strcmp(s->list[s->table[at]].name, name) != 0) at = (at + 1) & (s->table_size - 1);
  return at;
}

static bool grow(ambit_symbols *s) {
  size_t size = s->table_size ? 2 * s->table_size : FIRST_TABLE;
  uint32_t *table = malloc(size * sizeof *table);
  if (!table) return false;
  free(s->table);
  s->table = table;
  s->table_size = size;
  memset(table, 0xff, size * sizeof *table);
  for (size_t i = 0; i < s->count; i++) table[find(s, s->list[i].name)] = (uint32_t)i;
  return true;
}

const ambit_symbol_name *ambit_symbols_enter(ambit_symbols *s, const char *name, const char *unit, uint64_t *births) {
  if (2 * (s->count + 1) > s->table_size && !grow(s)) return NULL;
  size_t at = find(s, name);
  if (s->table[at] != FREE) return &s->list[s->table[at]];
  ambit_symbol_name *list = ambit_vector_reserve(s->list, &s->capacity, s->count + 1, sizeof *list);
  if (!list) return NULL;
  s->list = list;
  ambit_symbol_name entry = { strdup(name), unit ? strdup(unit) : NULL, *births + 1 };
  if (!entry.name || (unit && !entry.unit)) {
    free(entry.name);
    free(entry.unit);
    return NULL;
  }
  ++*births;
  s->table[at] = (uint32_t)s->count;
  list[s->count] = entry;
  return &list[s->count++];
}

void ambit_symbols_close(ambit_symbols *s) {
  for (size_t i = 0; i < s->count; i++) {
    free(s->list[i].name);
    free(s->list[i].unit);
  }
  free(s->list);
  free(s->table);
  *s = (ambit_symbols) { 0 };
}
