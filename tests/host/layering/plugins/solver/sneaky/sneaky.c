/* sneaky.c -- wrong on purpose: a plugin does not see the kernel, nor other plugins. */
#include "num/interval.h"
#include "../other.h"
#include <ambit/solver.h>
