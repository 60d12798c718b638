/* arithmetic_kit_elements.c -- set and bounds. */
#include "kit/arithmetic_kit_inside.h"
#include <float.h>
#include <math.h>

static void judge(kit_state *s, kit_set x, kit_set got, const char *how) {
  s->judged++;
  bool sane = !isnan(got.lo) && !isnan(got.hi) && got.lo <= got.hi;
  if (!sane || (s->rigorous && !(got.lo <= x.lo && x.hi <= got.hi)))
    kit_find(s, "bounds", "[%a, %a] %s has bounds [%a, %a], which do not contain it", x.lo, x.hi, how, got.lo, got.hi);
}

static void check_one(kit_state *s, kit_set x) {
  kit_set_element(s, 0, 0, x);
  judge(s, x, kit_bounds_of(s, 0, 0), "by set");
  kit_set_variable(s, 0, 0, x, (int32_t)(kit_random(s) % KIT_NVAR));
  judge(s, x, kit_bounds_of(s, 0, 0), "as a variable");
  judge(s, x, kit_through(s, 1, x), "between enter and leave");
}

/* n elements by one call, over an element that held something else */
static void check_many(kit_state *s) {
  size_t n = 1 + kit_random(s) % s->pitch;
  double lo[KIT_PITCH], hi[KIT_PITCH], down[KIT_PITCH], up[KIT_PITCH];
  for (size_t i = 0; i < n; i++) {
    kit_set x = kit_any_set(s);
    lo[i] = x.lo, hi[i] = x.hi;
  }
  if (n < s->pitch) kit_set_element(s, 2, n, (kit_set) { 5, 6 });
  s->full->set(s->ctx, kit_at(s, 2, 0), n, lo, hi, -1);
  s->full->bounds(s->ctx, kit_at(s, 2, 0), n, down, up);
  for (size_t i = 0; i < n; i++) judge(s, (kit_set) { lo[i], hi[i] }, (kit_set) { down[i], up[i] }, "among others");
  if (n == s->pitch) return;
  kit_set next = kit_bounds_of(s, 2, n);
  if (!(next.lo <= 6 && next.hi >= 5)) kit_find(s, "bounds", "set of %zu elements writes the next one", n);
}

void kit_check_elements(kit_state *s) {
  static const kit_set special[] = { { -INFINITY, INFINITY }, { 0, 0 }, { -0.0, 0.0 }, { -0x1p-1074, 0x1p-1074 },
    { 0x1p-1074, 0x1p-1074 }, { DBL_MAX, INFINITY }, { -INFINITY, -DBL_MAX }, { DBL_MAX, DBL_MAX },
    { -DBL_MAX, DBL_MAX }, { DBL_MIN, DBL_MIN }, { 1, 0x1.0000000000001p0 } };
  for (size_t i = 0; i < sizeof special / sizeof *special; i++) check_one(s, special[i]);
  for (int i = 0; kit_more(s, i, 1000); i++) {
    check_one(s, kit_any_set(s));
    if (i % 8 == 0) check_many(s);
  }
  kit_set_element(s, 0, 0, (kit_set) { INFINITY, -INFINITY });
  s->judged++;
  if (!kit_is_empty(kit_bounds_of(s, 0, 0))) kit_find(s, "bounds", "the empty set does not come back as (inf, -inf)");
}
