/* invariant.c -- linear invariants of a right-hand side f: integer w with w . f = 0 (invariant.h).
**
** They are found from the sums and differences that end the tape of f: coefficients of everything else must cancel
** exactly, so all numbers are integers that doubles multiply and add without rounding.
*/
#include "invariant.h"
#include <math.h>
#include <string.h>

/* coefficients of output i over slots that are no sum; 0: too large */
static int linear_form(const ambit_tape *t, uint32_t i, double *c) {
  memset(c, 0, t->nslot * sizeof *c);
  c[t->out[i]] = 1;
  for (uint32_t k = t->ninstr; k-- > 0;) {
    double x = c[t->dst[k]];
    if (!(fabs(x) < INVARIANT_LARGEST)) return 0;
    if (x == 0) continue;
    switch (t->op[k]) {
    case AMBIT_OP_ADD: c[t->a[k]] += x, c[t->b[k]] += x; break;
    case AMBIT_OP_SUB: c[t->a[k]] += x, c[t->b[k]] -= x; break;
    case AMBIT_OP_NEG: c[t->a[k]] -= x; break;
    default: continue;
    }
    c[t->dst[k]] = 0;
  }
  for (uint32_t k = 0; k < t->nconst; k++)
    if (t->lo[k] == 0 && t->hi[k] == 0) c[k] = 0;
  for (uint32_t k = 0; k < t->nslot; k++)
    if (!(fabs(c[k]) < INVARIANT_LARGEST)) return 0;
  return 1;
}

static double common_divisor(double a, double b) {
  while (b != 0) {
    double rest = fmod(a, b);
    a = b, b = rest;
  }
  return fabs(a);
}

/* row := (row p - pivot q) / their common divisor, all integers; 0: too large */
static int reduce(size_t n, double *row, const double *pivot, double p, double q) {
  double divisor = 0;
  for (size_t k = 0; k < n; k++) {
    row[k] = row[k] * p - pivot[k] * q;
    if (!(fabs(row[k]) < INVARIANT_LARGEST)) return 0;
    divisor = common_divisor(divisor, row[k]);
  }
  for (size_t k = 0; k < n && divisor > 1; k++) row[k] /= divisor;
  return 1;
}

uint32_t invariant_find(const ambit_tape *t, uint32_t nx, double *rows, double *w) {
  uint32_t found = 0, done = 0;
  size_t n = t->nslot + nx;
  for (uint32_t i = 0; i < nx; i++) {
    if (!linear_form(t, i, rows + i * n)) return 0;
    for (uint32_t k = 0; k < nx; k++) rows[i * n + t->nslot + k] = i == k;
  }
  for (size_t col = 0; col < t->nslot && done < nx; col++) {
    uint32_t pivot = done;
    while (pivot < nx && rows[pivot * n + col] == 0) pivot++;
    if (pivot == nx) continue;
    for (size_t k = 0; k < n && pivot != done; k++) {
      double x = rows[pivot * n + k];
      rows[pivot * n + k] = rows[done * n + k], rows[done * n + k] = x;
    }
    for (uint32_t i = done + 1; i < nx; i++) {
      double q = rows[i * n + col];
      if (q != 0 && !reduce(n, rows + i * n, rows + done * n, rows[done * n + col], q)) return 0;
    }
    done++;
  }
  for (uint32_t i = done; i < nx; i++, found++) memcpy(w + found * nx, rows + i * n + t->nslot, nx * sizeof *w);
  return found;
}
