/* What slopes' dependence on the data makes of the distance within a step (change.c), by itself. Crosses: for all xi
** the slopes must be in J_0 + sum xi_k u w' +- rest. Sizes: the bound of |w' z| of docs/numerics/zonotope.md, section
** 7e, in extended precision. */
#include "zonotope_case.h"
#include "solver/zonotope/change.h"
#include "solver/zonotope/depend.h"
#include "solver/zonotope/residual.h"

#define N 4 /* states and data at most */

typedef struct bench {
  zono z;
  proof p;
  depend d;
  residual r;
  uint32_t link[N];
  uint32_t link_to[N];
} bench;

static double *numbers(size_t n, double lo, double hi) {
  double *x = lend(&host, n * 8);
  for (size_t i = 0; i < n; i++) x[i] = draw(lo, hi);
  return x;
}

/* Slopes of n x n by m data, some of them 0: of one datum alone in any row, or of datum k in row k. dJ holds them, and
** in half of the cases more. */
static void open_bench(bench *b, uint32_t n, uint32_t m) {
  *b = (bench) { .z = { .host = &host, .nx = n, .m = m, .h = draw(0.1, 1) } };
  zono *z = &b->z;
  proof *p = &b->p;
  z->proof = p, p->depend = &b->d, p->residual = &b->r;
  b->d.mixed = m, p->ntarget = n, p->link = b->link, p->link_to = b->link_to;
  assert_true(change_open(z));
  change *c = p->change;
  c->known = 1;
  p->dJ = numbers(n * n, 0, 0), p->zeta = numbers(n, 0.1, 2), p->ramp = numbers(n, 0.1, 2);
  p->mean = numbers(n * n, -1, 1), p->tilt = numbers(n * n, -1, 1);
  p->reach = numbers(n * n, 0, 1), p->wobble = numbers(n * n, 0, 0.1);
  for (uint32_t i = 0; i < n; i++) b->link[i] = pick(5) ? LINK_TARGET : LINK_STATE, b->link_to[i] = i;
  uint32_t more = pick(2), alone = pick(2) ? pick(m) : m;
  for (uint32_t k = 0; k < m; k++)
    for (uint32_t i = 0; i < n; i++)
      for (uint32_t l = 0; l < n; l++) {
        int is_there = b->link[i] == LINK_TARGET && (alone < m ? k == alone : i == k) && pick(4) > 0;
        double s = is_there ? draw(-1, 1) : 0;
        c->slope[(i * n + l) * m + k] = s, p->dJ[i * n + l] += fabs(s) * (1 + 1e-15) + (more ? draw(0, 0.1) : 0);
      }
}

/* the datum of cross r: the first one with slopes in the row where u is largest */
static uint32_t datum_of(const bench *b, const change *c, uint32_t r) {
  uint32_t n = b->z.nx, m = b->z.m, row = 0, k = 0;
  for (uint32_t i = 0; i < n; i++)
    if (fabs(c->u[r * n + i]) > fabs(c->u[r * n + row])) row = i;
  for (;; k++)
    for (uint32_t l = 0; l < n; l++)
      if (c->slope[(row * n + l) * m + k] != 0) return k;
}

/* at least: what slopes may do besides their linear parts, and what crosses miss of these */
static long double true_rest(const bench *b, const change *c, uint32_t i, uint32_t l) {
  uint32_t n = b->z.nx, m = b->z.m;
  long double all = b->p.dJ[i * n + l];
  for (uint32_t k = 0; k < m; k++) {
    long double s = c->slope[(i * n + l) * m + k], missed = s;
    for (uint32_t r = 0; r < c->count; r++)
      if (datum_of(b, c, r) == k) missed -= (long double)c->u[r * n + i] * c->w[r * n + l];
    all += fabsl(missed) - fabsl(s);
  }
  return all;
}

static void check_turned(const bench *b, const change *c, uint32_t r) {
  uint32_t n = b->z.nx;
  for (uint32_t l = 0; l < n; l++) {
    long double mean = 0, tilt = 0, size = 0;
    for (uint32_t i = 0; i < n; i++) {
      mean += (long double)c->w[r * n + i] * b->p.mean[i * n + l];
      tilt += (long double)c->w[r * n + i] * b->p.tilt[i * n + l];
      size += fabsl((long double)c->w[r * n + i]);
    }
    assert_true(fabsl(mean - c->mean[r * n + l]) <= 1e-14L * size);
    assert_true(fabsl(tilt - c->tilt[r * n + l]) <= 1e-14L * size);
  }
}

