/* rounding.h -- the floating-point environment of a kernel call.
**
** Compilers move floating-point operations across a change of the rounding mode (gcc does so even with
** -frounding-math). So the rule of this code base: the mode is changed only in a wrapper that contains no
** floating-point arithmetic and calls a function marked AMBIT_WORKER, which is never inlined. Each wrapper restores
** what it found. On x86, setting a mode also clears flush-to-zero and denormals-are-zero, which a host program may have
** set; elsewhere C has no name for them, and a host must leave them off.
*/
#ifndef AMBIT_ABI_ROUNDING_H
#define AMBIT_ABI_ROUNDING_H
#include "base.h"

#define AMBIT_WORKER __attribute__((noinline, noipa))
#if defined(__clang__)
#undef AMBIT_WORKER
#define AMBIT_WORKER __attribute__((noinline))
#endif

typedef unsigned ambit_rounding; /* saved environment */

#if defined(__x86_64__) || defined(__i386__)
#include <xmmintrin.h>
static inline ambit_rounding ambit_rounding_set(unsigned control) {
  ambit_rounding old = _mm_getcsr();
  __asm__ volatile("ldmxcsr %0" : : "m"(control) : "memory");
  return old;
}
static inline ambit_rounding ambit_round_nearest(void) {
  return ambit_rounding_set(0x1f80);
} /* all exceptions masked */
static inline ambit_rounding ambit_round_up(void) { return ambit_rounding_set(0x5f80); }
static inline void ambit_rounding_restore(ambit_rounding old) {
  __asm__ volatile("ldmxcsr %0" : : "m"(old) : "memory");
}
#else
#include <fenv.h>
static inline ambit_rounding ambit_rounding_set(int mode) {
  int old = fegetround();
  fesetround(mode);
  return (ambit_rounding)old;
}
static inline ambit_rounding ambit_round_nearest(void) { return ambit_rounding_set(FE_TONEAREST); }
static inline ambit_rounding ambit_round_up(void) { return ambit_rounding_set(FE_UPWARD); }
static inline void ambit_rounding_restore(ambit_rounding old) { fesetround((int)old); }
#endif
#endif
