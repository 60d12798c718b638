/* portable.c -- the plugin for any machine (SSE2 on x86-64). */
#define VARIANT interval_portable
#define VARIANT_NAME "portable"
#define JETS interval_portable_jets
#include "variant.h"
