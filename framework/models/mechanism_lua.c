/* mechanism_lua.c -- mechanisms as Lua values: adding parts, pulling quantities, the variables. */
#include "host/params.h"
#include "models/mechanism_lua.h"
#include "graph/kink.h"
#include "script/core.h"
#include <string.h>

ambit_mechanism *ambit_lua_to_mechanism(lua_State *L, int idx) {
  ambit_mechanism **m = luaL_checkudata(L, idx, AMBIT_TYPE_MECHANISM);
  return *m;
}

static ambit_mechanism *self(lua_State *L) { return ambit_lua_to_mechanism(L, 1); }

static int close(lua_State *L) {
  ambit_mechanism **m = luaL_checkudata(L, 1, AMBIT_TYPE_MECHANISM);
  if (*m) ambit_mechanism_close(*m);
  *m = NULL;
  return ambit_lua_retire(L);
}

/* mechanism(name) */
static int mechanism(lua_State *L) {
  ambit_lua *core = AMBIT_LUA(L);
  ambit_mechanism **m = lua_newuserdatauv(L, sizeof(ambit_mechanism *), 0);
  *m = NULL;
  luaL_setmetatable(L, AMBIT_TYPE_MECHANISM);
  *m = ambit_mechanism_open(core->graph, luaL_checkstring(L, 1));
  if (!*m) ambit_lua_error(L, "out of memory");
  return 1;
}

/* {{expression, ...} or false, ...} at idx -> arrays owned by Lua */
static const ambit_expr **params_of(lua_State *L, int idx, size_t n) {
  const ambit_expr **param = lua_newuserdatauv(L, (n + 1) * sizeof *param, 0);
  luaL_checkstack(L, (int)n + 4, "too many parameters");
  for (size_t i = 0; i < n; i++) {
    param[i] = NULL;
    lua_rawgeti(L, idx, (lua_Integer)i + 1);
    if (lua_istable(L, -1)) param[i] = ambit_lua_to_array(L, -1, (size_t)luaL_len(L, -1)); /* stays on the stack */
  }
  return param;
}

/* {part, port, part, port, ...} at idx; part < 0: not connected */
static ambit_frame *frames_of(lua_State *L, int idx, size_t n) {
  ambit_frame *frame = lua_newuserdatauv(L, (n + 1) * sizeof *frame, 0);
  for (size_t i = 0; i < n; i++) {
    lua_rawgeti(L, idx, 2 * (lua_Integer)i + 1);
    lua_rawgeti(L, idx, 2 * (lua_Integer)i + 2);
    lua_Integer part = lua_tointeger(L, -2);
    frame[i] = part < 0 ? AMBIT_NOWHERE : (ambit_frame) { (uint32_t)part, (uint32_t)lua_tointeger(L, -1) };
    lua_pop(L, 2);
  }
  return frame;
}

