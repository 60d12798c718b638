/* vary.c -- parameters that are functions of time: how long steps may be for them.
**
** Such a parameter is its middle, and a lump as wide as its range: nothing is asked of a lump but that it be a
** measurable function of time with a bound. A step makes two generators of it, for its mean over the step and for its
** moment (kernel.c). The second one is what a step that is too long costs: it shrinks with the square of the step. No
** proof depends on anything here.
*/
#include "vary.h"
#include "proof.h"
#include "reduce.h"
#include "strip.h"

#define LOSS 0.01     /* of the moments' generators, in parts of those of the means */
#define TURN 0.2      /* longest step times the size of J, where bounds of states are used at each step (strip.c) */
#define SHORTEST 1e-5 /* of the whole time: steps are not made shorter than this */

uint32_t vary_first(const zono *z) { return slot_p(z, z->np - z->problem.nvarying); }

static double span(const zono *z) { return fabs(z->problem.time[z->problem.ntime - 1] - z->problem.time[0]); }

static double through(const zono *z, const double *kernel, uint32_t i, uint32_t slot) {
  const proof *p = z->proof;
  double sum = 0;
  for (uint32_t l = 0; l < z->nx; l++)
    if (p->link[l] != LINK_STATE) sum += kernel[(size_t)i * z->nx + l] * p->C[(size_t)p->link_to[l] * z->nslot + slot];
  return fabs(sum);
}

/* a state within bounds that no other one depends on: how it moves matters to nobody */
static int is_idle(const zono *z, uint32_t i) {
  for (uint32_t k = 0; k < z->nx; k++)
    if (k != i && z->proof->J[(size_t)k * z->nx + i] != 0) return 0;
  return strip_bounds(z, i);
}

/* moments' generators by means', each in the units of the norm in which the step is short */
static double loss(const zono *z) {
  const proof *p = z->proof;
  double means = 0, moments = 0;
  for (uint32_t i = 0; i < z->nx; i++) {
    double mean = 0, moment = 0;
    if (is_idle(z, i)) continue;
    for (uint32_t v = 0, slot = vary_first(z); v < z->nvarying; v++, slot++) {
      mean += through(z, p->mean, i, slot) * z->rr[slot];
      moment += 0.5 * through(z, p->tilt, i, slot) * z->rr[slot];
    }
    means = fmax(means, mean / p->unit[i]), moments = fmax(moments, moment / p->unit[i]);
  }
  return means > 0 ? moments / means : 0;
}

/* in the same norm */
static double size_of_slopes(const zono *z) {
  const proof *p = z->proof;
  double most = 0;
  for (uint32_t i = 0; i < z->nx; i++) {
    double sum = 0;
    for (uint32_t k = 0; k < z->nx; k++) sum += fabs(p->J[(size_t)i * z->nx + k]) * p->unit[k];
    most = fmax(most, sum / p->unit[i]);
  }
  return most;
}

void vary_start(zono *z) {
  z->vary_most = INFINITY;
  memset(z->proof->made_by, 0, z->ngen * sizeof *z->proof->made_by);
}

int vary_fits(zono *z) {
  if (!z->nvarying) return 1;
  double share = loss(z), least = SHORTEST * span(z);
  double most = share > 0 ? fabs(z->h) * LOSS / share : INFINITY;
  if (strip_columns(z) > 0) most = fmin(most, TURN / size_of_slopes(z));
  z->vary_most = fmax(most, least);
  return fabs(z->h) <= fmax(1.5 * z->vary_most, least);
}

/* -- their generators */

void vary_mark(zono *z, uint32_t source, uint32_t at, uint32_t end) {
  for (uint32_t c = at; c < end; c++) z->proof->source[c] = (uint16_t)(1 + 2 * source + (c - at));
}

static uint32_t next_of(const proof *p, uint32_t n, uint32_t c) {
  uint32_t next = c + 1;
  while (next < n && p->source[next] != p->source[c]) next++;
  return next;
}

/* one column of this source less: neighbours become one, or one goes into the box, whichever costs least */
static void drop_one(zono *z, uint32_t n, uint32_t first) {
  proof *p = z->proof;
  uint32_t best = n, with = n, nx = z->nx;
  joint least = { 0, 0, INFINITY };
  for (uint32_t c = first, next; c < n; c = next) {
    const double *g = p->columns + (size_t)c * nx;
    double alone = boxed_size(z, g);
    next = next_of(p, n, c);
    if (alone < least.left) least.left = alone, best = n, with = c;
    joint j = next < n ? joint_of(z, g, p->columns + (size_t)next * nx) : least;
    if (j.left < least.left) least = j, best = c, with = next;
  }
  if (with == n) return;
  double *g = p->columns + (size_t)with * nx;
  if (best < n)
    join(z, p->columns + (size_t)best * nx, g, least, FROM_VARYING);
  else
    for (uint32_t i = 0; i < nx; i++) *box(z, FROM_VARYING, i) += fabs(g[i]);
  memset(g, 0, nx * sizeof *g);
  p->source[with] = 0;
}

static uint32_t drop_empty(zono *z, uint32_t n) {
  proof *p = z->proof;
  uint32_t kept = 0;
  for (uint32_t c = 0; c < n; c++) {
    const double *g = p->columns + (size_t)c * z->nx;
    double size = 0;
    for (uint32_t i = 0; i < z->nx; i++) size += fabs(g[i]);
    if (size == 0) continue;
    memmove(p->columns + (size_t)kept * z->nx, g, z->nx * sizeof *g);
    p->origin[kept] = p->origin[c], p->source[kept++] = p->source[c];
  }
  return kept;
}

uint32_t vary_merge(zono *z, uint32_t n) {
  const proof *p = z->proof;
  uint32_t sources = 2 * vary_sources(z), most = sources ? z->vary_room / sources : 0;
  for (uint32_t s = 1; s <= sources; s++) {
    uint32_t count = 0, first = n;
    for (uint32_t c = n; c-- > 0;)
      if (p->source[c] == s) first = c, count++;
    for (; count > most; count--) {
      while (p->source[first] != s) first++;
      drop_one(z, n, first);
    }
  }
  return sources ? drop_empty(z, n) : n;
}
