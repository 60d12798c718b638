/* vary.h -- parameters that are functions of time. */
#ifndef ZONOTOPE_VARY_H
#define ZONOTOPE_VARY_H
#include "zonotope.h"

uint32_t vary_first(const zono *z); /* slot of the first of them; the others follow */
void vary_start(zono *z);
/* the step that was just proved: is it short enough? sets z->vary_most, the longest that would be */
int vary_fits(zono *z);
static inline int is_varying(const zono *z, uint32_t slot) {
  return slot - vary_first(z) < z->nvarying; /* unsigned: not below the first */
}
/* what makes columns in each step: functions of time, then equations */
static inline uint32_t vary_sources(const zono *z) { return z->nvarying ? z->nvarying + z->na : 0; }
/* columns [at, end), those of its mean and moment, are of one source */
void vary_mark(zono *z, uint32_t source, uint32_t at, uint32_t end);
/* columns [n] of what varies, of each source the oldest first, become few by joining neighbours; returns how many
** columns there are then. What columns leave goes into the box. */
uint32_t vary_merge(zono *z, uint32_t n);
#endif
