/* affine_in.c -- two searches over the nodes that depend on the symbols, operands first, without recursion. */
#include "mechanics/affine_in.h"
#include "base/vector.h"
#include "algebra/node_map.h"
#include <stdlib.h>
#include <string.h>

/* What is known of a node: 0 nothing, FIXED, or VARIES: it depends on one of the symbols; then VARIES + 1 + its place
** in the present search, if it has one. */
#define FIXED 1u
#define VARIES 2u

struct ambit_affine {
  ambit_graph *g;
  ambit_node_map known;
  ambit_expr *stack, *order; /* of the search */
  size_t stack_capacity, order_capacity, reached;
  ambit_expr *row; /* [reached * width] what the search found for each node */
  size_t row_capacity;
  size_t nsymbol;
  ambit_expr *symbol; /* [nsymbol] ascending */
};

static int by_number(const void *p, const void *q) {
  const ambit_expr *x = p, *y = q;
  return *x < *y ? -1 : *x > *y;
}

static bool is_leaf(const ambit_node *x) { return x->op >= AMBIT_LEAF_CONSTANT; }
static bool is_binary(const ambit_node *x) { return ambit_op_arity(x->op) == 2; }

static bool push(ambit_affine *a, size_t *depth, ambit_expr e) {
  ambit_expr *stack = ambit_vector_reserve(a->stack, &a->stack_capacity, *depth + 1, sizeof *stack);
  if (!stack) return false;
  a->stack = stack;
  stack[(*depth)++] = e;
  return true;
}

/* -- which nodes vary: found by going down from those in question, each node once */

static uint32_t known(const ambit_affine *a, ambit_expr e) { return ambit_node_map_get(&a->known, e); }
static bool varies(const ambit_affine *a, ambit_expr e) { return known(a, e) >= VARIES; }

static bool note(ambit_affine *a, ambit_expr e, uint32_t what) {
  uint32_t *value = ambit_node_map_at(&a->known, e);
  if (value) *value = what;
  return value;
}

static bool learn_one(ambit_affine *a, ambit_expr e) {
  size_t depth = 0;
  if (!push(a, &depth, e)) return false;
  while (depth > 0) {
    ambit_expr top = a->stack[depth - 1];
    const ambit_node *x = ambit_graph_node(a->g, top);
    bool leaf = is_leaf(x), binary = is_binary(x), any = false;
    if (leaf) {
      any = bsearch(&top, a->symbol, a->nsymbol, sizeof top, by_number) != NULL;
    } else {
      uint32_t left = known(a, x->a), right = binary ? known(a, x->b) : left;
      if (!left && !push(a, &depth, x->a)) return false;
      if (!right && binary && !push(a, &depth, x->b)) return false;
      if (!left || !right) continue;
      any = left >= VARIES || right >= VARIES;
    }
    if (!note(a, top, any ? VARIES : FIXED)) return false;
    depth--;
  }
  return true;
}

static bool learn(ambit_affine *a, size_t n, const ambit_expr *e) {
  bool done = true;
  for (size_t i = 0; i < n && done; i++) done = known(a, e[i]) || learn_one(a, e[i]);
  return done;
}

ambit_affine *ambit_affine_open(ambit_graph *g, size_t n, const ambit_expr *symbol) {
  ambit_affine *a = calloc(1, sizeof *a);
  if (!a) return NULL;
  a->g = g;
  a->nsymbol = n;
  a->symbol = malloc((n + 1) * sizeof *a->symbol);
  if (a->symbol) {
    memcpy(a->symbol, symbol, n * sizeof *symbol);
    qsort(a->symbol, n, sizeof *symbol, by_number);
    return a;
  }
  ambit_affine_close(a);
  return NULL;
}

void ambit_affine_close(ambit_affine *a) {
  if (!a) return;
  ambit_node_map_close(&a->known);
  free(a->stack);
  free(a->order);
  free(a->row);
  free(a->symbol);
  free(a);
}

bool ambit_affine_varies(ambit_affine *a, size_t n, const ambit_expr *e) {
  if (!learn(a, n, e)) return true;
  bool any = false;
  for (size_t i = 0; i < n; i++) any = any || varies(a, e[i]);
  return any;
}

