/* environment.c -- what the floating-point environment does to a few numbers. */
#include "num/environment.h"

bool ambit_environment_is_standard(void) {
  volatile double one = 1, tiny = 0x1p-60, least = 0x1p-1074, small = 0x1p-1022;
  volatile double above = one + tiny, below = -one - tiny, doubled = least * 2, halved = small * 0.5;
  /* upward: above > 1; downward: below < -1; toward zero: 1 - 2^-60 < 1; flushed operands or results: 0 */
  volatile double inside = one - tiny;
  return above == 1 && below == -1 && inside == 1 && doubled != 0 && halved != 0;
}
