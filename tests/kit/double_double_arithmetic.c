/* double_double_arithmetic.c -- intervals whose bounds have about 100 bits: each is an unevaluated sum of two doubles.
**
** A double-double x = h + l has h = RN(h + l), RN: rounding to nearest, u = 2^-53. All algorithms are those of Joldes,
** Muller & Popescu, ACM TOMS 44(2), 2017, and of Lefevre, Louvet, Muller, Picot & Rideau, ACM TOMS 49(1), 2023 (square
** root), with relative errors of at most 3u^2/(1 - 4u) for +, 5u^2 for *, 15u^2 + 56u^3 for / and 25/8 u^2 for sqrt,
** proved for round-to-nearest without underflow and overflow.
**
** Why the bounds hold: the fast path takes operands that are 0 or within 2^-450 .. 2^450 only, so that nothing
** overflows, and what underflows (products of low parts) is below 2^-1070, under u^3 of any result. Then each bound is
** moved outward by e = 2^-100 |h| + 2^-1020 in its low part. The errors above are below 2^-101.9 |h|, the rounding of
** l - e is below u (u + 2^-99) |h| < 2^-105.9 |h|, together less than 2^-101.8 |h|. A result 0 is exact. All other
** operands (empty, unbounded, huge, tiny) and all other operations go to the kernel by their double bounds.
*/
#include <ambit/arithmetic.h>
#include <ambit/num.h>
#include <ambit/rounding.h>
#include <math.h>
#include <string.h>

typedef struct number {
  double h, l;
} number;

typedef struct element {
  number lo, hi; /* empty: lo = +inf, hi = -inf, as for doubles */
} element;

typedef struct context {
  const ambit_num_service *num;
  ambit_rounding outside; /* of the caller, between enter and leave */
} context;

/* -- numbers; all of this in round-to-nearest */

/* a + b, exactly, for |a| >= |b| or a = 0 [Dekker 1971] */
static number sum_ordered(double a, double b) {
  double s = a + b;
  return (number) { s, b - (s - a) };
}

/* a + b, exactly [Moller 1965, Knuth] */
static number sum_exactly(double a, double b) {
  double s = a + b, t = s - a;
  return (number) { s, (a - (s - t)) + (b - t) };
}

/* a * b, exactly */
static number product_exactly(double a, double b) {
  double p = a * b;
  return (number) { p, fma(a, b, -p) };
}

static number negate(number x) { return (number) { -x.h, -x.l }; }

static number add(number x, number y) { /* AccurateDWPlusDW */
  number s = sum_exactly(x.h, y.h), t = sum_exactly(x.l, y.l);
  number v = sum_ordered(s.h, s.l + t.h);
  return sum_ordered(v.h, t.l + v.l);
}

static number multiply(number x, number y) { /* DWTimesDW3 */
  number c = product_exactly(x.h, y.h);
  double t = fma(x.l, y.h, fma(x.h, y.l, x.l * y.l));
  return sum_ordered(c.h, c.l + t);
}

static number scale(number x, double y) { /* DWTimesFP1 */
  number c = product_exactly(x.h, y), t = sum_ordered(c.h, x.l * y);
  return sum_ordered(t.h, t.l + c.l);
}

static number divide(number x, number y) { /* DWDivDW2 */
  double t = x.h / y.h;
  number r = scale(y, t);
  return sum_ordered(t, ((x.h - r.h) + (x.l - r.l)) / y.h);
}

static number root(number x) { /* SQRTDWtoDW */
  if (x.h == 0) return x;
  double s = sqrt(x.h), rest = fma(-s, s, x.h);
  return sum_ordered(s, (x.l + rest) / (2 * s));
}

static double error_of(number x) { return x.h == 0 ? 0 : 0x1p-100 * fabs(x.h) + 0x1p-1020; }
static number down(number x) { return sum_exactly(x.h, x.l - error_of(x)); }
static number up(number x) { return sum_exactly(x.h, x.l + error_of(x)); }

static int is_less(number x, number y) { return x.h < y.h || (x.h == y.h && x.l < y.l); }
static number smaller(number x, number y) { return is_less(y, x) ? y : x; }
static number larger(number x, number y) { return is_less(x, y) ? y : x; }

