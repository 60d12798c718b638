/* Phase 1 of the zonotope solver against arithmetic of its own: products of rows against products of lists of monomials
** in long double, what products drop, and the rows of random tapes, with equations that are solved for unknowns,
** against the relations that the bounds of phase 2 rely on (zonotope.h). */
#include "zonotope_case.h"

/* -- monomials of a shape: up to three variables, the data, then eps; NONE for no variable */

#define NONE 60000u
typedef struct monomial {
  uint32_t v[3]; /* rising */
} monomial;

static monomial of[20000];
static uint32_t where[20000]; /* in the row */
static uint32_t count;

static void one(uint32_t u, uint32_t v, uint32_t w, uint32_t at) {
  of[count] = (monomial) { { u, v, w } }, where[count++] = at;
}

static void list_monomials(const shape *s) {
  uint32_t at = 0;
  count = 0;
  one(NONE, NONE, NONE, at++);
  for (uint32_t i = 0; i < s->m + s->nx; i++) one(i, NONE, NONE, at++);
  for (uint32_t i = 0; i < s->m; i++)
    for (uint32_t j = i; j < s->reach[i]; j++) one(i, j, NONE, at++);
  for (uint32_t j = 0; j < s->mixed; j++)
    for (uint32_t i = 0; i < s->nx; i++) one(j, s->m + i, NONE, at++);
  assert_int_equal(at, s->norms);
  at = s->cube;
  for (uint32_t i = 0; i < s->cubic; i++)
    for (uint32_t j = i; j < s->cubic; j++)
      for (uint32_t k = j; k < s->cubic; k++) one(i, j, k, at++);
  assert_int_equal(at, s->cube + s->triples);
}

static uint32_t find(monomial p, monomial q) {
  uint32_t x[6], n = 0;
  for (int i = 0; i < 3; i++) {
    if (p.v[i] != NONE) x[n++] = p.v[i];
    if (q.v[i] != NONE) x[n++] = q.v[i];
  }
  if (n > 3) return NONE;
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t j = i + 1; j < n; j++)
      if (x[j] < x[i]) {
        uint32_t old = x[i];
        x[i] = x[j], x[j] = old;
      }
  for (; n < 3; n++) x[n] = NONE;
  for (uint32_t i = 0; i < count; i++)
    if (of[i].v[0] == x[0] && of[i].v[1] == x[1] && of[i].v[2] == x[2]) return i;
  return NONE;
}

/* the part that monomial i is of, 0: its constant and linear terms in xi */
static uint32_t part_of(const shape *s, uint32_t i) {
  uint32_t at = where[i];
  return at < s->eps ? 0 : at < s->pair[0] ? ERRORS : at < s->mix ? PAIRS : at < s->norms ? MIXED : TRIPLES;
}

static double value(const shape *s, const double *x, uint32_t i) {
  uint32_t part = part_of(s, i), norm = part == PAIRS ? NORM_Q : part == MIXED ? NORM_X : NORM_C;
  if (part == ERRORS) norm = NORM_R;
  return part == 0 || x[s->norms + norm] > 0 ? x[where[i]] : 0;
}

/* to [count] += scale a b, in a row with these parts; returns the sizes of what is dropped */
static long double multiply(
    const shape *s, long double *to, long double scale, const double *a, const double *b, uint32_t parts) {
  static uint32_t table[700][700];
  static const shape *tabled;
  if (!s) tabled = NULL;
  if (!s) return 0;
  if (tabled != s) {
    tabled = s;
    list_monomials(s);
    assert_true(count < 700);
    for (uint32_t i = 0; i < count; i++)
      for (uint32_t j = 0; j < count; j++) table[i][j] = find(of[i], of[j]);
  }
  long double dropped = 0;
  for (uint32_t i = 0; i < count; i++) {
    double x = value(s, a, i);
    for (uint32_t j = 0; j < count && x != 0; j++) {
      long double p = scale * x * value(s, b, j);
      uint32_t to_part = table[i][j] < count ? part_of(s, table[i][j]) : 0;
      if (table[i][j] >= count || (parts & to_part) != to_part)
        dropped += fabsl(p);
      else
        to[table[i][j]] += p;
    }
  }
  return dropped;
}

