/* tight.c -- constant expressions with more and more digits. */
#include "verbs/evaluate/tight.h"
#include "models/default.h"
#include <ambit/evaluate.h>
#include <math.h>

#define ENOUGH 0x1p-48 /* width per magnitude that sums of a few literals stay below: no plugin is loaded for them */
#define TIGHT 0x1p-50  /* what is asked of the plugin */
#define SMALLEST 0x1p-1074

static bool is_narrow(ambit_interval x, double relative) {
  if (!ambit_interval_is_bounded(x)) return false; /* a divisor that may be 0 as far as doubles know */
  return ambit_interval_width(x) <= fmax(relative * ambit_interval_mag(x), 2 * SMALLEST);
}

ambit_interval ambit_tight(ambit_graph *g, ambit_registry *registry, ambit_expr e) {
  static const char *const bits[] = { "128", "512", "2048", "8192" };
  ambit_interval x = ambit_graph_node(g, e)->range;
  if (ambit_interval_is_empty(x) || is_narrow(x, ENOUGH)) return x;
  for (size_t i = 0; i < sizeof bits / sizeof *bits && !is_narrow(x, TIGHT); i++) {
    const ambit_option precision = { "precision", bits[i] };
    const ambit_evaluate_request q = { .graph = g,
      .registry = registry,
      .arithmetic = AMBIT_DEFAULT_DIGITS,
      .noption = 1,
      .option = &precision,
      .nexpr = 1,
      .expr = &e };
    ambit_interval y;
    uint32_t flags;
    ambit_failure f = { 0 };
    if (ambit_evaluate(&q, &y, &flags, NULL, &f) != AMBIT_OK) return x;
    y = ambit_interval_intersect(x, y);
    if (!flags && !ambit_interval_is_empty(y)) x = y;
  }
  return x;
}
