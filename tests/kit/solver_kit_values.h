/* solver_kit_values.h -- what a record says besides its bounds, evaluated: dense enclosures and sets (solver.h). */
#ifndef AMBIT_SOLVER_KIT_VALUES_H
#define AMBIT_SOLVER_KIT_VALUES_H
#include <ambit/interval.h>
#include <ambit/solver.h>

/* the dense enclosure of state i at t_from + s */
ambit_interval kit_dense_value(const ambit_record *r, uint32_t i, ambit_interval s);
/* the set's enclosure of state i for the values u[nu] of the unknowns */
ambit_interval kit_set_value(const ambit_set *set, uint32_t i, const double *u);

/* NULL, or what is wrong with the form of it */
const char *kit_dense_fault(const ambit_record *r);
const char *kit_set_fault(const ambit_record *r, uint32_t nu);
#endif
