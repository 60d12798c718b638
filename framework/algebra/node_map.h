/* node_map.h -- a number for each of some nodes: what a search knows of them, at a cost that does not depend on how
** large the rest of the graph is.
*/
#ifndef AMBIT_NODE_MAP_H
#define AMBIT_NODE_MAP_H
#include <stddef.h>
#include <stdint.h>

typedef struct ambit_node_map { /* starts as zeros */
  struct ambit_node_entry {
    uint32_t key, value;
  } * entry;
  size_t size, count;
} ambit_node_map;

/* Where the key's value is: 0 unless it was set. Valid until the next call; NULL: out of memory. */
uint32_t *ambit_node_map_at(ambit_node_map *map, uint32_t key);
uint32_t ambit_node_map_get(const ambit_node_map *map, uint32_t key); /* 0: not set */
void ambit_node_map_close(ambit_node_map *map);
#endif
