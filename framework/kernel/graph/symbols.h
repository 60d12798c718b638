/* symbols.h -- the names of variables, each with its first unit and its place in the order of leaves.
**
** They are kept as long as the graph: a symbol that nobody holds is freed, and when its name is used again it is what
** it was. Memory grows with the number of different names only.
*/
#ifndef AMBIT_SYMBOLS_H
#define AMBIT_SYMBOLS_H
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct ambit_symbol_name {
  char *name, *unit; /* unit: may be NULL */
  uint64_t birth;
} ambit_symbol_name;

typedef struct ambit_symbols {
  ambit_symbol_name *list;
  size_t count, capacity;
  uint32_t *table; /* open addressing; UINT32_MAX = free */
  size_t table_size;
} ambit_symbols;

/* The name, entered with `unit` and the next number of *births unless it is known; NULL: out of memory. Valid until the
** next call; the texts as long as the list. */
const ambit_symbol_name *ambit_symbols_enter(
    ambit_symbols *symbols, const char *name, const char *unit, uint64_t *births);
void ambit_symbols_close(ambit_symbols *symbols);
#endif
