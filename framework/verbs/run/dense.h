/* dense.h -- the dense enclosure of a step: where every solution is at any time within it. */
#ifndef AMBIT_DENSE_H
#define AMBIT_DENSE_H
#include <ambit/interval.h>
#include <ambit/solver.h>

/* Where state i of a step record is while t is in the part `when` of the step: the dense enclosure, if there is one,
** intersected with the tube. Entire if the record has neither. */
ambit_interval ambit_dense_state(const ambit_record *r, uint32_t i, ambit_interval when);
#endif
