/* faceless.c -- broken: offers no interface. */
#include <ambit/arithmetic.h>
#include <stddef.h>

static const void *get(const char *id) {
  (void)id;
  return NULL;
}
const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "arithmetic.faceless", "1", "", get };
