/* The set at the end of a step of the zonotope solver (close.c, range.c, dense.c, set.c): linear systems
**   x' = (A + p D) x + (1 or p) B theta,   |theta| <= w any function of time,   p = about + scale xi_0,
** whose solutions are integrals, in extended precision. For each xi the farthest solution in a direction must be in the
** set of this xi. In each family of systems one part of the set holds most of what there is in some direction. All of
** it once more with generators that depend on the data (depend.c, change.c). */
#include "zonotope_case.h"
#include "solver/zonotope/depend.h"

#define N 3 /* states at most */

typedef struct family {
  const char *name;
  uint32_t n;
  double A[N][N], D[N][N], B[N];
  double lump, about, scale; /* w; p */
  int weighed;               /* B theta times p */
  double old;                /* size of generators at the start */
  uint32_t columns, kept;    /* their number; of all that are kept, in multiples of n */
  double h;
  uint32_t K;
  int from_rest; /* P = 0 */
  double least;  /* of what the set holds in some direction, at least this is reached */
} family;

/* -- the tape */

typedef struct lists {
  uint32_t A[N][N], B[N];
} lists;

static uint32_t sum_of(maker *k, uint32_t sum, uint32_t term) {
  return sum == AMBIT_NO_SLOT ? term : put(k, AMBIT_OP_ADD, sum, term);
}

/* constants: 0, then those of A, D, B */
static void make_linear(maker *k, const family *f) {
  uint32_t n = f->n, A = 1, D = A + n * n, B = D + n * n, x = B + n, p = x + n;
  make_empty(k, B + n, n, 0, 1);
  for (uint32_t i = 0; i < n; i++) {
    for (uint32_t j = 0; j < n; j++) {
      k->lo[A + i * n + j] = k->hi[A + i * n + j] = f->A[i][j];
      k->lo[D + i * n + j] = k->hi[D + i * n + j] = f->D[i][j];
    }
    k->lo[B + i] = -f->lump * fabs(f->B[i]), k->hi[B + i] = f->lump * fabs(f->B[i]);
  }
  for (uint32_t i = 0; i < n; i++) {
    uint32_t sum = AMBIT_NO_SLOT;
    for (uint32_t j = 0; j < n; j++) {
      if (f->A[i][j] != 0) sum = sum_of(k, sum, put(k, AMBIT_OP_MUL, A + i * n + j, x + j));
      if (f->D[i][j] != 0) sum = sum_of(k, sum, put(k, AMBIT_OP_MUL, D + i * n + j, put(k, AMBIT_OP_MUL, p, x + j)));
    }
    if (f->B[i] != 0) sum = sum_of(k, sum, f->weighed ? put(k, AMBIT_OP_MUL, p, B + i) : B + i);
    k->out[i] = sum == AMBIT_NO_SLOT ? 0 : sum;
  }
  k->tape.nslot = k->tape.nconst + k->tape.nin + k->tape.ninstr;
}

/* -- a step */

static double old_G[N * 400], old_P[N][400];
static uint32_t old_ngen;
static double old_depends[2][N * 400]; /* G_j; 0 where they are not followed */

/* G_j of the two data */
static void open_dependence(zono *z, const family *f) {
  depend *d = z->proof->depend;
  depend_begin(z);
  for (uint32_t j = 0; j < 2; j++) {
    d->is_there[j] = 1;
    for (uint32_t i = 0; i < f->n; i++) {
      double *row = d->now + (j * f->n + i) * d->stride;
      for (uint32_t c = 0; c < z->ngen; c++) {
        row[c] = old_depends[j][c * f->n + i] = 0.3 * f->old * draw(-1, 1);
        d->size[i] += fabs(row[c]) * (1 + 1e-12), z->E[i] += fabs(row[c]) * (1 + 1e-12);
      }
    }
  }
}

