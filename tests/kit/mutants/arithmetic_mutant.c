/* arithmetic_mutant.c -- arithmetics with one fault: shipped ones whose results are spoilt now and then, for some
** operations, operands, lanes or contexts. */
#include "kit/mutants/mutant.h"
#include "kit/mutants/mutant_conduct.h"
#include <ambit/arithmetic.h>
#include <math.h>

/* when */
enum {
  ALWAYS,
  EVERY_10000,
  EVERY_1000,
  EVERY_100000,
  SUBNORMAL,
  HUGE_OPERAND,
  ZERO_RESULT,
  STRADDLING,
  POINTS,
  WIDE,
  LAST_LANE,
  LANE_16,
  FOURTH,
  SAME,
  NEGATIVE,
  UNBOUNDED_OPERAND,
  SECOND_CONTEXT,
  MANY_VARIABLES,
  UPWARD,
  RARE_BITS
};
/* how */
enum {
  LOW_UP,
  HIGH_DOWN,
  BOTH_IN,
  CUT_TENTH,
  MIDDLE,
  NEGATED,
  NAN_BOUND,
  INVERTED,
  NO_PARTIAL,
  NO_EMPTY,
  NO_UNBOUNDED,
  ALL_PARTIAL,
  NOT_WRITTEN,
  NEXT_LANE,
  EMPTY_IS_ZERO,
  ALLOCATES,
  WRITES_ON,
  CHANGES_OPERAND,
  UNITED
};
#define EACH UINT32_MAX /* operation */

typedef struct fault {
  const char *name, *base;
  uint32_t op;
  int when, how;
  const char *word; /* what another function than run[] does */
} fault;

