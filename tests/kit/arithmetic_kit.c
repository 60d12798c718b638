/* arithmetic_kit.c -- tier 1: elements, every operation on thin, wide and nasty sets, flags, layout, rounding mode. */
#include "kit/arithmetic_kit_inside.h"
#include <fenv.h>
#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void kit_find(kit_state *s, const char *check, const char *format, ...) {
  char message[512];
  va_list arguments;
  s->findings++;
  if (!s->last || strcmp(s->last, check) != 0) s->last = check, s->repeats = 0;
  if (s->repeats++ >= 5) return;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  s->kit->finding(s->kit->user, check, message);
}

static const char *const op_name[] = {
#define NAME(name, arity, symbol) #name,
  AMBIT_OPS(NAME)
#undef NAME
};
static const int op_arity[] = {
#define ARITY(name, arity, symbol) arity,
  AMBIT_OPS(ARITY)
#undef ARITY
};

uint64_t kit_random(kit_state *s) { /* xorshift64*, Vigna 2016 */
  s->random ^= s->random >> 12, s->random ^= s->random << 25, s->random ^= s->random >> 27;
  return s->random * 0x2545F4914F6CDD1Dull;
}

double kit_uniform(kit_state *s, double lo, double hi) {
  return lo + (hi - lo) * ((double)(kit_random(s) >> 11) * 0x1p-53);
}

static double any_double(kit_state *s) {
  static const double nasty[] = { 0.0, -0.0, 1, -1, 0.5, 2, DBL_MIN, -0x1p-1074, 0x1p-1074, DBL_MAX, -DBL_MAX, 0x1p53,
    1e300, 1e-300, 0x1.921fb54442d18p+0, 0x1.921fb54442d18p+1, 0x1.fffffffffffffp-1, 0x1.0000000000001p0, 709.78,
    -745.2 };
  uint64_t r = kit_random(s);
  if (r % 6 == 0) return nasty[(r >> 8) % (sizeof nasty / sizeof *nasty)];
  if (r % 6 == 1) return ldexp(kit_uniform(s, -1, 1), (int)((r >> 8) % 2098) - 1074);
  return kit_uniform(s, -8, 8);
}

kit_set kit_any_set(kit_state *s) {
  double a = any_double(s), b = any_double(s);
  switch (kit_random(s) % 8) {
  case 0:
  case 1: return (kit_set) { a, a };
  case 2: return (kit_set) { a, a < DBL_MAX ? nextafter(a, INFINITY) : a };
  case 3: return (kit_set) { -INFINITY, a };
  case 4: return (kit_set) { a, INFINITY };
  default: return a <= b ? (kit_set) { a, b } : (kit_set) { b, a };
  }
}

/* an end of x, or something between */
static double point_of(kit_state *s, kit_set x) {
  double lo = fmax(x.lo, -DBL_MAX), hi = fmin(x.hi, DBL_MAX), p = 0;
  switch (kit_random(s) % 4) {
  case 0: return lo;
  case 1: return hi;
  case 2: p = lo / 2 + hi / 2; break;
  default: p = any_double(s); break;
  }
  return p < lo ? lo : p > hi ? hi : p;
}

/* -- a block of three slots: a, b, r */

void *kit_at(const kit_state *s, uint32_t slot, size_t lane) { return s->block + (slot * s->pitch + lane) * s->elem; }

void kit_set_element(kit_state *s, uint32_t slot, size_t lane, kit_set x) {
  s->full->set(s->ctx, kit_at(s, slot, lane), 1, &x.lo, &x.hi, -1);
}

kit_set kit_bounds_of(kit_state *s, uint32_t slot, size_t lane) {
  kit_set x = { NAN, NAN };
  s->full->bounds(s->ctx, kit_at(s, slot, lane), 1, &x.lo, &x.hi);
  return x;
}

uint32_t kit_apply(kit_state *s, uint32_t op, uint32_t dst, uint32_t a, uint32_t b, size_t lanes) {
  if (s->full->enter) s->full->enter(s->ctx);
  uint32_t flags = s->full->run[op](s->full, s->ctx, s->block, s->pitch, lanes, 1, &dst, &a, &b);
  if (s->full->leave) s->full->leave(s->ctx);
  return flags;
}

