/* product_avx2.c -- products of series and matrices: AVX2 and FMA. Its flags are in cmake/product.cmake. */
#if defined(__x86_64__)
#define AMBIT_VARIANT ambit_product_avx2
#include "num/product_kernel.h"
#endif
