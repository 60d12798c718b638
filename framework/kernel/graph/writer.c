/* writer.c -- the writer: a stack of pieces still to be written, no recursion. */
#include "graph/writer.h"
#include "base/vector.h"
#include <stdlib.h>
#include <string.h>

static int by_node(const void *p, const void *q) {
  const ambit_source_name *a = p, *b = q;
  return a->node < b->node ? -1 : a->node > b->node;
}

void ambit_source_names_sort(size_t n, ambit_source_name *list) {
  if (n > 0) qsort(list, n, sizeof *list, by_node);
}

const char *ambit_writer_name(const ambit_writer *w, ambit_expr e) {
  if (!w->names || w->names->n == 0) return NULL;
  const ambit_source_name key = { e, NULL };
  const ambit_source_name *found = bsearch(&key, w->names->list, w->names->n, sizeof key, by_node);
  return found ? found->name : NULL;
}

bool ambit_writer_brackets(const ambit_writer *w, ambit_expr e, int place) {
  if (place == AMBIT_BINDS_SUM || ambit_writer_name(w, e)) return false;
  uint32_t op = ambit_at(w->g, e)->op;
  if (place == AMBIT_BINDS_SIGN && (op == AMBIT_OP_MUL || op == AMBIT_OP_DIV))
    return false; /* with a sign or without */
  int s = w->style->strength(w, e);
  return place == AMBIT_BINDS_ADDEND ? s == AMBIT_BINDS_SIGN : s < place;
}

typedef enum stage { OPERAND, WRAPPED, ROOT, MIDDLE, TAIL, CLOSE } stage;

/* What is left to write: operand e in a place (the first three stages), or the rest of node e. */
typedef struct ambit_piece {
  ambit_expr e;
  int place;
  stage stage;
} piece;

bool ambit_writer_put(ambit_writer *w, const char *text) {
  size_t n = strlen(text), space = w->room - 1 - w->used;
  if (n > space && w->grows) {
    char *out = ambit_vector_reserve(w->out, &w->room, w->used + n + 1, 1);
    if (!out) return false;
    w->out = out;
  } else if (n > space) {
    n = space;
  }
  memcpy(w->out + w->used, text, n);
  w->used += n;
  return true;
}

static bool later(ambit_writer *w, ambit_expr e, int place, stage at) {
  piece *stack = ambit_vector_reserve(w->stack, &w->capacity, w->depth + 1, sizeof *stack);
  if (!stack) return false;
  w->stack = stack;
  stack[w->depth++] = (piece) { e, place, at };
  return true;
}

static bool put_node(ambit_writer *w, ambit_expr e) {
  const ambit_node *x = ambit_at(w->g, e);
  int32_t n = (int32_t)x->b;
  if (x->op == AMBIT_OP_POWN && (n > AMBIT_EXPONENT_MAX || n < -AMBIT_EXPONENT_MAX)) w->too_high = true;
  ambit_layout l = w->style->layout(w, e);
  return ambit_writer_put(w, l.head) && later(w, e, 0, l.two ? MIDDLE : TAIL) &&
         later(w, l.a, l.place_a, l.wrap ? WRAPPED : OPERAND);
}

static bool put_operand(ambit_writer *w, piece now) {
  bool leaf = ambit_op_is_leaf(ambit_at(w->g, now.e)->op);
  const char *name = leaf || now.stage != ROOT ? ambit_writer_name(w, now.e) : NULL;
  if (name) return ambit_writer_put(w, name);
  if (leaf && now.stage == WRAPPED) return w->style->leaf(w, now.e, true);
  if (ambit_writer_brackets(w, now.e, now.place) && !(ambit_writer_put(w, w->style->open) && later(w, now.e, 0, CLOSE)))
    return false;
  return leaf ? w->style->leaf(w, now.e, false) : put_node(w, now.e);
}

static bool put_piece(ambit_writer *w, piece now) {
  if (now.stage == CLOSE) return ambit_writer_put(w, w->style->close);
  if (now.stage != MIDDLE && now.stage != TAIL) return put_operand(w, now);
  ambit_layout l = w->style->layout(w, now.e);
  if (now.stage == TAIL) return ambit_writer_put(w, l.tail);
  return ambit_writer_put(w, l.middle) && later(w, now.e, 0, TAIL) && later(w, l.b, l.place_b, OPERAND);
}

bool ambit_writer_run(ambit_writer *w, ambit_expr e) {
  bool done = later(w, e, AMBIT_BINDS_SUM, ROOT);
  while (done && w->depth > 0 && (w->grows ? w->used <= AMBIT_SOURCE_MAX : w->used < w->room - 1))
    done = put_piece(w, w->stack[--w->depth]);
  w->out[w->used] = '\0';
  free(w->stack);
  w->stack = NULL;
  return done;
}

bool ambit_writer_begin(const ambit_graph *g, ambit_expr e, size_t room, char *out) {
  ambit_writer w = { .g = g, .style = &ambit_style_text, .out = out, .room = room };
  return ambit_writer_run(&w, e) && w.used + 1 < room;
}
