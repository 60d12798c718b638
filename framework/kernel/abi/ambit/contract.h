/* contract.h -- service "ambit.contract/1": narrowing a box to where a tape's outputs can have given values.
**
** Computed in the kernel's own intervals, whatever the arithmetic of the problem.
*/
#ifndef AMBIT_CONTRACT_H
#define AMBIT_CONTRACT_H
#include "arithmetic.h"

#define AMBIT_CONTRACT_SERVICE "ambit.contract/1"

/* Beside AMBIT_F_*: somewhere in the box the outputs may jump (the cut of atan2) or have a kink (abs, min, max). */
#define AMBIT_F_KINK 8u
#define AMBIT_F_KINK_ELSEWHERE 16u /* of inspect_in: the same, but not along the inputs that are asked about */

typedef struct ambit_contractor ambit_contractor;

typedef struct ambit_contract_service {
  uint32_t size;
  /* [ctx] the memory is the host object's; the tape must not be a SERIES tape */
  ambit_status (*open)(const ambit_host *h, const ambit_tape *t, ambit_contractor **c);
  /* [ctx] lo, hi [nin]: narrowed in place; every point of the box at which the tape is defined and each output k lies
  ** in [out_lo[k], out_hi[k]] (NULL: is 0) stays in it. AMBIT_DOMAIN: there is no such point, the box is unchanged. */
  ambit_status (*narrow)(ambit_contractor *c, double *lo, double *hi, const double *out_lo, const double *out_hi);
  /* [ctx] AMBIT_F_* and AMBIT_F_KINK over the box, of all slots; 0: the outputs are defined, bounded and continuous on
  ** it, and continuously differentiable wherever their derivative's formula is bounded */
  uint32_t (*inspect)(ambit_contractor *c, const double *lo, const double *hi);
  /* [ctx] the same for functions of the first n inputs, the others being fixed somewhere in the box: KINK only for
  ** slots that depend on one of the n, else KINK_ELSEWHERE */
  uint32_t (*inspect_in)(ambit_contractor *c, const double *lo, const double *hi, uint32_t n);
} ambit_contract_service;
#endif
