/* slope.c -- Jacobians of the rates and the outputs at nodes of a reference: the kernel's formulas, and difference
** quotients where these have none (a kink) or no value (the root of 0). */
#include "reduce.h"
#include <math.h>
#include <string.h>

#define STEP 0x1p-17 /* about the cube root of the precision: central differences are then at their best */

static int all_finite(size_t n, const double *x) {
  for (size_t i = 0; i < n; i++)
    if (!isfinite(x[i])) return 0;
  return 1;
}

/* s->near := pairs of points beside in, by states [first, first + count) */
static void place(reducer *s, const double *in, uint32_t first, uint32_t count) {
  uint32_t nin = s->r.nin;
  for (uint32_t l = 0; l < 2 * count; l++) {
    double *to = s->near + (size_t)l * nin, *x = to + first + l / 2;
    memcpy(to, in, nin * sizeof *to);
    double d = STEP * fmax(fabs(*x), s->scale[first + l / 2]);
    *x += l % 2 ? -d : d;
  }
}

/* out [rows x nx] := central difference quotients of the table's tape at in; no value: 0 */
static void difference(reducer *s, table *f, const double *in, double *out) {
  uint32_t rows = f->tape->nout, nin = s->r.nin;
  for (uint32_t first = 0; first < s->nx; first += s->width / 2) {
    uint32_t count = s->nx - first < s->width / 2 ? s->nx - first : s->width / 2;
    place(s, in, first, count);
    table_load(f, s->near, 2 * count);
    for (uint32_t j = 0; j < count; j++) {
      const double *up = table_at(f, 2 * j), *down = table_at(f, 2 * j + 1);
      double step = s->near[(size_t)2 * j * nin + first + j] - s->near[((size_t)2 * j + 1) * nin + first + j];
      for (uint32_t i = 0; i < rows; i++) {
        double quotient = (up[i] - down[i]) / step;
        s->undefined += isfinite(quotient) ? 0 : 1;
        out[(size_t)i * s->nx + first + j] = isfinite(quotient) ? quotient : 0;
      }
    }
  }
}

static void load(reducer *s, table *formula, table *f, const double *in, uint32_t count, double *out) {
  size_t entries = (size_t)f->tape->nout * s->nx;
  if (formula->tape) {
    table_load(formula, in, count);
    memcpy(out, formula->value, count * entries * sizeof *out);
  }
  for (uint32_t l = 0; l < count; l++)
    if (!formula->tape || !all_finite(entries, out + l * entries))
      difference(s, f, in + (size_t)l * s->r.nin, out + l * entries);
}

void slope_load(reducer *s, const ambit_reference *at, uint32_t first, uint32_t count) {
  const double *in = at->in + (size_t)first * s->r.nin;
  load(s, &s->jacobian, &s->rates, in, count, s->J);
  load(s, &s->output_jacobian, &s->output_value, in, count, s->C);
}
