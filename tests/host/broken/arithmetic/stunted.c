/* stunted.c -- broken: its struct is too short to hold what is required. */
#include <ambit/arithmetic.h>
#include <stddef.h>

static const ambit_arithmetic stunted = { .size = offsetof(ambit_arithmetic, set), .rigorous = 1 };
static const void *get(const char *id) { return id[6] == 'a' ? &stunted : NULL; }
const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "arithmetic.stunted", "1", "", get };
