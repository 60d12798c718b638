/* decimal.h -- decimal text <-> doubles, rigorous in both directions, in any ambient rounding mode and locale.
**
** Reads the bare literals of IEEE 1788-2015: "0.1", "-1e-3", "1/3", "0x1.8p3", "[0.1, 0.2]", "[1/3]", "[]", "[empty]",
** "[entire]", "[,]", "[1,]", "[-inf, 2]", and the uncertain form "3.56?2e1" (+- 2 units of the last place; no radius:
** half a unit; "??": unbounded; u or d behind the radius: upward or downward only); besides "pi". Letters may be
** capitals; white space is allowed around bounds and brackets. A lower bound above the upper one by less than the
** spacing of doubles is not noticed: the result holds both. Decorated literals are refused.
*/
#ifndef AMBIT_DECIMAL_H
#define AMBIT_DECIMAL_H
#include <ambit/status.h>
#include <ambit/interval.h>

/* The tightest doubles that enclose what the text says; quotients of other than integers, or of more than 1000
** characters, may be wider. INVALID with a message that quotes the text if it is no
** literal or reversed. The literal may be followed by white space and a rest (a unit): if rest is not NULL it is set
** there, otherwise a rest is an error. */
ambit_status ambit_decimal_read(const char *text, ambit_interval *x, const char **rest, ambit_failure *failure);
/* The same, and doubles `inner` between which every number belongs to the set that the text says: for ends that are no
** doubles the set is known from both sides only. Empty where no double is known to belong to it. */
ambit_status ambit_decimal_read_set(
    const char *text, ambit_interval *x, ambit_interval *inner, const char **rest, ambit_failure *failure);
/* A tolerance >= 0: "0.1%" (*relative, x encloses 0.001) or absolute, "1e-3"; a rest (a unit) as above. */
ambit_status ambit_decimal_tolerance(
    const char *text, ambit_interval *x, bool *relative, const char **rest, ambit_failure *failure);

#define AMBIT_DECIMAL_MAX 64
/* shortest text that reads back as x; "inf", "-inf" */
int ambit_decimal_shortest(char out[AMBIT_DECIMAL_MAX], double x);
int ambit_decimal_down(char out[AMBIT_DECIMAL_MAX], double x, int digits); /* `digits` significant, not above x */
int ambit_decimal_up(char out[AMBIT_DECIMAL_MAX], double x, int digits);   /* not below x */
/* "[2.3205, 2.3916]": rounded outward, `digits` significant digits of the width (1..17); a point that the digits show
** exactly prints bare: "2.5"; "[empty]", "[entire]". Returns the length. */
int ambit_decimal_interval(char out[3 * AMBIT_DECIMAL_MAX], ambit_interval x, int digits);
/* The same rounded inward, with two digits or more: all of what it shows is in x. */
int ambit_decimal_inner(char out[3 * AMBIT_DECIMAL_MAX], ambit_interval x, int digits);
#endif