static void products_are_those_of_polynomials(void **unused) {
  (void)unused;
  static shape shapes[24];
  for (uint32_t n = 0; n < 24; n++) {
    shape *s = &shapes[n];
    assert_true(shape_open(&host, s, n % 9, 1 + n % 7) != 0);
    if (n % 2) thin_out(s);
    double *a = lend(&host, s->stride * 8), *b = lend(&host, s->stride * 8), *c = lend(&host, s->stride * 8);
    double *d = lend(&host, s->stride * 8);
    long double *truth = lend(&host, (s->stride + 1) * sizeof *truth);
    for (uint32_t kind = 0; kind < 1024; kind++) {
      uint32_t parts = (kind >> 8 & 1 ? PAIRS | MIXED : pick(4)) | (kind >> 9 && s->room ? TRIPLES : 0u);
      if ((parts & MIXED) || pick(2)) parts |= ERRORS; /* mixed terms have errors in them */
      fill(s, a, (int)kind % 16), fill(s, b, (int)kind / 16 % 16);
      terms t;
      terms_clear(&t);
      terms_product(s, &t, 0.75, a, b), terms_row(s, &t, -2, b), terms_outer(s, &t, 0.5, a, a);
      terms_sum(s, &t, c, parts);
      memset(truth, 0, s->stride * sizeof *truth);
      double *moving = d;
      memcpy(moving, a, s->stride * 8);
      moving[0] = 0;
      multiply(s, truth, 0.5L, moving, moving, parts);
      long double dropped = multiply(s, truth, 0.75L, a, b, parts) / 0.75L, size = 0;
      for (uint32_t i = 0; i < count; i++) {
        if ((parts & part_of(s, i)) != part_of(s, i)) continue;
        truth[i] -= 2 * (long double)value(s, b, i), size = fmaxl(size, fabsl(truth[i]));
        long double low = i == 0 ? row_low(s, c) : 0;
        assert_true(fabsl(truth[i] - value(s, c, i) - low) <= 1e-14L * (1 + size));
      }
      /* as much as is dropped; more only where triples of some data are left out */
      double bound = row_dropped(s, a, b, parts);
      assert_true(bound >= (double)dropped * (1 - 1e-12));
      if (!s->triples || s->cubic == s->m || !(parts & TRIPLES))
        assert_true(bound <= (double)dropped * (1 + 1e-12) + 1e-300);
      double norm[NORMS];
      memcpy(norm, c + s->norms, sizeof norm);
      memcpy(d, c, s->stride * 8), row_copy(s, c, d), row_norms_all(s, c);
      for (uint32_t i = 0; i < NORMS; i++) assert_true(fabs(norm[i] - c[s->norms + i]) <= 1e-13 * norm[i]);
#if defined(__x86_64__)
      if (!__builtin_cpu_supports("avx2") || (!t.nrow && !t.nouter && !t.nbend)) continue;
      memset(c, 0, s->stride * 8), memset(d, 0, s->stride * 8);
      sum_portable(s, &t, c, parts), sum_avx2(s, &t, d, parts);
      assert_memory_equal(c, d, (s->norms + NORMS) * 8);
      if (parts & TRIPLES) assert_memory_equal(c + s->cube, d + s->cube, s->triples * 8);
#endif
    }
  }
  give_back();
}

/* -- constants: sums of products of integers, exact in 128 bits */

__extension__ typedef __int128 wide;

static double integer(int bits) {
  double x = nearbyint(ldexp(draw(-1, 1), bits));
  return x != 0 ? x : 1;
}

static wide size_of(wide x) { return x < 0 ? -x : x; }

