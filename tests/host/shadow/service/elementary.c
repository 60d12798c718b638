/* elementary.c -- broken: calls itself the slow path of the elementary functions and does not offer it. */
#include <ambit/elementary.h>

static const void *get(const char *id) {
  (void)id;
  return NULL;
}
const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "service.elementary", "1", "", get };
