/* zonotope_case.h -- the zonotope solver from inside: random shapes, rows and tapes, with equations that are solved for
** unknowns, and the values of rows at points in extended precision.
*/
#ifndef ZONOTOPE_CASE_H
#define ZONOTOPE_CASE_H
#include "oracle.h"
#include "num/service.h"
#include "solver/zonotope/implicit.h"
#include "solver/zonotope/kink.h"
#include "solver/zonotope/proof.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <cmocka.h>

static uint64_t seed = 17;
static inline double draw(double lo, double hi) { return oracle_uniform(&seed, lo, hi); }
static inline uint32_t pick(uint32_t n) { return (uint32_t)(oracle_random(&seed) >> 33) % n; }

/* -- a host that keeps what it lent */

static void *lent[20000];
static size_t nlent;

static inline void *lend(const ambit_host *h, size_t bytes) {
  (void)h;
  assert_true(nlent < sizeof lent / sizeof *lent);
  size_t size = (bytes + 127) / 64 * 64;
  return memset(lent[nlent++] = aligned_alloc(64, size), 0, size);
}

static const void *service(const ambit_host *h, const char *id) {
  (void)h;
  return strcmp(id, AMBIT_NUM_SERVICE) == 0 ? &ambit_num_service_v1 : NULL;
}

static const ambit_host host = { .size = sizeof host, .abi = AMBIT_ABI, .alloc = lend, .service = service };

static inline void give_back(void) {
  while (nlent) free(lent[--nlent]);
}

static inline void fill(const shape *s, double *x, int kind) {
  memset(x, 0, s->stride * sizeof *x);
  x[0] = kind & 1 ? draw(-2, 2) : 0;
  uint32_t to = kind & 2 ? s->norms : kind & 4 ? s->pair[0] : 1;
  for (uint32_t i = 1; i < to; i++) x[i] = draw(-1, 1) / 4;
  for (uint32_t i = 0; i < s->triples && (kind & 8); i++) x[s->cube + i] = draw(-1, 1) / 4;
  row_norms_all(s, x);
}

static inline void thin_out(shape *s) {
  for (uint32_t i = 0, last = s->m; i < s->m; i++) {
    uint32_t less = pick(3);
    last = last > less ? last - less : 0;
    s->reach[i] = last;
  }
  s->mixed = pick(s->m + 1), s->cubic = pick(s->m + 1);
  shape_place(s);
}

/* leaves parts out of rows of high orders in time */
static inline void leave_out(shape *s, uint32_t orders) {
  s->paired = 1 + pick(orders), s->mixing = pick(orders + 1);
  s->cubed = pick((s->paired < s->room ? s->paired : s->room) + 1);
}

/* -- random tapes */

#define SLOTS 200
#define UNKNOWNS 3

typedef struct maker {
  ambit_tape tape;
  uint32_t op[SLOTS], dst[SLOTS], a[SLOTS], b[SLOTS], aux[SLOTS], degree[SLOTS], out[16];
  double lo[SLOTS], hi[SLOTS];
} maker;

static inline uint32_t put(maker *k, uint32_t op, uint32_t a, uint32_t b) {
  uint32_t n = k->tape.ninstr++, slot = k->tape.nconst + k->tape.nin + n;
  assert_true(slot < SLOTS);
  k->op[n] = op, k->dst[n] = slot, k->a[n] = a, k->b[n] = b, k->aux[n] = AMBIT_NO_SLOT;
  k->degree[slot] = AMBIT_DEGREE_ANY;
  if (k->degree[a] == 0 && k->degree[b] == 0) k->degree[slot] = 0;
  return slot;
}

static inline uint32_t put_pair(maker *k, uint32_t first, uint32_t second, uint32_t a) {
  uint32_t n = k->tape.ninstr, s = put(k, first, a, a), c = put(k, second, a, a);
  k->aux[n] = c, k->aux[n + 1] = s;
  return pick(2) ? s : c;
}

/* with slot 0 the number 1 */
static inline uint32_t put_tanh(maker *k, uint32_t a) {
  uint32_t n = k->tape.ninstr, y = put(k, AMBIT_OP_TANH, a, a);
  k->aux[n] = put(k, AMBIT_OP_SUB, 0, put(k, AMBIT_OP_SQR, y, y));
  return y;
}

