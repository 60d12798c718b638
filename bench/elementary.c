/* elementary.c -- what a rigorous elementary function costs: ns per interval (both bounds), beside one call of the C
** library's function, which bounds nothing. Prints one line per function; ratio = our thin interval in arrays / C
** library.
*/
#define _POSIX_C_SOURCE 200809L
#include "num/elementary.h"
#include <stdio.h>
#include <time.h>

#define N 1024
#define ROUNDS 200

typedef struct data {
  double lo[N], hi[N], xlo[N], xhi[N], rlo[N], rhi[N];
} data;

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

/* the fastest of several passes, ns per element; group: intervals per call */
static double ours(uint32_t op, data *d, size_t group) {
  double best = 1e9;
  for (int round = 0; round < ROUNDS; round++) {
    double start = now();
    for (size_t i = 0; i + group <= N; i += group)
      ambit_elementary(op, group, d->lo + i, d->hi + i, d->xlo + i, d->xhi + i, d->rlo + i, d->rhi + i);
    double each = (now() - start) / N;
    if (each < best) best = each;
  }
  return best;
}

static double library(double (*f)(double), data *d) {
  double best = 1e9;
  for (int round = 0; round < ROUNDS; round++) {
    double start = now();
    for (size_t i = 0; i < N; i++) d->rlo[i] = f(d->lo[i]);
    double each = (now() - start) / N;
    if (each < best) best = each;
  }
  return best;
}

static double atan2_one(double y) { return atan2(y, 1.25); }

typedef struct row {
  const char *name;
  uint32_t op;
  double lo, hi;
  double (*library)(double);
} row;

static void fill(data *d, double lo, double hi, double width) {
  uint64_t s = 88172645463325252u;
  for (size_t i = 0; i < N; i++) {
    s ^= s << 13, s ^= s >> 7, s ^= s << 17;
    d->lo[i] = lo + (hi - lo) * ((double)(s >> 11) * 0x1p-53);
    d->hi[i] = d->lo[i] + width;
    d->xlo[i] = 1.25, d->xhi[i] = 1.25 + width;
  }
}

int main(void) {
  static const row rows[] = { { "exp", AMBIT_OP_EXP, -10, 10, exp }, { "log", AMBIT_OP_LOG, 0.1, 10, log },
    { "sin", AMBIT_OP_SIN, -10, 10, sin }, { "cos", AMBIT_OP_COS, -10, 10, cos }, { "tan", AMBIT_OP_TAN, -10, 10, tan },
    { "asin", AMBIT_OP_ASIN, -0.99, 0.98, asin }, { "acos", AMBIT_OP_ACOS, -0.99, 0.98, acos },
    { "atan", AMBIT_OP_ATAN, -10, 10, atan }, { "atan2", AMBIT_OP_ATAN2, -10, 10, atan2_one },
    { "sinh", AMBIT_OP_SINH, -10, 10, sinh }, { "cosh", AMBIT_OP_COSH, -10, 10, cosh },
    { "tanh", AMBIT_OP_TANH, -10, 10, tanh } };
  static data d;
  printf("ns per interval   arrays: thin   narrow   groups of 4: thin   narrow   alone: thin   narrow   C library   "
         "ratio\n");
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const row *r = &rows[i];
    double t[6];
    static const size_t group[3] = { N, 4, 1 };
    for (int k = 0; k < 6; k++) {
      fill(&d, r->lo, r->hi, k % 2 ? 1e-3 : 0);
      t[k] = ours(r->op, &d, group[k / 2]);
    }
    fill(&d, r->lo, r->hi, 0);
    double c = library(r->library, &d);
    printf("%-6s %23.1f %8.1f %19.1f %8.1f %13.1f %8.1f %11.1f %7.2f\n", r->name, t[0], t[1], t[2], t[3], t[4], t[5], c,
        t[0] / c);
  }
  return 0;
}