static void open_set(zono *z, const family *f) {
  uint32_t n = f->n;
  z->G = lend(&host, n * (z->ngen_max + n) * 8), z->lo = lend(&host, n * 8), z->hi = lend(&host, n * 8);
  z->tube_lo = lend(&host, n * 8), z->tube_hi = lend(&host, n * 8);
  double *p = z->p_row;
  p[0] = f->about, p[1] = f->scale, row_norms_all(&z->shape, p);
  z->ngen = f->columns;
  for (uint32_t i = 0; i < n; i++) {
    double *x = z->P + i * z->shape.stride;
    if (!f->from_rest) x[0] = draw(-1, 1), x[2] = 0.1 * draw(-1, 1);
    row_norms_all(&z->shape, x), memcpy(old_P[i], x, z->shape.stride * 8);
    z->E[i] = 0;
    for (uint32_t c = 0; c < z->ngen; c++) z->G[c * n + i] = f->old * draw(-1, 1), z->E[i] += fabs(z->G[c * n + i]);
    z->E[i] *= 1 + 1e-12;
  }
  old_ngen = z->ngen, memcpy(old_G, z->G, n * z->ngen * 8);
}

static void open_step(zono *z, maker *k, const family *f, int depends) {
  static double lo[2] = { -1, -1 }, hi[2] = { 1, 1 };
  make_linear(k, f);
  uint32_t n = f->n;
  *z = (zono) { .host = &host, .nx = n, .np = 1, .m = 2, .K = f->K, .K_max = f->K, .ngen_max = f->kept * n };
  z->program = (program) { .tape = &k->tape, .nx = n, .np = 1 };
  z->problem.extras = AMBIT_EXTRA_DENSE | AMBIT_EXTRA_SET, z->problem.nu = 2, z->problem.u_lo = lo,
  z->problem.u_hi = hi;
  z->unknown = lend(&host, 8), z->about = lend(&host, 16), z->scale = lend(&host, 16);
  z->unknown[1] = 1, z->scale[0] = z->scale[1] = 1;
  assert_true(shape_open(&host, &z->shape, z->m, n));
  z->P = lend(&host, n * z->shape.stride * 8), z->E = lend(&host, n * 8);
  assert_true(zono_open_rows(z) && zono_open_proof(z));
  z->proof->patience = 1;
  open_set(z, f);
  memset(old_depends, 0, sizeof old_depends);
  if (depends) open_dependence(z, f);
  z->h = f->h;
}

/* -- the truth */

#define PIECES 400

typedef struct matrix {
  long double x[N][N];
} matrix;

static matrix exponential(const family *f, long double xi, long double t) {
  matrix sum = { { { 0 } } }, term = sum;
  long double p = f->about + f->scale * xi;
  for (uint32_t i = 0; i < f->n; i++) sum.x[i][i] = term.x[i][i] = 1;
  for (int k = 1; k < 40; k++) {
    matrix next = { { { 0 } } };
    for (uint32_t i = 0; i < f->n; i++)
      for (uint32_t j = 0; j < f->n; j++) {
        for (uint32_t l = 0; l < f->n; l++) next.x[i][j] += term.x[i][l] * (f->A[l][j] + p * f->D[l][j]) * t / k;
        sum.x[i][j] += next.x[i][j];
      }
    term = next;
  }
  return sum;
}

typedef struct farthest {
  long double centre, old, lump; /* of l x(s): without old generators and lumps, and what these add at most */
} farthest;

static farthest look(const zono *z, const family *f, const point *p, const long double *l) {
  farthest r = { 0, 0, 0 };
  matrix K = exponential(f, p->xi[0], p->s);
  long double row[N] = { 0 }, factor = f->weighed ? f->about + f->scale * p->xi[0] : 1;
  for (uint32_t j = 0; j < f->n; j++)
    for (uint32_t i = 0; i < f->n; i++) row[j] += l[i] * K.x[i][j];
  for (uint32_t j = 0; j < f->n; j++) r.centre += row[j] * value_at(&z->shape, old_P[j], p);
  for (uint32_t c = 0; c < old_ngen; c++) {
    long double sum = 0;
    for (uint32_t j = 0; j < f->n; j++) {
      long double g = old_G[c * f->n + j];
      for (uint32_t v = 0; v < 2; v++) g += (long double)p->xi[v] * old_depends[v][c * f->n + j];
      sum += row[j] * g;
    }
    r.old += fabsl(sum);
  }
  for (int m = 0; m < PIECES && f->lump > 0; m++) {
    matrix k = exponential(f, p->xi[0], p->s * (m + 0.5L) / PIECES);
    for (uint32_t j = 0; j < f->n; j++) { /* each B_j is a lump of its own */
      long double sum = 0;
      for (uint32_t i = 0; i < f->n; i++) sum += l[i] * k.x[i][j];
      r.lump += fabsl(sum * f->B[j] * factor * f->lump * p->s) / PIECES;
    }
  }
  return r;
}

