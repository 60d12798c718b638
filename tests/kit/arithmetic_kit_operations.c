/* arithmetic_kit_operations.c -- every operation on thin, wide and nasty sets, in runs over all lanes. */
#include "kit/arithmetic_kit_inside.h"
#include <fenv.h>
#include <float.h>
#include <math.h>
#include <string.h>

enum { OPERANDS = 6, MOST = 4, RESULTS = OPERANDS };

/* A real arithmetic proves nothing: its result at a point must be near. */
static bool is_near(kit_set r, double lo, double hi) {
  double room = 1e-9 * fmax(fabs(lo), fabs(hi)) + 1e-300;
  return r.lo <= hi + room && r.hi >= lo - room;
}

/* The kernel keeps its own functions out of environments that flush; only the plugin's are called there. What is not
** rigorous must only leave each environment as it was. */
static bool is_excused(const kit_state *s, uint32_t op) {
  const kit_environment *e = s->environment;
  return s->rigorous ? e->flush && !kit_is_own(s->kit, op) : e->flush || e->mode != FE_TONEAREST;
}

/* One call over several lanes and what is known about one instruction in it. */
typedef struct call {
  uint32_t op, flags;
  int32_t n; /* exponent of POWN */
} call;

static void judge_point(kit_state *s, const call *c, kit_set a, kit_set b, double x, double y, kit_set r) {
  if (is_excused(s, c->op)) return;
  if (!s->rigorous && (a.lo < a.hi || b.lo < b.hi)) return; /* it computes with one number of each */
  double lo = s->kit->oracle(c->op, x, y, c->n, false), hi = s->kit->oracle(c->op, x, y, c->n, true);
  s->judged++;
  if (isnan(lo)) {
    if (!(c->flags & AMBIT_F_PARTIAL))
      kit_find(s, "partial", "%s over [%a, %a], [%a, %a], n = %d leaves the domain at (%a, %a) without PARTIAL (%s)",
          kit_op_name[c->op], a.lo, a.hi, b.lo, b.hi, c->n, x, y, s->environment->name);
    return;
  }
  bool ok = s->rigorous ? r.lo <= lo && hi <= r.hi : is_near(r, lo, hi);
  if (!ok)
    kit_find(s, "inclusion", "%s over [%a, %a], [%a, %a], n = %d is [%a, %a], but at (%a, %a) it is in [%a, %a] (%s)",
        kit_op_name[c->op], a.lo, a.hi, b.lo, b.hi, c->n, r.lo, r.hi, x, y, lo, hi, s->environment->name);
}

/* same: both operands are one element */
static void judge_lane(kit_state *s, const call *c, kit_set a, kit_set b, bool same, kit_set r, int points) {
  bool empty = kit_is_empty(r), sane = !isnan(r.lo) && !isnan(r.hi) && (r.lo <= r.hi || empty);
  if (!sane) kit_find(s, "inclusion", "%s yields bounds [%a, %a]", kit_op_name[c->op], r.lo, r.hi);
  if (empty && !(c->flags & AMBIT_F_EMPTY)) kit_find(s, "flags", "%s is empty without EMPTY", kit_op_name[c->op]);
  bool unbounded = !empty && (r.lo == -INFINITY || r.hi == INFINITY);
  /* the kernel's default does not know that the plugin's set() has made a bounded result unbounded */
  if (unbounded && !(c->flags & AMBIT_F_UNBOUNDED) && kit_is_own(s->kit, c->op))
    kit_find(s, "flags", "%s is unbounded without UNBOUNDED", kit_op_name[c->op]);
  for (int i = 0; i < points; i++) {
    double x = kit_point_of(s, a), y = same ? x : kit_point_of(s, b);
    judge_point(s, c, a, b, x, y, r);
  }
}

static int32_t any_exponent(kit_state *s) {
  static const int32_t nasty[] = { 0, 1, 2, -1, -2, INT32_MAX, INT32_MIN, INT32_MIN + 1, 1075, -1074, 100 };
  uint64_t r = kit_random(s);
  return r % 4 == 0 ? nasty[(r >> 8) % (sizeof nasty / sizeof *nasty)] : (int32_t)((r >> 8) % 25) - 12;
}

static void fill_pattern(kit_state *s, uint32_t slot, size_t from) {
  for (size_t l = from; l < s->pitch; l++) memcpy(kit_at(s, slot, l), s->pattern, s->elem);
}

static void check_pattern(kit_state *s, uint32_t op, uint32_t slot, size_t from) {
  for (size_t l = from; l < s->pitch; l++)
    if (memcmp(kit_at(s, slot, l), s->pattern, s->elem) != 0)
      kit_find(s, "layout", "%s writes lane %zu of %zu", kit_op_name[op], l, from);
}

