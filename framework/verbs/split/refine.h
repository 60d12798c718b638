/* refine.h -- a run whose data are cut unevenly: parts are cut again where their sets reach far beyond a band.
**
** Why it holds: the parts cover the box of the data as those of a grid do (split.h), for a part is replaced by all of
** its own parts, once they have come to the end or, where it had not got there itself, failed. What the whole part
** proved holds for each of them too, so that both are intersected. The band only says where to cut.
** Results do not depend on the number of threads: runs go in rounds, each part of which computes by itself; what the
** next round cuts is decided by what the last one proved, in the order of the parts.
** It begins with the whole, and equal parts: 8, and 64 if that is few enough runs. Then a round looks at the part that
** is worst: it is halved across each of up to eight data, those that move the solution most, and the data are ranked by
** how much worse the worse half still is. Every part that is too wide is then cut across the best datum, or across two
** where one is not expected to be enough. Not the datum that moves the set most is taken, but the one that makes it too
** wide: a kink costs by the width of its operand, whatever that does to the rest.
*/
#ifndef AMBIT_REFINE_H
#define AMBIT_REFINE_H
#include "verbs/split/split.h"

/* With s->band; as ambit_split_run. */
ambit_status ambit_refine_run(const ambit_split *s, ambit_arena *arena, ambit_split_outcome *out, ambit_failure *f);
#endif
