/* interval.h -- what the files of the interval plugin share.
**
** An element is 16 bytes, (-lo, hi): in upward mode both are then computed by the same instruction, and negation is a
** swap. The empty set is (-inf, -inf), and -inf occurs in no other element, so "x == -inf" finds the empty operands
** half by half.
*/
#ifndef INTERVAL_H
#define INTERVAL_H
#include <ambit/arithmetic.h>
#include <ambit/meter.h>
#include <ambit/num.h>
#include <ambit/rounding.h>

typedef struct interval_context {
  const ambit_num_service *num;
  const ambit_meter_service *meter; /* NULL: not profiled */
  ambit_rounding outside;           /* environment to restore on leave */
} interval_context;

/* One per instruction set: the same source, compiled three times (variant.h). */
extern const ambit_arithmetic interval_portable;
extern const ambit_jets interval_portable_jets;
#if defined(__x86_64__)
extern const ambit_arithmetic interval_avx2, interval_avx512;
extern const ambit_jets interval_avx2_jets;
#endif

/* The part that is the same for all (context.c); contracts in arithmetic.h. */
ambit_status interval_open(const ambit_host *h, const double *option, uint32_t nvar, void **ctx);
size_t interval_elem(void *ctx);
void interval_enter(void *ctx);
void interval_leave(void *ctx);
void interval_set(void *ctx, void *dst, size_t n, const double *lo, const double *hi, int32_t var);
void interval_bounds(void *ctx, const void *src, size_t n, double *lo, double *hi);
#endif
