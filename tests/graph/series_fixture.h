/* series_fixture.h -- for the tests of series and tails: tapes by hand, a smallest arithmetic, a host, and a judge.
**
** The judge computes power series in long double by composition with the Taylor coefficients of each function at the
** first coefficient, f(u) = sum f^(n)(u_0)/n! (u - u_0)^n, which shares nothing with the recursions under test.
*/
#ifndef AMBIT_TEST_SERIES_FIXTURE_H
#define AMBIT_TEST_SERIES_FIXTURE_H
#include <ambit/arena.h>
#include "graph/interpreter.h"
#include "graph/jet.h"
#include "oracle.h"
#include "num/interval.h"
#include <complex.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* -- a host: memory from an arena, the last message kept */

typedef struct fixture_host {
  ambit_host host;
  ambit_arena *arena;
  char message[512];
} fixture_host;

static void *fixture_alloc(const ambit_host *h, size_t bytes) {
  return ambit_arena_alloc(((const fixture_host *)(const void *)h)->arena, bytes);
}

static ambit_status fixture_fail(const ambit_host *h, ambit_status status, const char *format, ...) {
  fixture_host *f = (fixture_host *)(uintptr_t)h;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(f->message, sizeof f->message, format, arguments);
  va_end(arguments);
  return status;
}

static inline void fixture_host_open(fixture_host *f) {
  *f = (fixture_host) {
    .host = { .size = sizeof(ambit_host), .abi = AMBIT_ABI, .alloc = fixture_alloc, .fail = fixture_fail },
    .arena = ambit_arena_open()
  };
}

static inline void fixture_host_close(fixture_host *f) { ambit_arena_close(f->arena); }

/* -- the smallest arithmetic: an element is a pair of bounds, every operation is the kernel's */

static size_t box_elem(void *ctx) {
  (void)ctx;
  return sizeof(ambit_interval);
}

static void box_set(void *ctx, void *dst, size_t n, const double *lo, const double *hi, int32_t var) {
  (void)ctx, (void)var;
  for (size_t i = 0; i < n; i++) ((ambit_interval *)dst)[i] = (ambit_interval) { lo[i], hi[i] };
}

static void box_bounds(void *ctx, const void *src, size_t n, double *lo, double *hi) {
  (void)ctx;
  for (size_t i = 0; i < n; i++)
    lo[i] = ((const ambit_interval *)src)[i].lo, hi[i] = ((const ambit_interval *)src)[i].hi;
}

static inline ambit_arithmetic fixture_arithmetic(void) {
  const ambit_arithmetic box = {
    .size = sizeof box, .rigorous = 1, .elem = box_elem, .set = box_set, .bounds = box_bounds
  };
  ambit_arithmetic full;
  ambit_arithmetic_complete(&box, &full, NULL);
  return full;
}

/* -- tapes by hand */

#define FIXTURE_MAX 512

typedef struct fixture_tape {
  ambit_tape tape;
  uint32_t op[FIXTURE_MAX], dst[FIXTURE_MAX], a[FIXTURE_MAX], b[FIXTURE_MAX], aux[FIXTURE_MAX], out[FIXTURE_MAX];
  uint32_t degree[FIXTURE_MAX];
  double lo[FIXTURE_MAX], hi[FIXTURE_MAX], range_lo[FIXTURE_MAX], range_hi[FIXTURE_MAX];
  const char *text[FIXTURE_MAX];
  ambit_run run[FIXTURE_MAX];
} fixture_tape;

static inline fixture_tape *fixture_tape_open(fixture_host *f) {
  fixture_tape *x = ambit_arena_alloc(f->arena, sizeof *x);
  x->tape = (ambit_tape) { .size = sizeof(ambit_tape),
    .flags = AMBIT_TAPE_SERIES,
    .op = x->op,
    .dst = x->dst,
    .a = x->a,
    .b = x->b,
    .aux = x->aux,
    .run = x->run,
    .lo = x->lo,
    .hi = x->hi,
    .text = x->text,
    .out = x->out,
    .degree = x->degree,
    .range_lo = x->range_lo,
    .range_hi = x->range_hi };
  return x;
}