/* -- elements */

static int is_tame_number(number x) { return x.h == 0 || (fabs(x.h) >= 0x1p-450 && fabs(x.h) <= 0x1p450); }
static int is_tame(element x) { return is_tame_number(x.lo) && is_tame_number(x.hi); }

static element add_elements(element a, element b) { return (element) { down(add(a.lo, b.lo)), up(add(a.hi, b.hi)) }; }

static element negate_element(element a) { return (element) { negate(a.hi), negate(a.lo) }; }
static element subtract_elements(element a, element b) { return add_elements(a, negate_element(b)); }

/* The hull of op at the four corners. Errors are relative and signs exact, so the least approximation, moved down, is
** below all four values. */
static element corners(number (*op)(number, number), element a, element b) {
  number p = op(a.lo, b.lo), q = op(a.lo, b.hi), r = op(a.hi, b.lo), s = op(a.hi, b.hi);
  return (element) { down(smaller(smaller(p, q), smaller(r, s))), up(larger(larger(p, q), larger(r, s))) };
}

static element multiply_elements(element a, element b) { return corners(multiply, a, b); }
static element divide_elements(element a, element b) { return corners(divide, a, b); }

static element square_element(element a) {
  number left = negate(a.lo), far = larger(left, a.hi), near = { 0, 0 };
  if (a.lo.h > 0) near = a.lo;
  if (a.hi.h < 0) near = negate(a.hi);
  return (element) { down(multiply(near, near)), up(multiply(far, far)) };
}

static element root_element(element a) { return (element) { down(root(a.lo)), up(root(a.hi)) }; }

static int is_divisible(element a, element b) { return (void)a, b.lo.h > 0 || b.hi.h < 0; }
static int has_root(element a, element unused) { return (void)unused, a.lo.h >= 0; }

/* -- in and out: called in any environment, so they set their own; see <ambit/rounding.h> for AMBIT_WORKER */

static AMBIT_WORKER void write_bounds(const element *x, size_t n, double *lo, double *hi) {
  for (size_t i = 0; i < n; i++) {
    lo[i] = x[i].lo.l < 0 ? nextafter(x[i].lo.h, -INFINITY) : x[i].lo.h;
    hi[i] = x[i].hi.l > 0 ? nextafter(x[i].hi.h, INFINITY) : x[i].hi.h;
  }
}

static void bounds(void *ctx, const void *src, size_t n, double *lo, double *hi) {
  ambit_rounding old = ambit_round_nearest();
  (void)ctx;
  write_bounds(src, n, lo, hi);
  ambit_rounding_restore(old);
}

static void set(void *ctx, void *dst, size_t n, const double *lo, const double *hi, int32_t var) {
  element *r = dst;
  (void)ctx, (void)var;
  for (size_t i = 0; i < n; i++) r[i] = (element) { { lo[i], 0 }, { hi[i], 0 } };
}

/* "pi", "12.5", "-1/3": at most 15 digits before and behind the slash, so that all parts are exact doubles */
static AMBIT_WORKER int read_text(const char *text, number *x) {
  if (strcmp(text, "pi") == 0) { /* less than 2^-109 of it is missing: far below 2^-100 */
    *x = (number) { 0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53 };
    return 1;
  }
  double sign = *text == '-' ? -1 : 1, part[2] = { 0, 0 }, power = 1;
  int digits[2] = { 0, 0 }, which = 0, point = 0;
  for (text += sign < 0; *text; text++) {
    if (*text >= '0' && *text <= '9') {
      part[which] = 10 * part[which] + (*text - '0'), power *= point ? 10 : 1, digits[which]++;
    } else if (*text == '.' && !point && !which) {
      point = 1;
    } else if (*text == '/' && !point && !which) {
      which = 1;
    } else {
      return 0;
    }
  }
  if (digits[0] == 0 || digits[0] > 15 || digits[1] > 15 || (which && part[1] == 0)) return 0;
  *x = divide((number) { sign * part[0], 0 }, (number) { which ? part[1] : power, 0 });
  return 1;
}

static int32_t set_text(void *ctx, void *dst, const char *text) {
  ambit_rounding old = ambit_round_nearest();
  element *r = dst;
  number x;
  (void)ctx;
  int known = read_text(text, &x);
  if (known) *r = (element) { down(x), up(x) };
  ambit_rounding_restore(old);
  return known;
}

