/* graph.c -- hash-consed nodes in one growing array, found by open addressing; leaves.
**
** A node's range is the kernel's interval function over its operands' ranges, so by induction it holds for all real
** values of the leaves at which the node is defined; the node is total if its operands are and the interval function
** saw no point outside the domain. A constant whose enclosure is not a point and that has no literal is a new node at
** each call: two enclosures that look alike may stand for different numbers. Literals are the numbers they spell, so
** equal text is an equal node.
*/
#include "graph/graph.h"
#include "base/vector.h"
#include "graph/fold.h"
#include "graph/store.h"
#include "graph/walk.h"
#include "num/decimal.h"
#include <float.h>
#include <stdlib.h>
#include <string.h>

#define FIRST_TABLE 1024u
#define ANGLES_MAX 255u

static uint64_t mix(uint64_t h, uint64_t word) {
  h = (h ^ word) * 0x9e3779b97f4a7c15u;
  return h ^ (h >> 29);
}

static uint64_t bits_of(double x) {
  uint64_t word;
  memcpy(&word, &x, sizeof word);
  return word;
}

static uint32_t hash_node(const ambit_node *node) {
  uint64_t h = mix(mix(mix(1, node->op), node->a), node->b);
  if (node->text)
    for (const char *c = node->text; *c; c++) h = mix(h, (unsigned char)*c);
  else if (node->op == AMBIT_LEAF_CONSTANT)
    h = mix(h, bits_of(node->value.lo));
  return (uint32_t)(h >> 32);
}

static bool same_node(const ambit_node *x, const ambit_node *y) {
  if (x->op != y->op || x->a != y->a || x->b != y->b) return false;
  if (!ambit_op_is_leaf(x->op)) return true;
  if (x->text || y->text) return x->text && y->text && strcmp(x->text, y->text) == 0;
  return x->value.lo == y->value.lo && x->value.hi == y->value.hi;
}

static bool grow_table(ambit_graph *g) {
  size_t size = g->table_size ? 2 * g->table_size : FIRST_TABLE;
  uint32_t *table = malloc(size * sizeof *table);
  if (!table) return false;
  memset(table, 0xff, size * sizeof *table);
  for (size_t i = 0; i < g->table_size; i++) {
    uint32_t e = g->table[i];
    if (e == AMBIT_NO_EXPR) continue;
    size_t at = g->stored[e].hash & (size - 1);
    while (table[at] != AMBIT_NO_EXPR) at = (at + 1) & (size - 1);
    table[at] = e;
  }
  free(g->table);
  g->table = table;
  g->table_size = size;
  return true;
}

/* Where the node is, or would be. */
static size_t find_place(const ambit_graph *g, const ambit_node *node, uint32_t hash) {
  size_t at = hash & (g->table_size - 1);
  for (; g->table[at] != AMBIT_NO_EXPR; at = (at + 1) & (g->table_size - 1)) {
    const ambit_stored *other = &g->stored[g->table[at]];
    if (other->hash == hash && same_node(&other->node, node)) break;
  }
  return at;
}

static ambit_expr append(ambit_graph *g, const ambit_stored *stored) {
  if (g->count >= AMBIT_NO_EXPR) return AMBIT_NO_EXPR;
  ambit_stored *room = ambit_vector_reserve(g->stored, &g->capacity, g->count + 1, sizeof *room);
  if (!room) return AMBIT_NO_EXPR;
  g->stored = room;
  room[g->count] = *stored;
  return (ambit_expr)g->count++;
}

/* What holds for the node by its operands. */
static void describe(const ambit_graph *g, ambit_stored *stored) {
  ambit_node *node = &stored->node;
  const ambit_node *a = ambit_at(g, node->a);
  bool binary = ambit_op_is_binary(node->op);
  const ambit_node *b = binary ? ambit_at(g, node->b) : a;
  uint32_t flags = node->op == AMBIT_OP_POWN ? ambit_interval_pown(&node->range, a->range, (int32_t)node->b)
                                             : ambit_interval_op(node->op, &node->range, a->range, b->range);
  bool inside = !(flags & AMBIT_F_PARTIAL);
  if (node->op == AMBIT_OP_DIV && ambit_is_nonzero(g, node->b)) inside = true;
  node->total = inside && a->total && b->total;
  node->constant = a->constant && b->constant;
  uint64_t angles = 0;
  if (node->op == AMBIT_OP_SIN || node->op == AMBIT_OP_COS)
    angles = 1;
  else if (node->op == AMBIT_OP_MUL)
    angles = (uint64_t)g->stored[node->a].angles + g->stored[node->b].angles;
  else if (node->op == AMBIT_OP_SQR)
    angles = 2u * (uint64_t)g->stored[node->a].angles;
  else if (node->op == AMBIT_OP_POWN && (int32_t)node->b > 0)
    angles = (uint64_t)node->b * g->stored[node->a].angles;
  stored->angles = angles < ANGLES_MAX ? (uint32_t)angles : ANGLES_MAX;
}

