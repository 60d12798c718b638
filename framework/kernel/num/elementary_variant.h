/* elementary_variant.h -- the compiled variants of elementary_map.h; all give the same bits. Round-to-nearest on entry.
**
** portable: two lanes, any machine. fma: two lanes with FMA. avx2, avx512: four and eight lanes (x86-64 only, chosen at
** run time). One interval alone has its two ends in two lanes.
*/
#ifndef AMBIT_ELEMENTARY_VARIANT_H
#define AMBIT_ELEMENTARY_VARIANT_H
#include <ambit/tape.h>

#define AMBIT_ELEMENTARY_COUNT (AMBIT_OP_TANH - AMBIT_OP_EXP + 1)

/* Arrays as in ambit_elementary; indexed by op - AMBIT_OP_EXP. */
typedef void (*ambit_elementary_map)(
    size_t n, const double *alo, const double *ahi, const double *blo, const double *bhi, double *rlo, double *rhi);
extern const ambit_elementary_map ambit_elementary_portable[AMBIT_ELEMENTARY_COUNT];
#if defined(__x86_64__)
extern const ambit_elementary_map ambit_elementary_fma[AMBIT_ELEMENTARY_COUNT];
extern const ambit_elementary_map ambit_elementary_avx2[AMBIT_ELEMENTARY_COUNT];
extern const ambit_elementary_map ambit_elementary_avx512[AMBIT_ELEMENTARY_COUNT];
#endif

/* One interval of any kind: empty, infinite, leaving the domain, huge; uses the slow path where the kernels cannot. */
void ambit_elementary_rare(uint32_t op, double alo, double ahi, double blo, double bhi, double *lo, double *hi);
/* The slow path as it is set now. */
void ambit_elementary_slow(uint32_t op, double x, double y, double *lo, double *hi);
#endif