/* -- runs */

/* what the fast path does not take: the kernel's operation on the double bounds */
static uint32_t by_kernel(const context *c, uint32_t op, element a, element b, element *r) {
  double x[2], y[2], z[2];
  bounds(NULL, &a, 1, &x[0], &x[1]), bounds(NULL, &b, 1, &y[0], &y[1]);
  uint32_t flags = c->num->map(op, 1, z, x, y, 0);
  *r = (element) { { z[0], 0 }, { z[1], 0 } };
  return flags;
}

typedef struct operation {
  uint32_t op;
  element (*fast)(element a, element b);
  int (*fits)(element a, element b); /* NULL: all tame operands */
} operation;

static uint32_t run(const operation *o, const context *c, void *base, size_t pitch, size_t lanes, size_t count,
    const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  element *slot = base;
  uint32_t flags = 0;
  for (size_t i = 0; i < count; i++)
    for (size_t lane = 0; lane < lanes; lane++) {
      element x = slot[a[i] * pitch + lane], y = slot[b[i] * pitch + lane], *r = &slot[dst[i] * pitch + lane];
      if (is_tame(x) && is_tame(y) && (!o->fits || o->fits(x, y)))
        *r = o->fast(x, y);
      else
        flags |= by_kernel(c, o->op, x, y, r);
    }
  return flags;
}

#define UNARY(function)                                                                                                \
  static element function##_only(element a, element unused) { return (void)unused, function(a); }
UNARY(negate_element)
UNARY(square_element)
UNARY(root_element)

#define RUN(NAME, fast, fits)                                                                                          \
  static uint32_t run_##NAME(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,          \
      size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {                                       \
    static const operation o = { AMBIT_OP_##NAME, fast, fits };                                                        \
    return (void)self, run(&o, ctx, base, pitch, lanes, count, dst, a, b);                                             \
  }
RUN(ADD, add_elements, NULL)
RUN(SUB, subtract_elements, NULL)
RUN(NEG, negate_element_only, NULL)
RUN(MUL, multiply_elements, NULL)
RUN(SQR, square_element_only, NULL)
RUN(DIV, divide_elements, is_divisible)
RUN(SQRT, root_element_only, has_root)

/* -- life */

static ambit_status open(const ambit_host *h, const double *option, uint32_t nvar, void **ctx) {
  (void)option, (void)nvar;
  context *c = h->alloc(h, sizeof *c);
  if (!c) return AMBIT_NOMEM;
  c->num = h->service(h, AMBIT_NUM_SERVICE);
  if (!c->num) return h->fail(h, AMBIT_INVALID, "double_double: this kernel does not lend `%s`", AMBIT_NUM_SERVICE);
  *ctx = c;
  return AMBIT_OK;
}

static void close(void *ctx) { (void)ctx; }
static size_t elem(void *ctx) { return (void)ctx, sizeof(element); }
static void enter(void *ctx) { ((context *)ctx)->outside = ambit_round_nearest(); }
static void leave(void *ctx) { ambit_rounding_restore(((context *)ctx)->outside); }

static const ambit_arithmetic arithmetic = {
  .size = sizeof arithmetic,
  .rigorous = 1,
  .open = open,
  .close = close,
  .elem = elem,
  .enter = enter,
  .leave = leave,
  .set = set,
  .bounds = bounds,
  .run = { [AMBIT_OP_ADD] = run_ADD,
      [AMBIT_OP_SUB] = run_SUB,
      [AMBIT_OP_NEG] = run_NEG,
      [AMBIT_OP_MUL] = run_MUL,
      [AMBIT_OP_SQR] = run_SQR,
      [AMBIT_OP_DIV] = run_DIV,
      [AMBIT_OP_SQRT] = run_SQRT },
  .set_text = set_text,
};

static const void *get(const char *id) { return strcmp(id, AMBIT_ARITHMETIC) == 0 ? &arithmetic : NULL; }

AMBIT_EXPORT const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "arithmetic.double_double", "1.0",
  "Intervals with bounds of about 100 bits for + - * / sqr sqrt; elementary functions in double precision.", get };