/* -- the search */

static bool is_reached(const ambit_affine *a, ambit_expr e) { return known(a, e) > VARIES; }
static bool is_done(const ambit_affine *a, ambit_expr e) { return known(a, e) != VARIES; }

static bool settle(ambit_affine *a, ambit_expr e) {
  ambit_expr *order = ambit_vector_reserve(a->order, &a->order_capacity, a->reached + 1, sizeof *order);
  if (!order) return false;
  a->order = order;
  order[a->reached++] = e;
  return note(a, e, VARIES + (uint32_t)a->reached);
}

/* order[0..reached): the varying nodes below e, operands first */
static bool search(ambit_affine *a, size_t ne, const ambit_expr *e) {
  size_t depth = 0;
  for (size_t i = ne; i-- > 0;)
    if (!is_done(a, e[i]) && !push(a, &depth, e[i])) return false;
  while (depth > 0) {
    ambit_expr top = a->stack[depth - 1];
    const ambit_node *x = ambit_graph_node(a->g, top);
    bool leaf = is_leaf(x), binary = is_binary(x);
    if (is_reached(a, top)) { /* reached by another way meanwhile */
      depth--;
    } else if (leaf || (is_done(a, x->a) && (!binary || is_done(a, x->b)))) {
      depth--;
      if (!settle(a, top)) return false;
    } else {
      if (!is_done(a, x->a) && !push(a, &depth, x->a)) return false;
      if (binary && !is_done(a, x->b) && !push(a, &depth, x->b)) return false;
    }
  }
  return true;
}

/* `width` numbers for each node reached */
static bool begin(ambit_affine *a, size_t ne, const ambit_expr *e, size_t width) {
  a->reached = 0;
  if (!learn(a, ne, e)) return false;
  bool done = search(a, ne, e);
  ambit_expr *row = done ? ambit_vector_reserve(a->row, &a->row_capacity, (a->reached + 1) * width, sizeof *row) : NULL;
  if (row) a->row = row;
  return row != NULL;
}

static void end(ambit_affine *a) {
  for (size_t i = 0; i < a->reached; i++) note(a, a->order[i], VARIES);
}

static size_t find(size_t n, const ambit_expr *symbol, ambit_expr e) {
  size_t k = 0;
  while (k < n && symbol[k] != e) k++;
  return k;
}

/* -- coefficients: a row holds those of the symbols, then the constant */

typedef struct rules {
  ambit_affine *a;
  size_t n;
  const ambit_expr *symbol;
} rules;

static ambit_expr *row_of(const rules *r, ambit_expr e) {
  return r->a->row + (size_t)(known(r->a, e) - VARIES - 1) * (r->n + 1);
}

static bool is_constant(const rules *r, ambit_expr e) {
  if (!varies(r->a, e)) return true;
  const ambit_expr *row = row_of(r, e);
  size_t k = 0;
  while (k < r->n && row[k] == 0) k++;
  return k == r->n;
}

static ambit_expr constant_of(const rules *r, ambit_expr e) { return varies(r->a, e) ? row_of(r, e)[r->n] : e; }
static ambit_expr coefficient_of(const rules *r, ambit_expr e, size_t k) {
  return varies(r->a, e) ? row_of(r, e)[k] : 0;
}

/* A product with 0 is 0 here even where the other factor is not proved to be defined: see affine_in.h. */
static ambit_expr apply(const rules *r, const ambit_node *x, ambit_expr p, ambit_expr q) {
  if (p == 0 && (x->op == AMBIT_OP_MUL || x->op == AMBIT_OP_DIV)) return 0;
  if (q == 0 && x->op == AMBIT_OP_MUL) return 0;
  return x->op == AMBIT_OP_POWN ? ambit_graph_pown(r->a->g, p, (int32_t)x->b) : ambit_graph_op(r->a->g, x->op, p, q);
}

