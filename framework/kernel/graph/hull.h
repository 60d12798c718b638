/* hull.h -- a tape in the kernel's own intervals. */
#ifndef AMBIT_HULL_H
#define AMBIT_HULL_H
#include <ambit/interval.h>
#include <ambit/tape.h>

/* slot[nslot] := enclosures of every slot for the inputs in[nin]; returns AMBIT_F_* over all of them. */
uint32_t ambit_hull(const ambit_tape *t, const ambit_interval *in, ambit_interval *slot);
/* In the run just made, which left `slot`: may the argument of some atan2 cross its cut, on which atan2 jumps? */
bool ambit_hull_jumps(const ambit_tape *t, const ambit_interval *slot);
#endif
