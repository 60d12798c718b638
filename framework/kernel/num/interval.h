/* interval.h -- the kernel's interval functions: IEEE 1788-2015 set-based, sound in any ambient rounding mode.
**
** Empty is {+inf, -inf}; a bound is never NaN. Every function returns AMBIT_F_* flags (PARTIAL: an operand reached
** outside the domain; EMPTY, UNBOUNDED: of the result) and writes the enclosure of the image of the part inside the
** domain. Basic operations are the tightest doubles; elementary ones at most 1 ulp wider on each side
** (num/elementary.h).
*/
#ifndef AMBIT_NUM_INTERVAL_H
#define AMBIT_NUM_INTERVAL_H
#include <ambit/arithmetic.h>
#include <ambit/interval.h>
#include <ambit/tape.h>

/* r := op(a, b) for AMBIT_OP_*; b ignored when unary. POWN is ambit_interval_pown. */
uint32_t ambit_interval_op(uint32_t op, ambit_interval *r, ambit_interval a, ambit_interval b);
uint32_t ambit_interval_pown(ambit_interval *r, ambit_interval a, int32_t n);
/* The same over arrays: r[i] := op(a[i], b[i]), i < n. POWN: exponent n in `exponent`. r may be a or b. */
uint32_t ambit_interval_map(
    uint32_t op, size_t n, ambit_interval *r, const ambit_interval *a, const ambit_interval *b, int32_t exponent);

/* Tightest results of the basic operations, for kernel code that needs no flags. */
ambit_interval ambit_interval_add(ambit_interval a, ambit_interval b);
ambit_interval ambit_interval_sub(ambit_interval a, ambit_interval b);
ambit_interval ambit_interval_mul(ambit_interval a, ambit_interval b);
ambit_interval ambit_interval_div(ambit_interval a, ambit_interval b); /* b containing 0: hull of the quotient set */
ambit_interval ambit_interval_pi(void);
#endif