static const fault faults[] = {
  { "one of 10000 operations one ulp up", "interval", EACH, EVERY_10000, LOW_UP, NULL },
  { "one of 10000 operations one ulp down", "interval", EACH, EVERY_10000, HIGH_DOWN, NULL },
  { "one of 10000 operations narrowed by 10 %", "interval", EACH, EVERY_10000, CUT_TENTH, NULL },
  { "one of 100000 operations one ulp narrow", "interval", EACH, EVERY_100000, BOTH_IN, NULL },
  { "one of 1000 additions one ulp up", "interval", AMBIT_OP_ADD, EVERY_1000, LOW_UP, NULL },
  { "one of 1000 sines one ulp down", "interval", AMBIT_OP_SIN, EVERY_1000, HIGH_DOWN, NULL },
  { "one of 1000 divisions its middle", "interval", AMBIT_OP_DIV, EVERY_1000, MIDDLE, NULL },
  { "products with few bits in the mantissa", "interval", AMBIT_OP_MUL, RARE_BITS, LOW_UP, NULL },
  { "sums of subnormal numbers", "interval", AMBIT_OP_ADD, SUBNORMAL, BOTH_IN, NULL },
  { "products of subnormal numbers", "interval", AMBIT_OP_MUL, SUBNORMAL, HIGH_DOWN, NULL },
  { "square roots of subnormal numbers", "interval", AMBIT_OP_SQRT, SUBNORMAL, LOW_UP, NULL },
  { "products of huge numbers", "interval", AMBIT_OP_MUL, HUGE_OPERAND, BOTH_IN, NULL },
  { "sines of huge angles", "interval", AMBIT_OP_SIN, HUGE_OPERAND, CUT_TENTH, NULL },
  { "cosines of huge angles one ulp down", "interval", AMBIT_OP_COS, HUGE_OPERAND, HIGH_DOWN, NULL },
  { "cosines of wide sets", "interval", AMBIT_OP_COS, WIDE, CUT_TENTH, NULL },
  { "squares of sets around 0", "interval", AMBIT_OP_SQR, STRADDLING, LOW_UP, NULL },
  { "quotients by sets around 0", "interval", AMBIT_OP_DIV, STRADDLING, CUT_TENTH, NULL },
  { "absolute values of sets around 0", "interval", AMBIT_OP_ABS, STRADDLING, CUT_TENTH, NULL },
  { "powers of sets around 0", "interval", AMBIT_OP_POWN, STRADDLING, HIGH_DOWN, NULL },
  { "powers of negative numbers", "interval", AMBIT_OP_POWN, NEGATIVE, NEGATED, NULL },
  { "hyperbolic cosine of sets around 0", "interval", AMBIT_OP_COSH, STRADDLING, LOW_UP, NULL },
  { "angles of negative numbers", "interval", AMBIT_OP_ATAN2, NEGATIVE, CUT_TENTH, NULL },
  { "exponentials of points one ulp up", "interval", AMBIT_OP_EXP, POINTS, LOW_UP, NULL },
  { "logarithms of points one ulp down", "interval", AMBIT_OP_LOG, POINTS, HIGH_DOWN, NULL },
  { "arc sines in the middle", "interval", AMBIT_OP_ASIN, ALWAYS, MIDDLE, NULL },
  { "arc tangents of unbounded sets", "interval", AMBIT_OP_ATAN, UNBOUNDED_OPERAND, CUT_TENTH, NULL },
  { "smaller of wide sets", "interval", AMBIT_OP_MIN, WIDE, CUT_TENTH, NULL },
  { "larger with the wrong sign of negative numbers", "interval", AMBIT_OP_MAX, NEGATIVE, NEGATED, NULL },
  { "sums of an element with itself", "interval", AMBIT_OP_ADD, SAME, CUT_TENTH, NULL },
  { "products of an element with itself", "interval", AMBIT_OP_MUL, SAME, HIGH_DOWN, NULL },
  { "last lane wrong", "interval", EACH, LAST_LANE, NEGATED, NULL },
  { "lanes from 16 on wrong", "interval", EACH, LANE_16, CUT_TENTH, NULL },
  { "last lane not written", "interval", AMBIT_OP_MUL, LAST_LANE, NOT_WRITTEN, NULL },
  { "fourth instruction of a run wrong", "interval", EACH, FOURTH, CUT_TENTH, NULL },
  { "result of the neighbouring lane", "interval", AMBIT_OP_NEG, LANE_16, NEXT_LANE, NULL },
  { "writes one lane too many", "interval", AMBIT_OP_ADD, ALWAYS, WRITES_ON, NULL },
  { "changes an operand", "interval", AMBIT_OP_SQR, ALWAYS, CHANGES_OPERAND, NULL },
  { "NaN for unbounded operands", "interval", EACH, UNBOUNDED_OPERAND, NAN_BOUND, NULL },
  { "bounds exchanged in one of 10000", "interval", EACH, EVERY_10000, INVERTED, NULL },
  { "square root leaves its domain silently", "interval", AMBIT_OP_SQRT, ALWAYS, NO_PARTIAL, NULL },
  { "logarithm leaves its domain silently", "interval", AMBIT_OP_LOG, ALWAYS, NO_PARTIAL, NULL },
  { "division leaves its domain silently", "interval", AMBIT_OP_DIV, ALWAYS, NO_PARTIAL, NULL },
  { "arc cosine leaves its domain silently", "interval", AMBIT_OP_ACOS, ALWAYS, NO_PARTIAL, NULL },
  { "angle of the origin without PARTIAL", "interval", AMBIT_OP_ATAN2, ALWAYS, NO_PARTIAL, NULL },
  { "tangent over a pole without PARTIAL", "interval", AMBIT_OP_TAN, ALWAYS, NO_PARTIAL, NULL },
  { "empty results are not told", "interval", EACH, ALWAYS, NO_EMPTY, NULL },
  { "unbounded results are not told", "interval", AMBIT_OP_EXP, ALWAYS, NO_UNBOUNDED, NULL },
  { "flags without a reason", "interval", AMBIT_OP_COS, ALWAYS, ALL_PARTIAL, NULL },
  { "operations of the empty set give 0", "interval", EACH, ALWAYS, EMPTY_IS_ZERO, NULL },
  { "wrong in the second context", "interval", EACH, SECOND_CONTEXT, CUT_TENTH, NULL },
  { "wrong when rounding upward", "interval", AMBIT_OP_ADD, UPWARD, LOW_UP, NULL },
  { "affine: wrong with 8 variables or more", "affine", EACH, MANY_VARIABLES, CUT_TENTH, NULL },
  { "affine: one of 1000 products cut", "affine", AMBIT_OP_MUL, EVERY_1000, CUT_TENTH, NULL },
  { "affine: sines of wide sets cut", "affine", AMBIT_OP_SIN, WIDE, CUT_TENTH, NULL },
  { "taylor_model: one of 1000 exponentials cut", "taylor_model", AMBIT_OP_EXP, EVERY_1000, CUT_TENTH, NULL },
  { "taylor_model: wrong with 8 variables or more", "taylor_model", AMBIT_OP_ADD, MANY_VARIABLES, MIDDLE, NULL },
  { "gradient: derivatives at their middle", "gradient", 0, ALWAYS, 0, "slopes" },
  { "gradient: derivatives from the fourth variable on forgotten", "gradient", 0, ALWAYS, 0, "late slopes" },
  { "gradient: derivatives with the wrong sign", "gradient", 0, ALWAYS, 0, "turned slopes" },
  { "gradient: inverted derivatives", "gradient", 0, ALWAYS, 0, "inverted slopes" },
  { "gradient: none is known", "gradient", 0, ALWAYS, 0, "no slopes" },
  { "set rounds its lower bound up", "interval", 0, ALWAYS, 0, "set up" },
  { "set cuts wide sets", "interval", 0, ALWAYS, 0, "set cut" },
  { "set of many writes the first only", "interval", 0, ALWAYS, 0, "set first" },
  { "set of many writes one too many", "interval", 0, ALWAYS, 0, "set on" },
  { "the empty set becomes 0", "interval", 0, ALWAYS, 0, "set empty" },
  { "bounds are one ulp narrow", "interval", 0, ALWAYS, 0, "bounds in" },
  { "bounds of unbounded sets are finite", "interval", 0, ALWAYS, 0, "bounds finite" },
  { "bounds of many are those of the first", "interval", 0, ALWAYS, 0, "bounds first" },
  { "dot leaves out the last term", "interval", 0, ALWAYS, 0, "dot short" },
  { "dot with 8 terms or more one ulp narrow", "interval", 0, ALWAYS, 0, "dot in" },
  { "dot takes no negative strides", "interval", 0, ALWAYS, 0, "dot forward" },
  { "dot hides its flags", "interval", 0, ALWAYS, 0, "dot flags" },
  { "text is its nearest double", "mpfr", 0, ALWAYS, 0, "text" },
  { "text takes nonsense for 0", "mpfr", 0, ALWAYS, 0, "nonsense" },
  { "jets of order 5 on off", "interval", 0, ALWAYS, 0, "jets late" },
  { "jets without radii of slopes", "interval", 0, ALWAYS, 0, "jets slopes" },
  { "jets with the wrong sign of the second direction", "interval", 0, ALWAYS, 0, "jets sign" },
  { "magnitudes of jets too small", "interval", 0, ALWAYS, 0, "jets magnitude" },
  { "jets raise flags without a reason", "interval", 0, ALWAYS, 0, "jets flags" },
  { "opens though it has no memory", "interval", 0, ALWAYS, 0, "open" },
  { "elements of an odd size", "interval", 0, ALWAYS, 0, "odd" },
  { "elements of no size", "interval", 0, ALWAYS, 0, "size 0" },
  { "leaves what enter has set", "interval", 0, ALWAYS, 0, "leave" },
  { "allocates in operations", "interval", EACH, ALWAYS, ALLOCATES, NULL },
};
enum { FAULTS = sizeof faults / sizeof *faults };

