/* headless.c -- broken: its ambit_plugin is too short to hold what is required. */
#include <ambit/arithmetic.h>
#include <stddef.h>

static const void *get(const char *id) { return id; }
const ambit_plugin ambit_entry = { offsetof(ambit_plugin, get), AMBIT_ABI, "arithmetic.headless", "1", "", get };