/* an integer of more than 53 bits, as a constant of two parts */
static wide fill_long(const shape *s, double *row) {
  row[0] = (pick(2) ? 1 : -1) * (0x1p53 + fabs(integer(52)));
  row[s->norms + LOW] = pick(3) - 1.0;
  return (wide)row[0] + (wide)row[s->norms + LOW];
}

/* 16 (n + 4)^2 u^2 of the terms' sizes, although the terms cancel */
static void constants_have_twice_the_digits(void **unused) {
  (void)unused;
  static shape s;
  assert_true(shape_open(&host, &s, 2, 3) != 0);
  double *row[2][40], *sum = lend(&host, s.stride * 8);
  for (uint32_t i = 0; i < 80; i++) row[i % 2][i / 2] = lend(&host, s.stride * 8);
  for (int turn = 0; turn < 4000; turn++) {
    uint32_t n = 2 + (uint32_t)turn % 38;
    wide truth = 0, size = 0;
    terms t;
    terms_clear(&t);
    for (uint32_t i = 0; i < n; i++) {
      double a = integer(30 + turn % 23), b = integer(53), sign = turn / 7 % 2 ? 1 : -1;
      if (i + 1 == n && turn % 3) a = 1, b = -sign * nearbyint((double)(truth / 3)); /* cancels */
      if (i + 1 == n && turn % 3) a = 3;
      fill(&s, row[0][i], 0), fill(&s, row[1][i], 0);
      row[0][i][0] = a, row[1][i][0] = b;
      wide product = (wide)a * (wide)b;
      if (turn % 3 == 0) product = fill_long(&s, row[0][i]) * fill_long(&s, row[1][i]);
      terms_product(&s, &t, sign, row[0][i], row[1][i]);
      truth += sign > 0 ? product : -product, size += size_of(product);
    }
    terms_sum(&s, &t, sum, 0);
    long double off = (long double)size_of((wide)sum[0] + (wide)row_low(&s, sum) - truth);
    assert_true(off <= 0x1p-102L * (n + 4) * (n + 4) * (long double)size);
    assert_true(fabs(row_low(&s, sum)) <= 0x1p-53 * fabs(sum[0]));
  }
  give_back();
}

/* -- the relations */

typedef struct checker {
  zono *z;
  long double *sum;
  long double size;
} checker;

static void clear(checker *c) {
  memset(c->sum, 0, c->z->shape.stride * sizeof *c->sum);
  c->size = 0;
}

static void add(checker *c, double scale, uint32_t slot, uint32_t k) {
  const double *x = coefficient(c->z, slot, k);
  for (uint32_t i = 0; i < count; i++) c->sum[i] += (long double)scale * value(&c->z->shape, x, i);
  c->size += fabsl((long double)scale * row_total(&c->z->shape, x));
}

/* scale sum_{from <= j <= k} w_j u_j v_(k-j), w_j = j / k or 1 */
static void convolve(checker *c, double scale, uint32_t u, uint32_t v, uint32_t k, int weighted) {
  for (uint32_t j = 0; j <= k; j++) {
    const double *a = coefficient(c->z, u, j), *b = coefficient(c->z, v, k - j);
    long double w = weighted ? (long double)scale * j / k : (long double)scale;
    multiply(&c->z->shape, c->sum, w, a, b, row_parts(&c->z->shape, k));
    c->size += fabsl(w) * row_total(&c->z->shape, a) * row_total(&c->z->shape, b);
  }
}

static void is_zero(const checker *c, uint32_t op, uint32_t k) {
  uint32_t parts = row_parts(&c->z->shape, k);
  for (uint32_t i = 0; i < count; i++)
    if ((parts & part_of(&c->z->shape, i)) == part_of(&c->z->shape, i) &&
        !(fabsl(c->sum[i]) <= 1e-13L * c->size + 1e-300L))
      fail_msg("opcode %u, order %u, coefficient %u: %Lg of %Lg", op, k, i, c->sum[i], c->size);
}

