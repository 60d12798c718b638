/* product.h -- products of interval series and interval matrices (contracts: ambit/num.h).
**
** Midpoint-radius form [Rump, Fast and parallel interval arithmetic, BIT 39 (1999) 534-554], here two-sided: with all
** sums rounded up, H >= sum a b, L >= sum (-a) b and R >= sum |a| rb + ra (|b| + rb), every sum of products of
** elements of a +- ra and b +- rb lies in [-(L + R), H + R], since |x y - a b| <= |a| rb + ra |b| + ra rb. For thin
** data it is as tight as interval operations one by one, for wide ones at most 1.5 times as wide (loc. cit.), and there
** is no branch and no comparison in it. Data that are not bounded, or reach beyond the largest double, go the slow way.
*/
#ifndef AMBIT_PRODUCT_H
#define AMBIT_PRODUCT_H
#include <stddef.h>
#include <stdint.h>

uint32_t ambit_product_convolve(
    size_t n, double *rlo, double *rhi, const double *alo, const double *ahi, const double *blo, const double *bhi);
uint32_t ambit_product_matmul(size_t rows, size_t inner, size_t cols, double *rlo, double *rhi, const double *alo,
    const double *ahi, const double *blo, const double *bhi);
#endif
