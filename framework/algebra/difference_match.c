/* difference_match.c -- what a pair (u, w) is made of: equal terms of two sums and equal factors of two products meet
** each other, then those that are most alike; the rest stands alone.
**
** Any matching gives a correct difference; a good one gives a narrow enclosure.
*/
#include "base/vector.h"
#include "algebra/difference_pair.h"
#include <stdlib.h>

#define MOST_ITEMS 400u  /* terms or factors of one side; shared sums could have exponentially many */
#define ALIKE_DEPTH 4    /* how far below two expressions are compared */
#define MOST_PAIRS 2500u /* of items without an equal that are compared with each other */

/* A term or factor; sums: c * e. */
typedef struct item {
  ambit_expr e;
  double c;
  bool used;
} item;

typedef struct items {
  size_t n, capacity;
  item *item;
} items;

static bool add(items *list, ambit_expr e, double c) {
  item *grown = ambit_vector_reserve(list->item, &list->capacity, list->n + 1, sizeof *grown);
  if (!grown) return false;
  list->item = grown;
  grown[list->n++] = (item) { e, c, false };
  return true;
}

/* -- alikeness */

static unsigned alike(const ambit_graph *g, ambit_expr u, ambit_expr w, int depth) {
  if (u == w) return 1u << (2 * depth);
  const ambit_node *x = ambit_at(g, u), *y = ambit_at(g, w);
  if (x->op != y->op || ambit_op_is_leaf(x->op)) return 0;
  if (x->op == AMBIT_OP_POWN && x->b != y->b) return 0;
  if (depth == 0) return 1;
  unsigned sum = 1 + alike(g, x->a, y->a, depth - 1);
  if (!ambit_op_is_binary(x->op)) return sum;
  sum += alike(g, x->b, y->b, depth - 1);
  if (x->op != AMBIT_OP_ADD && x->op != AMBIT_OP_MUL) return sum;
  unsigned cross = 1 + alike(g, x->a, y->b, depth - 1) + alike(g, x->b, y->a, depth - 1);
  return cross > sum ? cross : sum;
}

/* -- the items of either side */

static bool is_sum(uint32_t op) { return op == AMBIT_OP_ADD || op == AMBIT_OP_SUB || op == AMBIT_OP_NEG; }

static bool terms(const ambit_graph *g, ambit_expr e, items *list) {
  size_t n = ambit_graph_terms(g, e, 0, NULL, NULL);
  if (n > MOST_ITEMS) return add(list, e, 1);
  ambit_expr term[MOST_ITEMS];
  bool negative[MOST_ITEMS], good = true;
  ambit_graph_terms(g, e, n, term, negative);
  for (size_t i = 0; i < n && good; i++) {
    ambit_term t = ambit_fold_split(g, term[i]);
    good = add(list, t.body, negative[i] ? -t.c : t.c);
  }
  return good;
}

static bool factors(const ambit_graph *g, ambit_expr e, items *list) {
  ambit_expr open[MOST_ITEMS];
  size_t depth = 0;
  open[depth++] = e;
  while (depth) {
    ambit_expr top = open[--depth];
    const ambit_node *x = ambit_at(g, top);
    int32_t power = x->op == AMBIT_OP_POWN ? (int32_t)x->b : x->op == AMBIT_OP_SQR ? 2 : 0;
    bool room = list->n + depth + 8 < MOST_ITEMS;
    if (x->op == AMBIT_OP_MUL && room) {
      open[depth++] = x->b;
      open[depth++] = x->a;
    } else if (power >= 2 && power <= 6 && room) {
      for (int32_t k = 0; k < power; k++) open[depth++] = x->a;
    } else if (!add(list, top, 1)) {
      return false;
    }
  }
  return true;
}

/* -- matching */

static bool link(ambit_pairs *p, item *u, item *w) {
  ambit_pair_link l = { AMBIT_NO_PAIR, AMBIT_NO_EXPR, AMBIT_NO_EXPR, 1, 1 };
  if (u) l.u = u->e, l.cu = u->c, u->used = true;
  if (w) l.w = w->e, l.cw = w->c, w->used = true;
  if (u && w) {
    l.pair = ambit_pairs_find(p, u->e, w->e);
    if (l.pair == AMBIT_NO_PAIR) return false;
  }
  return ambit_pairs_link(p, l);
}

static bool link_equal(ambit_pairs *p, items *u, items *w) {
  for (size_t i = 0; i < u->n; i++)
    for (size_t k = 0; k < w->n && !u->item[i].used; k++)
      if (!w->item[k].used && u->item[i].e == w->item[k].e && !link(p, &u->item[i], &w->item[k])) return false;
  return true;
}

/* Constants meet constants: c_1 - c_2 is a number. */
static unsigned likeness(const ambit_pairs *p, const item *u, const item *w) {
  if (u->used || w->used || u->c != w->c) return 0;
  if (ambit_is_exact(p->g, u->e) && ambit_is_exact(p->g, w->e)) return 1;
  return alike(p->g, u->e, w->e, ALIKE_DEPTH);
}

static size_t count_unused(const items *list) {
  size_t n = 0;
  for (size_t i = 0; i < list->n; i++) n += !list->item[i].used;
  return n;
}

