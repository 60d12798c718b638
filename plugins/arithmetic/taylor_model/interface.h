/* interface.h -- the plugin's own interface, "ambit.taylor/1". */
#ifndef INTERFACE_H
#define INTERFACE_H
#include "model.h"

extern const ambit_taylor taylor_interface;
#endif
