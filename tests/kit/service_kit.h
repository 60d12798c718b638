/* service_kit.h -- the conformance kit of services: what they export to Lua, and the interfaces of <ambit/...> that the
** kernel asks for.
**
**   exports       names, signatures, sentences; functions of numbers answer the same twice
**   eigen         A v = lambda v, pairs in order, the trace
**   quasi_random  points in [0, 1), the same however they are asked for, even, within its limits
**   elementary    the tightest bounds, against MPFR
**
** A service of which nothing can be checked does not conform.
*/
#ifndef AMBIT_SERVICE_KIT_H
#define AMBIT_SERVICE_KIT_H
#include <ambit/eigen.h>
#include <ambit/elementary.h>
#include <ambit/export.h>
#include <ambit/quasi_random.h>

typedef struct service_kit {
  uint64_t seed;
  double effort; /* times the usual number of rounds */
  /* [op](x, y) rounded downward or upward; NaN outside the domain */
  double (*oracle)(uint32_t op, double x, double y, int32_t n, int up);
  void (*finding)(void *user, const char *promise, const char *message);
  void *user;
  size_t judged, findings; /* counted */
} service_kit;

void service_kit_find(service_kit *k, const char *promise, const char *format, ...) AMBIT_PRINTF(3, 4);

void service_kit_exports(service_kit *k, const ambit_exports *e);
void service_kit_eigen(service_kit *k, const ambit_eigen_service *s);
void service_kit_quasi_random(service_kit *k, const ambit_quasi_random_service *s);
void service_kit_elementary(service_kit *k, const ambit_elementary_service *s);
#endif
