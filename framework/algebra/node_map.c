/* node_map.c -- open addressing with linear probing. A key that was only looked at takes room like one that was set;
** what is asked by get takes none.
*/
#include "algebra/node_map.h"
#include <stdlib.h>

#define FIRST_SIZE 256u
#define FREE UINT32_MAX /* no node has this number */

static size_t start_of(const ambit_node_map *map, uint32_t key) {
  return (size_t)((uint64_t)key * 0x9e3779b97f4a7c15u >> 32) & (map->size - 1);
}

static size_t find(const ambit_node_map *map, uint32_t key) {
  size_t at = start_of(map, key);
  while (map->entry[at].key != key && map->entry[at].key != FREE) at = (at + 1) & (map->size - 1);
  return at;
}

static int grow(ambit_node_map *map) {
  ambit_node_map larger = { .size = map->size ? 2 * map->size : FIRST_SIZE, .count = map->count };
  larger.entry = malloc(larger.size * sizeof *larger.entry);
  if (!larger.entry) return 0;
  for (size_t i = 0; i < larger.size; i++) larger.entry[i] = (struct ambit_node_entry) { FREE, 0 };
  for (size_t i = 0; i < map->size; i++)
    if (map->entry[i].key != FREE) larger.entry[find(&larger, map->entry[i].key)] = map->entry[i];
  free(map->entry);
  *map = larger;
  return 1;
}

uint32_t *ambit_node_map_at(ambit_node_map *map, uint32_t key) {
  if (2 * (map->count + 1) > map->size && !grow(map)) return NULL;
  struct ambit_node_entry *entry = &map->entry[find(map, key)];
  if (entry->key == FREE) {
    entry->key = key;
    map->count++;
  }
  return &entry->value;
}

uint32_t ambit_node_map_get(const ambit_node_map *map, uint32_t key) {
  return map->size ? map->entry[find(map, key)].value : 0;
}

void ambit_node_map_close(ambit_node_map *map) {
  free(map->entry);
  *map = (ambit_node_map) { 0 };
}
