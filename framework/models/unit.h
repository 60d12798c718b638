/* unit.h -- physical units as data: "N m", "kg*m^2/s^2", "deg", "mm".
**
** Factors are joined by a blank, `*`, `.` or `/` (which divides by the one factor, or bracket, behind it); `^` takes
** a power, whole or not: m^2, s^-1, m^1.5, m^(1/3). All SI prefixes go with SI units. No units with an
** offset (degC). An angle is dimensionless: deg is pi/180, rev 2 pi, rpm pi/30 per second. docs/units.md lists them.
*/
#ifndef AMBIT_UNIT_H
#define AMBIT_UNIT_H
#include <ambit/graph.h>
#include "models/dimension.h"

/* numerator / denominator * pi^pi * 10^decimal, exactly; the integers >= 1, without a common divisor */
typedef struct ambit_unit_factor {
  int8_t pi;
  int16_t decimal;
  uint64_t numerator, denominator;
} ambit_unit_factor;

#define AMBIT_UNIT_ROOTS 4

/* value in SI = number * factor * root[0]^(share[0] / 60) * ..., of units such as mm^0.5 */
typedef struct ambit_unit {
  int16_t power[AMBIT_DIMENSIONS]; /* in sixtieths */
  ambit_unit_factor factor;
  uint8_t roots, share[AMBIT_UNIT_ROOTS]; /* 0 < share < 60 */
  ambit_unit_factor root[AMBIT_UNIT_ROOTS];
} ambit_unit;

/* INVALID with the nearest known unit if the text is no unit. "1" and "" are dimensionless. */
ambit_status ambit_unit_read(const char *text, ambit_unit *unit, ambit_failure *f);
/* A number with an optional unit, "35 mm", as an expression in the SI unit `wanted` ("m"); a wrong dimension is
** INVALID and names both. No unit: SI.
*/
ambit_status ambit_unit_quantity(
    ambit_graph *g, const char *text, const char *wanted, ambit_expr *out, ambit_failure *f);
/* The table of units: name k and whether it takes SI prefixes; NULL behind the last. */
const char *ambit_unit_name(size_t k, bool *takes_prefix);
/* SI prefix k and its power of ten; NULL behind the last. */
const char *ambit_unit_prefix(size_t k, int *decimal);
#endif
