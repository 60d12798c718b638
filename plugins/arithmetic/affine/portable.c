/* portable.c -- for every processor: two doubles at a time (SSE2 is part of x86-64). */
#define VARIANT affine_portable
#include "variant.h"
