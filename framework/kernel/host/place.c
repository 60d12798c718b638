/* place.c -- where Ambit's own plugins are, seen from the folder of the file that this is linked into. */
#include "host/path.h"

const char ambit_place[] = AMBIT_PLACE;
