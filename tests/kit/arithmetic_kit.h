/* arithmetic_kit.h -- the conformance kit of "ambit.arithmetic/1": any arithmetic plugin can be put through it.
**
** It knows no test framework: what it finds goes to a callback, so that tests and `ambit check` can share it. Judges
** are MPFR and identities of the reals; nothing is compared with the kernel's own functions except jets.
**
**   elements      set, bounds, many at once, variables, the empty set
**   operations    inclusion, flags, runs of several instructions, equal operands, odd lane counts, padding, empty lanes
**   special sets  every pair of points, half lines, zeros of both signs, subnormals, the line
**   isotonicity   part of the operands, part of the image (a promise of plain interval arithmetics only)
**   identities    inverses and functional equations: the result must contain what the reals say
**   programs      random straight-line programs over shared variables: samples of the image, eval_tape, gradient
**   dot, set_text, jets
**   environments  the caller's rounding mode and flush-to-zero: sound in each, restored after each call
**   contexts      two contexts at once, two threads, no memory at any moment of open
**   options       each declared option at its fallback and at other values: works, or refuses with a message
*/
#ifndef AMBIT_ARITHMETIC_KIT_H
#define AMBIT_ARITHMETIC_KIT_H
#include <ambit/registry.h>
#include <ambit/arithmetic.h>
#include <stdbool.h>

typedef struct arithmetic_kit {
  const ambit_arithmetic *plugin; /* as exported: what it offers itself; its run[] are read only where they exist */
  const ambit_arithmetic *full;   /* completed by ambit_arithmetic_complete */
  const ambit_host *host;         /* lends its services; memory and messages are the kit's own */
  bool isotonic; /* also require that a subset has an image within the image (plain interval arithmetics) */
  uint64_t seed; /* not 0 */
  /* op(x, y), or x^n for POWN, rounded to a double downward or upward; NaN outside the domain; x, y finite. [any] */
  double (*oracle)(uint32_t op, double x, double y, int32_t n, bool up);
  /* a broken promise: which one, and one sentence with the numbers. At most 5 for each promise and section */
  void (*finding)(void *user, const char *check, const char *message);
  /* an operation that the plugin leaves to the kernel: no fault, but loose and slow. May be NULL */
  void (*fallback)(void *user, const char *operation);
  void *user;
  /* -- all of these may be 0 */
  size_t noption; /* options that do not stand at their fallbacks */
  const ambit_option *option;
  double effort;                                  /* times the usual number of rounds and seconds; 0: once */
  void (*begin)(void *user, const char *section); /* before each section */
  void (*done)(void *user, const char *section, size_t judged, size_t broken); /* judged 0: nothing to check there */
} arithmetic_kit;

/* Runs every section, about 4 s of CPU time times `effort`; returns the number of broken promises (also those not
** reported one by one). */
size_t arithmetic_kit_run(const arithmetic_kit *kit);
#endif