AMBIT_EXPORT const char *ambit_mutant_name(size_t i);
const char *ambit_mutant_name(size_t i) {
  return i < FAULTS ? faults[i].name : i < FAULTS + CONDUCT_FAULTS ? conduct_faults[i - FAULTS].name : NULL;
}

typedef struct context {
  void *inner;
  uint32_t nvar;
  uint64_t number, operations;
} context;

typedef struct selection {
  fault f;
  void (*conduct)(void);
  ambit_arithmetic base, own;
  ambit_jets jets;
  uint64_t contexts, calls;
} selection;

static selection *chosen;

static void *inner(void *ctx) { return ctx ? ((context *)ctx)->inner : NULL; }
static bool speaks(const char *word) { return chosen->f.word && strcmp(chosen->f.word, word) == 0; }

/* -- life */

static ambit_status open_context(const ambit_host *h, const double *option, uint32_t nvar, void **ctx) {
  context *c = h->alloc(h, sizeof *c);
  static _Thread_local context spare;
  if (!c && !speaks("open")) return AMBIT_NOMEM;
  if (!c) c = &spare;
  c->nvar = nvar;
  c->number = __atomic_add_fetch(&chosen->contexts, 1, __ATOMIC_RELAXED);
  *ctx = c;
  return chosen->base.open ? chosen->base.open(h, option, nvar, &c->inner) : AMBIT_OK;
}
static void close_context(void *ctx) {
  if (chosen->base.close) chosen->base.close(inner(ctx));
}
static size_t elem(void *ctx) {
  return speaks("odd") ? chosen->base.elem(inner(ctx)) + 1 : speaks("size 0") ? 0 : chosen->base.elem(inner(ctx));
}
static ambit_status init(void *ctx, void *base, size_t n) { return chosen->base.init(inner(ctx), base, n); }
static void clear(void *ctx, void *base, size_t n) { chosen->base.clear(inner(ctx), base, n); }
static void enter(void *ctx) {
  if (chosen->base.enter) chosen->base.enter(inner(ctx));
  if (speaks("leave")) fesetround(FE_UPWARD);
}
static void leave(void *ctx) {
  if (chosen->base.leave) chosen->base.leave(inner(ctx));
  if (speaks("leave")) fesetround(FE_UPWARD);
}

