/* constant.h -- what the constants of a tape are, to twice the digits of a double. */
#ifndef AMBIT_CONSTANT_H
#define AMBIT_CONSTANT_H
#include <ambit/double_double.h>
#include <ambit/tape.h>

/* The number that a text says, as x +- *error; 0: not understood. */
int constant_read(const char *text, dd *x, double *error);
/* Constant i is within x +- the result: 0 for a double, what its text says, or its enclosure. */
double constant_at(const ambit_tape *t, uint32_t i, dd *x);
#endif
