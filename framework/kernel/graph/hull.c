/* hull.c -- natural interval extension (Moore 1966): each operation encloses its image, hence so does their
** composition. */
#include "graph/hull.h"
#include "num/interval.h"
#include <string.h>

uint32_t ambit_hull(const ambit_tape *t, const ambit_interval *in, ambit_interval *slot) {
  uint32_t flags = 0;
  for (uint32_t i = 0; i < t->nconst; i++) slot[i] = (ambit_interval) { t->lo[i], t->hi[i] };
  for (uint32_t i = 0; i < t->nin; i++) slot[t->nconst + i] = in[i];
  for (uint32_t i = 0; i < t->ninstr; i++) {
    ambit_interval *r = &slot[t->dst[i]], a = slot[t->a[i]];
    if (t->op[i] != AMBIT_OP_POWN) {
      flags |= ambit_interval_op(t->op[i], r, a, slot[t->b[i]]);
      continue;
    }
    int32_t exponent;
    memcpy(&exponent, &t->b[i], sizeof exponent);
    flags |= ambit_interval_pown(r, a, exponent);
  }
  return flags;
}

bool ambit_hull_jumps(const ambit_tape *t, const ambit_interval *slot) {
  for (uint32_t i = 0; i < t->ninstr; i++) {
    if (t->op[i] != AMBIT_OP_ATAN2) continue;
    ambit_interval y = slot[t->a[i]], x = slot[t->b[i]];
    if (y.lo < 0 && y.hi >= 0 && x.lo < 0) return true;
  }
  return false;
}
