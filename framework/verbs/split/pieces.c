/* pieces.c -- the grid of a split. */
#include "verbs/split/pieces.h"
#include <stdbool.h>
#include <string.h>

/* In floating point the parts are equal but for rounding, which does not matter: an edge belongs to both sides. */
static double edge_at(double lo, double hi, uint32_t i, uint32_t n) {
  if (i == 0) return lo;
  if (i == n) return hi;
  double s = (double)i / n, x = lo * (1 - s) + hi * s; /* no overflow where hi - lo would */
  return x < lo ? lo : x > hi ? hi : x;
}

/* Writes strictly ascending edges (two equal ones for a point); returns the number of parts. */
static uint32_t cut(double lo, double hi, uint32_t parts, double *edge) {
  uint32_t n = 0;
  edge[0] = lo;
  for (uint32_t i = 1; i < parts; i++) {
    double x = edge_at(lo, hi, i, parts);
    if (x > edge[n] && x < hi) edge[++n] = x;
  }
  edge[++n] = hi;
  return n;
}

ambit_status ambit_pieces_cut(ambit_arena *arena, uint32_t nu, const double *lo, const double *hi,
    const uint32_t *parts, ambit_pieces *p, ambit_failure *f) {
  uint64_t asked = 1;
  for (uint32_t j = 0; j < nu; j++) {
    asked *= parts[j];
    if (asked > AMBIT_PIECES_MAX)
      return ambit_fail(f, AMBIT_INVALID, "split: more than %d pieces; cut into fewer parts", AMBIT_PIECES_MAX);
  }
  uint32_t *made = ambit_arena_alloc(arena, (nu + 1u) * sizeof *made);
  const double **edge = ambit_arena_alloc(arena, (nu + 1u) * sizeof *edge);
  if (!made || !edge) return ambit_no_memory(f);
  *p = (ambit_pieces) { .nu = nu, .count = 1, .parts = made, .edge = edge };
  for (uint32_t j = 0; j < nu; j++) {
    double *own = ambit_arena_alloc(arena, (parts[j] + 1u) * sizeof *own);
    if (!own) return ambit_no_memory(f);
    made[j] = cut(lo[j], hi[j], parts[j], own);
    edge[j] = own;
    p->count *= made[j];
  }
  return AMBIT_OK;
}

void ambit_pieces_range(const ambit_pieces *p, uint32_t item, double *lo, double *hi) {
  if (p->box) {
    const double *own = p->box + (size_t)item * 2 * p->nu;
    memcpy(lo, own, p->nu * sizeof *lo);
    memcpy(hi, own + p->nu, p->nu * sizeof *hi);
    return;
  }
  for (uint32_t j = p->nu; j-- > 0;) {
    uint32_t i = item % p->parts[j];
    item /= p->parts[j];
    lo[j] = p->edge[j][i];
    hi[j] = p->edge[j][i + 1];
  }
}

void ambit_pieces_deal(uint32_t nu, const double *influence, uint32_t total, uint32_t *parts) {
  uint64_t product = 1;
  for (uint32_t j = 0; j < nu; j++)
    if (parts[j]) product *= parts[j];
  /* an unknown that got its first part by being dealt to is told apart by the top bit until the end */
  const uint32_t dealt = UINT32_C(1) << 31;
  for (uint32_t j = 0; j < nu; j++)
    if (!parts[j]) parts[j] = dealt | 1;
  for (;;) {
    uint32_t best = nu;
    double most = 0;
    for (uint32_t j = 0; j < nu; j++) {
      uint32_t n = parts[j] & ~dealt;
      if (!(parts[j] & dealt) || product / n * (n + 1) > total) continue;
      double left = influence[j] / n;
      if (left > most) {
        most = left;
        best = j;
      }
    }
    if (best == nu) break;
    product = product / (parts[best] & ~dealt) * ((parts[best] & ~dealt) + 1);
    parts[best]++;
  }
  for (uint32_t j = 0; j < nu; j++) parts[j] &= ~dealt;
}
