/* service.h -- the kernel's side of service "ambit.num/1" (contract: ambit/num.h). */
#ifndef AMBIT_NUM_TABLE_H
#define AMBIT_NUM_TABLE_H
#include <ambit/num.h>

extern const ambit_num_service ambit_num_service_v1;
#endif
