/* name.c -- names of uncertain data. */
#include "graph/name.h"
#include "num/decimal.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DIGITS 3 /* of the width of a range in a name */

static bool is_nameless(const ambit_node *node) { return ambit_leaf_is_uncertain(node->op) && !node->text; }

static bool name_leaves(ambit_graph *g, size_t n, const ambit_expr *leaf, const char *label) {
  unsigned number = 0;
  bool good = true;
  for (size_t i = 0; good && i < n; i++) {
    char name[AMBIT_DATUM_NAME_MAX];
    if (!is_nameless(ambit_graph_node(g, leaf[i]))) continue;
    number++;
    snprintf(name, sizeof name, number > 1 ? "%s (%u)" : "%s", label, number);
    good = ambit_graph_name(g, leaf[i], name);
  }
  return good;
}

bool ambit_graph_name_data(ambit_graph *g, ambit_expr e, const char *label) {
  ambit_expr few[16], *leaf = few;
  const ambit_node *node = ambit_graph_node(g, e);
  if (node->constant) return true;
  if (node->op >= AMBIT_LEAF_CONSTANT) return name_leaves(g, 1, &e, label);
  size_t n = ambit_graph_leaves(g, 1, &e, sizeof few / sizeof *few, few);
  if (n > sizeof few / sizeof *few) {
    leaf = malloc(n * sizeof *leaf);
    if (!leaf) return false;
    ambit_graph_leaves(g, 1, &e, n, leaf);
  }
  bool good = name_leaves(g, n, leaf, label);
  if (leaf != few) free(leaf);
  return good;
}

static const char *place_of(const ambit_node *node) {
  return ambit_leaf_is_uncertain(node->op) && node->unit ? node->unit : "";
}

void ambit_graph_leaf_name(const ambit_graph *g, ambit_expr leaf, char out[AMBIT_DATUM_NAME_MAX]) {
  const ambit_node *node = ambit_graph_node(g, leaf);
  char range[3 * AMBIT_DECIMAL_MAX];
  if (!is_nameless(node)) {
    snprintf(out, AMBIT_DATUM_NAME_MAX, "%s", node->text ? node->text : "t");
    return;
  }
  ambit_decimal_interval(range, node->value, DIGITS);
  const char *place = place_of(node);
  snprintf(out, AMBIT_DATUM_NAME_MAX, *place ? "datum in %s (%s)" : "datum in %s", range, place);
}

typedef struct entry {
  size_t i; /* of the list */
  const char *name, *place;
} entry;

static int by_name(const void *x, const void *y) {
  const entry *a = x, *b = y;
  int order = strcmp(a->name, b->name);
  if (!order) order = strcmp(a->place, b->place);
  return order ? order : (a->i > b->i) - (a->i < b->i);
}

/* The neighbours [from, to) of equal names get their lines, and numbers where these are equal. */
static bool tell_apart(ambit_arena *arena, entry *list, size_t from, size_t to, const char **name) {
  unsigned number = 0;
  for (size_t i = from; i < to; i++) {
    char text[AMBIT_DATUM_NAME_MAX + 64];
    number = i > from && strcmp(list[i].place, list[i - 1].place) == 0 ? number + 1 : 1;
    int used = snprintf(text, sizeof text, "%s", list[i].name);
    if (*list[i].place && !strstr(list[i].name, list[i].place))
      used += snprintf(text + used, sizeof text - (size_t)used, " (%.60s)", list[i].place);
    if (number > 1 && used < (int)sizeof text) snprintf(text + used, sizeof text - (size_t)used, " (%u)", number);
    if (!(name[list[i].i] = ambit_arena_text(arena, text))) return false;
  }
  return true;
}

bool ambit_graph_leaf_names(
    const ambit_graph *g, ambit_arena *arena, size_t n, const ambit_expr *leaf, const char **name) {
  entry *list = malloc((n + 1) * sizeof *list);
  bool good = list != NULL;
  for (size_t i = 0; good && i < n; i++) {
    char text[AMBIT_DATUM_NAME_MAX];
    ambit_graph_leaf_name(g, leaf[i], text);
    good = (name[i] = ambit_arena_text(arena, text)) != NULL;
    list[i] = (entry) { i, name[i], place_of(ambit_graph_node(g, leaf[i])) };
  }
  if (good) qsort(list, n, sizeof *list, by_name);
  for (size_t from = 0, to; good && from < n; from = to) {
    for (to = from + 1; to < n && strcmp(list[to].name, list[from].name) == 0; to++) {}
    if (to > from + 1) good = tell_apart(arena, list, from, to, name);
  }
  free(list);
  return good;
}
