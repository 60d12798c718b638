/* multiply.h -- sums of products of polynomials, compiled once per instruction set; all variants give the same numbers.
**
** c_(4g .. 4g+3) += x_j b_(4g-j .. 4g+3-j) for each coefficient x_j of a row of the left factor: the shifted loads read
** up to three of the zeros in front of a row. Coefficients of c beyond its row's length take what is truncated;
** whoever finishes the sum clears them.
*/
#include "polynomial.h"

/* the first `terms` coefficients of a, or all of them in blocks of four, times b */
static inline __attribute__((always_inline)) void multiply_row(
    four *sum, double factor, const double *a, const double *b, int groups, int terms) {
#pragma GCC unroll 8
  for (int block = 0; block < groups; block++) {
#pragma GCC unroll 4
    for (int j = 0; j < 4; j++) {
      if (4 * block + j >= terms) continue;
      double x = factor * a[4 * block + j];
      four broadcast = { x, x, x, x };
#pragma GCC unroll 8
      for (int g = block; g < groups; g++) sum[g] += broadcast * *(const four *)(b + 4 * (g - block) - j);
    }
  }
}

/* row r of the product: with many unknowns, most rows are one or two coefficients long */
static inline __attribute__((always_inline)) void multiply_into(
    const space *s, double *c, double factor, cell a, cell b, uint32_t r, int groups, int terms) {
  uint32_t atop = (uint32_t)a.info[TOP], btop = (uint32_t)b.info[TOP];
  double *to = c + s->row[r].at;
  four sum[8];
#pragma GCC unroll 8
  for (int g = 0; g < groups; g++) sum[g] = *(const four *)(to + 4 * g);
  for (uint32_t k = s->pairs[r]; k < s->pairs[r + 1]; k++) {
    const row *x = &s->row[s->pair[k].a], *y = &s->row[s->pair[k].b];
    if (x->degree > atop || y->degree > btop) continue;
    multiply_row(sum, factor, a.c + x->at, b.c + y->at, groups, terms);
  }
#pragma GCC unroll 8
  for (int g = 0; g < groups; g++) *(four *)(to + 4 * g) = sum[g];
}

static void multiply(const space *s, double *c, double factor, cell a, cell b) {
  uint32_t most = (uint32_t)a.info[TOP] + (uint32_t)b.info[TOP];
  for (uint32_t r = 0; r < s->nrow && s->row[r].degree <= most; r++) switch (s->row[r].length) {
    case 1: multiply_into(s, c, factor, a, b, r, 1, 1); break;
    case 2: multiply_into(s, c, factor, a, b, r, 1, 2); break;
    case 3: multiply_into(s, c, factor, a, b, r, 1, 3); break;
    case 4: multiply_into(s, c, factor, a, b, r, 1, 4); break;
    default:
      switch (s->row[r].groups) {
      case 2: multiply_into(s, c, factor, a, b, r, 2, 8); break;
      case 3: multiply_into(s, c, factor, a, b, r, 3, 12); break;
      case 4: multiply_into(s, c, factor, a, b, r, 4, 16); break;
      case 5: multiply_into(s, c, factor, a, b, r, 5, 20); break;
      case 6: multiply_into(s, c, factor, a, b, r, 6, 24); break;
      case 7: multiply_into(s, c, factor, a, b, r, 7, 28); break;
      default: multiply_into(s, c, factor, a, b, r, 8, 32);
      }
    }
}

static inline void add_multiple(const space *s, double *c, double x, const double *b) {
  four broadcast = { x, x, x, x };
  for (size_t j = 0; j < s->size; j += 4) *(four *)(c + j) += broadcast * *(const four *)(b + j);
}

static inline double beyond(const space *s, cell a, cell b) { /* norms of products of degree > d */
  four t = { 0, 0, 0, 0 };
  for (size_t i = 0; i < s->degrees; i += 4) t += *(const four *)(a.deg + i) * *(const four *)(b.suf + i);
  return (t[0] + t[1]) + (t[2] + t[3]);
}

static inline void add_product(const space *s, sum *x, double factor, cell a, cell b) {
  double f = fabs(factor), na = a.info[NORM], nb = b.info[NORM], ra = a.info[RAD], rb = b.info[RAD];
  double atop = a.info[TOP], btop = b.info[TOP];
  if ((atop < 0 && ra == 0) || (btop < 0 && rb == 0)) return;
  x->rad += f * (na * rb + ra * (nb + rb));
  x->weight += f * (na * nb);
  x->count++;
  if (atop < 0 || btop < 0) return;
  if (atop == 0)
    add_multiple(s, x->c, factor * a.c[s->row[0].at], b.c);
  else if (btop == 0)
    add_multiple(s, x->c, factor * b.c[s->row[0].at], a.c);
  else {
    multiply(s, x->c, factor, a, b);
    if (atop + btop > s->d) x->cut += f * beyond(s, a, b);
  }
}

void VARIANT(const space *s, sum *x, const series_part *of) {
  for (uint32_t j = of->from; j <= of->to && j <= of->k; j++)
    add_product(
        s, x, of->weighted ? of->factor * (double)j : of->factor, cell_at(s, of->a, j), cell_at(s, of->b, of->k - j));
}
