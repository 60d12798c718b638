/* sample_extremes.c -- what is kept of draws. */
#include "verbs/sample/sample_extremes.h"

bool ambit_extremes_open(ambit_extremes *e, ambit_arena *arena, size_t m, size_t n) {
  *e = (ambit_extremes) { .m = m, .n = n };
  size_t sides = m * AMBIT_SIDES;
  e->at = ambit_arena_alloc(arena, (sides + 1) * sizeof *e->at);
  double *point = ambit_arena_alloc(arena, (sides * n + 1) * sizeof *point);
  if (!e->at || !point) return false;
  for (size_t i = 0; i < sides; i++) e->at[i].point = point + i * n;
  return true;
}

static bool beats(const ambit_extreme *x, int side, double value, size_t draw) {
  if (!x->seen) return true;
  if (value == x->value) return draw < x->draw;
  return side == AMBIT_LEAST ? value < x->value : value > x->value;
}

bool ambit_extremes_see(ambit_extremes *e, size_t j, double value, size_t draw, const double *point, size_t stride) {
  bool news = false;
  if (value != value) return false;
  for (int side = 0; side < AMBIT_SIDES; side++) {
    ambit_extreme *x = &e->at[j * AMBIT_SIDES + (size_t)side];
    if (!beats(x, side, value, draw)) continue;
    x->seen = news = true;
    x->value = value;
    x->draw = draw;
    for (size_t i = 0; i < e->n; i++) x->point[i] = point[i * stride];
  }
  return news;
}

void ambit_extremes_merge(ambit_extremes *into, const ambit_extremes *from) {
  for (size_t i = 0; i < from->m * AMBIT_SIDES; i++) {
    const ambit_extreme *x = &from->at[i];
    if (x->seen) ambit_extremes_see(into, i / AMBIT_SIDES, x->value, x->draw, x->point, 1);
  }
}
