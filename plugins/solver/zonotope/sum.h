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

/* the terms that have a part */
typedef struct picked {
  uint32_t nrow, nouter;
  const scaled_row *row;
  const scaled_product *outer;
} picked;

typedef struct picks {
  scaled_row row[TERMS];
  scaled_product outer[TERMS];
} picks;

/* `width` vectors of a segment: rows at `at`; linear parts at `linear`, each times the other's coefficient `by` */
static inline __attribute__((always_inline)) void sum_block(
    const picked *t, double *to, uint32_t at, uint32_t by, uint32_t linear, int outer, int width) {
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
    const picked *t, double *to, uint32_t at, uint32_t length, uint32_t by, uint32_t linear, int outer) {
  uint32_t done = 0;
  for (; done + 12 < length; done += 16) sum_block(t, to, at + done, by, linear + done, outer, 4);
  if (done >= length) return;
  switch ((length - done + 3) / 4) {
  case 1: sum_block(t, to, at + done, by, linear + done, outer, 1); break;
  case 2: sum_block(t, to, at + done, by, linear + done, outer, 2); break;
  default: sum_block(t, to, at + done, by, linear + done, outer, 3);
  }
}

static inline double sum_square(const picked *t, uint32_t at, uint32_t by) {
  double sum = 0;
  for (uint32_t n = 0; n < t->nrow; n++) sum += t->row[n].scale * t->row[n].x[at];
  for (uint32_t n = 0; n < t->nouter; n++) sum += t->outer[n].scale * t->outer[n].a[by] * t->outer[n].b[by];
  return sum;
}

/* rows whose norm is not 0 */
static picked pick_rows(const shape *s, const terms *t, uint32_t norm, picks *room) {
  uint32_t count = 0;
  for (uint32_t n = 0; n < t->nrow; n++)
    if (t->row[n].x[s->norms + norm] > 0) room->row[count++] = t->row[n];
  return (picked) { count, 0, room->row, room->outer };
}

/* each returns 0 if there are none */
static int sum_pairs(const shape *s, const terms *t, double *to) {
  picks room;
  picked p = pick_rows(s, t, NORM_Q, &room);
  for (uint32_t n = 0; n < t->nouter; n++)
    if (row_l(s, t->outer[n].a) * row_l(s, t->outer[n].b) > 0) room.outer[p.nouter++] = t->outer[n];
  if (!p.nrow && !p.nouter) return 0;
  for (uint32_t i = 0; i < s->m && s->reach[i] > i; i++) {
    to[s->pair[i]] = sum_square(&p, s->pair[i], 1 + i);
    sum_segment(&p, to, s->pair[i] + 1, s->reach[i] - i - 1, 1 + i, 2 + i, 1);
  }
  return 1;
}

static int sum_mixed(const shape *s, const terms *t, double *to) {
  picks room;
  picked p = pick_rows(s, t, NORM_X, &room);
  for (uint32_t n = 0; n < t->nouter; n++) {
    const double *a = t->outer[n].a, *b = t->outer[n].b;
    if (row_l(s, a) * row_r(s, b) + row_r(s, a) * row_l(s, b) > 0) room.outer[p.nouter++] = t->outer[n];
  }
  if (!p.nrow && !p.nouter) return 0;
  for (uint32_t j = 0; j < s->mixed; j++) sum_segment(&p, to, s->mix + j * s->nx, s->nx, 1 + j, s->eps, 1);
  return 1;
}

/* -- triples: coefficient ijk of a product is the sum of l_v q_(the other two) over its different v */

/* where the run of triples (i, j, k), k > j, and what it is made of starts */
typedef struct run_of {
  uint32_t at, i, j, k, ij, ik, jk;
} run_of;

static inline __attribute__((always_inline)) void sum_bend(
    const picked *c, const terms *t, double *to, const run_of *r, uint32_t done, int same, int width) {
  four sum[4];
#pragma GCC unroll 4
  for (int w = 0; w < width; w++) sum[w] = (four) { 0, 0, 0, 0 };
  for (uint32_t n = 0; n < c->nrow; n++) {
    const four *x = (const four *)(c->row[n].x + r->at + done);
    four scale = SPREAD(c->row[n].scale);
#pragma GCC unroll 4
    for (int w = 0; w < width; w++) sum[w] += scale * x[w];
  }
  for (uint32_t n = 0; n < t->nbend; n++) {
    const double *a = t->bend[n].a, *b = t->bend[n].b;
    double x = t->bend[n].scale * a[r->i], y = t->bend[n].scale * a[r->j], z = t->bend[n].scale * b[r->ij];
    four li = SPREAD(x), lj = SPREAD(y), q = SPREAD(z);
    const four *jk = (const four *)(b + r->jk + done), *ik = (const four *)(b + r->ik + done);
    const four *k = (const four *)(a + r->k + done);
#pragma GCC unroll 4
    for (int w = 0; w < width; w++) {
      sum[w] += li * jk[w] + q * k[w];
      if (!same) sum[w] += lj * ik[w];
    }
  }
#pragma GCC unroll 4
  for (int w = 0; w < width; w++) ((four *)(to + r->at + done))[w] = sum[w];
}