/* All constants first, then all inputs, then instructions. */
static inline uint32_t fixture_slot(fixture_tape *x, double lo, double hi, uint32_t degree) {
  uint32_t v = x->tape.nslot++;
  x->range_lo[v] = lo, x->range_hi[v] = hi, x->degree[v] = degree;
  return v;
}

static inline uint32_t fixture_constant(fixture_tape *x, double lo, double hi) {
  x->lo[x->tape.nconst] = lo, x->hi[x->tape.nconst++] = hi;
  return fixture_slot(x, lo, hi, 0);
}

static inline uint32_t fixture_input(fixture_tape *x, uint32_t degree) {
  x->tape.nin++;
  return fixture_slot(x, -INFINITY, INFINITY, degree);
}

static inline uint32_t fixture_degree(uint32_t op, uint32_t a, uint32_t b) {
  uint64_t sum = (uint64_t)a + b;
  switch (op) {
  case AMBIT_OP_ADD:
  case AMBIT_OP_SUB: return a > b ? a : b;
  case AMBIT_OP_NEG: return a;
  case AMBIT_OP_MUL:
  case AMBIT_OP_SQR: return sum < AMBIT_DEGREE_ANY ? (uint32_t)sum : AMBIT_DEGREE_ANY;
  case AMBIT_OP_DIV: return b == 0 ? a : AMBIT_DEGREE_ANY;
  default: return a == 0 && b == 0 ? 0 : AMBIT_DEGREE_ANY;
  }
}

static inline bool fixture_is_binary(uint32_t op) {
  switch (op) {
  case AMBIT_OP_ADD:
  case AMBIT_OP_SUB:
  case AMBIT_OP_MUL:
  case AMBIT_OP_DIV:
  case AMBIT_OP_ATAN2:
  case AMBIT_OP_MIN:
  case AMBIT_OP_MAX: return true;
  default: return false;
  }
}

static inline uint32_t fixture_op(fixture_tape *x, uint32_t op, uint32_t a, uint32_t b) {
  if (!fixture_is_binary(op)) b = a;
  ambit_interval r;
  ambit_interval_op(
      op, &r, (ambit_interval) { x->range_lo[a], x->range_hi[a] }, (ambit_interval) { x->range_lo[b], x->range_hi[b] });
  uint32_t i = x->tape.ninstr++, v = fixture_slot(x, r.lo, r.hi, fixture_degree(op, x->degree[a], x->degree[b]));
  x->op[i] = op, x->a[i] = a, x->b[i] = b, x->dst[i] = v, x->aux[i] = AMBIT_NO_SLOT;
  x->run[x->tape.nrun++] = (ambit_run) { .op = op, .first = i, .count = 1 };
  return v;
}

/* An operation with its helper slots behind it; `one`: a constant slot that holds 1. Returns the operation's slot. */
static inline uint32_t fixture_function(fixture_tape *x, uint32_t op, uint32_t a, uint32_t b, uint32_t one) {
  static const uint32_t partner[AMBIT_OP_COUNT] = { [AMBIT_OP_SIN] = AMBIT_OP_COS,
    [AMBIT_OP_COS] = AMBIT_OP_SIN,
    [AMBIT_OP_SINH] = AMBIT_OP_COSH,
    [AMBIT_OP_COSH] = AMBIT_OP_SINH };
  uint32_t i = x->tape.ninstr, y = fixture_op(x, op, a, b);
  if (partner[op]) {
    x->aux[i] = fixture_op(x, partner[op], a, a);
    x->aux[i + 1] = y;
  } else if (op == AMBIT_OP_TANH) {
    x->aux[i] = fixture_op(x, AMBIT_OP_SUB, one, fixture_op(x, AMBIT_OP_SQR, y, y));
  } else if (op == AMBIT_OP_ATAN) {
    x->aux[i] = fixture_op(x, AMBIT_OP_ADD, one, fixture_op(x, AMBIT_OP_SQR, a, a));
  } else if (op == AMBIT_OP_ATAN2) {
    uint32_t squares = fixture_op(x, AMBIT_OP_SQR, a, a);
    x->aux[i] = fixture_op(x, AMBIT_OP_ADD, squares, fixture_op(x, AMBIT_OP_SQR, b, b));
  }
  return y;
}