/* what is certainly reached: the integral by the midpoint rule is off by less */
static long double most_of(const farthest *r) {
  return r->old * (1 - 1e-18L) + r->lump * (1 - 1e-5L) - 1e-18L * fabsl(r->centre);
}

/* -- what the solver claims */

/* x(h) in direction l: its set for this xi */
static double reached(const zono *z, const family *f, const point *p, const long double *l) {
  point all = *p;
  farthest r = look(z, f, &all, l);
  long double about = 0, room = 0;
  for (uint32_t i = 0; i < f->n; i++) about += l[i] * value_at(&z->shape, z->P + i * z->shape.stride, p);
  for (uint32_t c = 0; c < z->ngen; c++) {
    long double sum = 0;
    for (uint32_t i = 0; i < f->n; i++) {
      const depend *d = z->proof->depend;
      long double g = z->G[c * f->n + i];
      for (uint32_t v = 0; v < 2 && d->any; v++)
        if (d->is_there[v]) g += (long double)p->xi[v] * d->now[(v * f->n + i) * d->stride + c];
      sum += l[i] * g;
    }
    room += fabsl(sum);
  }
  long double off = fabsl(r.centre - about) + most_of(&r);
  if (!(off <= room * (1 + 1e-18L))) fail_msg("%s: a solution is %Lg off, the set %Lg wide", f->name, off, room);
  return room > 0 ? (double)(off / room) : 0;
}

/* hull, tube and dense enclosure of state i at time s for the farthest solutions */
static void check_bounds(const zono *z, const family *f, const point *p, uint32_t i, const ambit_record *r) {
  long double l[N] = { 0 };
  l[i] = 1;
  farthest x = look(z, f, p, l);
  long double high = x.centre + most_of(&x), low = x.centre - most_of(&x);
  if (!(low >= z->tube_lo[i] && high <= z->tube_hi[i]))
    fail_msg("%s: %Lg, %Lg outside of the tube %g, %g", f->name, low, high, z->tube_lo[i], z->tube_hi[i]);
  if (p->s == z->h && !(low >= z->lo[i] && high <= z->hi[i]))
    fail_msg("%s: %Lg, %Lg outside of the hull %g, %g", f->name, low, high, z->lo[i], z->hi[i]);
  uint32_t order = r->ndense;
  long double mid = 0, rad = 0, power = 1;
  for (uint32_t k = 0; k < order; k++, power *= p->s) {
    mid += r->dense_mid[i * order + k] * power, rad += r->dense_rad[i * order + k] * fabsl(power);
    const double *column = r->dense_column + (size_t)i * r->ncolumn * order;
    for (uint32_t v = 0; v < z->m; v++) mid += column[v * order + k] * p->xi[v] * power;
  }
  /* eps: what of the old generators the columns of eps hold */
  for (uint32_t e = 0; e < f->n; e++) {
    const double *column = r->dense_column + ((size_t)i * r->ncolumn + z->m + e) * order;
    long double sum = 0;
    power = 1;
    for (uint32_t k = 0; k < order; k++, power *= p->s) sum += column[k] * power;
    rad += fabsl(sum);
  }
  if (!(fmaxl(high - mid, mid - low) <= rad))
    fail_msg("%s: %Lg, %Lg outside of the dense enclosure %Lg +- %Lg", f->name, low, high, mid, rad);
}

static void check_set(const zono *z, const family *f, const point *p) {
  const ambit_set *set = zono_describe_set((zono *)z);
  for (uint32_t i = 0; i < f->n; i++) {
    long double l[N] = { 0 }, sum = 0;
    l[i] = 1;
    farthest x = look(z, f, p, l);
    for (uint32_t t = 0; t < set->nterm; t++) {
      long double term = set->coefficient[i * set->nterm + t];
      for (uint32_t u = 0; u < 2; u++)
        for (uint32_t e = 0; e < set->exponent[t * 2 + u]; e++) term *= p->xi[u];
      sum += term;
    }
    if (!(fabsl(x.centre - sum) + most_of(&x) <= set->rest[i]))
      fail_msg("%s: %Lg +- %Lg outside of %Lg +- %g", f->name, x.centre, most_of(&x), sum, set->rest[i]);
  }
}

/* -- directions: those that the first lump's mean, and its tilt, do not touch are among them */

