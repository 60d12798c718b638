/* Fewer generators (reduce.c): what is left reaches at least as far as all columns and the box did, in any direction,
** and no farther where columns are nearly parallel, or all but a few are along one state.
*/
#include "solver/zonotope/reduce.h"
#include "solver/zonotope/depend.h"
#include "zonotope_case.h"

#define COLUMNS 60
#define ROOM 10

typedef struct few {
  zono z;
  maker k;
  double before[COLUMNS * 3], box[3];
  uint32_t n, nx;
} few;

static void open_few(few *f) {
  zono *z = &f->z;
  f->nx = 2 + pick(2), f->n = 0;
  open_case(z, &f->k, f->nx, 0, 0);
  z->ngen_max = ROOM + f->nx, z->ngen = 0;
  z->G = lend(&host, (z->ngen_max + f->nx) * f->nx * sizeof(double));
  assert_true(zono_open_proof(z));
  memset(f->box, 0, sizeof f->box);
}

static double *add(few *f) {
  assert_true(f->n < COLUMNS);
  return f->before + (size_t)f->n++ * f->nx;
}

static void shrink(few *f) {
  proof *p = f->z.proof;
  memcpy(p->columns, f->before, (size_t)f->n * f->nx * sizeof(double));
  for (uint32_t i = 0; i < f->nx; i++) *box(&f->z, (enum origin)pick(ORIGINS), i) = f->box[i];
  reduce(&f->z, f->n);
  assert_true(f->z.ngen <= f->z.ngen_max);
}

static long double reach(uint32_t nx, const double *g, uint32_t n, const double *y) {
  long double sum = 0;
  for (uint32_t c = 0; c < n; c++) {
    long double along = 0;
    for (uint32_t i = 0; i < nx; i++) along += (long double)y[i] * g[(size_t)c * nx + i];
    sum += fabsl(along);
  }
  return sum;
}

static long double reach_before(const few *f, const double *y) {
  long double sum = reach(f->nx, f->before, f->n, y);
  for (uint32_t i = 0; i < f->nx; i++) sum += fabsl((long double)y[i] * f->box[i]);
  return sum;
}

static void draw_direction(const few *f, double *y) {
  for (uint32_t i = 0; i < f->nx; i++) y[i] = pick(6) ? draw(-1, 1) : 0;
}

static void add_random(few *f, const double *bundle, uint32_t kind) {
  double *g = add(f), size = pow(10, kind == 2 ? draw(-1, 1) : draw(-6, 1));
  uint32_t only = pick(f->nx);
  for (uint32_t i = 0; i < f->nx; i++) {
    g[i] = size * draw(-1, 1);
    if (kind == 0 && i != only) g[i] = 0;
    if (kind == 1) g[i] = size * bundle[i] * (1 + 1e-3 * draw(-1, 1));
    if (kind == 2) g[i] = size * bundle[i];
  }
}

static void nothing_is_lost(void **unused) {
  (void)unused;
  static few f;
  for (uint32_t n = 0; n < 400; n++) {
    double bundle[3], y[3];
    open_few(&f);
    int exact = pick(2) == 0; /* multiples of one column, and no box: rounding is all that joins leave */
    for (uint32_t i = 0; i < f.nx; i++)
      bundle[i] = draw(-1, 1), f.box[i] = pick(3) && !exact ? pow(10, draw(-9, 0)) : 0;
    uint32_t count = 5 + pick(COLUMNS - 5);
    for (uint32_t c = 0; c < count; c++) add_random(&f, bundle, exact ? 2 : pick(4));
    shrink(&f);
    for (int m = 0; m < 100; m++) {
      draw_direction(&f, y);
      if (m % 4 == 0) y[0] = bundle[1], y[1] = -bundle[0], y[2] = 0; /* across the bundle */
      long double old = reach_before(&f, y), now = reach(f.nx, f.z.G, f.z.ngen, y);
      if (!(now >= old * (1 - 0x1p-60L))) fail_msg("case %u: %.21Lg reaches %.21Lg", n, old, now);
    }
    give_back();
  }
}

