/* upward.c -- wrong on purpose: num is below graph. */
#include "base/status.h"
#include "graph/graph.h"
