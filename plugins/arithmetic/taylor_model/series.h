/* series.h -- Taylor coefficients of the elementary functions, and what bounds the rest. */
#ifndef SERIES_H
#define SERIES_H
#include "model.h"

typedef struct series {
  uint32_t terms;                                                    /* highest coefficient */
  double mid[MONOMIALS_ORDER_MAX + 1], rad[MONOMIALS_ORDER_MAX + 1]; /* f^(k)(centre) / k! is in mid[k] +- rad[k] */
  interval rest;                                                     /* f^(terms + 1) / (terms + 1)! over `range` */
  double slope;                                                      /* |f'| <= slope on `wide` */
} series;

/* Upward mode. The series of op to order s->terms at a centre inside `range`, which is inside `wide`. 0: the function
** is not smooth on all of `wide`, or its derivatives are too large to be of use. exponent: of POWN. */
int series_expand(const ambit_num_service *num, uint32_t op, int32_t exponent, double centre, interval range,
    interval wide, series *s);
/* 1/x */
#define SERIES_RECIPROCAL AMBIT_OP_DIV
#endif
