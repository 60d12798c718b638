/* strings.h -- methods of strings, a scene's and Ambit's own. */
#ifndef AMBIT_LUA_STRINGS_H
#define AMBIT_LUA_STRINGS_H
#include <lua.h>

/* From now on Ambit's modules find methods of strings in the table on top of the stack, its copy of `string`. */
void ambit_strings_keep(lua_State *L);
#endif