/* Finds the node or enters it, with a copy of its texts. */
static ambit_expr intern(ambit_graph *g, ambit_node node) {
  if (2 * (g->count + 1) > g->table_size && !grow_table(g)) return AMBIT_NO_EXPR;
  ambit_stored stored = { .node = node, .hash = hash_node(&node) };
  size_t place = find_place(g, &node, stored.hash);
  if (g->table[place] != AMBIT_NO_EXPR) return g->table[place];
  if (!ambit_op_is_leaf(node.op)) describe(g, &stored);
  if (node.text && !(stored.node.text = ambit_arena_text(g->arena, node.text))) return AMBIT_NO_EXPR;
  if (node.unit && !(stored.node.unit = ambit_arena_text(g->arena, node.unit))) return AMBIT_NO_EXPR;
  ambit_expr e = append(g, &stored);
  if (e != AMBIT_NO_EXPR) g->table[place] = e;
  return e;
}

ambit_expr ambit_store_make(ambit_graph *g, uint32_t op, ambit_expr a, ambit_expr b) {
  if (a == AMBIT_NO_EXPR || b == AMBIT_NO_EXPR) {
    if (!(op == AMBIT_OP_POWN && a != AMBIT_NO_EXPR)) return AMBIT_NO_EXPR;
  }
  bool two = ambit_op_is_binary(op) || op == AMBIT_OP_POWN;
  size_t before = g->count;
  ambit_expr e = intern(g, (ambit_node) { .op = op, .a = a, .b = two ? b : a });
  if (g->count == before || !ambit_op_has_kink(op)) return e;
  return ambit_kinks_note(g, e) ? e : AMBIT_NO_EXPR;
}

static ambit_node constant_node(ambit_interval x, const char *text) {
  return (
      ambit_node) { .op = AMBIT_LEAF_CONSTANT, .value = x, .range = x, .total = true, .constant = true, .text = text };
}

ambit_graph *ambit_graph_open(void) {
  ambit_graph *g = calloc(1, sizeof *g);
  if (!g) return NULL;
  g->pi = g->time = AMBIT_NO_EXPR;
  g->arena = ambit_arena_open();
  g->marks = ambit_marks_open();
  if (g->arena && g->marks && ambit_graph_number(g, 0) == AMBIT_ZERO && ambit_graph_number(g, 1) == AMBIT_ONE) return g;
  ambit_graph_close(g);
  return NULL;
}

void ambit_graph_close(ambit_graph *g) {
  if (!g) return;
  ambit_marks_close(g->marks);
  ambit_arena_close(g->arena);
  free(g->table);
  free(g->stored);
  free(g->kinks.known);
  free(g);
}

const ambit_node *ambit_graph_node(const ambit_graph *g, ambit_expr e) { return ambit_at(g, e); }
uint32_t ambit_graph_count(const ambit_graph *g) { return (uint32_t)g->count; }

double ambit_graph_sealing_seconds(const ambit_graph *g) { return g->sealing; }

ambit_expr ambit_graph_number(ambit_graph *g, double x) {
  if (!isfinite(x)) return AMBIT_NO_EXPR;
  if (x == 0) x = 0; /* one zero */
  return intern(g, constant_node((ambit_interval) { x, x }, NULL));
}

ambit_expr ambit_graph_interval(ambit_graph *g, ambit_interval x) {
  x = ambit_interval_of(x.lo, x.hi);
  if (ambit_interval_is_empty(x)) return AMBIT_NO_EXPR;
  if (ambit_interval_is_point(x)) return ambit_graph_number(g, x.lo);
  return append(g, &(ambit_stored) { .node = constant_node(x, NULL) });
}