/* -- sets */

static void set(void *ctx, void *dst, size_t n, const double *lo, const double *hi, int32_t var) {
  size_t bytes = chosen->base.elem(inner(ctx));
  for (size_t i = 0; i < n; i++) {
    double a = lo[i], b = hi[i];
    if (speaks("set up") && a < b) a = nextafter(a, INFINITY);
    if (speaks("set cut") && b - a > 1 && isfinite(b - a)) b -= 0.1 * (b - a);
    if (speaks("set first") && i > 0) continue;
    if (speaks("set empty") && a > b) a = b = 0;
    chosen->base.set(inner(ctx), (char *)dst + i * bytes, 1, &a, &b, var);
  }
  double zero = 0;
  if (speaks("set on") && n > 1) chosen->base.set(inner(ctx), (char *)dst + n * bytes, 1, &zero, &zero, -1);
}

static void bounds(void *ctx, const void *src, size_t n, double *lo, double *hi) {
  chosen->base.bounds(inner(ctx), src, n, lo, hi);
  if (chosen->conduct && __atomic_add_fetch(&chosen->calls, 1, __ATOMIC_RELAXED) == 100) chosen->conduct();
  for (size_t i = 0; i < n; i++) {
    if (speaks("bounds in") && lo[i] < hi[i]) lo[i] = nextafter(lo[i], INFINITY);
    if (speaks("bounds finite") && hi[i] == INFINITY && lo[i] < hi[i]) hi[i] = 0x1.fffffffffffffp1023;
    if (speaks("bounds first")) lo[i] = lo[0], hi[i] = hi[0];
  }
}

/* -- operations */

typedef struct range {
  double lo, hi;
} range;

static range range_of(void *ctx, const void *element) {
  range x;
  chosen->base.bounds(inner(ctx), element, 1, &x.lo, &x.hi);
  return x;
}