static void direction(const zono *z, const family *f, int number, long double *l) {
  const proof *p = z->proof;
  uint32_t n = f->n;
  long double mean[N] = { 0 }, tilt[N] = { 0 };
  for (uint32_t i = 0; i < n; i++) {
    l[i] = number < (int)n ? (uint32_t)number == i : draw(-1, 1);
    for (uint32_t j = 0; j < n; j++) mean[i] += p->mean[i * n + j] * f->B[j], tilt[i] += p->tilt[i * n + j] * f->B[j];
  }
  if (number % 3) return;
  if (n == 2) l[0] = mean[1], l[1] = -mean[0];
  if (n == 3) {
    for (int i = 0; i < 3; i++) l[i] = mean[(i + 1) % 3] * tilt[(i + 2) % 3] - mean[(i + 2) % 3] * tilt[(i + 1) % 3];
    if (number % 2 == 0)
      for (int i = 0; i < 3; i++) l[i] = mean[(i + 1) % 3] * draw(-1, 1) - mean[(i + 2) % 3] * draw(-1, 1);
  }
}

static void try_family(const family *f, int depends) {
  static zono z;
  static maker k;
  open_step(&z, &k, f, depends);
  if (!(zono_series(&z) && zono_defects(&z) && zono_prove(&z))) fail_msg("%s: why %d", f->name, z.why);
  ambit_record r = { .size = sizeof r };
  zono_tube(&z);
  zono_describe_dense(&z, &r);
  zono_finish(&z);
  zono_hull(&z);
  double most = 0;
  for (int m = 0; m < 24; m++) {
    point p;
    long double l[N];
    draw_point(&z, &p, z.h);
    if (m == 0) p.xi[0] = f->about < 0 ? -1 : 1;
    for (uint32_t i = 0; i < f->n; i++) check_bounds(&z, f, &p, i, &r);
    p.s = z.h;
    for (uint32_t i = 0; i < f->n; i++) check_bounds(&z, f, &p, i, &r);
    check_set(&z, f, &p);
    direction(&z, f, m, l);
    most = fmax(most, reached(&z, f, &p, l));
  }
  if (most < f->least * (depends ? 0.8 : 1)) fail_msg("%s: only %.2g of the set is reached", f->name, most);
  give_back();
}

static const family families[] = {
  { "mean", 1, .A = { { -0.7 } }, .B = { 1 }, .lump = 0.1, .kept = 60, .h = 0.5, .K = 12, .least = 0.9 },
  { "tilt", 2, .A = { { 0, 1 } }, .B = { 0, 1 }, .lump = 0.1, .kept = 60, .h = 1, .K = 8, .least = 0.9 },
  { "tilt, backwards", 2, .A = { { 0, 1 } }, .B = { 0, 1 }, .lump = 0.1, .kept = 60, .h = -1, .K = 8, .least = 0.9 },
  { "wobble", 3, .A = { { 0, 1 }, { 0, 0, 1 } }, .B = { 0, 0, 1 }, .lump = 0.1, .kept = 60, .h = 1, .K = 8,
      .least = 0.5 },
  { "coefficients", 1, .B = { 1 }, .lump = 0.1, .about = 0, .scale = 1, .weighed = 1, .kept = 60, .h = 1, .K = 4,
      .least = 0.9 },
  { "slopes", 1, .D = { { 1 } }, .B = { 1 }, .lump = 0.1, .scale = 0.4, .kept = 60, .h = 1, .K = 20, .least = 0.5 },
  { "mixed", 1, .D = { { 1 } }, .scale = 0.4, .old = 0.01, .columns = 1, .kept = 60, .h = 0.2, .K = 12, .least = 0.9 },
  { "old", 3, .A = { { -0.1, 1, 0.2 }, { -1, 0.1, 0 }, { 0, 0.3, -1 } }, .old = 0.01, .columns = 40, .kept = 60,
      .h = 0.5, .K = 14, .least = 0.9 },
  { "old, alone", 3, .A = { { -0.1, 1, 0.2 }, { -1, 0.1, 0 }, { 0, 0.3, -1 } }, .old = 0.01, .columns = 40, .kept = 60,
      .h = 0.1, .K = 16, .from_rest = 1, .least = 0.9 },
  { "reduced", 3, .A = { { -0.1, 1, 0.2 }, { -1, 0.1, 0 }, { 0, 0.3, -1 } }, .old = 0.01, .columns = 40, .kept = 14,
      .h = 0.5, .K = 14, .least = 0.5 },
  { "truncated", 2, .A = { { 0, 1 }, { -1, 0 } }, .kept = 60, .h = 0.3, .K = 3, .least = 0.1 },
  { "rounded", 2, .A = { { 0, 1 }, { -1, 0 } }, .kept = 60, .h = 0.1, .K = 14, .least = 1e-3 },
  { "all", 3, .A = { { -0.1, 1, 0.2 }, { -1, 0.1, 0 }, { 0, 0.3, -1 } },
      .D = { { 0, 0.3, 0 }, { 0.2, 0, 0 }, { 0, 0, -0.4 } }, .B = { 0.5, 1, 0.2 }, .lump = 0.01, .about = 1,
      .scale = 0.2, .weighed = 1, .old = 0.01, .columns = 5, .kept = 60, .h = 0.4, .K = 14, .least = 0.5 },
};

