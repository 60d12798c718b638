/* start.h -- between open.c, options.c and start.c. */
#ifndef TAYLOR_MODEL_START_H
#define TAYLOR_MODEL_START_H
#include "flow.h"

ambit_status start_open(flow *f);                /* space and start_* of the initial set */
uint32_t flow_automatic_order(uint32_t m);
double flow_automatic_split_tolerance(uint32_t m);
uint32_t flow_automatic_pieces(size_t bytes_of_piece);
double flow_automatic_step_min(const ambit_problem *p);
#endif
