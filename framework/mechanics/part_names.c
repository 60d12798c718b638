/* part_names.c -- names of parts: unique within a mechanism, found by hashing (FNV-1a). */
#include "base/vector.h"
#include "mechanics/parts.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NAME_BYTES 100
#define FIRST_TABLE 64u

static uint32_t hash(const char *text) {
  uint32_t h = 2166136261u;
  for (; *text; text++) h = (h ^ (unsigned char)*text) * 16777619u;
  return h;
}

/* Where the name is, or would be. */
static size_t find_place(const ambit_mechanism *m, const char *name) {
  size_t mask = m->names.table_size - 1, at = hash(name) & mask;
  while (m->names.table[at] != UINT32_MAX && strcmp(m->part[m->names.table[at]].name, name) != 0) at = (at + 1) & mask;
  return at;
}

static const ambit_part *find_name(const ambit_mechanism *m, const char *name) {
  uint32_t part = m->names.table_size ? m->names.table[find_place(m, name)] : UINT32_MAX;
  return part == UINT32_MAX ? NULL : &m->part[part];
}

static bool grow(ambit_mechanism *m) {
  size_t size = m->names.table_size ? 2 * m->names.table_size : FIRST_TABLE;
  uint32_t *table = malloc(size * sizeof *table);
  if (!table) return false;
  memset(table, 0xff, size * sizeof *table);
  free(m->names.table);
  m->names.table = table;
  m->names.table_size = size;
  for (uint32_t i = 0; i < m->count; i++) table[find_place(m, m->part[i].name)] = i;
  return true;
}

bool ambit_part_enter_name(ambit_mechanism *m, const ambit_part *p) {
  if (2 * (m->count + 1) > m->names.table_size && !grow(m)) return false;
  m->names.table[find_place(m, p->name)] = (uint32_t)m->count;
  return true;
}

/* beta' and beta'' are the derivatives of beta, ball'.1 is a speed of ball. */
ambit_status ambit_part_check_name(const ambit_mechanism *m, const ambit_part *p, ambit_failure *f) {
  size_t n = strlen(p->name);
  char who[AMBIT_WHO_MAX], first[AMBIT_WHO_MAX];
  ambit_part_who(p, who);
  if (n == 0) return ambit_fail(f, AMBIT_INVALID, "%s: the name is empty", who);
  if (n > NAME_BYTES) return ambit_fail(f, AMBIT_INVALID, "%s: the name is longer than %d bytes", who, NAME_BYTES);
  for (size_t i = 0; i < n; i++)
    if ((unsigned char)p->name[i] < ' ')
      return ambit_fail(f, AMBIT_INVALID, "%s: the name has a control character", who);
  if (p->name[n - 1] == '\'')
    return ambit_fail(f, AMBIT_INVALID, "%s: a name cannot end in `'`: that marks time derivatives", who);
  if (strcmp(p->name, "t") == 0) return ambit_fail(f, AMBIT_INVALID, "%s: a name cannot be `t`: that is the time", who);
  if (strstr(p->name, "'."))
    return ambit_fail(f, AMBIT_INVALID, "%s: a name cannot have `'` before a dot: that marks speeds", who);
  const ambit_part *other = find_name(m, p->name);
  if (other) return ambit_fail(f, AMBIT_INVALID, "%s: the name is taken by the %s", who, ambit_part_who(other, first));
  return AMBIT_OK;
}

/* The counter of unnamed parts of that type. */
static struct ambit_type_count *counter(ambit_mechanism *m, const char *type) {
  ambit_part_names *names = &m->names;
  for (size_t i = 0; i < names->ntype; i++)
    if (strcmp(names->type[i].type, type) == 0) return &names->type[i];
  struct ambit_type_count *grown =
      ambit_vector_reserve(names->type, &names->type_capacity, names->ntype + 1, sizeof *grown);
  if (!grown) return NULL;
  names->type = grown;
  grown[names->ntype] = (struct ambit_type_count) { ambit_arena_text(m->arena, type), 1 };
  return grown[names->ntype].type ? &grown[names->ntype++] : NULL;
}

const char *ambit_part_make_name(ambit_mechanism *m, const char *type) {
  char name[NAME_BYTES];
  struct ambit_type_count *count = counter(m, type);
  if (!count) return NULL;
  do snprintf(name, sizeof name, "%.60s%zu", type, count->next++);
  while (find_name(m, name));
  return ambit_arena_text(m->arena, name);
}