static void farthest_solutions_are_in_the_set(void **unused) {
  (void)unused;
  for (size_t n = 0; n < sizeof families / sizeof *families; n++)
    for (int again = 0; again < 4; again++) try_family(&families[n], again % 2);
}

/* -- what rows leave of an equation: x' = a, p a = x + theta or p a = theta, theta = w, w xi or w s / h */

enum theta { STEADY, BY_DATUM, BY_TIME };

/* R's rows are -theta, as if phase 1 had left that */
static void leave(zono *z, uint32_t slot, enum theta kind, double w) {
  double *row = row_at(z, slot, kind == BY_TIME);
  row[kind == BY_DATUM] = kind == BY_TIME ? -w / z->h : -w;
  row_norms_all(&z->shape, row);
  z->rr_out[1] = w;
}

static void try_equation(int coupled, enum theta kind) {
  static zono z;
  static maker k;
  static const uint32_t stage_end[1] = { 1 }, pivot[1] = { 0 };
  const double w = 0.01, scale = 0.3, h = 0.5;
  make_empty(&k, 1, 1, 1, 1); /* constant 0; x, a, p, t */
  k.out[0] = 2, k.out[1] = put(&k, AMBIT_OP_MUL, 2, 3);
  if (coupled) k.out[1] = put(&k, AMBIT_OP_SUB, k.out[1], 1);
  k.tape.nslot = k.tape.nconst + k.tape.nin + k.tape.ninstr;
  z = (zono) { .host = &host, .nx = 1, .na = 1, .np = 1, .m = 1, .K = 8, .K_max = 8, .ngen_max = 60, .h = h };
  z.program = (program) { &k.tape, 1, 1, 1, 0, 1, stage_end, pivot, NULL, NULL, NULL, NULL };
  assert_true(shape_open(&host, &z.shape, 1, 1));
  z.P = lend(&host, z.shape.stride * 8), z.E = lend(&host, 8), z.G = lend(&host, 61 * 8);
  assert_true(zono_open_rows(&z) && zono_open_implicit(&z) && zono_open_proof(&z));
  z.proof->patience = 1, z.p_row[0] = 1, z.p_row[1] = scale, row_norms_all(&z.shape, z.p_row);
  assert_true(zono_series(&z) && zono_defects(&z));
  leave(&z, k.out[1], kind, w);
  assert_true(zono_prove(&z));
  double bound = z.proof->alpha_new[0]; /* scratch afterwards */
  zono_finish(&z);
  /* from x = 0, p least, and theta at the end for the acceleration */
  double p = 1 - scale, most = coupled ? w * expm1(h / p) : w * h / p;
  if (kind == BY_TIME) most = coupled ? w / h * (p * expm1(h / p) - h) : most / 2;
  double alpha = ((coupled ? most : 0) + w) / (1 - scale);
  assert_true(most <= z.E[0] && most <= z.proof->zeta[0] && z.E[0] < (kind == BY_TIME ? 4 : 1.6) * most);
  assert_true(alpha <= bound && bound < 2 * alpha);
  give_back();
}

static void lumps_of_equations_are_in_the_set(void **unused) {
  (void)unused;
  for (int kind = STEADY; kind <= BY_TIME; kind++) try_equation(0, (enum theta)kind), try_equation(1, (enum theta)kind);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(farthest_solutions_are_in_the_set),
    cmocka_unit_test(lumps_of_equations_are_in_the_set),
  };
  return cmocka_run_group_tests_name("zonotope: a step", tests, NULL, NULL);
}
