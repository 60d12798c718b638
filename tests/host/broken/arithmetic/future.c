/* future.c -- broken: built for another major version of the ABI. */
#include <ambit/arithmetic.h>

static const void *get(const char *id) { return id; }
const ambit_plugin ambit_entry = { sizeof ambit_entry, (AMBIT_ABI_MAJOR + 1) << 16 | 7, "arithmetic.future", "1", "",
  get };