static void crosses_and_rest_hold_all_slopes(void **unused) {
  (void)unused;
  static bench b;
  uint32_t crosses = 0, full = 0;
  for (int turn = 0; turn < 400; turn++) {
    uint32_t n = 1 + pick(N), m = 1 + pick(n < 3 ? n : 3);
    open_bench(&b, n, m);
    change_begin(&b.z);
    change *c = b.p.change;
    assert_true(c->count <= CROSSES * m);
    crosses += c->count;
    for (uint32_t e = 0; e < n * n && c->count; e++) {
      long double least = true_rest(&b, c, e / n, e % n);
      if (!(c->rest[e] >= least)) fail_msg("%u, %u of %u: %g < %Lg", e / n, e % n, n, c->rest[e], least);
      assert_true(c->rest[e] <= fmaxl(least, 0) + 1e-8L * b.p.dJ[e] + 1e-14L);
      full += least > 1e-3;
    }
    for (uint32_t r = 0; r < c->count; r++) check_turned(&b, c, r);
    give_back();
  }
  assert_true(crosses > 300 && full > 300);
}

static void sizes_are_bounds_of_the_distance(void **unused) {
  (void)unused;
  static bench b;
  uint32_t by_size = 0, by_single = 0, by_ramp = 0;
  for (int turn = 0; turn < 400; turn++) {
    uint32_t n = 1 + pick(N), m = 1 + pick(n < 3 ? n : 3);
    open_bench(&b, n, m);
    const zono *z = &b.z;
    proof *p = &b.p;
    double scale = ldexp(1, -(int)pick(8)), *centre = numbers(n, 0, 0), *width = numbers(n, 0, scale), zeta[N],
           dJ[N * N];
    change_begin(&b.z);
    change *c = p->change;
    long double noted[CROSSES * N] = { 0 };
    for (int k = 0; k < 3; k++) {
      double *by = numbers(n, -1, 1), rest = draw(0, scale);
      for (uint32_t i = 0; i < n; i++) centre[i] += fabs(by[i]) * rest;
      change_note(&b.z, by, rest);
      for (uint32_t r = 0; r < c->count; r++) {
        long double mean = 0, tilt = 0;
        for (uint32_t i = 0; i < n; i++)
          mean += (long double)c->mean[r * n + i] * by[i], tilt += (long double)c->tilt[r * n + i] * by[i];
        noted[r] += z->h * (fabsl(mean) + 0.5L * fabsl(tilt)) * rest;
      }
    }
    memcpy(zeta, p->zeta, sizeof *zeta * n), memcpy(dJ, p->dJ, sizeof *dJ * n * n);
    change_end(&b.z, centre, width);
    for (uint32_t r = 0; r < c->count; r++) {
      long double size = noted[r], flat = 0, single = 0, ramp = 0;
      for (uint32_t i = 0; i < n; i++) {
        long double w = fabsl((long double)c->w[r * n + i]);
        single += w * zeta[i], ramp += w * p->ramp[i];
        for (uint32_t l = 0; l < n; l++) {
          long double other = width[l];
          for (uint32_t k = 0; k < n; k++) other += (long double)dJ[l * n + k] * zeta[k];
          size += w * p->reach[i * n + l] * other, flat += w * p->wobble[i * n + l] * centre[l];
        }
      }
      long double most = fminl(size + flat, single), mean = fminl(size / 2 + flat, fminl(ramp / 2, single));
      const lump *x = &c->lump[r];
      assert_true(x->most >= most && x->rest >= most && x->path >= mean && x->mean >= mean && x->moment >= mean / 2);
      assert_true(x->most <= most * (1 + 1e-7L) && x->mean <= mean * (1 + 1e-7L));
      by_size += most < single && mean < ramp / 2, by_single += most == single, by_ramp += mean == ramp / 2;
    }
    if (c->count) assert_memory_equal(p->dJ, c->rest, sizeof *dJ * n * n);
    give_back();
  }
  assert_true(by_size > 20 && by_single > 20 && by_ramp > 20);
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(crosses_and_rest_hold_all_slopes),
    cmocka_unit_test(sizes_are_bounds_of_the_distance) };
  return cmocka_run_group_tests_name("zonotope: change", tests, NULL, NULL);
}