/* a run of up to MOST instructions over up to pitch - 1 lanes, operands shared at random */
static void check_run(kit_state *s, uint32_t op, int points) {
  kit_set in[OPERANDS][KIT_PITCH];
  uint32_t dst[MOST], a[MOST], b[MOST];
  size_t count = 1 + kit_random(s) % MOST, most = s->pitch - 1;
  size_t lanes = 1 + kit_random(s) % (kit_random(s) % 4 || most < 7 ? (most < 7 ? most : 7) : most);
  for (uint32_t slot = 0; slot < OPERANDS; slot++)
    for (size_t l = 0; l < lanes; l++) kit_set_element(s, slot, l, in[slot][l] = kit_any_set(s));
  for (uint32_t i = 0; i < count; i++) {
    dst[i] = RESULTS + i, a[i] = (uint32_t)(kit_random(s) % OPERANDS);
    b[i] = kit_op_arity[op] == 2 ? (uint32_t)(kit_random(s) % OPERANDS) : a[i];
    if (op == AMBIT_OP_POWN) b[i] = (uint32_t)any_exponent(s);
    if (!s->full->init) fill_pattern(s, dst[i], lanes);
  }
  call c = { op, kit_run(s, op, count, dst, a, b, lanes), 0 };
  for (uint32_t i = 0; i < count; i++) {
    uint32_t right = op == AMBIT_OP_POWN ? a[i] : b[i];
    c.n = op == AMBIT_OP_POWN ? (int32_t)b[i] : 0;
    for (size_t l = 0; l < lanes; l++)
      judge_lane(s, &c, in[a[i]][l], in[right][l], a[i] == right, kit_bounds_of(s, dst[i], l), points);
    if (!s->full->init) check_pattern(s, op, dst[i], lanes);
  }
  for (uint32_t slot = 0; slot < OPERANDS && s->rigorous; slot++) {
    size_t l = kit_random(s) % lanes;
    kit_set x = kit_bounds_of(s, slot, l);
    if (!(x.lo <= in[slot][l].lo && in[slot][l].hi <= x.hi))
      kit_find(s, "layout", "%s changes an operand: [%a, %a] became [%a, %a]", kit_op_name[op], in[slot][l].lo,
          in[slot][l].hi, x.lo, x.hi);
  }
}

static void check_empty(kit_state *s, uint32_t op) {
  const kit_set none = { INFINITY, -INFINITY }, some = { 1, 2 };
  enum { A, B, R };
  for (int which = 0; which < kit_op_arity[op]; which++) {
    for (size_t l = 0; l < 3; l++) {
      kit_set_element(s, A, l, which == 0 && l == 1 ? none : some);
      kit_set_element(s, B, l, which == 1 && l == 1 ? none : some);
    }
    uint32_t word = op == AMBIT_OP_POWN ? 2 : kit_op_arity[op] == 2 ? B : A;
    uint32_t flags = kit_apply(s, op, R, A, word, 3);
    kit_set r = kit_bounds_of(s, R, 1);
    s->judged++;
    if (!kit_is_empty(r)) kit_find(s, "empty", "%s of the empty set is [%a, %a]", kit_op_name[op], r.lo, r.hi);
    if (!(flags & AMBIT_F_EMPTY)) kit_find(s, "empty", "%s of the empty set does not raise EMPTY", kit_op_name[op]);
    if (op != AMBIT_OP_ASIN && op != AMBIT_OP_ACOS && kit_is_empty(kit_bounds_of(s, R, 2)))
      kit_find(s, "empty", "%s: an empty lane spoils its neighbour", kit_op_name[op]);
  }
}

/* where everything is defined, bounded and far from the rim, no flag has a reason */
static void check_flags(kit_state *s, uint32_t op) {
  kit_set_element(s, 0, 0, (kit_set) { 0.25, 0.375 }), kit_set_element(s, 1, 0, (kit_set) { 0.5, 0.625 });
  uint32_t word = op == AMBIT_OP_POWN ? 3 : kit_op_arity[op] == 2 ? 1 : 0;
  uint32_t flags = kit_apply(s, op, 2, 0, word, 1);
  s->judged++;
  if (flags) kit_find(s, "flags", "%s of [0.25, 0.375], [0.5, 0.625] raises flags %u", kit_op_name[op], flags);
}

/* The poles of the tangent are no doubles: no sample meets one. */
static void check_poles(kit_state *s) {
  for (int k = -9; k <= 9 && s->rigorous; k += 2) {
    double pole = k * 0x1.921fb54442d18p+0, reach = ldexp(1, -(int)(kit_random(s) % 40)); /* farther than it is off */
    kit_set_element(s, 0, 0, (kit_set) { pole - reach, pole + reach });
    uint32_t flags = kit_apply(s, AMBIT_OP_TAN, 1, 0, 0, 1);
    s->judged++;
    if (!(flags & AMBIT_F_PARTIAL))
      kit_find(s, "partial", "TAN over [%a, %a] passes a pole without PARTIAL", pole - reach, pole + reach);
  }
}

