/* rational.c -- the number that a constant expression is, exactly. */
#include "verbs/run/rational.h"
#include <ambit/base.h>
#include <math.h>

#define MOST_DEPTH 200
#define MOST_VISITS 10000 /* an expression may use a part of it often: then it counts as none */

ambit_status ambit_rational_find(ambit_registry *r, const ambit_rational_service **s, ambit_failure *f) {
  const ambit_plugin *plugin;
  ambit_status status = ambit_registry_plugin(r, "service", "rational", &plugin, f);
  if (status != AMBIT_OK) return status;
  *s = plugin->get(AMBIT_RATIONAL_SERVICE);
  if (*s && (*s)->size >= sizeof **s) return AMBIT_OK;
  return ambit_fail(f, AMBIT_INVALID, "the plugin service/rational offers no %s", AMBIT_RATIONAL_SERVICE);
}

/* NOLINTNEXTLINE(misc-no-recursion) -- as deep as `depth` lets it */
static bool value_of(
    const ambit_rational_service *s, const ambit_graph *g, ambit_expr e, int depth, int *visits, ambit_rational *to) {
  const ambit_node *x = ambit_graph_node(g, e);
  if (!x->constant || depth > MOST_DEPTH || (*visits)++ > MOST_VISITS) return false;
  if (x->op == AMBIT_LEAF_CONSTANT) {
    if (x->value.lo == x->value.hi && isfinite(x->value.lo)) return s->set(to, x->value.lo), true;
    return x->text && s->read(to, x->text);
  }
  if (x->op >= AMBIT_LEAF_CONSTANT || !value_of(s, g, x->a, depth + 1, visits, to)) return false;
  if (x->op == AMBIT_OP_POWN) return s->apply(to, x->op, to, (int32_t)x->b);
  ambit_rational *b = s->open();
  bool good = b && value_of(s, g, x->b, depth + 1, visits, b) && s->apply(to, x->op, b, 0);
  s->close(b);
  return good;
}

bool ambit_rational_of(const ambit_rational_service *s, const ambit_graph *g, ambit_expr e, ambit_rational *x) {
  int visits = 0;
  return value_of(s, g, e, 0, &visits, x);
}
