/* elementary.c -- broken: the slow path of the elementary functions, with its bounds the wrong way round. */
#include <ambit/elementary.h>
#include <string.h>

static void point(uint32_t op, double x, double y, double *lo, double *hi) {
  (void)op, (void)x, (void)y;
  *lo = 0.5, *hi = 0.25;
}

static const ambit_elementary_service service = { sizeof service, point };
static const void *get(const char *id) { return strcmp(id, AMBIT_ELEMENTARY_SERVICE) == 0 ? &service : NULL; }
const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "service.elementary", "1", "", get };
