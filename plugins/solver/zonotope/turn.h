/* turn.h -- sine and cosine of a double to twice the digits. */
#ifndef ZONOTOPE_TURN_H
#define ZONOTOPE_TURN_H
#include <ambit/double_double.h>

#define TURN_ERROR 0x1p-96 /* each is off by at most this */

int turn_at(double c, dd *sine, dd *cosine); /* 0: |c| is too large */
#endif