/* the line for abs, min or max; for a second one of the same operands, what the first leaves of a + b */
static void add_line(checker *c, uint32_t i, uint32_t k) {
  const ambit_tape *t = c->z->program.tape;
  long double by_a = 0, by_b = 0, offset = c->z->kinks->of[i].offset;
  kink_slopes(c->z, i, &by_a, &by_b);
  if (by_a != 0) add(c, (double)by_a, t->a[i], k);
  if (by_b != 0) add(c, (double)by_b, t->b[i], k);
  if (twin_of(c->z, i) < SLOTS)
    add(c, -1, twin_of(c->z, i), k);
  else if (k == 0)
    c->sum[0] += t->op[i] == AMBIT_OP_ABS || t->op[i] == AMBIT_OP_TANH ? offset
                 : t->op[i] == AMBIT_OP_MAX                            ? offset / 2
                                                                       : -offset / 2;
}

static void check(checker *c, uint32_t i, uint32_t k) {
  const ambit_tape *t = c->z->program.tape;
  uint32_t op = t->op[i], z = t->dst[i], a = t->a[i], b = t->b[i], q = t->aux[i];
  int weighted = op != AMBIT_OP_ADD && op != AMBIT_OP_SUB && op != AMBIT_OP_NEG && op != AMBIT_OP_MUL &&
                 op != AMBIT_OP_SQR && op != AMBIT_OP_DIV && op != AMBIT_OP_SQRT && !is_line(c->z, i);
  if (weighted && k == 0) return; /* Taylor polynomials: next test */
  clear(c);
  if (is_line(c->z, i)) op = AMBIT_OP_ABS;
  switch (op) {
  case AMBIT_OP_ADD: add(c, 1, a, k), add(c, 1, b, k), add(c, -1, z, k); break;
  case AMBIT_OP_SUB: add(c, 1, a, k), add(c, -1, b, k), add(c, -1, z, k); break;
  case AMBIT_OP_NEG: add(c, 1, a, k), add(c, 1, z, k); break;
  case AMBIT_OP_ABS: add_line(c, i, k), add(c, -1, z, k); break;
  case AMBIT_OP_MUL: convolve(c, 1, a, b, k, 0), add(c, -1, z, k); break;
  case AMBIT_OP_SQR: convolve(c, 1, a, a, k, 0), add(c, -1, z, k); break;
  case AMBIT_OP_DIV: convolve(c, 1, z, b, k, 0), add(c, -1, a, k); break;
  case AMBIT_OP_SQRT: convolve(c, 1, z, z, k, 0), add(c, -1, a, k); break;
  case AMBIT_OP_SIN:
  case AMBIT_OP_SINH:
  case AMBIT_OP_TANH:
  case AMBIT_OP_COSH: convolve(c, 1, a, q, k, 1), add(c, -1, z, k); break;
  case AMBIT_OP_COS: convolve(c, -1, a, q, k, 1), add(c, -1, z, k); break;
  case AMBIT_OP_EXP: convolve(c, 1, a, z, k, 1), add(c, -1, z, k); break;
  case AMBIT_OP_LOG: convolve(c, 1, z, a, k, 1), add(c, -1, a, k); break;
  case AMBIT_OP_ATAN: convolve(c, 1, z, q, k, 1), add(c, -1, a, k); break;
  case AMBIT_OP_ATAN2: convolve(c, 1, z, q, k, 1), convolve(c, -1, a, b, k, 1), convolve(c, 1, b, a, k, 1); break;
  default: fail();
  }
  is_zero(c, op, k);
}

