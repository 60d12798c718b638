/* real.c -- plain double precision: fast, rounded to nearest, proves nothing.
**
** An element is one double; NaN stands for "no value" (an operand outside the domain, or an empty set), so it travels
** through every operation and comes out as the empty set, never as a bound. An operation that makes a NaN from
** numbers raises PARTIAL and EMPTY, one that overflows UNBOUNDED. Elementary functions are those of the C library.
*/
#include <ambit/arithmetic.h>
#include <float.h>
#include <math.h>
#include <string.h>

static size_t elem(void *ctx) {
  (void)ctx;
  return sizeof(double);
}

/* some number of [lo, hi], the middle if it is bounded */
static double representative(double lo, double hi) {
  if (!(lo <= hi) || lo == INFINITY || hi == -INFINITY) return NAN;
  if (lo == hi) return lo;
  if (lo == -INFINITY) return hi == INFINITY ? 0 : -DBL_MAX;
  if (hi == INFINITY) return DBL_MAX;
  double middle = 0.5 * (lo + hi);
  return isfinite(middle) ? middle : 0.5 * lo + 0.5 * hi;
}

static void set(void *ctx, void *dst, size_t n, const double *lo, const double *hi, int32_t var) {
  (void)ctx, (void)var;
  double *x = dst;
  if (lo == hi) /* the same array: points */
    for (size_t i = 0; i < n; i++) x[i] = lo[i] - lo[i] == 0 ? lo[i] : NAN;
  else
    for (size_t i = 0; i < n; i++) x[i] = representative(lo[i], hi[i]);
}

/* an infinity is "too large for a double" */
static void bounds(void *ctx, const void *src, size_t n, double *lo, double *hi) {
  (void)ctx;
  const double *x = src;
  for (size_t i = 0; i < n; i++) {
    double most = x[i] > DBL_MAX ? DBL_MAX : x[i], least = x[i] < -DBL_MAX ? -DBL_MAX : x[i];
    lo[i] = isnan(x[i]) ? INFINITY : most;
    hi[i] = isnan(x[i]) ? -INFINITY : least;
  }
}

static double root(double x) { return x < 0 ? NAN : sqrt(x); }
static double quotient(double a, double b) { return b == 0 ? NAN : a / b; }
static double logarithm(double x) { return x <= 0 ? NAN : log(x); }
static double smaller(double a, double b) { return a < b || isnan(a) ? a : b; }
static double larger(double a, double b) { return a > b || isnan(a) ? a : b; }
/* the sign of a zero is no matter of sets: the angle lies in (-pi, pi] */
static double angle(double y, double x) { return y == 0 && x == 0 ? NAN : atan2(y + 0.0, x); }

static double power(double x, int32_t n) {
  if (x == 0 && n < 0) return NAN;
  double result = 1;
  for (uint32_t m = n < 0 ? 0u - (uint32_t)n : (uint32_t)n; m; m >>= 1, x *= x)
    if (m & 1) result *= x;
  return n < 0 ? 1 / result : result;
}

/* 0 for a number, other bits for NaN and the infinities: z - z is 0 or NaN */
static uint64_t oddness(double z) {
  double zero = z - z;
  uint64_t bits;
  memcpy(&bits, &zero, sizeof bits);
  return bits;
}

/* Flags of one row that has something odd in it. */
static uint32_t inspect(const double *z, const double *x, const double *y, size_t lanes) {
  uint32_t flags = 0;
  for (size_t l = 0; l < lanes; l++) {
    if (isnan(z[l])) flags |= AMBIT_F_EMPTY | (isnan(x[l]) || isnan(y[l]) ? 0 : AMBIT_F_PARTIAL);
    if (isinf(z[l])) flags |= AMBIT_F_UNBOUNDED;
  }
  return flags;
}

/* The same of all instructions of a run, once there are reasons to look. */
static uint32_t inspect_run(const double *base, size_t pitch, size_t lanes, size_t count, const uint32_t *dst,
    const uint32_t *a, const uint32_t *b) {
  uint32_t flags = 0;
  for (size_t i = 0; i < count; i++)
    flags |= inspect(base + dst[i] * pitch, base + a[i] * pitch, base + b[i] * pitch, lanes);
  return flags;
}

/* z over the lanes of each instruction, or over the instructions if there is one lane; y is x when unary */
#define RUN(NAME, other, expression)                                                                                   \
  static uint32_t run_##NAME(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,          \
      size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {                                       \
    (void)self, (void)ctx, (void)b;                                                                                    \
    double *slot = base;                                                                                               \
    uint64_t odd = 0;                                                                                                  \
    for (size_t i = 0; i < count && lanes == 1; i++) {                                                                 \
      double x = slot[a[i] * pitch], y = slot[other[i] * pitch], z;                                                    \
      (void)y;                                                                                                         \
      z = (expression);                                                                                                \
      slot[dst[i] * pitch] = z;                                                                                        \
      odd |= oddness(z);                                                                                               \
    }                                                                                                                  \
    for (size_t i = 0; i < count && lanes != 1; i++) {                                                                 \
      double *r = slot + dst[i] * pitch;                                                                               \
      const double *left = slot + a[i] * pitch, *right = slot + other[i] * pitch;                                      \
      for (size_t l = 0; l < lanes; l++) {                                                                             \
        double x = left[l], y = right[l], z;                                                                           \
        (void)y;                                                                                                       \
        z = (expression);                                                                                              \
        r[l] = z;                                                                                                      \
        odd |= oddness(z);                                                                                             \
      }                                                                                                                \
    }                                                                                                                  \
    return odd ? inspect_run(slot, pitch, lanes, count, dst, a, other) : 0;                                            \
  }

