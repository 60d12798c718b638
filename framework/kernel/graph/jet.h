/* jet.h -- the kernel's side of service "ambit.jet/1" (contract: ambit/jet.h). */
#ifndef AMBIT_GRAPH_JET_H
#define AMBIT_GRAPH_JET_H
#include <ambit/jet.h>

extern const ambit_jet_service ambit_jet_service_v1;
/* The general form over run[] of a completed arithmetic, in the shape that an arithmetic would offer itself. `ctx` here
** is an ambit_jet_source. */
typedef struct ambit_jet_source {
  const ambit_arithmetic *arithmetic;
  void *actx;
} ambit_jet_source;
extern const ambit_jets ambit_jets_general;
#endif
