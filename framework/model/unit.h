/* unit.h -- physical units as data: "N m", "kg*m^2/s^2", "deg", "mm".
**
** Factors are joined by a blank, `*`, `.` or `/` (which divides by the one factor, or bracket, behind it); `^` takes
** an integer power. SI prefixes n u m c d k M G go with SI units. No units with an offset (degC). An angle is
** dimensionless: deg is pi/180, rev 2 pi, rpm pi/30 per second.
*/
#ifndef AMBIT_UNIT_H
#define AMBIT_UNIT_H
#include "graph/graph.h"

/* value in SI = number * numerator / denominator * pi^pi * 10^decimal, exactly */
typedef struct ambit_unit {
  int8_t power[7]; /* m kg s A K mol cd */
  int8_t pi;
  int16_t decimal;
  uint64_t numerator, denominator; /* >= 1, without a common divisor */
} ambit_unit;

/* INVALID with the nearest known unit if the text is no unit. "1" and "" are dimensionless. */
ambit_status ambit_unit_read(const char *text, ambit_unit *unit, ambit_failure *f);
/* A number with an optional unit, "35 mm", as an expression in the SI unit `wanted` ("m"); a wrong dimension is
** INVALID and names both. No unit: SI.
*/
ambit_status ambit_unit_quantity(
    ambit_graph *g, const char *text, const char *wanted, ambit_expr *out, ambit_failure *f);
#endif
