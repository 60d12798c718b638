/* multiply.h -- the part of degree 4 of a product, compiled once per instruction set like sum.h.
**
** The coefficient of xi_i xi_j xi_k xi_l is the sum of l_v c_rest over its different data v and of q_p q_rest over its
** different pairs p. Runs over l > k are made in vectors; the last one of a run may write up to three coefficients of
** the next run, which is made after it.
*/
#include "depend.h"
#include "quartic.h"

/* of i <= j <= k = l */
static double multiply_square(const quartic *q, uint32_t i, uint32_t j, uint32_t k) {
  const operand *a = &q->a, *b = &q->b;
  uint32_t n = q->n, jkk = q->triple[j * n + k], ikk = q->triple[i * n + k], ijk = q->triple[i * n + j] + k - j;
  uint32_t ij = q->pair[i] + j - i, kk = q->pair[k], ik = q->pair[i] + k - i, jk = q->pair[j] + k - j;
  double sum = a->l[i] * b->c[jkk] + b->l[i] * a->c[jkk] + a->q[ij] * b->q[kk];
  if (j != i) sum += a->l[j] * b->c[ikk] + b->l[j] * a->c[ikk];
  if (k != j) sum += a->l[k] * b->c[ijk] + b->l[k] * a->c[ijk] + a->q[ik] * b->q[jk];
  if (k != j && j != i) sum += a->q[jk] * b->q[ik];
  if (k != i) sum += a->q[kk] * b->q[ij];
  return sum;
}

/* of i <= j <= k < l, all l */
static inline __attribute__((always_inline)) void multiply_run(
    const quartic *q, uint32_t i, uint32_t j, uint32_t k, double *to) {
  const operand *a = &q->a, *b = &q->b;
  uint32_t n = q->n, ij = q->pair[i] + j - i, ik = q->pair[i] + k - i, jk = q->pair[j] + k - j;
  uint32_t jkl = q->triple[j * n + k] + 1, ikl = q->triple[i * n + k] + 1, ijl = q->triple[i * n + j] + k + 1 - j;
  uint32_t kl = q->pair[k] + 1, jl = jk + 1, il = ik + 1;
  double other_j = j != i, other_k = k != j, aj = other_j * a->l[j], ak = other_k * a->l[k];
  double bj = other_j * b->l[j], bk = other_k * b->l[k], ca = a->c[ijl - 1], cb = b->c[ijl - 1];
  four ai = SPREAD(a->l[i]), bi = SPREAD(b->l[i]), a_j = SPREAD(aj), b_j = SPREAD(bj), a_k = SPREAD(ak);
  four b_k = SPREAD(bk), ac = SPREAD(ca), bc = SPREAD(cb), a_ij = SPREAD(a->q[ij]), b_ij = SPREAD(b->q[ij]);
  four a_ik = SPREAD(other_k * a->q[ik]), b_ik = SPREAD(other_k * b->q[ik]);
  four a_jk = SPREAD(other_j * a->q[jk]), b_jk = SPREAD(other_j * b->q[jk]);
#define AT(x, at) (*(const four *)((x) + (at) + done))
  for (uint32_t done = 0; done + k + 1 < n; done += 4) {
    four sum = ai * AT(b->c, jkl) + bi * AT(a->c, jkl) + a_j * AT(b->c, ikl) + b_j * AT(a->c, ikl);
    sum += a_k * AT(b->c, ijl) + b_k * AT(a->c, ijl) + ac * AT(b->l, k + 1) + bc * AT(a->l, k + 1);
    sum += a_ij * AT(b->q, kl) + b_ij * AT(a->q, kl) + a_ik * AT(b->q, jl) + b_ik * AT(a->q, jl);
    sum += a_jk * AT(b->q, il) + b_jk * AT(a->q, il);
    *(four *)(to + done) = sum;
  }
#undef AT
}

void MULTIPLY(const quartic *q, double *to) {
  uint32_t n = q->n;
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t j = i; j < n; j++)
      for (uint32_t k = j; k < n; k++) {
        to[0] = multiply_square(q, i, j, k);
        multiply_run(q, i, j, k, to + 1);
        to += n - k;
      }
}

/* far triples: sums of l_v q_rest over different data v */
void MULTIPLY_FAR(const quartic *q, double *to) {
  const uint32_t *pair = q->shape->pair;
  const double *al = q->a.all_l, *bl = q->b.all_l, *aq = q->a.all_q, *bq = q->b.all_q;
  for (const far_run *r = q->far.run; r < q->far.run + q->far.nrun; r++) {
    uint32_t i = r->i, j = r->j, k = r->from, end = r->to, start = pair[0];
    uint32_t ij = pair[i] - start + j - i, jk = pair[j] - start + k - j, ik = pair[i] - start + k - i;
    double other = i != j, xa = other * al[j], xb = other * bl[j];
    if (k == j) {
      *to++ = al[i] * bq[jk] + bl[i] * aq[jk] + xa * bq[ij] + xb * aq[ij];
      k++, jk++, ik++;
    }
    four ai = SPREAD(al[i]), bi = SPREAD(bl[i]), aj = SPREAD(xa), bj = SPREAD(xb);
    four a_ij = SPREAD(aq[ij]), b_ij = SPREAD(bq[ij]);
#define AT(x, at) (*(const four *)((x) + (at) + done))
    for (uint32_t done = 0; k + done < end; done += 4) {
      four sum = ai * AT(bq, jk) + bi * AT(aq, jk) + aj * AT(bq, ik) + bj * AT(aq, ik);
      sum += b_ij * AT(al, k) + a_ij * AT(bl, k);
      *(four *)(to + done) = sum;
    }
#undef AT
    to += end - k;
  }
}

void ADD(double *to, double scale, const double *x, size_t n) {
  size_t m = 0;
  for (; m + 4 <= n; m += 4) *(four *)(to + m) += SPREAD(scale) * *(const four *)(x + m);
  for (; m < n; m++) to[m] += scale * x[m];
}

void MEASURE(const double *G, size_t stride, size_t n, uint32_t nx, const double *w, uint32_t count, double *to) {
  const four_bits no_sign = { INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX };
  for (size_t c = 0; c < n; c += 8)
    for (uint32_t r = 0; r < count; r++) {
      four a = { 0, 0, 0, 0 }, b = a;
      for (uint32_t k = 0; k < nx; k++) {
        const four *x = (const four *)(G + k * stride + c);
        four by = SPREAD(w[r * nx + k]);
        a += by * x[0], b += by * x[1];
      }
      a = (four)((four_bits)a & no_sign) + (four)((four_bits)b & no_sign);
      to[r] += (a[0] + a[1]) + (a[2] + a[3]);
    }
}
