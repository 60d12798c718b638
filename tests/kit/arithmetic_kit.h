/* arithmetic_kit.h -- the conformance kit of "ambit.arithmetic/1": any arithmetic plugin can be put through it.
**
** It knows no test framework: what it finds goes to a callback, so that tests and `ambit check` can share it. The
** judge of enclosures is a callback too (MPFR in the tests).
*/
#ifndef AMBIT_ARITHMETIC_KIT_H
#define AMBIT_ARITHMETIC_KIT_H
#include <ambit/arithmetic.h>
#include <stdbool.h>

typedef struct arithmetic_kit {
  const ambit_arithmetic *plugin; /* as exported: what it offers itself */
  const ambit_arithmetic *full;   /* completed by ambit_arithmetic_complete */
  const ambit_host *host;         /* contexts are opened on it */
  bool isotonic; /* also require that a subset has an image within the image (plain interval arithmetics) */
  uint64_t seed; /* not 0 */
  /* op(x, y), or x^n for POWN, rounded to a double downward or upward; NaN outside the domain; x, y finite. [ctx] */
  double (*oracle)(uint32_t op, double x, double y, int32_t n, bool up);
  /* a broken promise: which check, and one sentence with the numbers. At most 5 for each check */
  void (*finding)(void *user, const char *check, const char *message);
  /* an operation that the plugin leaves to the kernel: no fault, but loose and slow. May be NULL */
  void (*fallback)(void *user, const char *operation);
  void *user;
} arithmetic_kit;

/* Runs every check; returns the number of broken promises (also those not reported one by one). */
size_t arithmetic_kit_run(const arithmetic_kit *kit);
#endif
