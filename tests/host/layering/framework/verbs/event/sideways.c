/* sideways.c -- wrong on purpose: event is not built on roots. */
#include "verbs/roots/roots.h"
#include "verbs/run/report.h"
