/* sneaky.c -- wrong on purpose: a plugin does not see the kernel, nor other plugins. */
#include "num/interval.h"
#include "../other.h"
#include <ambit/solver.h>

static void believe(const ambit_arithmetic *a, void *ctx, void *x, double *lo, double *hi) {
  a->bounds(ctx, x, 1, lo, hi);
}
