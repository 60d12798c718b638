/* unresolved.c -- broken: needs a symbol that no library has. */
#include <ambit/arithmetic.h>

extern const void *ambit_symbol_that_nobody_defines(const char *id);
const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "arithmetic.unresolved", "1", "",
  ambit_symbol_that_nobody_defines };
