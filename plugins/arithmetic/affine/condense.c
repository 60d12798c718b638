/* condense.c -- fewer symbols: the least important become part of each element's own error. Upward mode.
**
** Soundness: c e with a shared e in [-1, 1] becomes |c| e' with an own e' = +-e.
**
** What is lost. Let c_s be the coefficient of a symbol in slot s, and r_s the radius of that slot. A later result that
** is, to first order, sum_s l_s value_s loses sum_s |l_s c_s| - |sum_s l_s c_s|
** <= 2 (sum_s |l_s c_s| - max_s |l_s c_s|) <= 2 (sum over s other than z of |l_s c_s|), for any z. With |l_s| r_s <= L
** and z the slot with the largest |c_s| / r_s, that is at most 2 L w,
**
**   w = sum_s m_s |c_s| / r_s - max_s |c_s| / r_s.
**
** m_s is 1, or 2 if slot s is used more than once, which counts as two slots that agree. Removing the symbols with the
** least weights w therefore widens such a result's radius by at most 2 L times their sum; and if m of K symbols go,
** their sum is at most m/K of the sum of all. Symbols that no slot carries have w = 0 and cost nothing; neither does
** one of a single slot that is used once. Several lanes share one decision: their weights are added.
*/
#include "affine.h"
#include <string.h>

static const double *own_coefficients(const affine_context *c, const affine_element *x, uint32_t *n) {
  int carries = x->blocks > c->vblocks && x->epoch == c->epoch && affine_has_form(x);
  uint64_t room = carries ? (x->blocks - c->vblocks) * AFFINE_BLOCK : 0;
  *n = room < c->next ? (uint32_t)room : c->next;
  return x->coef + c->vblocks * AFFINE_BLOCK;
}

static void weigh(affine_context *c, void *base, size_t pitch, size_t lane, uint32_t nlive) {
  double *weight = c->weight, *top = c->weight + c->symbols;
  memset(top, 0, c->next * sizeof *top);
  for (uint32_t i = 0; i < nlive; i++) {
    const affine_element *x = affine_at(c, base, c->plan.live[i] * pitch + lane);
    uint32_t n;
    const double *coef = own_coefficients(c, x, &n);
    double often = c->plan.uses[c->plan.live[i]] > 1 ? 2 : 1;
    for (uint32_t k = 0; k < n; k++) {
      double share = x->rad > 0 ? fabs(coef[k]) / x->rad : 0;
      weight[k] += often * share;
      if (share > top[k]) top[k] = share;
    }
  }
  for (uint32_t k = 0; k < c->next; k++) weight[k] -= top[k];
}

/* rank[0 .. n) := the numbers of the `keep` heaviest symbols, none of weight 0, ascending; returns n */
static uint32_t choose(affine_context *c, uint32_t keep) {
  const double *weight = c->weight;
  uint32_t *rank = c->rank, n = 0;
  for (uint32_t k = 0; k < c->next; k++) { /* insertion into the list of the heaviest so far, heaviest first */
    if (!(weight[k] > 0)) continue;
    uint32_t at = n < keep ? n++ : keep;
    for (; at > 0 && weight[rank[at - 1]] < weight[k]; at--)
      if (at < keep) rank[at] = rank[at - 1];
    if (at < keep) rank[at] = k;
  }
  for (uint32_t i = 1; i < n; i++)
    for (uint32_t j = i; j > 0 && rank[j - 1] > rank[j]; j--) {
      uint32_t other = rank[j];
      rank[j] = rank[j - 1], rank[j - 1] = other;
    }
  return n;
}

/* the kept symbols move to the front, in order, so no place is overwritten before it is read */
static void rewrite(const affine_context *c, affine_element *x, uint32_t kept) {
  uint32_t n;
  own_coefficients(c, x, &n);
  if (n == 0) return;
  double *coef = x->coef + c->vblocks * AFFINE_BLOCK, dropped = 0;
  uint32_t next = 0;
  for (uint32_t k = 0; k < n; k++) {
    if (next < kept && c->rank[next] == k)
      coef[next++] = coef[k];
    else
      dropped += fabs(coef[k]);
  }
  uint64_t blocks = ((uint64_t)next + AFFINE_BLOCK - 1) / AFFINE_BLOCK;
  memset(coef + next, 0, (blocks * AFFINE_BLOCK - next) * sizeof *coef);
  x->blocks = c->vblocks + blocks;
  x->err += dropped;
  x->rad = c->kernels->size(x->coef, x->blocks) + x->err;
  x->epoch = c->epoch + 1;
  if (!affine_has_form(x)) affine_of_hull(x, x->nlo, x->hi);
}

void affine_condense(affine_context *c, void *base, size_t pitch, size_t lanes, uint32_t nlive, uint32_t keep) {
  memset(c->weight, 0, c->next * sizeof *c->weight);
  for (size_t lane = 0; lane < lanes; lane++) weigh(c, base, pitch, lane, nlive);
  uint32_t kept = choose(c, keep);
  for (uint32_t i = 0; i < nlive; i++)
    for (size_t lane = 0; lane < lanes; lane++) rewrite(c, affine_at(c, base, c->plan.live[i] * pitch + lane), kept);
  c->epoch++, c->next = kept;
}
