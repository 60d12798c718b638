/* gear.h -- two joints whose coordinates stay in a fixed ratio: g = q_2 - k q_1 - q_0 = 0, kept by a multiplier.
**
** Virtual power lambda dg/dt = lambda (q_2' - k q_1'): the efforts are lambda on the driven joint and -k lambda on the
** driver. An ideal gear neither stores nor loses energy. [Featherstone 2008, 3.2 and 8.11]
*/
#ifndef AMBIT_GEAR_H
#define AMBIT_GEAR_H
#include <ambit/spatial.h>

enum { GEAR_DRIVER, GEAR_DRIVEN, GEAR_MESH };
enum { GEAR_RATIO, GEAR_OFFSET };

static inline ambit_status gear_residual(ambit_build *b, ambit_expr *out) {
  const ambit_expr *first = b->get(b, GEAR_DRIVER, AMBIT_COORDINATE);
  const ambit_expr *second = first ? b->get(b, GEAR_DRIVEN, AMBIT_COORDINATE) : NULL;
  if (!second) return AMBIT_INVALID;
  ambit_expr turned = ambit_multiply(b, *b->param(b, GEAR_RATIO), *first);
  *out = ambit_subtract(b, ambit_subtract(b, *second, turned), *b->param(b, GEAR_OFFSET));
  return AMBIT_OK;
}

/* `unit`: of the multiplier */
static inline ambit_status gear_express(
    ambit_build *b, uint32_t port, uint32_t quantity, const char *unit, ambit_expr *out) {
  if (port == GEAR_MESH && quantity == AMBIT_RESIDUAL) return gear_residual(b, out);
  if (port > GEAR_DRIVEN || quantity != AMBIT_EFFORT) return AMBIT_UNABLE;
  ambit_expr lambda = b->multiplier(b, 0, unit);
  *out = port == GEAR_DRIVEN ? lambda : ambit_negate(b, ambit_multiply(b, *b->param(b, GEAR_RATIO), lambda));
  return AMBIT_OK;
}

/* `names`: of the two parameters */
static inline ambit_status gear_check(ambit_build *b, const char *ratio, const char *offset) {
  ambit_status status = ambit_check_fixed(b, b->param(b, GEAR_RATIO), 1, ratio);
  return status == AMBIT_OK ? ambit_check_fixed(b, b->param(b, GEAR_OFFSET), 1, offset) : status;
}
#endif