/* add(mechanism, type, name or nil, where, params, connections [, unit]) -> part number */
static int add(lua_State *L) {
  ambit_lua *core = AMBIT_LUA(L);
  ambit_mechanism *m = self(L);
  ambit_failure f = { 0 };
  ambit_part_spec spec = { 0 };
  spec.type = luaL_checkstring(L, 2);
  spec.name = lua_isnil(L, 3) ? NULL : luaL_checkstring(L, 3);
  spec.where = luaL_checkstring(L, 4);
  spec.unit = luaL_optstring(L, 7, NULL);
  if (ambit_registry_element(core->registry, spec.type, &spec.element, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  spec.param = params_of(L, 5, ambit_params_count(spec.element->param));
  spec.connection = frames_of(L, 6, spec.element->nport);
  uint32_t part = 0;
  if (ambit_mechanism_add(m, &spec, &part, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  lua_pushinteger(L, part);
  return 1;
}

/* written_by(mechanism, who, f, ...) -> f(...); formulas written meanwhile are that element's, for messages about
** kinks. f cannot yield: it is called from C, and would leave the others in the middle of it. */
static int written_by(lua_State *L) {
  ambit_graph *g = ambit_mechanism_graph(self(L));
  const char *other = ambit_graph_written_by(g, luaL_checkstring(L, 2));
  int outcome = lua_pcall(L, lua_gettop(L) - 3, LUA_MULTRET, 0);
  ambit_graph_written_by(g, other);
  if (outcome == LUA_OK) return lua_gettop(L) - 2;
  if (lua_isstring(L, -1) && strstr(lua_tostring(L, -1), "attempt to yield across a C-call"))
    ambit_lua_error(L, "%s: a function that writes a formula cannot yield", lua_tostring(L, 2));
  return lua_error(L);
}

/* pull(mechanism, part, port, quantity, count) -> {expression, ...}; part < 0: of the mechanism */
static int pull(lua_State *L) {
  ambit_mechanism *m = self(L);
  ambit_failure f = { 0 };
  lua_Integer part = luaL_checkinteger(L, 2);
  ambit_frame frame = part < 0 ? AMBIT_NOWHERE : (ambit_frame) { (uint32_t)part, (uint32_t)luaL_checkinteger(L, 3) };
  const ambit_expr *e = ambit_mechanism_pull(m, frame, (uint32_t)luaL_checkinteger(L, 4), &f);
  if (!e) ambit_lua_raise(L, &f);
  ambit_lua_push_expressions(L, (size_t)luaL_checkinteger(L, 5), e);
  return 1;
}

static int part_name(lua_State *L) {
  uint32_t part = (uint32_t)luaL_checkinteger(L, 2);
  ambit_mechanism *m = self(L);
  lua_pushstring(L, part < ambit_mechanism_count(m) ? ambit_mechanism_part_name(m, part) : "?");
  return 1;
}

static int pulled(lua_State *L) {
  size_t some = 0, all = 0;
  ambit_mechanism_pulled(self(L), &some, &all);
  lua_pushinteger(L, (lua_Integer)some);
  lua_pushinteger(L, (lua_Integer)all);
  return 2;
}

/* quantities(mechanism, part) -> {{name, port or nil, pulled}, ...}: all that the part has */
static int quantities(lua_State *L) {
  const ambit_mechanism *m = self(L);
  lua_Integer part = luaL_checkinteger(L, 2);
  luaL_argcheck(L, part >= 0 && part < (lua_Integer)ambit_mechanism_count(m), 2, "there is no such part");
  const ambit_element *element = ambit_mechanism_part_element(m, (uint32_t)part);
  size_t n = ambit_mechanism_part_quantities(m, (uint32_t)part, 0, NULL);
  ambit_part_quantity *q = lua_newuserdatauv(L, (n + 1) * sizeof *q, 0);
  ambit_mechanism_part_quantities(m, (uint32_t)part, n, q);
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    lua_createtable(L, 0, 3);
    lua_pushstring(L, q[i].name);
    lua_setfield(L, -2, "name");
    if (q[i].port != AMBIT_NO_PORT) lua_pushstring(L, element->port[q[i].port].name);
    if (q[i].port != AMBIT_NO_PORT) lua_setfield(L, -2, "port");
    lua_pushboolean(L, q[i].pulled);
    lua_setfield(L, -2, "pulled");
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  return 1;
}

static int count(lua_State *L) {
  lua_pushinteger(L, ambit_mechanism_count(self(L)));
  return 1;
}

/* {name, unit, [a_key] = a, [b_key] = b, part} appended to the list at the top */
static void append_variable(lua_State *L, const char *name, const char *unit, uint32_t part, const char *a_key,
    ambit_expr a, const char *b_key, ambit_expr b) {
  lua_createtable(L, 0, 5);
  lua_pushstring(L, name);
  lua_setfield(L, -2, "name");
  lua_pushstring(L, unit);
  lua_setfield(L, -2, "unit");
  lua_pushinteger(L, part);
  lua_setfield(L, -2, "part");
  ambit_lua_push_expression(L, a);
  lua_setfield(L, -2, a_key);
  if (b != AMBIT_NO_EXPR) ambit_lua_push_expression(L, b);
  if (b != AMBIT_NO_EXPR) lua_setfield(L, -2, b_key);
  lua_rawseti(L, -2, luaL_len(L, -2) + 1);
}

/* {{name, unit, part, q, rate}, ...}: of joints, or elements' own states */
static int push_coordinates(lua_State *L, bool own) {
  ambit_mechanism *m = self(L);
  size_t n = ambit_mechanism_coordinates(m, 0, NULL);
  ambit_coordinate *c = lua_newuserdatauv(L, (n + 1) * sizeof *c, 0);
  ambit_mechanism_coordinates(m, n, c);
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++)
    if (c[i].own == own) append_variable(L, c[i].name, c[i].unit, c[i].part, "q", c[i].q, "rate", c[i].rate);
  return 1;
}

/* coordinates(mechanism) -> those of joints; own_states(mechanism) -> those with equations of their own */
static int coordinates(lua_State *L) { return push_coordinates(L, false); }
static int own_states(lua_State *L) { return push_coordinates(L, true); }

/* coordinate_unit(mechanism, expression) -> unit of the coordinate that it is; nil: it is none */
static int coordinate_unit(lua_State *L) {
  lua_pushstring(L, ambit_mechanism_coordinate_unit(self(L), ambit_lua_to_expression(L, 2, NULL, NULL).e));
  return 1;
}

/* speeds(mechanism) -> {{name, unit, part, u, du, du_name}, ...} */
static int speeds(lua_State *L) {
  ambit_mechanism *m = self(L);
  size_t n = ambit_mechanism_speeds(m, 0, NULL);
  ambit_speed *s = lua_newuserdatauv(L, (n + 1) * sizeof *s, 0);
  ambit_mechanism_speeds(m, n, s);
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    append_variable(L, s[i].name, s[i].unit, s[i].part, "u", s[i].u, "du", s[i].du);
    lua_rawgeti(L, -1, (lua_Integer)i + 1);
    lua_pushstring(L, ambit_graph_node(ambit_mechanism_graph(m), s[i].du)->text);
    lua_setfield(L, -2, "du_name");
    lua_pop(L, 1);
  }
  return 1;
}

void ambit_lua_open_mechanism(lua_State *L, ambit_lua *core) {
  static const luaL_Reg meta[] = { { "__gc", close }, { NULL, NULL } };
  static const luaL_Reg functions[] = { { "mechanism", mechanism }, { "add", add }, { "pull", pull },
    { "written_by", written_by }, { "part_name", part_name }, { "pulled", pulled }, { "quantities", quantities },
    { "part_count", count }, { "coordinates", coordinates }, { "own_states", own_states },
    { "coordinate_unit", coordinate_unit }, { "speeds", speeds }, { NULL, NULL } };
  static const struct {
    const char *name;
    lua_Integer value;
  } quantity[] = { { "POSE", AMBIT_POSE }, { "TWIST", AMBIT_TWIST }, { "ACCEL", AMBIT_ACCEL },
    { "WRENCH", AMBIT_WRENCH }, { "ENERGY", AMBIT_ENERGY }, { "COORDINATE", AMBIT_COORDINATE }, { "RATE", AMBIT_RATE },
    { "RATE2", AMBIT_RATE2 }, { "EFFORT", AMBIT_EFFORT }, { "BALANCE", AMBIT_BALANCE },
    { "COORDINATE_RATE", AMBIT_COORDINATE_RATE }, { "RESIDUAL", AMBIT_RESIDUAL }, { "POWER", AMBIT_POWER },
    { "FIELD", AMBIT_FIELD }, { "MASS", AMBIT_MASS }, { "MASS_MOMENT", AMBIT_MASS_MOMENT },
    { "MOMENTUM", AMBIT_MOMENTUM } };
  ambit_lua_set_functions(L, core, functions);
  for (size_t i = 0; i < sizeof quantity / sizeof *quantity; i++) {
    lua_pushinteger(L, quantity[i].value);
    lua_setfield(L, -2, quantity[i].name);
  }
  ambit_lua_new_type(L, core, AMBIT_TYPE_MECHANISM, meta);
  lua_pop(L, 1);
}
