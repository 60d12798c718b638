/* elementary.c -- what a rigorous elementary function or integer power costs: ns per interval (both bounds), in one run
** beside one call of the C library's function, which bounds nothing.
**
** Narrow intervals, of width 10^-3, need two evaluations; thin ones, points, need one. The columns are the compiled
** variants of framework/kernel/num over arrays, and the public function with one interval at a time. ratio = narrow
** with AVX2 (without it: portable) / C library.
*/
#define _POSIX_C_SOURCE 200809L
#include "num/elementary.h"
#include "num/elementary_variant.h"
#include "num/power.h"
#include "num/power_variant.h"
#include "num/rounding.h"
#include <stdio.h>
#include <time.h>

#define N 1024
#define ROUNDS 100

typedef struct data {
  double lo[N], hi[N], xlo[N], xhi[N], rlo[N], rhi[N];
} data;

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

/* what is timed: a variant's function over the array, the public one interval by interval, or the C library's */
typedef struct job {
  ambit_elementary_map map;
  double (*library)(double);
  uint32_t op;
} job;

static AMBIT_WORKER void work(const job *j, data *d) {
  if (j->map) {
    j->map(N, d->lo, d->hi, d->xlo, d->xhi, d->rlo, d->rhi);
  } else if (j->library) {
    for (size_t i = 0; i < N; i++) d->rlo[i] = j->library(d->lo[i]);
  } else {
    for (size_t i = 0; i < N; i++)
      ambit_elementary(j->op, 1, d->lo + i, d->hi + i, d->xlo + i, d->xhi + i, d->rlo + i, d->rhi + i);
  }
}

/* the fastest of several passes, ns per element */
static double fastest(job j, data *d) {
  double best = 1e9;
  for (int round = 0; round < ROUNDS; round++) {
    double start = now();
    work(&j, d);
    double each = (now() - start) / N;
    if (each < best) best = each;
  }
  return best;
}

static void fill(data *d, double lo, double hi, double width) {
  uint64_t s = 88172645463325252u;
  for (size_t i = 0; i < N; i++) {
    s ^= s << 13, s ^= s >> 7, s ^= s << 17;
    d->lo[i] = lo + (hi - lo) * ((double)(s >> 11) * 0x1p-53);
    d->hi[i] = d->lo[i] + width * fmax(1, fabs(d->lo[i]));
    d->xlo[i] = 1.25, d->xhi[i] = 1.25 + width;
  }
}

static double atan2_one(double y) { return atan2(y, 1.25); }

typedef struct row {
  const char *name;
  uint32_t op;
  double lo, hi;
  double (*library)(double);
} row;

#define COLUMNS 4
static const ambit_elementary_map *const *variants(void) {
  static const ambit_elementary_map *table[COLUMNS] = { ambit_elementary_portable };
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    table[1] = ambit_elementary_fma, table[2] = ambit_elementary_avx2;
  if (__builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) table[3] = ambit_elementary_avx512;
#endif
  return table;
}

static void print_row(const row *r, data *d) {
  const ambit_elementary_map *const *table = variants();
  double chosen = 0;
  printf("%-6s", r->name);
  for (int k = 0; k < COLUMNS; k++) {
    if (!table[k]) {
      printf("      -      -");
      continue;
    }
    job j = { table[k][r->op - AMBIT_OP_EXP], NULL, r->op };
    fill(d, r->lo, r->hi, 1e-3);
    double narrow = fastest(j, d);
    fill(d, r->lo, r->hi, 0);
    printf(" %6.1f %6.1f", narrow, fastest(j, d));
    if (k == 0 || k == 2) chosen = narrow;
  }
  job alone = { NULL, NULL, r->op }, library = { NULL, r->library, r->op };
  fill(d, r->lo, r->hi, 1e-3);
  double one = fastest(alone, d);
  fill(d, r->lo, r->hi, 0);
  double plain = fastest(library, d);
  printf(" %6.1f %6.1f %7.1f %6.2f\n", one, fastest(alone, d), plain, chosen / plain);
}

