/* inexpressive.c -- broken: an element without express(). */
#include <ambit/element.h>
#include <stddef.h>

static const ambit_element inexpressive = { .size = sizeof inexpressive };
static const void *get(const char *id) { return id[6] == 'e' && id[7] == 'l' ? &inexpressive : NULL; }
const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "element.inexpressive", "1", "", get };
