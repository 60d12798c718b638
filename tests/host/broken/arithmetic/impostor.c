/* impostor.c -- broken: its id is not the name of its file. */
#include <ambit/arithmetic.h>

static const void *get(const char *id) { return id; }
const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "arithmetic.somebody_else", "1", "", get };