/* a slot in (1, 3) or so */
static inline uint32_t positive(maker *k, uint32_t a) {
  uint32_t sine = put_pair(k, AMBIT_OP_SIN, AMBIT_OP_COS, a);
  return put(k, AMBIT_OP_ADD, sine, 2);
}

static inline uint32_t any(maker *k, uint32_t from) {
  uint32_t n = k->tape.nconst + k->tape.nin + k->tape.ninstr - from;
  return from + pick(n);
}

/* one more operation on what there is; results stay of moderate size */
static inline uint32_t grow(maker *k, uint32_t a, uint32_t b) {
  uint32_t small = put_pair(k, AMBIT_OP_SIN, AMBIT_OP_COS, a), n;
  switch (pick(15)) {
  case 0: return put(k, AMBIT_OP_ADD, small, b);
  case 1: return put(k, AMBIT_OP_SUB, a, small);
  case 2: return put(k, AMBIT_OP_MUL, small, b);
  case 3: return put(k, AMBIT_OP_SQR, small, small);
  case 4: return put(k, AMBIT_OP_DIV, b, positive(k, a));
  case 5:
    return put(k, AMBIT_OP_SQRT, positive(k, a), positive(k, a)), k->tape.nconst + k->tape.nin + k->tape.ninstr - 1;
  case 6: return put(k, AMBIT_OP_EXP, small, small);
  case 7: n = positive(k, b); return put(k, AMBIT_OP_LOG, n, n);
  case 8: return put_pair(k, AMBIT_OP_SINH, AMBIT_OP_COSH, small);
  case 9:
    n = put(k, AMBIT_OP_SQR, a, a), n = put(k, AMBIT_OP_ADD, n, 0);
    small = put(k, AMBIT_OP_ATAN, a, a), k->aux[k->tape.ninstr - 1] = n;
    return small;
  case 10: {
    uint32_t y = small, x = positive(k, b);
    n = put(k, AMBIT_OP_ADD, put(k, AMBIT_OP_SQR, y, y), put(k, AMBIT_OP_SQR, x, x));
    small = put(k, AMBIT_OP_ATAN2, y, x), k->aux[k->tape.ninstr - 1] = n;
    return small;
  }
  case 11: return put(k, AMBIT_OP_ABS, pick(2) ? small : positive(k, b), a);
  case 12:
    n = put(k, AMBIT_OP_MIN, small, b);
    return pick(2) ? n : put(k, AMBIT_OP_SUB, put(k, AMBIT_OP_MAX, b, small), n);
  case 13: return put(k, AMBIT_OP_MAX, small, b);
  default: return put_tanh(k, pick(2) ? a : small);
  }
}

/* inputs x [nx], a [na], p [np], t; no instruction yet */
static inline void make_empty(maker *k, uint32_t nconst, uint32_t nx, uint32_t na, uint32_t np) {
  memset(k, 0, sizeof *k);
  k->tape = (ambit_tape) { .size = sizeof k->tape,
    .flags = AMBIT_TAPE_SERIES,
    .nconst = nconst,
    .nin = nx + na + np + 1,
    .nout = nx + na,
    .op = k->op,
    .dst = k->dst,
    .a = k->a,
    .b = k->b,
    .aux = k->aux,
    .lo = k->lo,
    .hi = k->hi,
    .out = k->out,
    .degree = k->degree };
  for (uint32_t i = 0; i < nx + na; i++) k->degree[nconst + i] = AMBIT_DEGREE_ANY;
  k->degree[nconst + nx + na + np] = 1;
}

/* abs, min, max and tanh as the step takes them: a and b times these, less the twin's slot; others are left as they
** are */
static inline void kink_slopes(const zono *z, uint32_t i, long double *by_a, long double *by_b) {
  double a, b;
  if (!is_line(z, i)) return;
  kink_shares(z, i, &a, &b);
  *by_a = has_twin(z, i) ? 1 : a, *by_b = has_twin(z, i) ? 1 : b;
}

static inline uint32_t twin_of(const zono *z, uint32_t i) {
  const ambit_tape *t = z->program.tape;
  return is_kinked(t->op[i]) && has_twin(z, i) ? t->dst[z->kinks->of[i].twin] : SLOTS;
}

