/* dimension.h -- the dimension of a quantity, and what operations make of it.
**
** KNOWN is what a unit said, and then it is checked. A number without a unit is BARE: as a term it takes the unit of
** the others, as a factor it is a number. Beside a state or a coordinate it may be a coefficient of any unit, though
** (100 in -100 * x is 100 1/s^2), so that product is OPEN: of a unit that nobody knows, which fits everything; of_state
** tells which those are. SOFT has a unit that is not insisted on: what a force law is called with, since -x may stand
** for -1 N/m * x; and pi and sines of open numbers, which are plain numbers as factors and anything as terms.
**
**   a + b, min, max, ends:  KNOWN and KNOWN must agree; KNOWN and BARE or SOFT: KNOWN; OPEN and anything: OPEN
**   a * b, a / b:           KNOWN or SOFT on both sides: powers add, KNOWN if one is; OPEN and anything: OPEN
**     with a BARE factor:   BARE; pi, sines, angles and KNOWN numbers: BARE; KNOWN: the same unit, or 1 over it; but
**                           of a state: OPEN
**   sin, exp, ...:          KNOWN must be a number or angle, unless a BARE or SOFT term was in it
**
** Rules for users: docs/units.md.
*/
#ifndef AMBIT_DIMENSION_H
#define AMBIT_DIMENSION_H
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define AMBIT_DIMENSIONS 7 /* m kg s A K mol cd */
#define AMBIT_POWER_ONE 60 /* powers are in sixtieths: m^0.5 is 30, m^(1/3) is 20 */
#define AMBIT_POWER_MAX (99 * AMBIT_POWER_ONE)

enum { AMBIT_DIMENSION_BARE, AMBIT_DIMENSION_OPEN, AMBIT_DIMENSION_SOFT, AMBIT_DIMENSION_KNOWN };

typedef struct ambit_dimension {
  uint8_t state;
  bool mixed;                      /* KNOWN, with a term in it that had no unit of its own */
  bool of_state;                   /* KNOWN, SOFT: made of states or coordinates, so BARE factors may be coefficients */
  int16_t power[AMBIT_DIMENSIONS]; /* KNOWN, SOFT: in sixtieths; otherwise 0 */
} ambit_dimension;

ambit_dimension ambit_dimension_known(const int16_t power[AMBIT_DIMENSIONS]);
/* May they be terms of one sum? */
bool ambit_dimension_agree(ambit_dimension a, ambit_dimension b);
bool ambit_dimension_is_number(ambit_dimension a); /* not known to be anything but a number or an angle */
/* Of an operation AMBIT_OP_* but POWN (unary: b ignored); false: the operands do not fit. */
bool ambit_dimension_op(uint32_t op, ambit_dimension a, ambit_dimension b, ambit_dimension *out);
/* a^(power / 60), |power| < 2^40; powers that are no sixtieths or too large: OPEN */
ambit_dimension ambit_dimension_power(ambit_dimension a, int64_t power);

#define AMBIT_DIMENSION_TEXT_MAX 128
/* "m*kg/s^2", "m^1.5", "1": for people and for the unit reader. */
void ambit_dimension_text(const int16_t power[AMBIT_DIMENSIONS], char out[AMBIT_DIMENSION_TEXT_MAX]);
/* "a force (N)", "a length (m)"; for what has no name "a value in kg/s^4". */
void ambit_dimension_name(const int16_t power[AMBIT_DIMENSIONS], char out[AMBIT_DIMENSION_TEXT_MAX]);
#endif
