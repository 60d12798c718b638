/* sampled_lua.c -- sampled ranges as Lua values. */
#include "verbs/sample/sampled_lua.h"
#include "verbs/sample/sample_error.h"
#include "num/decimal.h"
#include <math.h>
#include <stdio.h>

void ambit_lua_push_sampled(lua_State *L, size_t n, const ambit_interval *hull, const double *error) {
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    ambit_lua_sampled *x = lua_newuserdatauv(L, sizeof *x, 0);
    x->error = error[i];
    x->own = (ambit_lua_enclosure) { .x = ambit_sample_sure(hull[i], &x->error), .flags = AMBIT_LUA_SAMPLED };
    luaL_setmetatable(L, AMBIT_TYPE_ENCLOSURE);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
}

/* A value and how far it may be off: one digit more than is known, and room for its rounding. */
static int value_text(double value, double error, char out[AMBIT_SAMPLED_MAX]) {
  char at[AMBIT_DECIMAL_MAX], off[AMBIT_DECIMAL_MAX];
  double size = fmax(fabs(value), error);
  int digits = size > 0 && error > 0 ? (int)(floor(log10(size)) - floor(log10(error))) + 2 : 17;
  if (digits > 17) digits = 17;
  snprintf(at, sizeof at, "%.*g", digits, value);
  ambit_decimal_up(off, 1.1 * error, 1);
  return snprintf(out, AMBIT_SAMPLED_MAX, "%s +- %s", at, off);
}

int ambit_lua_sampled_text(const ambit_lua_sampled *x, int digits, char out[AMBIT_SAMPLED_MAX]) {
  ambit_interval hull = x->own.x;
  char range[3 * AMBIT_DECIMAL_MAX];
  if (!ambit_interval_is_bounded(hull) || x->error == 0)
    return ambit_decimal_inner(range, hull, digits), snprintf(out, AMBIT_SAMPLED_MAX, "%s", range);
  if (!isfinite(x->error))
    return ambit_decimal_inner(range, hull, digits), snprintf(out, AMBIT_SAMPLED_MAX, "%s +- ?", range);
  if (!(hull.lo < hull.hi)) return value_text(hull.lo, x->error, out);
  double known = floor(log10(ambit_interval_width(hull) / x->error)) + 1;
  ambit_decimal_inner(range, hull, known < digits ? (int)known : digits);
  return snprintf(out, AMBIT_SAMPLED_MAX, "%s", range);
}
