/* source_lua.c -- equations as source text of other languages. */
#include "algebra/source.h"
#include "script/core.h"
#include <stdlib.h>
#include <string.h>

static ambit_language language_at(lua_State *L, int idx) {
  const char *name = luaL_checkstring(L, idx);
  for (int k = 0; k < AMBIT_LANGUAGE_COUNT; k++)
    if (strcmp(name, ambit_language_name[k]) == 0) return (ambit_language)k;
  ambit_lua_error(L, "source: there is no language `%s`; there is: text, lua, latex, modelica", name);
}

/* { {expression, name}, ... } at idx, or nothing; memory of Lua above the stack. The texts are kept by the table. */
static ambit_source_names names_at(lua_State *L, int idx) {
  if (lua_isnoneornil(L, idx)) return (ambit_source_names) { 0, NULL };
  luaL_checktype(L, idx, LUA_TTABLE);
  size_t n = (size_t)luaL_len(L, idx);
  ambit_source_name *list = lua_newuserdatauv(L, (n + 1) * sizeof *list, 0);
  for (size_t i = 0; i < n; i++) {
    lua_rawgeti(L, idx, (lua_Integer)i + 1);
    luaL_checktype(L, -1, LUA_TTABLE);
    lua_rawgeti(L, -1, 1);
    lua_rawgeti(L, -2, 2);
    list[i].node = ((ambit_lua_expression *)luaL_checkudata(L, -2, AMBIT_TYPE_EXPRESSION))->e;
    if (lua_type(L, -1) != LUA_TSTRING) ambit_lua_error(L, "source: expected { expression, name }");
    list[i].name = lua_tostring(L, -1);
    lua_pop(L, 3);
  }
  ambit_source_names_sort(n, list);
  return (ambit_source_names) { n, list };
}

/* source({expression}, language [, {{expression, name}, ...}]) -> {text}: an expression that has a name is written as
** that name inside of others */
static int source(lua_State *L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  lua_settop(L, 3);
  ambit_language language = language_at(L, 2);
  size_t n = (size_t)luaL_len(L, 1);
  const ambit_expr *e = ambit_lua_to_array(L, 1, n);
  ambit_source_names names = names_at(L, 3);
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    char *text = NULL;
    ambit_failure f = { 0 };
    if (ambit_source_write(AMBIT_LUA(L)->graph, e[i], language, &names, &text, &f) != AMBIT_OK) {
      free(text);
      ambit_lua_raise(L, &f);
    }
    lua_pushstring(L, text);
    free(text);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  return 1;
}

/* source_share({expression}) -> {expression}: the parts that want names of their own, operands first; few or none */
static int source_share(lua_State *L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  const ambit_graph *g = AMBIT_LUA(L)->graph;
  size_t n = (size_t)luaL_len(L, 1);
  const ambit_expr *e = ambit_lua_to_array(L, 1, n);
  size_t count = ambit_source_share(g, n, e, 0, NULL);
  if (count == SIZE_MAX) ambit_lua_error(L, "out of memory");
  ambit_expr *node = lua_newuserdatauv(L, (count + 1) * sizeof *node, 0);
  if (ambit_source_share(g, n, e, count, node) == SIZE_MAX) ambit_lua_error(L, "out of memory");
  ambit_lua_push_expressions(L, count, node);
  return 1;
}

/* source_identifier(language, name) -> what it may be called there */
static int source_identifier(lua_State *L) {
  ambit_language language = language_at(L, 1);
  const char *name = luaL_checkstring(L, 2);
  size_t room = 16 * strlen(name) + 64;
  char *out = lua_newuserdatauv(L, room, 0);
  if (!ambit_source_identifier(language, name, room, out)) ambit_lua_error(L, "out of memory");
  lua_pushstring(L, out);
  return 1;
}

void ambit_lua_open_source(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "source", source }, { "source_share", source_share },
    { "source_identifier", source_identifier }, { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