static void rows_satisfy_their_relations(void **unused) {
  (void)unused;
  static zono z;
  static maker k;
  for (uint32_t n = 0; n < 60; n++) {
    uint32_t na = n % 4 == 3 ? UNKNOWNS : n % 3, nx = 2 + n % 3;
    open_case(&z, &k, nx, na, n % 2);
    assert_true(zono_open_proof(&z));
    if (!zono_series(&z)) fail_msg("tape %u: why %d, slot %u", n, z.why, z.blamed);
    multiply(NULL, NULL, 0, NULL, NULL, 0), list_monomials(&z.shape);
    checker c = { &z, lend(&host, (z.shape.stride + 1) * sizeof(long double)), 0 };
    for (uint32_t i = 0; i < k.tape.ninstr; i++)
      for (uint32_t o = 0; o < orders(&z, k.dst[i]); o++) check(&c, i, o);
    for (uint32_t i = 0; i < nx; i++)
      for (uint32_t o = 0; o < z.K; o++) {
        clear(&c), add(&c, o + 1.0, slot_x(&z, i), o + 1), add(&c, -1, k.out[i], o);
        is_zero(&c, 100, o + 1);
      }
    for (uint32_t e = 0; e < na; e++)
      for (uint32_t o = 0; o <= z.K; o++) {
        double left = row_total(&z.shape, coefficient(&z, k.out[nx + e], o)), size = 1;
        for (uint32_t j = 0; j < k.tape.nslot; j++) size = fmax(size, row_total(&z.shape, coefficient(&z, j, o)));
        if (!(left <= 1e-11 * size)) fail_msg("tape %u: equation %u, order %u is off by %g of %g", n, e, o, left, size);
      }
    give_back();
  }
}

/* -- Taylor polynomials: the truth at points, in long double; an error of fourth order */

static void functions_are_of_third_order(void **unused) {
  (void)unused;
  static const uint32_t op[] = { AMBIT_OP_SIN, AMBIT_OP_COS, AMBIT_OP_EXP, AMBIT_OP_LOG, AMBIT_OP_SINH, AMBIT_OP_COSH,
    AMBIT_OP_ATAN, AMBIT_OP_SQRT, AMBIT_OP_ATAN2, AMBIT_OP_DIV, AMBIT_OP_TANH };
  static zono z;
  static maker k;
  for (uint32_t n = 0; n < 200; n++) {
    memset(&k, 0, sizeof k);
    k.tape = (ambit_tape) { .nin = 2,
      .nout = 1,
      .ninstr = 0,
      .op = k.op,
      .dst = k.dst,
      .a = k.a,
      .b = k.b,
      .aux = k.aux,
      .lo = k.lo,
      .hi = k.hi,
      .out = k.out,
      .degree = k.degree };
    k.out[0] = put(&k, op[n % 11], 0, 1), k.aux[0] = 1, k.tape.nslot = 3;
    z = (zono) { .host = &host, .np = 2, .m = 2 };
    z.program = (program) { .tape = &k.tape, .np = 2 };
    assert_true(shape_open(&host, &z.shape, 2, 1) && zono_open_rows(&z));
    double a = draw(0.5, 2), b = draw(0.5, 2), da = draw(-1, 1), db = draw(-1, 1), h = 1e-3;
    double *x = z.p_row, *y = x + z.shape.stride;
    x[0] = a, x[1] = h * da, y[0] = b, y[1] = h * db;
    row_norms(&z.shape, x), row_norms(&z.shape, y);
    assert_true(zono_series(&z));
    const double *r = row_at(&z, 2, 0);
    for (int at = -1; at <= 1; at++) {
      long double exact = operation(op[n % 11], a + at * (long double)h * da, b + at * (long double)h * db);
      long double series = r[0] + at * (long double)r[1] + at * at * (long double)r[z.shape.pair[0]];
      series += at * at * at * (long double)r[z.shape.cube];
      assert_true(fabsl(exact - series) < 1e-10L);
    }
    give_back();
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(products_are_those_of_polynomials),
    cmocka_unit_test(constants_have_twice_the_digits),
    cmocka_unit_test(rows_satisfy_their_relations),
    cmocka_unit_test(functions_are_of_third_order),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
