/* mute.c -- broken: a shared object without ambit_entry. */
#include <ambit/base.h>

AMBIT_EXPORT extern const int ambit_mute;
const int ambit_mute = 1;