RUN(ADD, b, x + y)
RUN(SUB, b, x - y)
RUN(NEG, a, -x)
RUN(MUL, b, x *y)
RUN(SQR, a, x *x)
RUN(DIV, b, quotient(x, y))
RUN(SQRT, a, root(x))
RUN(EXP, a, exp(x))
RUN(LOG, a, logarithm(x))
RUN(SIN, a, sin(x))
RUN(COS, a, cos(x))
RUN(TAN, a, tan(x))
RUN(ASIN, a, asin(x))
RUN(ACOS, a, acos(x))
RUN(ATAN, a, atan(x))
RUN(ATAN2, b, angle(x, y))
RUN(SINH, a, sinh(x))
RUN(COSH, a, cosh(x))
RUN(TANH, a, tanh(x))
RUN(ABS, a, fabs(x))
RUN(MIN, b, smaller(x, y))
RUN(MAX, b, larger(x, y))

static uint32_t run_POWN(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes, size_t count,
    const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  (void)self, (void)ctx;
  uint32_t flags = 0;
  for (size_t i = 0; i < count; i++) {
    double *r = (double *)base + dst[i] * pitch;
    const double *x = (double *)base + a[i] * pitch;
    for (size_t l = 0; l < lanes; l++) r[l] = power(x[l], (int32_t)b[i]);
    flags |= inspect(r, x, x, lanes);
  }
  return flags;
}

/* -- functions, by the C library's of the same name */

typedef double (*function)(double x);
typedef double (*function_of_pair)(double x, double y);
#define ONE_1(symbol) symbol
#define ONE_2(symbol) 0
#define TWO_1(symbol) 0
#define TWO_2(symbol) symbol

/* Poles lie in [-1, 1], where nothing overflows: an infinity there is no value. */
static double value_of(uint32_t op, double x) {
#define ROW(NAME, arity, symbol) ONE_##arity(symbol),
  static const function f[] = { AMBIT_FUNCTIONS(ROW) };
#undef ROW
  size_t k = op - AMBIT_OP_FUNCTIONS;
  function value = k < sizeof f / sizeof *f ? f[k] : NULL; /* NULL: a function of two */
  double z = value ? value(x) : NAN;
  return isinf(z) && fabs(x) <= 1 ? NAN : z;
}

/* the library's powers are defined for some x <= 0 */
static double value_of_pair(uint32_t op, double x, double y) {
#define ROW(NAME, arity, symbol) TWO_##arity(symbol),
  static const function_of_pair f[] = { AMBIT_FUNCTIONS(ROW) };
#undef ROW
  size_t k = op - AMBIT_OP_FUNCTIONS;
  function_of_pair value = k < sizeof f / sizeof *f ? f[k] : NULL; /* NULL: a function of one */
  return !value || isnan(x) || isnan(y) || (op == AMBIT_OP_POW && x <= 0) ? NAN : value(x, y);
}

static uint32_t run_function(const ambit_arithmetic *self, void *ctx, uint32_t op, void *base, size_t pitch,
    size_t lanes, size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  (void)self, (void)ctx;
  double *slot = base;
  uint64_t odd = 0;
  int two = ambit_op_arity(op) == 2;
  for (size_t i = 0; i < count; i++)
    for (size_t l = 0; l < lanes; l++) {
      double x = slot[a[i] * pitch + l];
      double z = two ? value_of_pair(op, x, slot[b[i] * pitch + l]) : value_of(op, x);
      slot[dst[i] * pitch + l] = z;
      odd |= oddness(z);
    }
  return odd ? inspect_run(slot, pitch, lanes, count, dst, a, b) : 0;
}

#define ENTRY(NAME, arity, symbol) [AMBIT_OP_##NAME] = run_##NAME,
static const ambit_arithmetic arithmetic = {
  .size = sizeof arithmetic,
  .rigorous = 0,
  .elem = elem,
  .set = set,
  .bounds = bounds,
  .run = { AMBIT_OPS(ENTRY) },
  .function = run_function,
  .pair = run_function,
};

static const void *get(const char *interface_id) {
  return strcmp(interface_id, AMBIT_ARITHMETIC) == 0 ? &arithmetic : NULL;
}

const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "arithmetic.real", "1.0",
  "Double precision, rounded to nearest: one number for each quantity, the middle of every set. The fastest arithmetic "
  "and the one that "
  "proves nothing; for reference, sampling and plots.",
  get };