/* The row of an operation that is linear in both operands (ADD, SUB, NEG), or in the one that is not constant. */
static void write_linear(const rules *r, ambit_node x, ambit_expr *row) {
  bool sum = x.op == AMBIT_OP_ADD || x.op == AMBIT_OP_SUB || x.op == AMBIT_OP_NEG;
  bool left = !is_constant(r, x.a); /* MUL, DIV: the factor that varies */
  for (size_t k = 0; k < r->n; k++) {
    ambit_expr p = sum || left ? coefficient_of(r, x.a, k) : constant_of(r, x.a);
    ambit_expr q = sum || !left ? coefficient_of(r, x.b, k) : constant_of(r, x.b);
    row[k] = p == 0 && q == 0 ? 0 : apply(r, &x, p, q);
  }
  row[r->n] = apply(r, &x, constant_of(r, x.a), constant_of(r, x.b));
}

static ambit_status write_row(const rules *r, ambit_expr e, ambit_expr *row) {
  ambit_node x = *ambit_graph_node(r->a->g, e);
  memset(row, 0, (r->n + 1) * sizeof *row);
  if (is_leaf(&x)) {
    size_t k = find(r->n, r->symbol, e);
    row[k] = k < r->n ? ambit_graph_number(r->a->g, 1) : e;
    return AMBIT_OK;
  }
  bool a = is_constant(r, x.a), b = !is_binary(&x) ? a : is_constant(r, x.b);
  bool sum = x.op == AMBIT_OP_ADD || x.op == AMBIT_OP_SUB || x.op == AMBIT_OP_NEG;
  if (a && b)
    row[r->n] = apply(r, &x, constant_of(r, x.a), is_binary(&x) ? constant_of(r, x.b) : 0);
  else if (sum || (x.op == AMBIT_OP_MUL && (a || b)) || (x.op == AMBIT_OP_DIV && b))
    write_linear(r, x, row);
  else
    return AMBIT_DOMAIN;
  for (size_t k = 0; k <= r->n; k++)
    if (row[k] == AMBIT_NO_EXPR) return AMBIT_NOMEM;
  return AMBIT_OK;
}

ambit_status ambit_affine_in(ambit_affine *a, size_t ne, const ambit_expr *e, size_t n, const ambit_expr *symbol,
    ambit_expr *coefficient, ambit_expr *constant) {
  rules r = { a, n, symbol };
  ambit_status status = begin(a, ne, e, n + 1) ? AMBIT_OK : AMBIT_NOMEM;
  for (size_t i = 0; status == AMBIT_OK && i < a->reached; i++)
    status = write_row(&r, a->order[i], a->row + i * (n + 1));
  for (size_t i = 0; status == AMBIT_OK && i < ne; i++) {
    for (size_t k = 0; k < n; k++) coefficient[i * n + k] = coefficient_of(&r, e[i], k);
    constant[i] = constant_of(&r, e[i]);
  }
  end(a);
  if (status == AMBIT_OK && ambit_affine_varies(a, ne * n, coefficient)) status = AMBIT_DOMAIN;
  return status;
}

/* -- values */

ambit_status ambit_affine_put(ambit_affine *a, size_t ne, const ambit_expr *e, size_t n, const ambit_expr *symbol,
    const ambit_expr *value, ambit_expr *to) {
  rules r = { a, 0, symbol }; /* a row is a constant alone */
  ambit_status status = begin(a, ne, e, 1) ? AMBIT_OK : AMBIT_NOMEM;
  for (size_t i = 0; status == AMBIT_OK && i < a->reached; i++) {
    ambit_node x = *ambit_graph_node(a->g, a->order[i]);
    size_t k = is_leaf(&x) ? find(n, symbol, a->order[i]) : n;
    if (is_leaf(&x))
      a->row[i] = k < n ? value[k] : a->order[i];
    else
      a->row[i] = apply(&r, &x, constant_of(&r, x.a), is_binary(&x) ? constant_of(&r, x.b) : 0);
    if (a->row[i] == AMBIT_NO_EXPR) status = AMBIT_NOMEM;
  }
  for (size_t i = 0; status == AMBIT_OK && i < ne; i++) to[i] = constant_of(&r, e[i]);
  end(a);
  return status;
}
