/* unrounded.h -- takes the place of ambit/rounding.h: setting upward mode sets what the test says instead. */
#ifndef AMBIT_ABI_ROUNDING_H
#define AMBIT_ABI_ROUNDING_H
#include <fenv.h>
#include <stdlib.h>
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

#define AMBIT_WORKER __attribute__((noinline))
typedef unsigned ambit_rounding;

/* "up", "nearest", "down", "zero" or "flush": upward with flush-to-zero and denormals-are-zero */
static inline ambit_rounding ambit_round_up(void) {
  const char *mode = getenv("AMBIT_TEST_ROUNDING");
  int old = fegetround(), first = mode ? mode[0] : 'u';
  fesetround(first == 'n' ? FE_TONEAREST : first == 'd' ? FE_DOWNWARD : first == 'z' ? FE_TOWARDZERO : FE_UPWARD);
#if defined(__x86_64__)
  if (first == 'f') _mm_setcsr(_mm_getcsr() | 0x8040u);
#endif
  return (ambit_rounding)old;
}

static inline void ambit_rounding_restore(ambit_rounding old) {
#if defined(__x86_64__)
  _mm_setcsr(_mm_getcsr() & ~0x8040u);
#endif
  fesetround((int)old);
}
#endif
