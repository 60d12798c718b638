/* sampled_lua.h -- what a sample knows of a range, as an enclosure whose text says no more than that.
**
** lo, hi: the hull of what was drawn made smaller by its error; `error`: by how much, NaN if it is not known. Where the
** hull is nothing but error, lo and hi are its middle, which is off by at most `error`.
*/
#ifndef AMBIT_LUA_SAMPLED_H
#define AMBIT_LUA_SAMPLED_H
#include "script/core.h"

typedef struct ambit_lua_sampled {
  ambit_lua_enclosure own; /* first; flags: AMBIT_LUA_SAMPLED */
  double error;
} ambit_lua_sampled;

/* Pushes {sampled, ...}. */
void ambit_lua_push_sampled(lua_State *L, size_t n, const ambit_interval *hull, const double *error);
/* "[0.4934, 0.5895]" rounded inward, "0.540302305(2)" as "0.540302305 +- 2e-9"; returns the length. */
#define AMBIT_SAMPLED_MAX 256
int ambit_lua_sampled_text(const ambit_lua_sampled *x, int digits, char out[AMBIT_SAMPLED_MAX]);
#endif
