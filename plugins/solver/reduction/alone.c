/* alone.c -- each candidate proved by itself: the exact ranking, and with runs of lowered order the interval ranking of
** Mikelsons and Brandt. Value: the greatest error relative to its bound; infinite if nothing can be proved. */
#include "reduce.h"
#include <math.h>
#include <string.h>

ambit_status alone_rank(reducer *s, uint32_t ranking) {
  uint32_t how = ranking == AMBIT_RANK_LOWERED ? AMBIT_PROVE_LOWERED : AMBIT_PROVE_FULL;
  uint32_t n = s->r.ncandidate;
  memset(s->single, 0, n);
  for (uint32_t k = 0; k < n; k++) {
    if (reduce_is_stopped(s, (double)k / n, "reduction: ranking")) return AMBIT_STOPPED;
    s->single[k] = 1;
    ambit_status status = reduce_prove(s, how, s->single);
    s->single[k] = 0;
    if (status != AMBIT_OK && status != AMBIT_UNABLE) return status;
    s->value[ranking][k] = status == AMBIT_OK ? reduce_relative(s, s->error) : INFINITY;
  }
  return AMBIT_OK;
}
