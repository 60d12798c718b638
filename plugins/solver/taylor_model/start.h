/* start.h -- between open.c, options.c and start.c. */
#ifndef TAYLOR_MODEL_START_H
#define TAYLOR_MODEL_START_H
#include "flow.h"

ambit_status start_open(flow *f); /* space and start_* of the initial set, and tolerances */
/* `width`: of the set relative to its place, the geometric mean over all that is uncertain */
uint32_t flow_automatic_order(uint32_t m, double width);
void flow_choose_tolerances(options *o, uint32_t m, double width);
uint32_t flow_automatic_pieces(size_t bytes_of_piece, size_t monomials);

#endif