void kit_check_operations(kit_state *s) {
  double end = s->deadline;
  for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++) {
    kit_reseed(s, op);
    kit_slice(s, 1.2 / AMBIT_OP_COUNT);
    for (int round = 0; kit_more(s, round, 500); round++) check_run(s, op, 2);
    check_empty(s, op);
    check_flags(s, op);
  }
  check_poles(s);
  s->deadline = end;
}

void kit_check_briefly(kit_state *s, int rounds) {
  for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++) {
    for (int round = 0; round < rounds; round++) check_run(s, op, 1);
    if (s->rigorous) check_empty(s, op);
  }
}

/* -- every operation on every pair of sets at the rim of what doubles can say
*/

static const kit_set special[] = { { 0, 0 }, { -0.0, -0.0 }, { -0.0, 0x1p-1074 }, { -0x1p-1074, 0x1p-1074 },
  { 0x1p-1074, 0x1p-1074 }, { -DBL_MIN, -0x1p-1074 }, { 0, INFINITY }, { -INFINITY, 0 }, { -INFINITY, INFINITY },
  { DBL_MAX, DBL_MAX }, { DBL_MAX, INFINITY }, { -INFINITY, -DBL_MAX }, { -DBL_MAX, DBL_MAX }, { 1, 1 }, { -1, 1 },
  { 0x1.fffffffffffffp-1, 0x1.0000000000001p0 }, { 0, 1 }, { -1, -0.0 }, { 1, INFINITY }, { -INFINITY, -1 },
  { -3, 0x1p-60 }, { 0x1.921fb54442d18p+0, 0x1.921fb54442d19p+0 }, { 0x1.921fb54442d18p+1, 0x1.921fb54442d18p+1 },
  { 1e15, 1e15 }, { 709.782712893384, 709.782712893384 }, { -745.1332191019412, -745.1332191019411 } };

enum { SPECIAL = sizeof special / sizeof *special };

static void check_pair(kit_state *s, uint32_t op, kit_set a, kit_set b, int32_t n) {
  kit_set_element(s, 0, 0, a), kit_set_element(s, 1, 0, b);
  uint32_t word = op == AMBIT_OP_POWN ? (uint32_t)n : kit_op_arity[op] == 2 ? 1 : 0;
  call c = { op, kit_apply(s, op, 2, 0, word, 1), n };
  judge_lane(s, &c, a, b, false, kit_bounds_of(s, 2, 0), kit_op_arity[op] == 2 ? 2 : 4);
}

void kit_check_special_sets(kit_state *s) {
  static const int32_t exponent[] = { 0, 1, 2, 3, -1, -2, -3, INT32_MAX, INT32_MIN };
  for (int round = 0; kit_more(s, round, 2); round++)
    for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++)
      for (size_t i = 0; i < SPECIAL; i++) {
        size_t others = op == AMBIT_OP_POWN ? sizeof exponent / sizeof *exponent : kit_op_arity[op] == 2 ? SPECIAL : 1;
        for (size_t k = 0; k < others; k++)
          check_pair(
              s, op, special[i], op == AMBIT_OP_POWN ? special[i] : special[k], op == AMBIT_OP_POWN ? exponent[k] : 0);
      }
}

/* -- isotonicity: an observation, unless the arithmetic promises it */

static kit_set subset_of(kit_state *s, kit_set x) {
  double p = kit_point_of(s, x), q = kit_point_of(s, x);
  return p <= q ? (kit_set) { p, q } : (kit_set) { q, p };
}

static void check_part(kit_state *s, uint32_t op, size_t *broken) {
  kit_set a = kit_any_set(s), b = kit_any_set(s);
  uint32_t word = op == AMBIT_OP_POWN ? (uint32_t)((int32_t)(kit_random(s) % 13) - 6) : kit_op_arity[op] == 2 ? 1 : 0;
  kit_set_element(s, 0, 0, a), kit_set_element(s, 1, 0, b);
  kit_set_element(s, 0, 1, subset_of(s, a)), kit_set_element(s, 1, 1, subset_of(s, b));
  kit_apply(s, op, 2, 0, word, 2);
  kit_set whole = kit_bounds_of(s, 2, 0), part = kit_bounds_of(s, 2, 1);
  s->judged++;
  if (kit_is_empty(part) || (whole.lo <= part.lo && part.hi <= whole.hi)) return;
  ++*broken;
  if (s->kit->isotonic)
    kit_find(s, "isotonicity", "%s of a part of [%a, %a], [%a, %a] is [%a, %a], outside [%a, %a]", kit_op_name[op],
        a.lo, a.hi, b.lo, b.hi, part.lo, part.hi, whole.lo, whole.hi);
}

void kit_check_isotonic(kit_state *s) {
  size_t broken = 0;
  for (int round = 0; s->rigorous && kit_more(s, round, 200); round++)
    for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++) check_part(s, op, &broken);
  if (!s->kit->isotonic && broken) s->judged = 0; /* not isotonic, and not meant to be: nothing was checked */
}
