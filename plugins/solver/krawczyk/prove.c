/* prove.c -- from a box that may hold a root to a proof.
**
** A root on the edge of the box, or one that moves across it with the parameters, cannot be proved in the box: then in
** one that is a little larger (epsilon inflation, Rump 1980, 1998).
*/
#include "krawczyk.h"
#include <float.h>
#include <math.h>

#define CONTRACTIONS 12
#define NEWTONS 25
#define INFLATIONS 8
#define REFINEMENTS 30
#define SLOW 0.9
#define SLOPES_ALLOW 0.98 /* at the end every bit counts */
#define WORTH 0.98        /* cutting once more must narrow an unknown by this */

static int contract_once(const krawczyk *k, ambit_contractor *c, span *x) {
  for (uint32_t i = 0; i < k->m; i++) k->in_lo[i] = x[i].lo, k->in_hi[i] = x[i].hi;
  if (k->contract->narrow(c, k->in_lo, k->in_hi, NULL, NULL) == AMBIT_DOMAIN) return 0;
  for (uint32_t i = 0; i < k->n; i++) x[i] = (span) { k->in_lo[i], k->in_hi[i] };
  return 1; /* the parameters stay what they are: something is to be said for all of them */
}

int krawczyk_contract(krawczyk *k, span *x) {
  for (uint32_t i = 0; i < CONTRACTIONS; i++) {
    box_copy(k->n, k->row, x);
    if (!contract_once(k, k->shape, x)) return 0;
    if (k->further && !contract_once(k, k->further, x)) return 0;
    if (box_shrinking(k->n, x, k->row) > SLOW) return 1;
  }
  return 1;
}

void krawczyk_refine(krawczyk *k, span *x) {
  for (uint32_t i = 0; i < REFINEMENTS; i++) {
    box_copy(k->m, k->left, x);
    enum verdict v = krawczyk_newton(k, x);
    if (v == VERDICT_UNKNOWN || v == VERDICT_NONE) {
      box_copy(k->m, x, k->left);
      return;
    }
    if (box_shrinking(k->n, x, k->left) > SLOPES_ALLOW) return;
  }
}

/* narrows x by Newton steps while that pays; UNIQUE: around is where it was proved */
static enum verdict approach(krawczyk *k, span *x, span *around) {
  enum verdict v = VERDICT_UNKNOWN;
  for (uint32_t i = 0; i < NEWTONS; i++) {
    box_copy(k->m, around, x);
    v = krawczyk_newton(k, x);
    if (v == VERDICT_NONE || v == VERDICT_UNIQUE) return v;
    if (box_shrinking(k->n, x, around) > SLOW) return v;
    if (!krawczyk_contract(k, x)) return VERDICT_NONE;
  }
  return v;
}

/* Boxes around x and what the operator made of the last one, until one holds its image. */
static enum verdict inflate(krawczyk *k, span *x, span *around) {
  box_copy(k->m, around, x);
  box_join(k->n, around, k->estimate);
  for (uint32_t i = 0; i < INFLATIONS; i++) {
    /* a component that is a point must not stay far narrower than what the others' errors make of it */
    box_inflate(k->n, around, 2 * i < INFLATIONS ? 1e-290 : DBL_EPSILON * k->options.tolerance);
    box_copy(k->m, k->enclosure, around);
    enum verdict v = krawczyk_newton(k, k->enclosure);
    if (v == VERDICT_UNIQUE) box_copy(k->n, x, k->enclosure);
    if (v != VERDICT_AT_MOST) return v;
    box_join(k->n, around, k->estimate);
  }
  return VERDICT_UNKNOWN;
}

int krawczyk_prove(krawczyk *k, span *x, span *around) {
  enum verdict v = approach(k, x, around);
  if (v == VERDICT_AT_MOST) v = inflate(k, x, around);
  if (v == VERDICT_NONE) return 0;
  if (v != VERDICT_UNIQUE) return -1;
  krawczyk_refine(k, x);
  return 1;
}

/* -- the parameters' ranges in pieces: the hull of what the root is over each of them */

/* the parameter that moves the root most, by the last operator; or the relatively widest */
static uint32_t find_mover(const krawczyk *k, const span *x) {
  uint32_t best = k->n;
  double most = -1;
  for (uint32_t j = 0; j < k->np; j++) {
    double moved = 0, width = x[k->n + j].hi - x[k->n + j].lo;
    for (uint32_t i = 0; i < k->n; i++) {
      size_t at = (size_t)i * k->np + j;
      double extent = x[i].hi - x[i].lo;
      if (k->has_S && extent > 0) moved = fmax(moved, fmax(-k->CS.lo[at], k->CS.hi[at]) / extent);
    }
    double gain = width > 0 ? (moved > 0 ? moved : 1e-300) * width : -1;
    if (gain > most) most = gain, best = k->n + j;
  }
  return most > 0 ? best : k->m;
}

/* every piece in two, each with its own enclosure; 0: there is nothing to cut */
static int halve(krawczyk *k) {
  uint32_t count = k->half.count;
  for (uint32_t i = 0; i < count; i++) {
    span *x = boxes_at(&k->half, k->m, i);
    box_copy(k->m, k->common, x);
    krawczyk_newton(k, k->common); /* for df/dp */
    uint32_t j = find_mover(k, x);
    double at = j < k->m ? box_middle(x[j]) : 0;
    if (j == k->m || !(at > x[j].lo && at < x[j].hi)) return 0;
    boxes_push(&k->half, k->m, x, 0);
    x[j].hi = at;
    boxes_at(&k->half, k->m, k->half.count - 1)[j].lo = at;
    krawczyk_refine(k, x);
    krawczyk_refine(k, boxes_at(&k->half, k->m, k->half.count - 1));
  }
  return 1;
}

void krawczyk_tighten(krawczyk *k, span *x) {
  double most = k->options.pieces ? k->options.pieces / krawczyk_count_parts(k, x) : k->half.room; /* x's share */
  k->half.count = 0;
  boxes_push(&k->half, k->m, x, 0);
  while (2 * k->half.count <= most && halve(k)) {
    box_copy(k->m, k->enclosure, boxes_at(&k->half, k->m, 0));
    for (uint32_t i = 1; i < k->half.count; i++) box_join(k->n, k->enclosure, boxes_at(&k->half, k->m, i));
    double gained = box_shrinking(k->n, k->enclosure, x);
    box_meet(k->n, x, k->enclosure);
    if (!k->options.pieces && gained > WORTH) return;
  }
}
