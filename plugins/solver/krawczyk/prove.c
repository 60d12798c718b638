/* prove.c -- from a box that may hold a root to a proof.
**
** A root on the edge of the box, or one that moves across it with the parameters, cannot be proved in the box: then in
** one that is a little larger (epsilon inflation, Rump 1980, 1998).
*/
#include "krawczyk.h"
#include <math.h>

#define CONTRACTIONS 12
#define NEWTONS 25
#define INFLATIONS 8
#define REFINEMENTS 30
#define SLOW 0.9
#define SHARP 0.98 /* at the end every bit counts */

static int contract_once(const krawczyk *k, ambit_contractor *c, span *x) {
  for (uint32_t i = 0; i < k->n; i++) k->in_lo[i] = x[i].lo, k->in_hi[i] = x[i].hi;
  for (uint32_t i = 0; i < k->np; i++) k->in_lo[k->n + i] = k->p[i].lo, k->in_hi[k->n + i] = k->p[i].hi;
  if (k->contract->narrow(c, k->in_lo, k->in_hi, NULL, NULL) == AMBIT_DOMAIN) return 0;
  for (uint32_t i = 0; i < k->n; i++) x[i] = (span) { k->in_lo[i], k->in_hi[i] };
  return 1;
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

/* x is known to hold its root; its enclosure becomes as narrow as the arithmetic allows */
static void refine(krawczyk *k, span *x) {
  for (uint32_t i = 0; i < REFINEMENTS; i++) {
    box_copy(k->n, k->left, x);
    enum verdict v = krawczyk_newton(k, x);
    if (v == VERDICT_UNKNOWN || v == VERDICT_NONE) {
      box_copy(k->n, x, k->left);
      return;
    }
    if (box_shrinking(k->n, x, k->left) > SHARP) return;
  }
}

/* narrows x by Newton steps while that pays; UNIQUE: around is where it was proved */
static enum verdict approach(krawczyk *k, span *x, span *around) {
  enum verdict v = VERDICT_UNKNOWN;
  for (uint32_t i = 0; i < NEWTONS; i++) {
    box_copy(k->n, around, x);
    v = krawczyk_newton(k, x);
    if (v == VERDICT_NONE || v == VERDICT_UNIQUE) return v;
    if (box_shrinking(k->n, x, around) > SLOW) return v;
    if (!krawczyk_contract(k, x)) return VERDICT_NONE;
  }
  return v;
}

/* Boxes around x and what the operator made of the last one, until one holds its image. */
static enum verdict inflate(krawczyk *k, span *x, span *around) {
  box_copy(k->n, around, x);
  box_join(k->n, around, k->estimate);
  for (uint32_t i = 0; i < INFLATIONS; i++) {
    box_inflate(k->n, around);
    box_copy(k->n, k->enclosure, around);
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
  refine(k, x);
  return 1;
}
