/* rounding.h -- the floating-point environment of a kernel call: the same rule for kernel and plugins, so it is part
** of the SDK. */
#ifndef AMBIT_ROUNDING_H
#define AMBIT_ROUNDING_H
#include <ambit/rounding.h>
#endif