static bool is_rare(double x) {
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return isfinite(x) && x != 0 && (bits & 0xffffffffff) == 0 && (bits >> 40 & 7) == 5;
}

static bool is_time(context *c, range a, range b, size_t lane, size_t lanes, size_t i, bool same) {
  double most = fmax(fmax(fabs(a.lo), fabs(a.hi)), fmax(fabs(b.lo), fabs(b.hi)));
  switch (chosen->f.when) {
  case EVERY_1000: return c->operations % 1000 == 999;
  case EVERY_10000: return c->operations % 10000 == 4999;
  case EVERY_100000: return c->operations % 100000 == 49999;
  case SUBNORMAL: return (a.lo != 0 && fabs(a.lo) < 0x1p-1022) || (a.hi != 0 && fabs(a.hi) < 0x1p-1022);
  case HUGE_OPERAND: return most > 1e150 && isfinite(most);
  case STRADDLING: return (a.lo < 0 && a.hi > 0) || (b.lo < 0 && b.hi > 0);
  case POINTS: return a.lo == a.hi && b.lo == b.hi;
  case WIDE: return a.hi - a.lo > 4 && isfinite(a.hi - a.lo);
  case LAST_LANE: return lane + 1 == lanes && lanes > 1;
  case LANE_16: return lane >= 16;
  case FOURTH: return i == 3;
  case SAME: return same;
  case NEGATIVE: return a.hi < 0;
  case UNBOUNDED_OPERAND: return isinf(a.hi) && a.lo < a.hi;
  case SECOND_CONTEXT: return c->number == 2;
  case MANY_VARIABLES: return c->nvar >= 8;
  case UPWARD: return fegetround() == FE_UPWARD;
  case RARE_BITS: return is_rare(a.lo) || is_rare(b.lo);
  default: return true;
  }
}

static void spoil(void *ctx, void *element, void *next, range *before) {
  range x = range_of(ctx, element), n = next ? range_of(ctx, next) : x;
  double mid = 0.5 * x.lo + 0.5 * x.hi, radius = 0.5 * x.hi - 0.5 * x.lo;
  bool bounded = isfinite(x.lo) && isfinite(x.hi) && x.lo <= x.hi, empty = x.lo > x.hi;
  switch (chosen->f.how) {
  case LOW_UP: x.lo = nextafter(x.lo, INFINITY); break;
  case HIGH_DOWN: x.hi = nextafter(x.hi, -INFINITY); break;
  case BOTH_IN: x.lo = nextafter(x.lo, INFINITY), x.hi = nextafter(x.hi, -INFINITY); break;
  case CUT_TENTH:
    if (bounded) x.lo = mid - 0.9 * radius, x.hi = mid + 0.9 * radius;
    break;
  case MIDDLE:
    if (bounded) x.lo = x.hi = mid;
    break;
  case NEGATED: x = (range) { -x.hi, -x.lo }; break;
  case NAN_BOUND: x.hi = NAN; break;
  case INVERTED:
    if (bounded) x = (range) { nextafter(x.hi, INFINITY), x.lo };
    break;
  case NEXT_LANE: x = n; break;
  case NOT_WRITTEN: x = *before; break;
  case EMPTY_IS_ZERO:
    if (empty) x.lo = x.hi = 0;
    break;
  default: return;
  }
  if (empty && chosen->f.how != EMPTY_IS_ZERO) return;
  if (x.lo > x.hi && chosen->f.how != INVERTED) x.lo = x.hi = mid;
  chosen->base.set(inner(ctx), element, 1, &x.lo, &x.hi, -1);
}

static uint32_t change_flags(uint32_t flags) {
  switch (chosen->f.how) {
  case NO_PARTIAL: return flags & ~AMBIT_F_PARTIAL;
  case NO_EMPTY: return flags & ~AMBIT_F_EMPTY;
  case NO_UNBOUNDED: return flags & ~AMBIT_F_UNBOUNDED;
  case ALL_PARTIAL: return flags | AMBIT_F_PARTIAL;
  default: return flags;
  }
}

