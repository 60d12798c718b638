/* portable.c -- for every processor: two directions at a time (SSE2 is part of x86-64). */
#define VARIANT gradient_portable
#include "loops.h"
