/* jets_access.c -- coefficients in and out. From the first order that could not be bounded on, every coefficient
** reads 0 +- inf. */
#include "jets.h"
#include <float.h>
#include <math.h>
#include <string.h>

static size_t place(const jets *j, uint32_t k, uint32_t direction) {
  return ((size_t)(direction / j->width) * (j->order + 1u) + k) * j->width + direction % j->width;
}

/* also for a caller who takes subnormal numbers for zero */
static int is_zero(double x) {
  int64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return (bits & INT64_MAX) == 0;
}

/* an unbounded or senseless coefficient becomes DBL_MAX, which advance() reports */
static void keep(double *mid, double *rad, double m, double r, int allowed) {
  int known = allowed && fabs(m) <= DBL_MAX && r >= 0 && r < DBL_MAX;
  *mid = known ? m : 0;
  *rad = known ? r : DBL_MAX;
}

void jets_put(void *self, uint32_t in, uint32_t k, double mid, double rad, const double *dmid, const double *drad) {
  jets *j = self;
  slot *s = &j->slot[j->nsource - j->nin + in];
  int allowed = k <= s->degree || (is_zero(mid) && is_zero(rad)); /* the tape says that it vanishes */
  for (uint32_t d = 0; d < j->ndir; d++) {
    double m = dmid ? dmid[d] : 0, r = drad ? drad[d] : 0;
    size_t at = place(j, k, d);
    keep(&s->slope.mid[at], &s->slope.rad[at], m, r, 1);
    if (k > s->degree && !(is_zero(m) && is_zero(r))) allowed = 0;
    if (s->slope.rad[at] >= DBL_MAX) allowed = 0;
  }
  keep(&s->u.mid[k], &s->u.rad[k], mid, rad, allowed);
}

void jets_get(const void *self, uint32_t slot_index, uint32_t k, double *mid, double *rad, double *dmid, double *drad) {
  const jets *j = self;
  const slot *s = &j->slot[slot_index];
  int known = k < j->failed && s->u.rad[k] < DBL_MAX;
  *mid = known ? s->u.mid[k] : 0;
  *rad = known ? s->u.rad[k] : INFINITY;
  int slopes = s->varies != 0;
  for (uint32_t d = 0; d < j->ndir; d++) {
    size_t at = place(j, k, d);
    if (dmid) dmid[d] = known && slopes ? s->slope.mid[at] : 0;
    if (drad) drad[d] = !known ? INFINITY : slopes ? s->slope.rad[at] : 0;
  }
}

/* upward mode */
static AMBIT_WORKER void magnitudes(const jets *j, const slot *s, uint32_t n, double *mag, double *dmag) {
  for (uint32_t k = 0; k < n; k++) {
    int known = k < j->failed && s->u.rad[k] < DBL_MAX;
    mag[k] = known ? fabs(s->u.mid[k]) + s->u.rad[k] : INFINITY;
    if (!dmag) continue;
    for (uint32_t d = 0; d < j->ndir; d++) {
      size_t at = place(j, k, d);
      double size = s->varies ? fabs(s->slope.mid[at]) + s->slope.rad[at] : 0;
      dmag[(size_t)k * j->ndir + d] = known ? size : INFINITY;
    }
  }
}

void jets_magnitude(const void *self, uint32_t slot_index, uint32_t n, double *mag, double *dmag) {
  const jets *j = self;
  ambit_rounding old = ambit_round_up();
  magnitudes(j, &j->slot[slot_index], n, mag, dmag);
  ambit_rounding_restore(old);
}