/* two stages, the second with what the first found */
static inline void make(maker *k, uint32_t nx, uint32_t na) {
  make_empty(k, 3, nx, na, 2);
  k->lo[0] = k->hi[0] = 1, k->lo[1] = k->hi[1] = -0.5, k->lo[2] = k->hi[2] = 2.25;
  uint32_t x = 3, a = 3 + nx, known[12], n = 0;
  for (uint32_t i = 0; i < nx; i++) known[n++] = x + i;
  for (uint32_t i = 0; i < 3; i++) known[n++] = a + na + i;
  for (uint32_t i = 0; i < 3; i++) known[n - 1 - i] = grow(k, known[pick(n)], known[pick(n)]);
  for (uint32_t e = 0; e < na; e++) {
    if (e == 2) known[pick(n)] = grow(k, a, a + 1); /* nonlinear in what stage 1 found */
    uint32_t from = e < 2 ? 0 : 2, to = e < 2 ? (na < 2 ? na : 2) : na, sum = known[pick(n)];
    for (uint32_t j = from; j < to; j++) {
      uint32_t factor = j == e ? put(k, AMBIT_OP_ADD, positive(k, known[pick(n)]), 2)
                               : put_pair(k, AMBIT_OP_SIN, AMBIT_OP_COS, known[pick(n)]);
      uint32_t term = pick(4)  ? put(k, AMBIT_OP_MUL, factor, a + j)
                      : j == e ? put(k, AMBIT_OP_DIV, a + j, factor)
                               : put(k, AMBIT_OP_MUL, a + j, 1);
      sum = put(k, pick(2) ? AMBIT_OP_ADD : AMBIT_OP_SUB, sum, term);
    }
    k->out[nx + e] = sum;
  }
  for (uint32_t i = 0; i < nx; i++)
    k->out[i] = i == 0 ? x + 1 : grow(k, na ? a + pick(na) : any(k, 3), any(k, 3 + nx + na));
  k->tape.nslot = 3 + k->tape.nin + k->tape.ninstr;
}

/* errors of the states one by one: kinks ask for generators, not for their sums E */
static inline void put_generators(zono *z) {
  z->ngen = z->nx, z->G = lend(&host, (size_t)z->nx * z->nx * sizeof *z->G);
  for (uint32_t i = 0; i < z->nx; i++) z->G[i * z->nx + i] = z->E[i];
}

static inline void open_case(zono *z, maker *k, uint32_t nx, uint32_t na, int thin) {
  static const uint32_t stage_end[2] = { 2, UNKNOWNS };
  static const uint32_t pivot[UNKNOWNS] = { 1, 0, 2 };
  make(k, nx, na);
  *z = (zono) { .host = &host, .nx = nx, .na = na, .np = 2, .m = 4, .K = 6, .K_max = 6, .t = 0.25 };
  z->program = (program) { &k->tape, nx, na, 2, 1,
    na > 2 ? 2
    : na   ? 1
           : 0,
    na > 1 ? stage_end : &z->na, na > 1 ? pivot : pivot + 1, NULL, NULL, NULL, NULL };
  assert_true(shape_open(&host, &z->shape, z->m, nx));
  if (thin) thin_out(&z->shape);
  if (pick(2)) leave_out(&z->shape, z->K + 1);
  assert_true(zono_open_rows(z) && zono_open_implicit(z));
  z->P = lend(&host, nx * z->shape.stride * 8), z->E = lend(&host, nx * 8);
  for (uint32_t i = 0; i < nx; i++) {
    double *x = z->P + i * z->shape.stride;
    fill(&z->shape, x, 3);
    for (uint32_t j = 1; j < z->shape.norms; j++)
      x[j] *= j < z->shape.eps || (j >= z->shape.pair[0] && j < z->shape.mix) ? 0.1 : 0;
    row_norms(&z->shape, x);
    x[z->shape.norms + NORM_C] = 0;
    z->E[i] = draw(0, 1e-3);
  }
  for (uint32_t i = 0; i < 2; i++) fill(&z->shape, z->p_row + i * z->shape.stride, 5);
  put_generators(z);
}

/* -- points: values of xi, eps and s, and what rows are there */

#define MOST_SIGMAS 64

typedef struct point {
  long double xi[MOST_SIGMAS], eps[MOST_SIGMAS], s;
} point;

