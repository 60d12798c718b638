/* service.c -- the interval functions as plugins see them.
**
** Plugins know no ambit_interval: a pair of doubles crosses the border. The struct has the two bounds as its only
** members, so an array of n of them is an array of 2 n doubles, and each may be accessed as the other (C17 6.5 p7: an
** aggregate that includes a double).
*/
#include "num/service.h"
#include "num/decimal.h"
#include "num/elementary.h"
#include "num/function.h"
#include "num/interval.h"
#include "num/product.h"
#include <stdio.h>
#include <string.h>

_Static_assert(sizeof(ambit_interval) == 2 * sizeof(double), "an interval is two doubles");

static const ambit_interval *intervals(const double *pairs) { return (const ambit_interval *)(const void *)pairs; }

static uint32_t map(uint32_t op, size_t n, double *r, const double *a, const double *b, int32_t exponent) {
  return ambit_interval_map(op, n, (ambit_interval *)(void *)r, intervals(a), intervals(b ? b : a), exponent);
}

static uint32_t pown(double *lo, double *hi, double alo, double ahi, int32_t n) {
  ambit_interval r;
  uint32_t flags = ambit_interval_pown(&r, (ambit_interval) { alo, ahi }, n);
  *lo = r.lo, *hi = r.hi;
  return flags;
}

static ambit_status read(const char *text, double *lo, double *hi, char *message, size_t room) {
  ambit_interval x = AMBIT_ENTIRE;
  ambit_failure failure = { 0 };
  ambit_status status = ambit_decimal_read(text, &x, NULL, &failure);
  if (room) snprintf(message, room, "%s", failure.message);
  *lo = x.lo, *hi = x.hi;
  return status;
}

static size_t shortest(char *out, size_t room, double x) {
  char text[AMBIT_DECIMAL_MAX];
  int length = ambit_decimal_shortest(text, x);
  if (length < 0 || (size_t)length >= room) return 0;
  memcpy(out, text, (size_t)length + 1);
  return (size_t)length;
}

static uint32_t taylor(uint32_t op, uint32_t n, double *c, double lo, double hi) {
  return ambit_function_taylor(op, n, (ambit_interval *)(void *)c, (ambit_interval) { lo, hi });
}

static const ambit_function_facts *facts(uint32_t op) {
  const ambit_described *f = ambit_function_of(op);
  return f ? &f->facts : NULL;
}

const ambit_num_service ambit_num_service_v1 = { sizeof ambit_num_service_v1, map, ambit_elementary, pown, read,
  shortest, ambit_product_convolve, ambit_product_matmul, taylor, facts };