static uint32_t run(uint32_t op, void *ctx, void *block, size_t pitch, size_t lanes, size_t count, const uint32_t *dst,
    const uint32_t *a, const uint32_t *b) {
  context *c = ctx;
  size_t bytes = chosen->base.elem(inner(ctx));
  bool mine = chosen->f.name && !chosen->f.word && (chosen->f.op == EACH || chosen->f.op == op);
  range before = { 7, 7 };
  if (mine && chosen->f.how == ALLOCATES) conduct_allocates();
  uint32_t flags = chosen->base.run[op](&chosen->base, inner(ctx), block, pitch, lanes, count, dst, a, b);
  for (size_t i = 0; mine && i < count; i++)
    for (size_t lane = 0; lane < lanes; lane++, c->operations++) {
      char *base = block;
      uint32_t right = op == AMBIT_OP_POWN ? a[i] : b[i];
      range x = range_of(ctx, base + (a[i] * pitch + lane) * bytes);
      range y = range_of(ctx, base + (right * pitch + lane) * bytes);
      if (!is_time(c, x, y, lane, lanes, i, a[i] == right)) continue;
      char *at = base + (dst[i] * pitch + lane) * bytes;
      spoil(ctx, at, lane + 1 < lanes ? at + bytes : NULL, &before);
      if (chosen->f.how == WRITES_ON && lane + 1 == lanes) memset(at + bytes, 0, bytes);
      if (chosen->f.how == CHANGES_OPERAND)
        chosen->base.set(inner(ctx), base + (a[i] * pitch + lane) * bytes, 1, &before.lo, &before.hi, -1);
    }
  return mine ? change_flags(flags) : flags;
}

