/* frame.c -- from the end of one step to the set that begins the next.
**
** The end is p(1, xi) + B(1) z + r. The polynomial is rounded to doubles. What is left is a sum of generators g_c e_c,
** |e_c| <= 1: the columns of B(1) with their weights, those of the basis V with the bounds of r, and a box of
** roundings. They are put into one frame D Q, D a diagonal of powers of two and Q nearly orthogonal (Lohner 1988,
** with pivoting): with E = I - Q^T Q, |E| <= e < 1 in the row-sum norm, D Q y = g has |y_j| <= v_j + e / (1 - e)
** max v, where v_j bounds |Q^T D^-1 g|_j. e is computed, never assumed.
*/
#include "valencia.h"
#include <string.h>

static interval at_end(const double *c, uint32_t n) {
  interval r = point(0);
  for (uint32_t m = 0; m < n; m++) r = plus(r, point(c[m]));
  return r;
}

/* P and B at the end; rounding [nx] is what that leaves */
static void round_end(valencia *s, double *rounding) {
  uint32_t n = s->stages.n + 1;
  for (uint32_t i = 0; i < s->nx; i++) {
    rounding[i] = 0;
    for (uint32_t k = 0; k < s->terms.n; k++) {
      size_t at = (size_t)i * s->terms.n + k;
      interval x = at_end(s->curve + at * n, n);
      if (k == 0) x = plus(x, point(s->shift[i]));
      s->p[at] = middle(x);
      rounding[i] += radius_about(x, s->p[at]);
    }
    for (uint32_t j = 0; j < s->nx; j++) {
      size_t at = (size_t)i * s->nx + j;
      interval x = at_end(s->frame + at * n, n);
      double mid = middle(x);
      s->generator[(size_t)i * 3 * s->nx + j] = mid;
      rounding[i] += radius_about(x, mid) * s->w[j];
    }
  }
}

/* generator [nx x 3 nx] and their weights [3 nx] */
static void gather(valencia *s, double *weight) {
  uint32_t nx = s->nx, pitch = 3 * nx;
  double *rounding = s->scratch;
  round_end(s, rounding);
  for (uint32_t i = 0; i < nx; i++) {
    weight[i] = s->w[i];
    weight[2 * nx + i] = rounding[i];
    if (s->frozen) weight[2 * nx + i] += s->error[i];
    for (uint32_t j = 0; j < nx; j++) {
      s->generator[(size_t)i * pitch + nx + j] = s->basis.v[(size_t)i * nx + j];
      s->generator[(size_t)i * pitch + 2 * nx + j] = i == j;
    }
  }
  for (uint32_t b = 0; b < s->basis.nblock; b++)
    for (uint32_t j = s->basis.first[b]; j < s->basis.first[b + 1]; j++) weight[nx + j] = s->frozen ? 0 : s->last[b];
}

/* D: powers of two, four to eight times what states were when they last exceeded theirs, so that it changes seldom:
** every change of what is orthogonal wraps the set once */
static void find_scale(valencia *s) {
  for (uint32_t i = 0; i < s->nx; i++) {
    double size = larger(smaller(larger(fabs(s->tube_lo[i]), fabs(s->tube_hi[i])), 0x1p900), 0x1p-900);
    if (!(size <= s->scale[i])) s->scale[i] = exp2(2 + ceil(log2(size)));
  }
}

