/* restrict.c -- polynomials over a part of the cube, and their bounds.
**
** p(about + reach eta) comes from p by Horner's shift in each unknown in turn, q_i += about q_(i+1) in d passes, then
** powers of `reach`. With |about| + reach <= 1 the same shift of the magnitudes has a norm of at most |p|, and each
** coefficient is a sum of terms that were rounded at most 3 d m times, so rounding changes the result by no more than
** gamma(3 d m) |p| in the sum of magnitudes.
*/
#include "polynomial.h"
#include <string.h>

double polynomial_norm(const space *s, const double *p) {
  double norm = 0;
  for (uint32_t r = 0; r < s->nrow; r++)
    for (uint32_t j = 0; j < s->row[r].length; j++) norm += fabs(p[s->row[r].at + j]);
  return norm;
}

static void shift_first(const space *s, double about, double *q) {
  for (uint32_t r = 0; r < s->nrow; r++) {
    double *c = q + s->row[r].at;
    uint32_t n = s->row[r].length;
    for (uint32_t i = 0; i + 1 < n; i++)
      for (uint32_t j = n - 1; j-- > i;) c[j] += about * c[j + 1];
  }
}

static void scale_first(const space *s, double reach, double *q) {
  for (uint32_t r = 0; r < s->nrow; r++) {
    double *c = q + s->row[r].at, power = reach;
    for (uint32_t j = 1; j < s->row[r].length; j++, power *= reach) c[j] *= power;
  }
}

/* rows that differ in unknown v only: from the one without it */
static void shift_line(const space *s, const uint32_t *line, uint32_t n, double about, double reach, double *q) {
  for (uint32_t i = 0; i + 1 < n; i++)
    for (uint32_t j = n - 1; j-- > i;) {
      double *to = q + s->row[line[j]].at;
      const double *from = q + s->row[line[j + 1]].at;
      for (uint32_t k = 0; k < s->row[line[j + 1]].length; k++) to[k] += about * from[k];
    }
  double power = reach;
  for (uint32_t j = 1; j < n; j++, power *= reach) {
    double *to = q + s->row[line[j]].at;
    for (uint32_t k = 0; k < s->row[line[j]].length; k++) to[k] *= power;
  }
}

static void shift_other(const space *s, uint32_t v, double about, double reach, double *q) {
  uint32_t line[DEGREE_MAX + 1];
  for (uint32_t r = 0; r < s->nrow; r++) {
    if (s->exponent[(size_t)r * s->m + v] != 0) continue;
    uint32_t n = 0;
    for (uint32_t at = r; at != NO_ROW; at = s->next[(size_t)v * s->nrow + at]) line[n++] = at;
    shift_line(s, line, n, about, reach, q);
  }
}

double polynomial_restrict(const space *s, const double *p, const double *about, const double *reach, double *out) {
  double norm = polynomial_norm(s, p);
  if (out != p) memcpy(out, p, s->size * sizeof *out);
  for (uint32_t v = 0; v < s->m; v++) {
    if (about[v] == 0 && reach[v] == 1) continue;
    if (v == 0) {
      shift_first(s, about[0], out);
      scale_first(s, reach[0], out);
    } else
      shift_other(s, v, about[v], reach[v], out);
  }
  return gamma_of(3.0 * s->d * s->m + 4) * norm + (norm > 0 ? TINY : 0);
}

/* The constant, products of even powers, which are in [0, 1], and the magnitudes of the rest. */
void polynomial_bounds(const space *s, const double *p, double *low, double *high) {
  double rest = 0, up = 0, down = 0;
  for (uint32_t r = 0; r < s->nrow; r++) {
    const double *c = p + s->row[r].at;
    int even = s->row[r].degree % 2 == 0;
    for (uint32_t v = 1; v < s->m && even; v++) even = s->exponent[(size_t)r * s->m + v] % 2 == 0;
    for (uint32_t j = r == 0; j < s->row[r].length; j++)
      if (even && j % 2 == 0) {
        up += larger(c[j], 0), down += larger(-c[j], 0);
        rest += c[j] - c[j]; /* what is not finite must not be lost */
      } else
        rest += fabs(c[j]);
  }
  double c = p[s->row[0].at];
  *high = c + (up + rest);
  *low = -((down + rest) - c);
}

/* signs of the linear terms say which vertex is highest; its value is bounded from both sides */
void polynomial_vertex(const space *s, const double *p, int upper, double *low, double *high) {
  double sign[UNKNOWNS_MAX] = { 0 }, up = 0, down = 0;
  if (s->m) sign[0] = s->d && (p[s->row[0].at + 1] >= 0) == upper ? 1 : -1;
  for (uint32_t v = 1; v < s->m; v++)
    sign[v] = s->d && (p[s->row[s->next[(size_t)v * s->nrow]].at] >= 0) == upper ? 1 : -1;
  for (uint32_t r = 0; r < s->nrow; r++) {
    double f = 1;
    for (uint32_t v = 1; v < s->m; v++)
      if (s->exponent[(size_t)r * s->m + v] % 2) f *= sign[v];
    for (uint32_t j = 0; j < s->row[r].length; j++, f *= s->m ? sign[0] : 1) {
      up += f * p[s->row[r].at + j];
      down += (-f) * p[s->row[r].at + j];
    }
  }
  *low = -down, *high = up;
}