/* Those that leave lie along a line, but for a millionth: boxed, each would be as wide across it as along it. */
static void parallel_columns_become_one(void **unused) {
  (void)unused;
  static few f;
  for (uint32_t n = 0; n < 100; n++) {
    open_few(&f);
    for (uint32_t c = 0; c < COLUMNS; c++) {
      double *g = add(&f), size = draw(0.5, 1) * (pick(2) ? 1 : -1);
      for (uint32_t i = 0; i < f.nx; i++) g[i] = size * (1 + 1e-6 * draw(-1, 1));
    }
    shrink(&f);
    const double across[3] = { 1, -1, 0 }, along[3] = { 1, 1, 0 };
    assert_true(reach(f.nx, f.z.G, f.z.ngen, across) < 1e-3);
    assert_true(reach(f.nx, f.z.G, f.z.ngen, along) < 1.0001L * reach_before(&f, along));
    give_back();
  }
}

/* Columns along one state are as good in the box. They all count for nothing, and those behind them for something. */
static void the_first_of_equals_push_nobody_out(void **unused) {
  (void)unused;
  static few f;
  for (uint32_t n = 0; n < 100; n++) {
    double y[3];
    open_few(&f);
    for (uint32_t c = 0; c < COLUMNS - ROOM; c++) {
      double *g = add(&f);
      memset(g, 0, f.nx * sizeof *g);
      g[pick(f.nx)] = draw(-1, 1);
    }
    for (uint32_t c = 0; c < ROOM; c++) {
      double *g = add(&f);
      for (uint32_t i = 0; i < f.nx; i++) g[i] = draw(0.1, 1) * (pick(2) ? 1 : -1);
    }
    shrink(&f);
    for (int m = 0; m < 20; m++) {
      draw_direction(&f, y);
      long double old = reach_before(&f, y), now = reach(f.nx, f.z.G, f.z.ngen, y);
      assert_true(now >= old * (1 - 0x1p-60L) && now <= old * (1 + 1e-8L));
    }
    give_back();
  }
}

/* Generators that are known as functions of the data stay what they are: nothing may join them. */
static void dependent_generators_stay(void **unused) {
  (void)unused;
  static few f;
  for (uint32_t n = 0; n < 100; n++) {
    open_few(&f);
    for (uint32_t c = 0; c < COLUMNS; c++) {
      double *g = add(&f), size = draw(0.5, 1);
      for (uint32_t i = 0; i < f.nx; i++) g[i] = size * (1 + 1e-6 * draw(-1, 1));
    }
    f.z.proof->depend->any = 1;
    shrink(&f);
    for (uint32_t c = 0; c < f.z.ngen; c++) {
      const double *g = f.z.G + (size_t)c * f.nx;
      uint32_t other = 0, is_old = 0;
      for (uint32_t i = 0; i < f.nx; i++) other += g[i] != 0;
      for (uint32_t k = 0; k < f.n; k++) is_old |= memcmp(g, f.before + (size_t)k * f.nx, f.nx * sizeof *g) == 0;
      assert_true(is_old || other <= 1); /* one of the columns, or a side of the box */
    }
    give_back();
  }
}

/* What is no number must not take more room than there is. */
static void no_number_stays_within_the_room(void **unused) {
  (void)unused;
  static few f;
  const double odd[3] = { NAN, INFINITY, 1e308 };
  for (uint32_t n = 0; n < 400; n++) {
    open_few(&f);
    for (uint32_t c = 0; c < COLUMNS; c++) {
      double *g = add(&f);
      for (uint32_t i = 0; i < f.nx; i++) g[i] = pick(8) ? draw(-1, 1) : odd[pick(3)];
    }
    shrink(&f);
    give_back();
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(nothing_is_lost),
    cmocka_unit_test(parallel_columns_become_one),
    cmocka_unit_test(the_first_of_equals_push_nobody_out),
    cmocka_unit_test(dependent_generators_stay),
    cmocka_unit_test(no_number_stays_within_the_room),
  };
  return cmocka_run_group_tests_name("zonotope: fewer generators", tests, NULL, NULL);
}
