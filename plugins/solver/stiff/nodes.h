/* nodes.h -- fills node, D and V of a collocation from its N; 0: impossible. */
#ifndef STIFF_NODES_H
#define STIFF_NODES_H
#include "collocation.h"

int nodes_fill(collocation *q);
#endif
