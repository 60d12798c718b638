/* upward.c -- wrong on purpose: base is below graph, whose header of the C API this is. */
#include <ambit/graph.h>
