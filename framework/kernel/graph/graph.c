/* graph.c -- hash-consed nodes in one growing array, found by open addressing; leaves.
**
** A node's range is the kernel's interval function over its operands' ranges, so by induction it holds for all real
** values of the leaves at which the node is defined; the node is total if its operands are and the interval function
** saw no point outside the domain. A constant whose enclosure is not a point and that has no literal is a new node at
** each call: two enclosures that look alike may stand for different numbers. Literals are the numbers they spell, so
** equal text is an equal node. Symbols are known by their names, which are never forgotten (symbols.h).
*/
#include <ambit/graph.h>
#include "base/vector.h"
#include "graph/fold.h"
#include "graph/store.h"
#include "graph/walk.h"
#include "num/decimal.h"
#include "num/interval.h"
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

/* Is the node found by what it says? Unknowns and enclosures of numbers that nobody spelt are themselves only. */
static bool is_shared(const ambit_node *x) {
  if (x->op == AMBIT_LEAF_CONSTANT) return x->text || x->value.lo == x->value.hi;
  return !ambit_op_is_leaf(x->op) || x->op == AMBIT_LEAF_SYMBOL;
}

static void fill_table(ambit_graph *g) {
  memset(g->table, 0xff, g->table_size * sizeof *g->table);
  for (size_t e = 0; e < g->count; e++) {
    if (!is_shared(&g->stored[e].node)) continue;
    size_t at = g->stored[e].hash & (g->table_size - 1);
    while (g->table[at] != AMBIT_NO_EXPR) at = (at + 1) & (g->table_size - 1);
    g->table[at] = (uint32_t)e;
  }
}

static bool resize_table(ambit_graph *g, size_t size) {
  uint32_t *table = malloc(size * sizeof *table);
  if (!table) return false;
  free(g->table);
  g->table = table;
  g->table_size = size;
  fill_table(g);
  return true;
}

void ambit_store_tidy(ambit_graph *g) {
  size_t size = FIRST_TABLE;
  while (size < 4 * ((size_t)g->living + 1)) size *= 2;
  if (size >= g->table_size || !resize_table(g, size)) fill_table(g);
  size_t room = 2 * g->count;
  ambit_stored *less = g->capacity > 2 * room ? realloc(g->stored, room * sizeof *less) : NULL;
  if (less) g->stored = less, g->capacity = room;
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
  ambit_expr e = g->unused;
  if (e != AMBIT_NO_EXPR) {
    g->unused = g->stored[e].node.a;
  } else {
    if (g->count >= AMBIT_NO_EXPR) return AMBIT_NO_EXPR;
    ambit_stored *room = ambit_vector_reserve(g->stored, &g->capacity, g->count + 1, sizeof *room);
    if (!room) return AMBIT_NO_EXPR;
    g->stored = room;
    e = (ambit_expr)g->count++;
  }
  g->stored[e] = *stored;
  if (ambit_op_is_leaf(stored->node.op) && !stored->birth) g->stored[e].birth = ++g->births;
  g->living++;
  g->made++;
  return e;
}

/* Names and units of symbols are the list's, those of time are no copies. */
static bool owns_texts(uint32_t op) {
  return op == AMBIT_LEAF_CONSTANT || ambit_leaf_is_uncertain(op) || !ambit_op_is_leaf(op);
}

void ambit_store_clear(ambit_stored *x) {
  if (owns_texts(x->node.op)) {
    free((char *)(uintptr_t)x->node.text);
    free((char *)(uintptr_t)x->node.unit);
  }
  *x = (ambit_stored) { .node = { .op = AMBIT_LEAF_NONE } };
}