static bool is_empty(kit_set x) { return x.lo == INFINITY && x.hi == -INFINITY; }
static bool is_whole(kit_set x) { return !isnan(x.lo) && !isnan(x.hi) && (x.lo <= x.hi || is_empty(x)); }

/* -- set and bounds */

static void check_elements(kit_state *s) {
  for (int i = 0; i < 2000; i++) {
    kit_set x = kit_any_set(s), inside, outside;
    if (i == 0) x = (kit_set) { -INFINITY, INFINITY };
    kit_set_element(s, 0, 0, x);
    outside = kit_bounds_of(s, 0, 0);
    if (s->full->enter) s->full->enter(s->ctx);
    kit_set_element(s, 1, 0, x);
    inside = kit_bounds_of(s, 1, 0);
    if (s->full->leave) s->full->leave(s->ctx);
    if (!is_whole(outside))
      kit_find(s, "bounds", "set [%a, %a] has bounds [%a, %a]", x.lo, x.hi, outside.lo, outside.hi);
    else if (s->rigorous && !(outside.lo <= x.lo && x.hi <= outside.hi))
      kit_find(
          s, "bounds", "set [%a, %a] has bounds [%a, %a], which do not contain it", x.lo, x.hi, outside.lo, outside.hi);
    if (inside.lo > outside.lo && s->rigorous && inside.lo > x.lo)
      kit_find(s, "bounds", "set [%a, %a] between enter and leave loses its lower end: %a", x.lo, x.hi, inside.lo);
  }
  kit_set_element(s, 0, 0, (kit_set) { INFINITY, -INFINITY });
  if (!is_empty(kit_bounds_of(s, 0, 0))) kit_find(s, "bounds", "the empty set does not come back as (inf, -inf)");
}

/* -- operations */

static int32_t exponent_of(uint32_t op, uint32_t word) { return op == AMBIT_OP_POWN ? (int32_t)word : 0; }

/* A real arithmetic proves nothing: its result at a point must be near. */
static bool is_near(kit_set r, double lo, double hi) {
  double room = 1e-9 * fmax(fabs(lo), fabs(hi)) + 1e-300;
  return r.lo <= hi + room && r.hi >= lo - room;
}

static void judge(
    kit_state *s, uint32_t op, int32_t n, kit_set a, kit_set b, double x, double y, kit_set r, uint32_t flags) {
  if (!s->rigorous && (a.lo < a.hi || b.lo < b.hi)) return; /* it computes with one number of each */
  double lo = s->kit->oracle(op, x, y, n, false), hi = s->kit->oracle(op, x, y, n, true);
  if (isnan(lo)) {
    if (!(flags & AMBIT_F_PARTIAL))
      kit_find(s, "partial", "%s over [%a, %a], [%a, %a], n = %d leaves the domain at (%a, %a) without PARTIAL",
          op_name[op], a.lo, a.hi, b.lo, b.hi, n, x, y);
    return;
  }
  bool ok = s->rigorous ? r.lo <= lo && hi <= r.hi : is_near(r, lo, hi);
  if (!ok)
    kit_find(s, "inclusion", "%s over [%a, %a], [%a, %a], n = %d is [%a, %a], but at (%a, %a) it is in [%a, %a]",
        op_name[op], a.lo, a.hi, b.lo, b.hi, n, r.lo, r.hi, x, y, lo, hi);
}

static void judge_lane(kit_state *s, uint32_t op, uint32_t word, kit_set a, kit_set b, kit_set r, uint32_t flags) {
  if (!is_whole(r)) kit_find(s, "inclusion", "%s yields bounds [%a, %a]", op_name[op], r.lo, r.hi);
  if (is_empty(r) && !(flags & AMBIT_F_EMPTY)) kit_find(s, "flags", "%s is empty without EMPTY", op_name[op]);
  bool unbounded = !is_empty(r) && (r.lo == -INFINITY || r.hi == INFINITY);
  if (unbounded && !(flags & AMBIT_F_UNBOUNDED)) kit_find(s, "flags", "%s is unbounded without UNBOUNDED", op_name[op]);
  for (int i = 0; i < 4; i++) judge(s, op, exponent_of(op, word), a, b, point_of(s, a), point_of(s, b), r, flags);
}

