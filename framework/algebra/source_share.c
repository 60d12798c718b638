/* source_share.c -- which parts of long expressions get names of their own.
**
** Lengths are estimates, by what an operation adds at least. A part that is named counts as a name in whatever holds
** it, so no text is longer than about twice LONG, and the work is linear in the nodes.
*/
#include "algebra/source.h"
#include "graph/walk.h"
#include <stdlib.h>
#include <string.h>

#define SHORT 160u /* characters: if nothing is longer, nothing is named */
#define WORTH 24u  /* a part that is used again is named from this length on */
#define LONG 400u  /* a part is named in any case */
#define DEEP 30u   /* and if it is as deep, since parsers recurse */
#define NAME 4u

typedef struct part {
  size_t length;
  uint32_t depth, uses;
  bool named;
} part;

static size_t plus(size_t a, size_t b) { return a < SIZE_MAX - b ? a + b : SIZE_MAX; }

/* part[i] from its operands; a named operand is a name. */
static void measure(const ambit_graph *g, const ambit_walk *walk, size_t i, part *p) {
  const ambit_node *x = ambit_at(g, walk->node[i]);
  char buffer[AMBIT_LEAF_MAX];
  if (ambit_op_is_leaf(x->op)) {
    p[i].length = strlen(ambit_leaf_text(g, walk->node[i], buffer));
    p[i].depth = 0;
    return;
  }
  const part *operand[] = { &p[walk->a[i]], &p[walk->b[i]] };
  size_t length = 3, count = ambit_op_is_binary(x->op) ? 2 : 1;
  uint32_t depth = 0;
  for (size_t k = 0; k < count; k++) {
    length = plus(length, operand[k]->named ? NAME : operand[k]->length);
    if (!operand[k]->named && operand[k]->depth >= depth) depth = operand[k]->depth + 1;
  }
  p[i].length = length;
  p[i].depth = depth;
}

static bool is_worth_a_name(const ambit_graph *g, ambit_expr e, const part *p) {
  if (ambit_op_is_leaf(ambit_at(g, e)->op)) return false;
  return (p->uses > 1 && p->length >= WORTH) || p->length > LONG || p->depth > DEEP;
}

static void count_uses(const ambit_graph *g, const ambit_walk *walk, part *p) {
  for (size_t i = 0; i < walk->count; i++) {
    uint32_t op = ambit_at(g, walk->node[i])->op;
    if (ambit_op_is_leaf(op)) continue;
    p[walk->a[i]].uses++;
    if (ambit_op_is_binary(op) && walk->b[i] != walk->a[i]) p[walk->b[i]].uses++;
  }
}

/* Names what wants one. A root that nothing else uses is written where it belongs. */
static size_t name_parts(const ambit_graph *g, const ambit_walk *walk, part *p, size_t room, ambit_expr *node) {
  size_t n = 0;
  for (size_t i = 0; i < walk->count; i++) {
    measure(g, walk, i, p);
    p[i].named = p[i].uses > 0 && is_worth_a_name(g, walk->node[i], &p[i]);
    if (p[i].named && n++ < room) node[n - 1] = walk->node[i];
  }
  return n;
}

size_t ambit_source_share(const ambit_graph *g, size_t ne, const ambit_expr *e, size_t room, ambit_expr *node) {
  ambit_walk walk;
  if (!ambit_walk_open(g, ne, e, NULL, &walk)) return SIZE_MAX;
  part *p = calloc(walk.count + 1, sizeof *p);
  size_t n = p ? 0 : SIZE_MAX;
  bool any = false;
  for (size_t i = 0; i < walk.count && p; i++) {
    measure(g, &walk, i, p);
    any = any || p[i].length > SHORT;
  }
  if (p && any) {
    count_uses(g, &walk, p);
    for (size_t i = 0; i < ne; i++) { /* the same right-hand side twice */
      part *root = &p[ambit_walk_find(g, e[i])];
      for (size_t k = 0; k < i; k++)
        if (e[k] == e[i]) root->uses = 2;
    }
    n = name_parts(g, &walk, p, room, node);
  }
  free(p);
  ambit_walk_close(&walk);
  return n;
}