static inline void fixture_output(fixture_tape *x, uint32_t slot) { x->out[x->tape.nout++] = slot; }

static inline void fixture_output_all(fixture_tape *x) {
  for (uint32_t v = 0; v < x->tape.nslot; v++) fixture_output(x, v);
}

/* -- the judge */

#define JUDGE_ORDER 24
typedef long double real;
typedef long double complex plane;
typedef struct judge_series {
  real c[JUDGE_ORDER + 1];
} judge_series;
typedef struct judge_plane {
  plane c[JUDGE_ORDER + 1];
} judge_plane;

/* sum_n g[n] (u - u_0)^n by Horner's rule */
static inline judge_plane judge_compose(const plane *g, judge_plane u, uint32_t order) {
  judge_plane y = { { 0 } };
  u.c[0] = 0;
  for (uint32_t n = order + 1; n-- > 0;) {
    judge_plane z = { { 0 } };
    for (uint32_t i = 0; i <= order; i++)
      for (uint32_t j = 1; i + j <= order; j++) z.c[i + j] += y.c[i] * u.c[j];
    z.c[0] += g[n];
    y = z;
  }
  return y;
}

/* Taylor coefficients of a function at z */
static inline void judge_taylor(uint32_t op, plane z, plane *g, uint32_t order) {
  real x = creall(z), factorial = 1;
  for (uint32_t n = 0; n <= order; n++) {
    if (n) factorial *= n;
    switch (op) {
    case AMBIT_OP_EXP: g[n] = expl(x) / factorial; break;
    case AMBIT_OP_SIN:
      g[n] = (n % 4 == 0 ? sinl(x) : n % 4 == 1 ? cosl(x) : n % 4 == 2 ? -sinl(x) : -cosl(x)) / factorial;
      break;
    case AMBIT_OP_COS:
      g[n] = (n % 4 == 0 ? cosl(x) : n % 4 == 1 ? -sinl(x) : n % 4 == 2 ? -cosl(x) : sinl(x)) / factorial;
      break;
    case AMBIT_OP_SINH: g[n] = (n % 2 ? coshl(x) : sinhl(x)) / factorial; break;
    case AMBIT_OP_COSH: g[n] = (n % 2 ? sinhl(x) : coshl(x)) / factorial; break;
    case AMBIT_OP_SQRT: g[n] = n ? g[n - 1] * (1.5L - n) / n / x : sqrtl(x); break;
    case AMBIT_OP_DIV: g[n] = n ? -g[n - 1] / x : 1 / x; break;                 /* the reciprocal */
    default: g[n] = n ? (n % 2 ? 1 : -1) / (n * cpowl(z, n)) : clogl(z); break; /* LOG, also of the plane */
    }
  }
}

static inline judge_series judge_product(judge_series a, judge_series b, uint32_t order) {
  judge_series y = { { 0 } };
  for (uint32_t i = 0; i <= order; i++)
    for (uint32_t j = 0; i + j <= order; j++) y.c[i + j] += a.c[i] * b.c[j];
  return y;
}

static inline judge_series judge_part(judge_plane z, bool imaginary) {
  judge_series y;
  for (uint32_t k = 0; k <= JUDGE_ORDER; k++) y.c[k] = imaginary ? cimagl(z.c[k]) : creall(z.c[k]);
  return y;
}

/* function of re + i im */
static inline judge_series judge_function(
    uint32_t op, judge_series re, judge_series im, bool imaginary, uint32_t order) {
  plane g[JUDGE_ORDER + 1];
  judge_plane z;
  for (uint32_t k = 0; k <= JUDGE_ORDER; k++) z.c[k] = re.c[k] + im.c[k] * I;
  judge_taylor(op, z.c[0], g, order);
  return judge_part(judge_compose(g, z, order), imaginary);
}