/* a corner, or with one in four of its coordinates inside */
static inline void draw_point(const zono *z, point *p, double h) {
  for (uint32_t i = 0; i < z->shape.m; i++) p->xi[i] = pick(4) ? (pick(2) ? 1 : -1) : draw(-1, 1);
  for (uint32_t i = 0; i < z->shape.nx; i++) p->eps[i] = pick(4) ? (pick(2) ? 1 : -1) : draw(-1, 1);
  p->s = pick(3) ? h : draw(0, 1) * h;
}

static inline long double value_at(const shape *s, const double *x, const point *p) {
  long double sum = (long double)x[0] + row_low(s, x);
  const double *pair = x + s->pair[0], *mixed = x + s->mix, *cube = x + s->cube;
  for (uint32_t i = 0; i < s->m; i++) sum += x[1 + i] * p->xi[i];
  for (uint32_t i = 0; i < s->nx; i++) sum += x[s->eps + i] * p->eps[i];
  for (uint32_t i = 0; i < s->m; i++)
    for (uint32_t j = i; j < s->reach[i] && row_q(s, x) > 0; j++) sum += *pair++ * p->xi[i] * p->xi[j];
  for (uint32_t j = 0; j < s->mixed; j++)
    for (uint32_t i = 0; i < s->nx && row_x(s, x) > 0; i++) sum += *mixed++ * p->xi[j] * p->eps[i];
  for (uint32_t i = 0; i < s->cubic && row_c(s, x) > 0; i++)
    for (uint32_t j = i; j < s->cubic; j++)
      for (uint32_t k = j; k < s->cubic; k++) sum += *cube++ * p->xi[i] * p->xi[j] * p->xi[k];
  return sum;
}

/* V_slot(s) */
static inline long double slot_at(const zono *z, uint32_t slot, const point *p) {
  long double sum = 0;
  for (uint32_t k = orders(z, slot); k-- > 0;) sum = sum * p->s + value_at(&z->shape, row_at(z, slot, k), p);
  return sum;
}

static inline long double operation(uint32_t op, long double a, long double b) {
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
  case AMBIT_OP_SINH: return sinhl(a);
  case AMBIT_OP_COSH: return coshl(a);
  case AMBIT_OP_TANH: return tanhl(a);
  case AMBIT_OP_ATAN: return atanl(a);
  case AMBIT_OP_ATAN2: return atan2l(a, b);
  case AMBIT_OP_ABS: return fabsl(a);
  case AMBIT_OP_MIN: return fminl(a, b);
  case AMBIT_OP_MAX: return fmaxl(a, b);
  default: return NAN;
  }
}

/* derivatives by the operands at (a, b) */
static inline void slopes_at(uint32_t op, long double a, long double b, long double *by_a, long double *by_b) {
  long double q = a * a + b * b;
  *by_a = 1, *by_b = 0;
  switch (op) {
  case AMBIT_OP_ADD: *by_b = 1; return;
  case AMBIT_OP_SUB: *by_b = -1; return;
  case AMBIT_OP_NEG: *by_a = -1; return;
  case AMBIT_OP_MUL: *by_a = b, *by_b = a; return;
  case AMBIT_OP_SQR: *by_a = 2 * a; return;
  case AMBIT_OP_DIV: *by_a = 1 / b, *by_b = -a / (b * b); return;
  case AMBIT_OP_SQRT: *by_a = 0.5L / sqrtl(a); return;
  case AMBIT_OP_EXP: *by_a = expl(a); return;
  case AMBIT_OP_LOG: *by_a = 1 / a; return;
  case AMBIT_OP_SIN: *by_a = cosl(a); return;
  case AMBIT_OP_COS: *by_a = -sinl(a); return;
  case AMBIT_OP_SINH: *by_a = coshl(a); return;
  case AMBIT_OP_COSH: *by_a = sinhl(a); return;
  case AMBIT_OP_TANH: *by_a = 1 - tanhl(a) * tanhl(a); return;
  case AMBIT_OP_ATAN: *by_a = 1 / (1 + a * a); return;
  case AMBIT_OP_ATAN2: *by_a = b / q, *by_b = -a / q; return;
  case AMBIT_OP_ABS: *by_a = a < 0 ? -1 : 1; return;
  case AMBIT_OP_MIN: *by_a = a <= b, *by_b = a > b; return;
  case AMBIT_OP_MAX: *by_a = a >= b, *by_b = a < b; return;
  default: *by_a = NAN;
  }
}
#endif
