/* contract.h -- the kernel's side of service "ambit.contract/1" (contract: ambit/contract.h), and inverse
** operations. */
#ifndef AMBIT_CONTRACT_TABLE_H
#define AMBIT_CONTRACT_TABLE_H
#include <ambit/interval.h>
#include <ambit/contract.h>

extern const ambit_contract_service ambit_contract_service_v1;

/* Given that r = op(a, b), narrows a and b: every real solution with a, b and r in their intervals stays. False: there
** is none. Unary: b is not looked at. */
bool ambit_inverse(uint32_t op, ambit_interval r, ambit_interval *a, ambit_interval *b);
bool ambit_inverse_pown(int32_t n, ambit_interval r, ambit_interval *a);
/* In inverse_angle.c: sin a = r, cos a = r, tan a = r. */
bool ambit_inverse_sin(ambit_interval r, ambit_interval *a);
bool ambit_inverse_cos(ambit_interval r, ambit_interval *a);
bool ambit_inverse_tan(ambit_interval r, ambit_interval *a);
#endif