#define RUN(NAME, arity, symbol)                                                                                       \
  static uint32_t run_##NAME(const ambit_arithmetic *self, void *ctx, void *block, size_t pitch, size_t lanes,         \
      size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {                                       \
    return (void)self, run(AMBIT_OP_##NAME, ctx, block, pitch, lanes, count, dst, a, b);                               \
  }
AMBIT_OPS(RUN)
#undef RUN
#define ENTRY(NAME, arity, symbol) [AMBIT_OP_##NAME] = run_##NAME,
static const ambit_run_fn runs[32] = { AMBIT_OPS(ENTRY) };
#undef ENTRY

/* -- tier 2 */

static uint32_t dot(
    void *ctx, void *dst, const void *a, ptrdiff_t sa, const void *b, ptrdiff_t sb, size_t m, size_t lanes) {
  if (speaks("dot short") && m > 1) m--;
  if (speaks("dot forward") && sb < 0)
    sb = -sb, b = (const char *)b - (ptrdiff_t)(m - 1) * sb * (ptrdiff_t)chosen->base.elem(inner(ctx));
  uint32_t flags = chosen->base.dot(inner(ctx), dst, a, sa, b, sb, m, lanes);
  range x = range_of(ctx, dst);
  x.lo = nextafter(x.lo, INFINITY);
  if (speaks("dot in") && m >= 8 && x.lo <= x.hi) chosen->base.set(inner(ctx), dst, 1, &x.lo, &x.hi, -1);
  return speaks("dot flags") ? 0 : flags;
}

static uint32_t eval_tape(void *ctx, const ambit_tape *t, void *base, size_t pitch, size_t lanes) {
  return chosen->base.eval_tape(inner(ctx), t, base, pitch, lanes);
}

static int32_t set_text(void *ctx, void *dst, const char *text) {
  double x = strcmp(text, "pi") == 0 ? 0x1.921fb54442d18p+1 : strtod(text, NULL);
  int32_t known = chosen->base.set_text(inner(ctx), dst, text);
  if ((speaks("text") && known) || (speaks("nonsense") && !known)) {
    chosen->base.set(inner(ctx), dst, 1, &x, &x, -1);
    return 1;
  }
  return known;
}

static int32_t gradient(void *ctx, const void *src, double *lo, double *hi) {
  int32_t known = chosen->base.gradient(inner(ctx), src, lo, hi);
  for (uint32_t j = 0; known && j < ((context *)ctx)->nvar; j++) {
    double a = lo[j], b = hi[j];
    if (speaks("slopes")) lo[j] = hi[j] = 0.5 * a + 0.5 * b;
    if (speaks("late slopes") && j >= 3) lo[j] = hi[j] = 0;
    if (speaks("turned slopes")) lo[j] = -b, hi[j] = -a;
    if (speaks("inverted slopes")) lo[j] = b, hi[j] = a;
  }
  return speaks("no slopes") ? 0 : known;
}

/* -- jets */

static ambit_status open_jets(const ambit_host *h, void *ctx, const ambit_tape *t, uint32_t order, uint32_t ndir,
    const void *centre, void **self) {
  return chosen->base.jets->open(h, inner(ctx), t, order, ndir, centre, self);
}
static void get_jet(const void *self, uint32_t slot, uint32_t k, double *mid, double *rad, double *dmid, double *drad) {
  chosen->base.jets->get(self, slot, k, mid, rad, dmid, drad);
  if (speaks("jets late") && k >= 5) *mid *= 1 + 1e-9;
  if (speaks("jets slopes") && drad) drad[0] = drad[1] = drad[2] = 0;
  if (speaks("jets sign") && dmid) dmid[1] = -dmid[1];
}
static void magnitude(const void *self, uint32_t slot, uint32_t n, double *mag, double *dmag) {
  chosen->base.jets->magnitude(self, slot, n, mag, dmag);
  for (uint32_t k = 3; speaks("jets magnitude") && k < n; k++) mag[k] *= 0.5;
}
static uint32_t advance(void *self, uint32_t k) {
  uint32_t flags = chosen->base.jets->advance(self, k);
  return speaks("jets flags") && k == 7 ? flags | AMBIT_F_PARTIAL : flags;
}

/* -- the plugin */

static void wrap(const ambit_arithmetic *base) {
  memcpy(&chosen->base, base, base->size < sizeof *base ? base->size : sizeof *base);
  ambit_arithmetic *own = &chosen->own;
  *own = chosen->base;
  own->size = sizeof *own;
  own->open = open_context, own->close = close_context, own->elem = elem, own->set = set, own->bounds = bounds;
  own->init = own->init ? init : NULL, own->clear = own->clear ? clear : NULL;
  own->enter = enter, own->leave = leave;
  own->dot = own->dot ? dot : NULL, own->set_text = own->set_text ? set_text : NULL;
  own->eval_tape = own->eval_tape ? eval_tape : NULL, own->gradient = own->gradient ? gradient : NULL;
  for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++) own->run[op] = chosen->base.run[op] ? runs[op] : NULL;
  if (!own->jets) return;
  chosen->jets = *own->jets;
  chosen->jets.open = open_jets, chosen->jets.get = get_jet, chosen->jets.magnitude = magnitude;
  chosen->jets.advance = advance;
  own->jets = &chosen->jets;
}

__attribute__((constructor)) static void choose(void);
static void choose(void) {
  const char *wanted = mutant_wanted();
  chosen = calloc(1, sizeof *chosen);
  for (size_t i = 0; i < FAULTS; i++)
    if (strcmp(faults[i].name, wanted) == 0) chosen->f = faults[i];
  chosen->conduct = conduct_of(wanted);
  const ambit_arithmetic *base = mutant_base(chosen->f.base ? chosen->f.base : "interval", AMBIT_ARITHMETIC);
  if (!base) exit(1);
  wrap(base);
}

static const void *get(const char *id) { return strcmp(id, AMBIT_ARITHMETIC) == 0 ? &chosen->own : NULL; }

AMBIT_EXPORT const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "arithmetic.arithmetic_mutant", "1.0",
  "An arithmetic with one fault.", get };