static void check_padding(kit_state *s, uint32_t op, size_t lanes) {
  for (size_t l = lanes; l < s->pitch; l++)
    if (memcmp(kit_at(s, KIT_R, l), s->pattern, s->elem) != 0)
      kit_find(s, "layout", "%s writes lane %zu of %zu", op_name[op], l, lanes);
}

static void check_operation(kit_state *s, uint32_t op) {
  kit_set a[KIT_PITCH], b[KIT_PITCH];
  for (int round = 0; round < 120; round++) {
    size_t lanes = 1 + kit_random(s) % (KIT_PITCH - 1);
    uint32_t word = op == AMBIT_OP_POWN ? (uint32_t)((int32_t)(kit_random(s) % 25) - 12) : KIT_B;
    if (op_arity[op] == 1 && op != AMBIT_OP_POWN) word = KIT_A;
    for (size_t l = 0; l < lanes; l++) {
      a[l] = kit_any_set(s), b[l] = op_arity[op] == 2 ? kit_any_set(s) : a[l];
      kit_set_element(s, KIT_A, l, a[l]), kit_set_element(s, KIT_B, l, b[l]);
    }
    if (!s->full->init)
      for (size_t l = lanes; l < s->pitch; l++) memcpy(kit_at(s, KIT_R, l), s->pattern, s->elem);
    uint32_t flags = kit_apply(s, op, KIT_R, KIT_A, word, lanes);
    for (size_t l = 0; l < lanes; l++) judge_lane(s, op, word, a[l], b[l], kit_bounds_of(s, KIT_R, l), flags);
    if (!s->full->init) check_padding(s, op, lanes);
  }
}

/* both operands in the same slot: x op x */
static void check_same_operand(kit_state *s, uint32_t op) {
  for (int round = 0; round < 60; round++) {
    kit_set x = kit_any_set(s);
    kit_set_element(s, KIT_A, 0, x);
    uint32_t flags = kit_apply(s, op, KIT_R, KIT_A, KIT_A, 1);
    kit_set r = kit_bounds_of(s, KIT_R, 0);
    for (int i = 0; i < 4; i++) {
      double p = point_of(s, x);
      judge(s, op, 0, x, x, p, p, r, flags);
    }
  }
}

static void check_empty(kit_state *s, uint32_t op) {
  const kit_set none = { INFINITY, -INFINITY }, some = { 1, 2 };
  for (int which = 0; which < op_arity[op]; which++) {
    for (size_t l = 0; l < 3; l++) {
      kit_set_element(s, KIT_A, l, which == 0 && l == 1 ? none : some);
      kit_set_element(s, KIT_B, l, which == 1 && l == 1 ? none : some);
    }
    uint32_t word = op == AMBIT_OP_POWN ? 2 : op_arity[op] == 2 ? KIT_B : KIT_A;
    uint32_t flags = kit_apply(s, op, KIT_R, KIT_A, word, 3);
    kit_set r = kit_bounds_of(s, KIT_R, 1);
    if (!is_empty(r)) kit_find(s, "empty", "%s of the empty set is [%a, %a]", op_name[op], r.lo, r.hi);
    if (!(flags & AMBIT_F_EMPTY)) kit_find(s, "empty", "%s of the empty set does not raise EMPTY", op_name[op]);
    if (op != AMBIT_OP_ASIN && op != AMBIT_OP_ACOS && is_empty(kit_bounds_of(s, KIT_R, 2)))
      kit_find(s, "empty", "%s: an empty lane spoils its neighbour", op_name[op]);
  }
}

static kit_set subset_of(kit_state *s, kit_set x) {
  double p = point_of(s, x), q = point_of(s, x);
  return p <= q ? (kit_set) { p, q } : (kit_set) { q, p };
}