/* rows of s->shape are D^-1 times generator times weight; the longest remaining one gives the next direction */
static void find_directions(valencia *s, const double *weight, double *q) {
  uint32_t nx = s->nx, n = 3 * nx;
  for (uint32_t c = 0; c < n; c++)
    for (uint32_t i = 0; i < nx; i++)
      s->shape[(size_t)c * nx + i] = s->generator[(size_t)i * n + c] * weight[c] / s->scale[i];
  for (uint32_t k = 0; k < nx; k++) {
    uint32_t best = n;
    double longest = 0x1p-400;
    for (uint32_t c = 0; c < n; c++) {
      double square = 0;
      for (uint32_t i = 0; i < nx; i++) square += s->shape[(size_t)c * nx + i] * s->shape[(size_t)c * nx + i];
      if (square > longest) longest = square, best = c;
    }
    double *direction = q + (size_t)k * nx;
    for (uint32_t i = 0; i < nx; i++) direction[i] = best < n ? s->shape[(size_t)best * nx + i] : 0;
    /* none left: the unit vector that is most outside */
    if (best == n) {
      uint32_t most = 0;
      double least = INFINITY;
      for (uint32_t i = 0; i < nx; i++) {
        double square = 0;
        for (uint32_t c = 0; c < k; c++) square += q[(size_t)c * nx + i] * q[(size_t)c * nx + i];
        if (square < least) least = square, most = i;
      }
      direction[most] = 1;
    }
    for (int pass = 0; pass < 2; pass++)
      for (uint32_t c = 0; c < k; c++) {
        double share = 0;
        for (uint32_t i = 0; i < nx; i++) share += q[(size_t)c * nx + i] * direction[i];
        for (uint32_t i = 0; i < nx; i++) direction[i] -= share * q[(size_t)c * nx + i];
      }
    double norm = 0;
    for (uint32_t i = 0; i < nx; i++) norm += direction[i] * direction[i];
    for (uint32_t i = 0; i < nx; i++) direction[i] /= sqrt(norm);
    for (uint32_t c = 0; c < n; c++) {
      double share = 0, *row = s->shape + (size_t)c * nx;
      for (uint32_t i = 0; i < nx; i++) share += row[i] * direction[i];
      for (uint32_t i = 0; i < nx; i++) row[i] -= share * direction[i];
    }
  }
}

/* row-sum norm of I - Q^T Q, the rows of q being directions (the columns of Q) */
static double departure(uint32_t n, const double *q) {
  double most = 0;
  for (uint32_t j = 0; j < n; j++) {
    double row = 0;
    for (uint32_t k = 0; k < n; k++) {
      interval sum = point(j == k);
      for (uint32_t i = 0; i < n; i++) sum = minus(sum, scaled(point(q[(size_t)j * n + i]), q[(size_t)k * n + i]));
      row += magnitude(sum);
    }
    most = larger_or_nan(most, row);
  }
  return most;
}

void valencia_move(valencia *s) {
  uint32_t nx = s->nx, n = 3 * nx;
  double *weight = s->sum, *q = s->directions, most = 0;
  gather(s, weight);
  find_scale(s);
  find_directions(s, weight, q);
  for (uint32_t k = 0; k < nx * nx; k++)
    if (fabs(q[k]) < 0x1p-100) q[k] = 0; /* so that D Q is exact */
  double e = departure(nx, q);
  if (!(e < 0.5)) {
    for (uint32_t k = 0; k < nx * nx; k++) q[k] = k % (nx + 1) == 0;
    e = 0;
  }
  for (uint32_t k = 0; k < nx; k++) {
    double v = 0;
    for (uint32_t c = 0; c < n; c++) {
      interval sum = point(0);
      if (weight[c] == 0) continue;
      for (uint32_t i = 0; i < nx; i++)
        sum = plus(sum, scaled(point(q[(size_t)k * nx + i]), s->generator[(size_t)i * n + c] / s->scale[i]));
      v += (magnitude(sum) + 0x1p-1000) * weight[c]; /* quotients by D may have underflowed */
    }
    s->next_w[k] = v;
    most = larger_or_nan(most, v);
  }
  for (uint32_t k = 0; k < nx; k++) {
    s->w[k] = s->next_w[k] + e / -(e - 1) * most;
    for (uint32_t i = 0; i < nx; i++) s->b[(size_t)i * nx + k] = s->scale[i] * q[(size_t)k * nx + i];
  }
}