ambit_expr ambit_graph_pi(ambit_graph *g) {
  if (g->pi == AMBIT_NO_EXPR) g->pi = intern(g, constant_node(ambit_interval_pi(), "pi"));
  return g->pi;
}

static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f'; }

/* The literal without white space and sign around it; *negative: the sign. A copy in the arena. */
static const char *bare_literal(ambit_graph *g, const char *text, bool *negative) {
  while (is_space(*text)) text++;
  *negative = *text == '-';
  if (*text == '-' || *text == '+') text++;
  while (is_space(*text)) text++;
  char *bare = ambit_arena_text(g->arena, text);
  if (!bare) return NULL;
  size_t n = strlen(bare);
  while (n > 0 && is_space(bare[n - 1])) bare[--n] = '\0';
  return bare;
}

ambit_expr ambit_graph_decimal(ambit_graph *g, const char *text, ambit_failure *f) {
  ambit_interval x, magnitude;
  if (ambit_decimal_read(text, &x, NULL, f) != AMBIT_OK) return AMBIT_NO_EXPR;
  if (!strpbrk(text, "[?") && !ambit_interval_is_bounded(x)) {
    ambit_fail(f, AMBIT_INVALID, "\"%s\" is beyond the largest number, %.1e", text, DBL_MAX);
    return AMBIT_NO_EXPR;
  }
  if (strpbrk(text, "[?")) {
    ambit_fail(f, AMBIT_INVALID, "\"%s\" is not one number: expected a decimal, a fraction or \"pi\"", text);
    return AMBIT_NO_EXPR;
  }
  if (ambit_interval_is_point(x)) return ambit_graph_number(g, x.lo);
  bool negative;
  const char *bare = bare_literal(g, text, &negative);
  if (!bare) {
    ambit_fail(f, AMBIT_NOMEM, "out of memory for the number \"%s\"", text);
    return AMBIT_NO_EXPR;
  }
  magnitude = negative ? (ambit_interval) { -x.hi, -x.lo } : x;
  ambit_expr e = strcmp(bare, "pi") == 0 ? ambit_graph_pi(g) : intern(g, constant_node(magnitude, bare));
  return negative && e != AMBIT_NO_EXPR ? ambit_graph_op(g, AMBIT_OP_NEG, e, e) : e;
}

ambit_expr ambit_graph_datum(
    ambit_graph *g, const char *name, const char *place, ambit_interval outer, ambit_interval inner) {
  outer = ambit_interval_of(outer.lo, outer.hi);
  if (ambit_interval_is_empty(outer)) return AMBIT_NO_EXPR;
  inner = ambit_interval_intersect(ambit_interval_of(inner.lo, inner.hi), outer);
  ambit_node node = { .op = AMBIT_LEAF_UNKNOWN, .value = outer, .inner = inner, .range = outer, .total = true };
  if (name && !(node.text = ambit_arena_text(g->arena, name))) return AMBIT_NO_EXPR;
  if (place && !(node.unit = ambit_arena_text(g->arena, place))) return AMBIT_NO_EXPR;
  return append(g, &(ambit_stored) { .node = node });
}

ambit_expr ambit_graph_unknown(ambit_graph *g, const char *name, ambit_interval range) {
  return ambit_graph_datum(g, name, NULL, range, range);
}

bool ambit_graph_name(ambit_graph *g, ambit_expr unknown, const char *name) {
  ambit_node *node = &g->stored[unknown].node;
  if (node->op != AMBIT_LEAF_UNKNOWN || node->text) return true;
  return (node->text = ambit_arena_text(g->arena, name)) != NULL;
}

ambit_expr ambit_graph_symbol(ambit_graph *g, const char *name, const char *unit) {
  return intern(g, (ambit_node) { .op = AMBIT_LEAF_SYMBOL,
                       .value = AMBIT_ENTIRE,
                       .range = AMBIT_ENTIRE,
                       .total = true,
                       .text = name,
                       .unit = unit });
}

ambit_expr ambit_graph_time(ambit_graph *g) {
  if (g->time == AMBIT_NO_EXPR)
    g->time = append(g, &(ambit_stored) { .node = { .op = AMBIT_LEAF_TIME,
                                              .value = AMBIT_ENTIRE,
                                              .range = AMBIT_ENTIRE,
                                              .total = true,
                                              .text = "t",
                                              .unit = "s" } });
  return g->time;
}
