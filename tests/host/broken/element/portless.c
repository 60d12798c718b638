/* portless.c -- broken: announces two ports and shows none. */
#include <ambit/element.h>
#include <stddef.h>

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  (void)b, (void)port, (void)quantity, (void)out;
  return AMBIT_UNABLE;
}

static const ambit_element portless = { .size = sizeof portless, .nport = 2, .express = express };
static const void *get(const char *id) { return id[6] == 'e' && id[7] == 'l' ? &portless : NULL; }
const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "element.portless", "1", "", get };
