/* sum.h -- sums of rows and of products of linear parts, compiled once per instruction set; all give the same numbers.
**
** A row is written from its start to its end in blocks of vectors; the last block of a segment may run up to three
** coefficients into the next one, which is written after it. Norms are written last, and are part of the row, so that
** nothing is read or written outside of it.
*/
#include "row.h"

typedef double four __attribute__((vector_size(32), aligned(8), may_alias));
typedef int64_t four_bits __attribute__((vector_size(32)));

#define SPREAD(x) ((four) { (x), (x), (x), (x) })

/* `width` vectors of a segment: rows at `at`; linear parts at `linear`, each times the other's coefficient `by` */
static inline __attribute__((always_inline)) void sum_block(
    const terms *t, double *to, uint32_t at, uint32_t by, uint32_t linear, int outer, int width) {
  four sum[4];
#pragma GCC unroll 4
  for (int w = 0; w < width; w++) sum[w] = (four) { 0, 0, 0, 0 };
  for (uint32_t n = 0; n < t->nrow; n++) {
    const four *x = (const four *)(t->row[n].x + at);
    four scale = SPREAD(t->row[n].scale);
#pragma GCC unroll 4
    for (int w = 0; w < width; w++) sum[w] += scale * x[w];
  }
  for (uint32_t n = 0; outer && n < t->nouter; n++) {
    const double *a = t->outer[n].a, *b = t->outer[n].b;
    double l = t->outer[n].scale * a[by], r = t->outer[n].scale * b[by];
    four left = SPREAD(l), right = SPREAD(r);
#pragma GCC unroll 4
    for (int w = 0; w < width; w++)
      sum[w] += left * ((const four *)(b + linear))[w] + right * ((const four *)(a + linear))[w];
  }
#pragma GCC unroll 4
  for (int w = 0; w < width; w++) ((four *)(to + at))[w] = sum[w];
}

static inline __attribute__((always_inline)) void sum_segment(
    const terms *t, double *to, uint32_t at, uint32_t length, uint32_t by, uint32_t linear, int outer) {
  uint32_t done = 0;
  for (; done + 12 < length; done += 16) sum_block(t, to, at + done, by, linear + done, outer, 4);
  if (done >= length) return;
  switch ((length - done + 3) / 4) {
  case 1: sum_block(t, to, at + done, by, linear + done, outer, 1); break;
  case 2: sum_block(t, to, at + done, by, linear + done, outer, 2); break;
  default: sum_block(t, to, at + done, by, linear + done, outer, 3);
  }
}

static inline double sum_square(const terms *t, uint32_t at, uint32_t by) {
  double sum = 0;
  for (uint32_t n = 0; n < t->nrow; n++) sum += t->row[n].scale * t->row[n].x[at];
  for (uint32_t n = 0; n < t->nouter; n++) sum += t->outer[n].scale * t->outer[n].a[by] * t->outer[n].b[by];
  return sum;
}

static double sum_sizes(const double *x, uint32_t n) {
  const four_bits no_sign = { INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX };
  four sum = { 0, 0, 0, 0 };
  uint32_t i = 0;
  for (; i + 4 <= n; i += 4) sum += (four)((four_bits) * (const four *)(x + i) & no_sign);
  double all = (sum[0] + sum[1]) + (sum[2] + sum[3]);
  for (; i < n; i++) all += fabs(x[i]);
  return all;
}

static void sum_norms(const shape *s, double *x) {
  double *norm = x + s->norms;
  double l = sum_sizes(x + 1, s->m), r = sum_sizes(x + s->eps, s->nx);
  double q = sum_sizes(x + s->pair[0], s->mix - s->pair[0]), mixed = sum_sizes(x + s->mix, s->norms - s->mix);
  norm[0] = l, norm[1] = r, norm[2] = q, norm[3] = mixed;
}

void VARIANT(const shape *s, const terms *t, double *to) {
  to[0] = t->c;
  sum_segment(t, to, 1, s->m + s->nx, 0, 0, 0);
  for (uint32_t i = 0; i < s->m && s->reach[i] > i; i++) {
    to[s->pair[i]] = sum_square(t, s->pair[i], 1 + i);
    sum_segment(t, to, s->pair[i] + 1, s->reach[i] - i - 1, 1 + i, 2 + i, 1);
  }
  for (uint32_t j = 0; j < s->mixed; j++) sum_segment(t, to, s->mix + j * s->nx, s->nx, 1 + j, s->eps, 1);
  sum_norms(s, to);
}