/* ---- integer powers, beside pow */
typedef struct power_job {
  ambit_power_map *map; /* NULL: pow */
  int32_t n;
} power_job;

static AMBIT_WORKER void power_work(power_job j, data *d) {
  if (j.map)
    j.map(j.n, N, d->lo, d->hi, d->rlo, d->rhi);
  else
    for (size_t i = 0; i < N; i++) d->rlo[i] = pow(d->lo[i], j.n);
}
static double fastest_power(power_job j, data *d) {
  double best = 1e9;
  for (int round = 0; round < ROUNDS; round++) {
    double start = now();
    power_work(j, d);
    double each = (now() - start) / N;
    if (each < best) best = each;
  }
  return best;
}
static void alone_power(int32_t n, size_t count, const double *alo, const double *ahi, double *rlo, double *rhi) {
  for (size_t i = 0; i < count; i++) ambit_power(n, 1, alo + i, ahi + i, rlo + i, rhi + i);
}

static void print_power(int32_t n, data *d) {
  ambit_power_map *table[COLUMNS + 1] = { ambit_power_portable };
#if defined(__x86_64__)
  if (variants()[2]) table[1] = ambit_power_fma, table[2] = ambit_power_avx2;
  if (variants()[3]) table[3] = ambit_power_avx512;
#endif
  table[COLUMNS] = alone_power;
  double size = fabs((double)n), chosen = 0;
  char name[16];
  snprintf(name, sizeof name, "x^%d", n);
  printf("%-6s", name);
  for (int k = 0; k <= COLUMNS; k++) {
    if (!table[k]) {
      printf("      -      -");
      continue;
    }
    fill(d, exp2(-300 / size), exp2(300 / size), 1e-3 / size);
    double narrow = fastest_power((power_job) { table[k], n }, d);
    fill(d, exp2(-300 / size), exp2(300 / size), 0);
    printf(" %6.1f %6.1f", narrow, fastest_power((power_job) { table[k], n }, d));
    if (k == 0 || k == 2) chosen = narrow;
  }
  double plain = fastest_power((power_job) { NULL, n }, d);
  printf(" %7.1f %6.2f\n", plain, chosen / plain);
}

int main(void) {
  static const int32_t exponents[] = { 2, 3, 4, 7, 8, -1, -3, -8, 31, 511, 1000, 65535, 1000000007 };
  static const row rows[] = { { "exp", AMBIT_OP_EXP, -10, 10, exp }, { "log", AMBIT_OP_LOG, 0.1, 10, log },
    { "sin", AMBIT_OP_SIN, -10, 10, sin }, { "cos", AMBIT_OP_COS, -10, 10, cos }, { "tan", AMBIT_OP_TAN, -10, 10, tan },
    { "asin", AMBIT_OP_ASIN, -0.99, 0.98, asin }, { "acos", AMBIT_OP_ACOS, -0.99, 0.98, acos },
    { "atan", AMBIT_OP_ATAN, -10, 10, atan }, { "atan2", AMBIT_OP_ATAN2, -10, 10, atan2_one },
    { "sinh", AMBIT_OP_SINH, -10, 10, sinh }, { "cosh", AMBIT_OP_COSH, -10, 10, cosh },
    { "tanh", AMBIT_OP_TANH, -10, 10, tanh } };
  static data d;
  printf("ns per interval, narrow and thin\n");
  printf("            portable    scalar FMA          AVX2       AVX-512         alone  C lib.  ratio\n");
  ambit_rounding old = ambit_round_nearest();
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) print_row(&rows[i], &d);
  for (size_t i = 0; i < sizeof exponents / sizeof *exponents; i++) print_power(exponents[i], &d);
  ambit_rounding_restore(old);
  return 0;
}
