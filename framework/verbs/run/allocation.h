/* allocation.h -- "no allocation between the first and the last record", enforced in builds with
** AMBIT_COUNT_ALLOCATIONS.
**
** Such a build links tests/kit/allocations.c, whose malloc aborts while the calling thread forbids it; all others
** pay nothing.
*/
#ifndef AMBIT_ALLOCATION_H
#define AMBIT_ALLOCATION_H

#ifdef AMBIT_COUNT_ALLOCATIONS
void ambit_allocation_forbid(int on); /* this thread */
#else
static inline void ambit_allocation_forbid(int on) { (void)on; }
#endif
#endif
