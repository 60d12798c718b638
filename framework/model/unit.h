/* unit.h -- physical units as data: "N m", "kg*m^2/s^2", "deg", "mm". */
#ifndef AMBIT_UNIT_H
#define AMBIT_UNIT_H
#include "graph/graph.h"

typedef struct ambit_unit {
  int8_t power[7];      /* m kg s A K mol cd; an angle (rad) is dimensionless */
  const char *factor[2]; /* value in SI = number * factor[0] / factor[1]: decimal literals or "pi"; NULL = 1 */
  int decimal;           /* further power of ten */
} ambit_unit;

/* INVALID with the nearest known unit if the text is no unit. "1" and "" are dimensionless. */
ambit_status ambit_unit_read(const char *text, ambit_unit *unit, ambit_failure *f);
/* A number with an optional unit, "35 mm", as an expression in the SI unit `wanted` ("m"); a wrong dimension is INVALID and names both. No unit: SI. */
ambit_status ambit_unit_quantity(ambit_graph *g, const char *text, const char *wanted, ambit_expr *out, ambit_failure *f);
#endif
