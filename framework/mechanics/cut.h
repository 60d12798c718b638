/* cut.h -- a mechanism cut open: some quantities are given, and what follows from them is pulled anew.
**
** While it is cut, everything that accelerations or the field of gravity may act on (accelerations, wrenches, efforts,
** balances, energies) lives in cells of its own, so that nothing of it is remembered afterwards; poses and twists are
** shared. Give the acceleration of a frame, and everything beyond it hangs on that alone.
*/
#ifndef AMBIT_CUT_H
#define AMBIT_CUT_H
#include <ambit/mechanism.h>

typedef struct ambit_cut ambit_cut;
ambit_cut *ambit_cut_open(ambit_mechanism *m); /* NULL: out of memory; no part may be added until close */
void ambit_cut_close(ambit_cut *cut);
/* From now on `value` is the quantity at any port (IN or OUT) of a part, or of the mechanism (AMBIT_NOWHERE). What has
** been pulled already stays as it is. */
ambit_status ambit_cut_give(
    ambit_cut *cut, ambit_frame port, uint32_t quantity, const ambit_expr *value, ambit_failure *f);
#endif