static void check_isotonic(kit_state *s, uint32_t op) {
  for (int round = 0; round < 200; round++) {
    kit_set a = kit_any_set(s), b = kit_any_set(s);
    uint32_t word = op == AMBIT_OP_POWN ? (uint32_t)((int32_t)(kit_random(s) % 13) - 6)
                    : op_arity[op] == 2 ? KIT_B
                                        : KIT_A;
    kit_set_element(s, KIT_A, 0, a), kit_set_element(s, KIT_B, 0, b);
    kit_set_element(s, KIT_A, 1, subset_of(s, a)), kit_set_element(s, KIT_B, 1, subset_of(s, b));
    kit_apply(s, op, KIT_R, KIT_A, word, 2);
    kit_set whole = kit_bounds_of(s, KIT_R, 0), part = kit_bounds_of(s, KIT_R, 1);
    if (!is_empty(part) && !(whole.lo <= part.lo && part.hi <= whole.hi))
      kit_find(s, "isotonicity", "%s of a part of [%a, %a], [%a, %a] is [%a, %a], outside [%a, %a]", op_name[op], a.lo,
          a.hi, b.lo, b.hi, part.lo, part.hi, whole.lo, whole.hi);
  }
}

/* the same numbers, called in each rounding mode; and arithmetic afterwards rounds as before */
static void check_environment(kit_state *s) {
  static const int mode[] = { FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO };
  for (int m = 0; m < 4; m++) {
    fesetround(mode[m]);
    volatile double one = 1, tiny = 0x1p-60, before = one + tiny, before_negative = -one - tiny;
    kit_set_element(s, KIT_A, 0, (kit_set) { 1.0 / 3, 0.5 });
    for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++) kit_apply(s, op, KIT_R, KIT_A, op == AMBIT_OP_POWN ? 3 : KIT_A, 1);
    (void)kit_bounds_of(s, KIT_R, 0);
    volatile double after = one + tiny, after_negative = -one - tiny;
    bool kept = fegetround() == mode[m] && before == after && before_negative == after_negative;
    fesetround(FE_TONEAREST);
    if (!kept) kit_find(s, "environment", "the rounding mode (case %d) is not restored", m);
  }
}

static void check_tier_1(kit_state *s) {
  check_elements(s);
  for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++) {
    check_operation(s, op);
    if (op_arity[op] == 2) check_same_operand(s, op);
    check_empty(s, op);
    if (s->kit->isotonic) check_isotonic(s, op);
    if (!s->kit->plugin->run[op] && s->kit->fallback) s->kit->fallback(s->kit->user, op_name[op]);
  }
  check_environment(s);
}

static bool open_state(kit_state *s) {
  const ambit_arithmetic *full = s->full;
  if (full->open && full->open(s->kit->host, NULL, 2, &s->ctx) != AMBIT_OK) {
    kit_find(s, "open", "open fails");
    return false;
  }
  s->elem = full->elem(s->ctx);
  if (s->elem == 0 || s->elem % 8 != 0) {
    kit_find(s, "open", "elements of %zu bytes; a positive multiple of 8 is asked for", s->elem);
    return false;
  }
  s->pitch = KIT_PITCH;
  size_t count = KIT_SLOTS * s->pitch;
  s->block = s->kit->host->alloc(s->kit->host, count * s->elem);
  s->pattern = s->kit->host->alloc(s->kit->host, s->elem);
  if (!s->block || !s->pattern || (full->init && full->init(s->ctx, s->block, count) != AMBIT_OK)) {
    kit_find(s, "open", "no memory for %zu elements", count);
    return false;
  }
  memset(s->pattern, 0x5a, s->elem);
  return true;
}

size_t arithmetic_kit_run(const arithmetic_kit *kit) {
  kit_state s = { .kit = kit, .full = kit->full, .rigorous = kit->full->rigorous != 0, .random = kit->seed };
  if (open_state(&s)) {
    check_tier_1(&s);
    kit_check_tier_2(&s);
    if (s.full->clear) s.full->clear(s.ctx, s.block, KIT_SLOTS * s.pitch);
  }
  if (s.ctx && s.full->close) s.full->close(s.ctx);
  return s.findings;
}
