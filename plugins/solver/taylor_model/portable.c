/* portable.c -- the product for every machine. */
#define VARIANT sum_convolve_portable
#include "multiply.h"