static inline judge_series judge_op(uint32_t op, judge_series a, judge_series b, uint32_t order) {
  const judge_series zero = { { 0 } };
  judge_series y = zero, one = { { 1 } };
  switch (op) {
  case AMBIT_OP_ADD:
    for (uint32_t k = 0; k <= order; k++) y.c[k] = a.c[k] + b.c[k];
    return y;
  case AMBIT_OP_SUB:
    for (uint32_t k = 0; k <= order; k++) y.c[k] = a.c[k] - b.c[k];
    return y;
  case AMBIT_OP_NEG: return judge_op(AMBIT_OP_SUB, zero, a, order);
  case AMBIT_OP_MUL: return judge_product(a, b, order);
  case AMBIT_OP_SQR: return judge_product(a, a, order);
  case AMBIT_OP_DIV: return judge_product(a, judge_function(op, b, zero, false, order), order);
  case AMBIT_OP_TANH:
    y = judge_function(AMBIT_OP_COSH, a, zero, false, order);
    return judge_op(AMBIT_OP_DIV, judge_function(AMBIT_OP_SINH, a, zero, false, order), y, order);
  case AMBIT_OP_ATAN: return judge_function(AMBIT_OP_LOG, one, a, true, order);
  case AMBIT_OP_ATAN2: return judge_function(AMBIT_OP_LOG, b, a, true, order);
  case AMBIT_OP_ABS: return a.c[0] < 0 ? judge_op(AMBIT_OP_NEG, a, a, order) : a;
  case AMBIT_OP_MIN: return a.c[0] < b.c[0] ? a : b;
  case AMBIT_OP_MAX: return a.c[0] > b.c[0] ? a : b;
  default: return judge_function(op, a, zero, false, order);
  }
}

static inline real judge_value(uint32_t op, real a, real b) {
  switch (op) {
  case AMBIT_OP_ADD: return a + b;
  case AMBIT_OP_SUB: return a - b;
  case AMBIT_OP_NEG: return -a;
  case AMBIT_OP_MUL: return a * b;
  case AMBIT_OP_SQR: return a * a;
  case AMBIT_OP_DIV: return a / b;
  case AMBIT_OP_SQRT: return sqrtl(a);
  case AMBIT_OP_EXP: return expl(a);
  case AMBIT_OP_LOG: return logl(a);
  case AMBIT_OP_SIN: return sinl(a);
  case AMBIT_OP_COS: return cosl(a);
  case AMBIT_OP_ATAN: return atanl(a);
  case AMBIT_OP_ATAN2: return atan2l(a, b);
  case AMBIT_OP_SINH: return sinhl(a);
  case AMBIT_OP_COSH: return coshl(a);
  case AMBIT_OP_TANH: return tanhl(a);
  case AMBIT_OP_ABS: return fabsl(a);
  case AMBIT_OP_MIN: return a < b ? a : b;
  default: return a > b ? a : b;
  }
}

/* Series and values of every slot, [nslot] with the inputs' set. Constants are at their lower bounds. */
static inline void judge_tape_series(const ambit_tape *t, judge_series *series, uint32_t order) {
  for (uint32_t v = 0; v < t->nconst; v++) series[v] = (judge_series) { { t->lo[v] } };
  for (uint32_t i = 0; i < t->ninstr; i++)
    series[t->dst[i]] = judge_op(t->op[i], series[t->a[i]], series[t->b[i]], order);
}

static inline void judge_tape_values(const ambit_tape *t, real *value) {
  for (uint32_t v = 0; v < t->nconst; v++) value[v] = t->lo[v];
  for (uint32_t i = 0; i < t->ninstr; i++) value[t->dst[i]] = judge_value(t->op[i], value[t->a[i]], value[t->b[i]]);
}
#endif