static inline __attribute__((always_inline)) void sum_run(
    const picked *c, const terms *t, double *to, const run_of *r, uint32_t length, int same) {
  uint32_t done = 0;
  for (; done + 12 < length; done += 16) sum_bend(c, t, to, r, done, same, 4);
  if (done >= length) return;
  switch ((length - done + 3) / 4) {
  case 1: sum_bend(c, t, to, r, done, same, 1); break;
  case 2: sum_bend(c, t, to, r, done, same, 2); break;
  default: sum_bend(c, t, to, r, done, same, 3);
  }
}

/* triple (i, j, j) */
static double sum_first(const shape *s, const picked *c, const terms *t, uint32_t at, uint32_t i, uint32_t j) {
  double sum = 0;
  uint32_t jj = s->pair[j], ij = s->pair[i] + j - i;
  for (uint32_t n = 0; n < c->nrow; n++) sum += c->row[n].scale * c->row[n].x[at];
  for (uint32_t n = 0; n < t->nbend; n++) {
    const double *a = t->bend[n].a, *b = t->bend[n].b;
    double x = a[1 + i] * b[jj];
    if (i != j) x += a[1 + j] * b[ij];
    sum += t->bend[n].scale * x;
  }
  return sum;
}

static int sum_triples(const shape *s, const terms *t, double *to) {
  picks room;
  const picked c = pick_rows(s, t, NORM_C, &room);
  uint32_t at = s->cube, n = s->cubic;
  if (!c.nrow && !t->nbend) return 0;
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t j = i; j < n; j++) {
      const run_of r = { at + 1, 1 + i, 1 + j, 2 + j, s->pair[i] + j - i, s->pair[i] + j + 1 - i, s->pair[j] + 1 };
      to[at] = sum_first(s, &c, t, at, i, j);
      if (i == j)
        sum_run(&c, t, to, &r, n - j - 1, 1);
      else
        sum_run(&c, t, to, &r, n - j - 1, 0);
      at += n - j;
    }
  return 1;
}

/* -- norms */

static double sum_sizes(const double *x, uint32_t n) {
  const four_bits no_sign = { INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX };
  four sum = { 0, 0, 0, 0 };
  uint32_t i = 0;
  for (; i + 4 <= n; i += 4) sum += (four)((four_bits) * (const four *)(x + i) & no_sign);
  double all = (sum[0] + sum[1]) + (sum[2] + sum[3]);
  for (; i < n; i++) all += fabs(x[i]);
  return all;
}

static void sum_norms(const shape *s, double *x, uint32_t parts) {
  double *norm = x + s->norms, far = 0, q = 0;
  if (parts & PAIRS) {
    for (uint32_t i = 0; i < s->cubic && s->cubic < s->m; i++)
      far += sum_sizes(x + s->pair[i] + s->cubic - i, s->pair[i + 1] - s->pair[i] - (s->cubic - i));
    far += sum_sizes(x + s->pair[s->cubic], s->mix - s->pair[s->cubic]);
    q = sum_sizes(x + s->pair[0], s->mix - s->pair[0]);
  }
  double mixed = parts & MIXED ? sum_sizes(x + s->mix, s->norms - s->mix) : 0;
  norm[NORM_L] = sum_sizes(x + 1, s->m), norm[NORM_R] = parts & ERRORS ? sum_sizes(x + s->eps, s->nx) : 0;
  norm[NORM_L_FAR] = sum_sizes(x + 1 + s->cubic, s->m - s->cubic);
  norm[NORM_Q] = q, norm[NORM_Q_FAR] = far, norm[NORM_X] = mixed;
  norm[NORM_C] = parts & TRIPLES ? sum_sizes(x + s->cube, s->triples) : 0;
}

void VARIANT(const shape *s, const terms *t, double *to, uint32_t parts) {
  const picked all = { t->nrow, 0, t->row, NULL };
  uint32_t made = parts & ERRORS;
  if (s->lean)
    sum_segment(&all, to, s->eps, made ? s->nx : 0, 0, 0, 0);
  else
    sum_segment(&all, to, 1, made ? s->m + s->nx : s->m, 0, 0, 0);
  if (!made && !s->lean) memset(to + s->eps, 0, s->nx * sizeof *to);
  if ((parts & PAIRS) && sum_pairs(s, t, to)) made |= PAIRS;
  if ((parts & MIXED) && sum_mixed(s, t, to)) made |= MIXED;
  if ((parts & TRIPLES) && sum_triples(s, t, to)) made |= TRIPLES;
  sum_norms(s, to, made);
}
