/* outward.h -- does this build round outward? */
#ifndef AMBIT_OUTWARD_H
#define AMBIT_OUTWARD_H
#include <stdbool.h>

/* Inexact sums, products, quotients and roots have the bounds that IEEE 754 demands. False: a compiler or an emulator
** has broken directed rounding, and no enclosure can be trusted. Takes about a tenth of a microsecond. */
bool ambit_interval_rounds_outward(void);
#endif
