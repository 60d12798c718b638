/* product_portable.c -- products of series and matrices: any machine (SSE2 on x86-64). */
#define AMBIT_VARIANT ambit_product_portable
#include "num/product_kernel.h"
