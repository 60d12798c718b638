/* walk.h -- the nodes below some expressions, operands first, without recursion. */
#ifndef AMBIT_WALK_H
#define AMBIT_WALK_H
#include "graph/store.h"

typedef struct ambit_walk {
  size_t count;
  ambit_expr *node; /* [count] operands precede */
  uint32_t *a, *b;  /* [count] positions of the operands; leaves: own position; b == a when unary or POWN */
} ambit_walk;

ambit_marks *ambit_marks_open(void);
void ambit_marks_close(ambit_marks *marks);

/* Does the walk treat e as a leaf? */
typedef bool (*ambit_walk_stop)(const ambit_graph *g, ambit_expr e);

/* Everything that e[0..ne) reach. stop: NULL, or where not to go deeper. False: out of memory, nothing to close. */
bool ambit_walk_open(const ambit_graph *g, size_t ne, const ambit_expr *e, ambit_walk_stop stop, ambit_walk *walk);
void ambit_walk_close(ambit_walk *walk);
/* Position of e in the newest walk over this graph; UINT32_MAX: not reached. */
uint32_t ambit_walk_find(const ambit_graph *g, ambit_expr e);
#endif