/* The most alike first; of equals those that come first. */
static bool link_best(ambit_pairs *p, items *u, items *w, const unsigned *like) {
  for (;;) {
    unsigned best = 0;
    size_t at = 0;
    for (size_t i = 0; i < u->n * w->n; i++) {
      bool used = !like[i] || u->item[i / w->n].used || w->item[i % w->n].used;
      if (!used && like[i] > best) best = like[i], at = i;
    }
    if (!best) return true;
    if (!link(p, &u->item[at / w->n], &w->item[at % w->n])) return false;
  }
}

static bool link_alike(ambit_pairs *p, items *u, items *w) {
  size_t left = count_unused(u), right = count_unused(w);
  if (left == 0 || right == 0 || left * right > MOST_PAIRS) return true;
  unsigned *like = malloc((u->n * w->n + 1) * sizeof *like);
  if (!like) return false;
  for (size_t i = 0; i < u->n * w->n; i++) like[i] = likeness(p, &u->item[i / w->n], &w->item[i % w->n]);
  bool done = link_best(p, u, w, like);
  free(like);
  return done;
}

static bool link_rest(ambit_pairs *p, items *u, items *w) {
  for (size_t i = 0; i < u->n; i++)
    if (!u->item[i].used && !link(p, &u->item[i], NULL)) return false;
  for (size_t k = 0; k < w->n; k++)
    if (!w->item[k].used && !link(p, NULL, &w->item[k])) return false;
  return true;
}

static bool match(ambit_pairs *p, ambit_expr u, ambit_expr w, bool (*read)(const ambit_graph *, ambit_expr, items *)) {
  items left = { 0 }, right = { 0 };
  bool done = read(p->g, u, &left) && read(p->g, w, &right) && link_equal(p, &left, &right) &&
              link_alike(p, &left, &right) && link_rest(p, &left, &right);
  free(left.item), free(right.item);
  return done;
}

/* -- plans */

static bool has_rule(const ambit_pairs *p, uint32_t op) {
  switch (op) {
  case AMBIT_OP_ABS:
  case AMBIT_OP_MIN:
  case AMBIT_OP_MAX: return p->clamps;
  case AMBIT_OP_ASIN:
  case AMBIT_OP_ACOS:
  case AMBIT_OP_ATAN2: return false;
  default: return op < AMBIT_OP_COUNT; /* functions are written in other operations */
  }
}

/* A root of data alone may be taken at 0, where its rule is not defined. */
static bool is_root_of_data(const ambit_pairs *p, const ambit_node *x, const ambit_node *y) {
  return x->op == AMBIT_OP_SQRT && !ambit_moves(p, x->a) && !ambit_moves(p, y->a) &&
         !(ambit_at(p->g, x->a)->range.lo > 0);
}

static ambit_pair_state kind_of(const ambit_pairs *p, ambit_expr u, ambit_expr w) {
  const ambit_node *x = ambit_at(p->g, u), *y = ambit_at(p->g, w);
  bool same = x->op == y->op;
  if (u == w && !ambit_moves(p, u)) return PAIR_PLAIN;
  if (u == AMBIT_ZERO || w == AMBIT_ZERO) return PAIR_PLAIN;
  if (u == w) return has_rule(p, x->op) ? PAIR_RULE : PAIR_PLAIN;
  if (is_sum(x->op) || is_sum(y->op)) {
    bool shared = ambit_graph_terms(p->g, u, 0, NULL, NULL) > MOST_ITEMS;
    return shared && same ? PAIR_RULE : PAIR_SUM;
  }
  if (same && x->op == AMBIT_OP_POWN && x->b != y->b) return PAIR_PRODUCT;
  if (same && x->op != AMBIT_OP_MUL) return has_rule(p, x->op) && !is_root_of_data(p, x, y) ? PAIR_RULE : PAIR_PLAIN;
  bool product = x->op == AMBIT_OP_MUL || y->op == AMBIT_OP_MUL || x->op == AMBIT_OP_SQR || y->op == AMBIT_OP_SQR ||
                 x->op == AMBIT_OP_POWN || y->op == AMBIT_OP_POWN;
  return product ? PAIR_PRODUCT : PAIR_PLAIN;
}

static bool link_operands(ambit_pairs *p, ambit_expr u, ambit_expr w) {
  ambit_node x = *ambit_at(p->g, u), y = *ambit_at(p->g, w);
  item a = { x.a, 1, false }, c = { y.a, 1, false }, b = { x.b, 1, false }, d = { y.b, 1, false };
  if (!link(p, &a, &c)) return false;
  return !ambit_op_is_binary(x.op) || link(p, &b, &d);
}

bool ambit_pair_plan(ambit_pairs *p, uint32_t at) {
  ambit_expr u = p->pair[at].u, w = p->pair[at].w;
  ambit_pair_state state = kind_of(p, u, w);
  size_t first = p->nlink;
  bool done = true;
  if (state == PAIR_RULE) done = link_operands(p, u, w);
  if (state == PAIR_SUM) done = match(p, u, w, terms);
  if (state == PAIR_PRODUCT) done = match(p, u, w, factors);
  p->pair[at].state = state;
  p->pair[at].first = first;
  p->pair[at].count = p->nlink - first;
  return done;
}