/* Appends the node with copies of its texts, if nobody else keeps them. */
static ambit_expr append_copy(ambit_graph *g, ambit_stored *stored) {
  const char *text = stored->node.text, *unit = stored->node.unit;
  if (!owns_texts(stored->node.op)) return append(g, stored);
  stored->node.text = text ? strdup(text) : NULL;
  stored->node.unit = unit ? strdup(unit) : NULL;
  bool copied = (stored->node.text || !text) && (stored->node.unit || !unit);
  ambit_expr e = copied ? append(g, stored) : AMBIT_NO_EXPR;
  if (e == AMBIT_NO_EXPR) ambit_store_clear(stored);
  return e;
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
  uint32_t left = g->stored[node->a].height, right = binary ? g->stored[node->b].height : left;
  stored->height = 1 + (left > right ? left : right);
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

/* May it be undefined where its operands are not? */
static bool leaves_domain(const ambit_graph *g, const ambit_node *x) {
  if (ambit_op_is_leaf(x->op) || x->total || !ambit_at(g, x->a)->total) return false;
  return !ambit_op_is_binary(x->op) || ambit_at(g, x->b)->total;
}

/* Finds the node or enters it; birth: of a symbol. */
static ambit_expr intern(ambit_graph *g, ambit_node node, uint64_t birth) {
  size_t size = g->table_size ? 2 * g->table_size : FIRST_TABLE;
  if (2 * ((size_t)g->living + 1) > g->table_size && !resize_table(g, size)) return AMBIT_NO_EXPR;
  ambit_stored stored = { .node = node, .hash = hash_node(&node), .birth = birth };
  size_t place = find_place(g, &node, stored.hash);
  if (g->table[place] != AMBIT_NO_EXPR) return g->table[place];
  if (!ambit_op_is_leaf(node.op)) describe(g, &stored);
  g->has_functions = g->has_functions || ambit_op_is_function(node.op);
  if (ambit_op_has_kink(node.op) || leaves_domain(g, &stored.node)) stored.node.text = g->maker;
  ambit_expr e = append_copy(g, &stored);
  if (e != AMBIT_NO_EXPR) g->table[place] = e;
  return e;
}

ambit_expr ambit_store_make(ambit_graph *g, uint32_t op, ambit_expr a, ambit_expr b) {
  if (a == AMBIT_NO_EXPR || b == AMBIT_NO_EXPR) {
    if (!(op == AMBIT_OP_POWN && a != AMBIT_NO_EXPR)) return AMBIT_NO_EXPR;
  }
  bool two = ambit_op_is_binary(op) || op == AMBIT_OP_POWN;
  ambit_store_expect(g, a);
  if (ambit_op_is_binary(op)) ambit_store_expect(g, b);
  return intern(g, (ambit_node) { .op = op, .a = a, .b = two ? b : a }, 0);
}

static ambit_node constant_node(ambit_interval x, const char *text) {
  return (
      ambit_node) { .op = AMBIT_LEAF_CONSTANT, .value = x, .range = x, .total = true, .constant = true, .text = text };
}

ambit_graph *ambit_graph_open(void) {
  ambit_graph *g = calloc(1, sizeof *g);
  if (!g) return NULL;
  g->pi = g->time = g->unused = AMBIT_NO_EXPR;
  g->due = AMBIT_COLLECT_LEAST;
  g->marks = ambit_marks_open();
  if (g->marks && ambit_graph_number(g, 0) == AMBIT_ZERO && ambit_graph_number(g, 1) == AMBIT_ONE) return g;
  ambit_graph_close(g);
  return NULL;
}

void ambit_graph_close(ambit_graph *g) {
  if (!g) return;
  while (g->holders) ambit_graph_release(g->holders);
  for (size_t i = 0; i < g->count; i++) ambit_store_clear(&g->stored[i]);
  ambit_marks_close(g->marks);
  ambit_symbols_close(&g->symbols);
  free(g->to_mark);
  free(g->table);
  free(g->stored);
  free(g);
}

const ambit_node *ambit_graph_node(const ambit_graph *g, ambit_expr e) { return ambit_at(g, e); }
uint32_t ambit_graph_count(const ambit_graph *g) { return (uint32_t)g->count; }
uint64_t ambit_graph_made(const ambit_graph *g) { return g->made; }
uint64_t ambit_graph_birth(const ambit_graph *g, ambit_expr leaf) { return g->stored[leaf].birth; }

double ambit_graph_sealing_seconds(const ambit_graph *g) { return g->sealing; }

ambit_expr ambit_graph_number(ambit_graph *g, double x) {
  if (!isfinite(x)) return AMBIT_NO_EXPR;
  if (x == 0) x = 0; /* one zero */
  return intern(g, constant_node((ambit_interval) { x, x }, NULL), 0);
}

ambit_expr ambit_graph_interval(ambit_graph *g, ambit_interval x) {
  x = ambit_interval_of(x.lo, x.hi);
  if (ambit_interval_is_empty(x)) return AMBIT_NO_EXPR;
  if (ambit_interval_is_point(x)) return ambit_graph_number(g, x.lo);
  return append(g, &(ambit_stored) { .node = constant_node(x, NULL) });
}

ambit_expr ambit_graph_pi(ambit_graph *g) {
  if (g->pi == AMBIT_NO_EXPR) g->pi = intern(g, constant_node(ambit_interval_pi(), "pi"), 0);
  return g->pi;
}

static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f'; }

/* The literal without white space and sign around it, to be freed; *negative: the sign. NULL: out of memory. */
static char *bare_literal(const char *text, bool *negative) {
  while (is_space(*text)) text++;
  *negative = *text == '-';
  if (*text == '-' || *text == '+') text++;
  while (is_space(*text)) text++;
  char *bare = strdup(text);
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
  char *bare = bare_literal(text, &negative);
  if (!bare) {
    ambit_fail(f, AMBIT_NOMEM, "out of memory for the number \"%s\"", text);
    return AMBIT_NO_EXPR;
  }
  magnitude = negative ? (ambit_interval) { -x.hi, -x.lo } : x;
  ambit_expr e = strcmp(bare, "pi") == 0 ? ambit_graph_pi(g) : intern(g, constant_node(magnitude, bare), 0);
  free(bare);
  return negative && e != AMBIT_NO_EXPR ? ambit_graph_op(g, AMBIT_OP_NEG, e, e) : e;
}

static ambit_expr uncertain_leaf(
    ambit_graph *g, uint32_t op, const char *name, const char *place, ambit_interval outer, ambit_interval inner) {
  outer = ambit_interval_of(outer.lo, outer.hi);
  if (ambit_interval_is_empty(outer)) return AMBIT_NO_EXPR;
  inner = ambit_interval_intersect(ambit_interval_of(inner.lo, inner.hi), outer);
  ambit_node node = { .op = op, .value = outer, .inner = inner, .range = outer, .total = true };
  node.text = name;
  node.unit = place;
  return append_copy(g, &(ambit_stored) { .node = node });
}

ambit_expr ambit_graph_datum(
    ambit_graph *g, const char *name, const char *place, ambit_interval outer, ambit_interval inner) {
  return uncertain_leaf(g, AMBIT_LEAF_UNKNOWN, name, place, outer, inner);
}

ambit_expr ambit_graph_varying(
    ambit_graph *g, const char *name, const char *place, ambit_interval outer, ambit_interval inner) {
  return uncertain_leaf(g, AMBIT_LEAF_VARYING, name, place, outer, inner);
}

ambit_expr ambit_graph_unknown(ambit_graph *g, const char *name, ambit_interval range) {
  return ambit_graph_datum(g, name, NULL, range, range);
}

void ambit_graph_set_plain(ambit_graph *g, ambit_expr unknown) { g->stored[unknown].node.plain = true; }
void ambit_graph_mark_partial(ambit_graph *g, ambit_expr unknown) {
  ambit_node *node = &g->stored[unknown].node;
  if (node->op == AMBIT_LEAF_UNKNOWN) node->total = false;
}

bool ambit_graph_name(ambit_graph *g, ambit_expr unknown, const char *name) {
  ambit_node *node = &g->stored[unknown].node;
  if (!ambit_leaf_is_uncertain(node->op) || node->text) return true;
  node->plain = false;
  return (node->text = strdup(name)) != NULL;
}

ambit_expr ambit_graph_symbol(ambit_graph *g, const char *name, const char *unit) {
  const ambit_symbol_name *known = ambit_symbols_enter(&g->symbols, name, unit, &g->births);
  if (!known) return AMBIT_NO_EXPR;
  ambit_node node = { .op = AMBIT_LEAF_SYMBOL, .value = AMBIT_ENTIRE, .range = AMBIT_ENTIRE, .total = true };
  node.text = known->name;
  node.unit = known->unit;
  return intern(g, node, known->birth);
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
