/* plugins.c -- plugins as Lua tables: the listing, and what each declares about itself (ports, parameters, options). */
#include "host/load.h"
#include "host/params.h"
#include "script/core.h"
#include "base/names.h"
#include "script/provenance.h"
#include "host/slow.h"
#include "host/trust.h"
#include <stdlib.h>
#include <string.h>

static void set_text(lua_State *L, const char *key, const char *value) {
  lua_pushstring(L, value); /* nil if NULL */
  lua_setfield(L, -2, key);
}

static void set_integer(lua_State *L, const char *key, lua_Integer value) {
  lua_pushinteger(L, value);
  lua_setfield(L, -2, key);
}

/* {{name, unit, shape, fallback, doc}, ...} */
static void push_params(lua_State *L, const ambit_param *param) {
  size_t n = ambit_params_count(param);
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    lua_createtable(L, 0, 5);
    set_text(L, "name", param[i].name);
    set_text(L, "unit", param[i].unit && param[i].unit[0] ? param[i].unit : "1");
    set_text(L, "shape", param[i].shape ? param[i].shape : "");
    set_text(L, "fallback", param[i].fallback);
    set_text(L, "doc", param[i].doc);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
}

static const char *kind_of(const ambit_port *port) {
  if (port->kind == AMBIT_PORT_STATE) return "state";
  return port->kind == AMBIT_PORT_FRAME ? "frame" : port->kind == AMBIT_PORT_JOINT ? "joint" : "constraint";
}

static void push_ports(lua_State *L, const ambit_element *element) {
  lua_createtable(L, (int)element->nport, 0);
  for (uint32_t i = 0; i < element->nport; i++) {
    const ambit_port *port = &element->port[i];
    lua_createtable(L, 0, 7);
    set_text(L, "name", port->name);
    set_text(L, "kind", kind_of(port));
    set_text(L, "role", port->role == AMBIT_ROLE_IN ? "in" : "out");
    set_text(L, "doc", port->doc);
    set_integer(L, "dof", ambit_port_dof(port));
    set_integer(L, "coordinates", ambit_port_coordinates(port));
    lua_pushboolean(L, port->optional != 0);
    lua_setfield(L, -2, "optional");
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
}

static void push_plugin(lua_State *L, const char *kind, const char *name) {
  const ambit_plugin *plugin;
  ambit_failure f = { 0 };
  if (ambit_registry_plugin(AMBIT_LUA(L)->registry, kind, name, &plugin, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  lua_createtable(L, 0, 10);
  set_text(L, "kind", kind);
  set_text(L, "name", name);
  set_text(L, "id", plugin->id);
  set_text(L, "version", plugin->version);
  set_text(L, "doc", plugin->doc);
}

static void set_flag(lua_State *L, const char *key, bool value) {
  lua_pushboolean(L, value);
  lua_setfield(L, -2, key);
}

/* What the three interfaces of solvers declare alike. */
#define PUSH_METHOD(L, s, for_verb)                                                                                    \
  (push_params(L, (s)->param), lua_setfield(L, -2, "parameters"), set_text(L, "arithmetics", (s)->arithmetics),        \
      set_text(L, "verb", for_verb), set_flag(L, "rigorous", (s)->needs_rigorous != 0))

/* Of a plugin that offers several, the first of flow, roots, strategy. */
static ambit_status push_solver(lua_State *L, ambit_registry *r, const char *name, ambit_failure *f) {
  const ambit_plugin *plugin;
  const ambit_solver *solver;
  const ambit_root_finder *finder;
  const ambit_strategy *strategy;
  ambit_status status = ambit_registry_plugin(r, "solver", name, &plugin, f);
  if (status != AMBIT_OK) return status;
  if (!plugin->get(AMBIT_SOLVER) && plugin->get(AMBIT_ROOT_FINDER)) {
    status = ambit_registry_root_finder(r, name, &finder, f);
    if (status == AMBIT_OK) PUSH_METHOD(L, finder, "roots");
    return status;
  }
  if (!plugin->get(AMBIT_SOLVER) && plugin->get(AMBIT_STRATEGY)) {
    status = ambit_registry_strategy(r, name, &strategy, f);
    if (status == AMBIT_OK) PUSH_METHOD(L, strategy, "reduce");
    return status;
  }
  status = ambit_registry_solver(r, name, &solver, f);
  if (status != AMBIT_OK) return status;
  PUSH_METHOD(L, solver, "simulate");
  set_text(L, "compared", solver->compared);
  set_text(L, "cheap", solver->cheap);
  set_flag(L, "varying", solver->want & AMBIT_WANT_VARYING);
  set_flag(L, "sampled", solver->want & AMBIT_WANT_JUMP);
  return AMBIT_OK;
}

/* plugin(kind, name) -> {kind, name, id, version, doc, and what the kind declares}; loads it */
static int plugin(lua_State *L) {
  const char *kind = luaL_checkstring(L, 1), *name = luaL_checkstring(L, 2);
  ambit_registry *r = AMBIT_LUA(L)->registry;
  ambit_failure f = { 0 };
  ambit_status status = AMBIT_OK;
  push_plugin(L, kind, name);
  if (strcmp(kind, "element") == 0) {
    const ambit_element *element;
    if ((status = ambit_registry_element(r, name, &element, &f)) == AMBIT_OK) {
      push_ports(L, element);
      lua_setfield(L, -2, "ports");
      push_params(L, element->param);
      lua_setfield(L, -2, "parameters");
    }
  } else if (strcmp(kind, "solver") == 0) {
    status = push_solver(L, r, name, &f);
  } else if (strcmp(kind, "arithmetic") == 0) {
    const ambit_arithmetic *arithmetic;
    if ((status = ambit_registry_arithmetic(r, name, &arithmetic, &f)) == AMBIT_OK) {
      push_params(L, arithmetic->param);
      lua_setfield(L, -2, "parameters");
      lua_pushboolean(L, arithmetic->rigorous != 0);
      lua_setfield(L, -2, "rigorous");
    }
  }
  if (status != AMBIT_OK) ambit_lua_raise(L, &f);
  return 1;
}

/* list() -> {{kind, name, file, loaded}, ...}; loads nothing */
static int list(lua_State *L) {
  ambit_registry *r = AMBIT_LUA(L)->registry;
  size_t n = ambit_registry_list(r, 0, NULL);
  ambit_listing *entry = lua_newuserdatauv(L, (n + 1) * sizeof *entry, 0);
  size_t found = ambit_registry_list(r, n, entry);
  if (found < n) n = found;
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    lua_createtable(L, 0, 4);
    set_text(L, "kind", entry[i].kind);
    set_text(L, "name", entry[i].name);
    set_text(L, "file", entry[i].file);
    lua_pushboolean(L, entry[i].loaded);
    lua_setfield(L, -2, "loaded");
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  return 1;
}

/* distrusted(file) -> why a file that decides about runs may not be read, or nil */
static int distrusted(lua_State *L) {
  char reason[AMBIT_MESSAGE_MAX];
  if (ambit_trust_file(luaL_checkstring(L, 1), reason, sizeof reason)) return 0;
  lua_pushstring(L, reason);
  return 1;
}

static void push_identity(lua_State *L, const ambit_identity *id) {
  lua_createtable(L, 0, 6);
  set_text(L, "kind", id->kind);
  set_text(L, "name", id->name);
  set_text(L, "version", id->version);
  set_text(L, "file", id->file);
  set_text(L, "sha256", id->sha256);
  if (id->shadows) set_text(L, "shadows", "yes");
}

static void add_folder(void *user, const char *folder) {
  lua_State *L = user;
  lua_pushstring(L, folder);
  lua_rawseti(L, -2, luaL_len(L, -2) + 1);
}

/* provenance() -> the plugins that are loaded, each { kind, name, version, file, sha256, shadows }, the folders that
** are trusted, and whether plugins may take names of Ambit's own */
static int provenance(lua_State *L) {
  ambit_registry *r = AMBIT_LUA(L)->registry;
  ambit_failure f = { 0 };
  ambit_identity id;
  lua_newtable(L);
  for (size_t i = 0; i < ambit_registry_count(r); i++) {
    if (ambit_provenance_plugin(r, i, &id, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
    push_identity(L, &id);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  ambit_status status = ambit_provenance_slow(r, &id, &f);
  if (status != AMBIT_OK && status != AMBIT_UNABLE) ambit_lua_raise(L, &f);
  if (status == AMBIT_OK) {
    push_identity(L, &id);
    lua_rawseti(L, -2, luaL_len(L, -2) + 1);
  }
  lua_newtable(L);
  ambit_trust_each(add_folder, L);
  lua_pushboolean(L, ambit_trust_has_shadows());
  return 3;
}

/* loaded() -> "kind.name" of each plugin that is loaded */
static int loaded(lua_State *L) {
  ambit_registry *r = AMBIT_LUA(L)->registry;
  lua_newtable(L);
  for (size_t i = 0; i < ambit_registry_count(r); i++) {
    const char *kind, *name;
    ambit_registry_loaded(r, i, &kind, &name);
    lua_pushfstring(L, "%s.%s", kind, name);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  if (ambit_slow_loaded()) {
    lua_pushliteral(L, "service.elementary");
    lua_rawseti(L, -2, luaL_len(L, -2) + 1);
  }
  return 1;
}

/* sha256(text) -> of a text */
static int sha256(lua_State *L) {
  char digits[AMBIT_DIGEST_TEXT];
  ambit_failure f = { 0 };
  size_t bytes;
  const char *text = luaL_checklstring(L, 1, &bytes);
  if (ambit_provenance_text(AMBIT_LUA(L)->registry, text, bytes, digits, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  lua_pushstring(L, digits);
  return 1;
}

/* kernel() -> its file, and the SHA-256 of that as it lies there */
static int kernel(lua_State *L) {
  char digits[AMBIT_DIGEST_TEXT];
  ambit_failure f = { 0 };
  char *name = ambit_trust_kernel();
  lua_pushstring(L, name ? name : "");
  free(name);
  if (ambit_provenance_file(AMBIT_LUA(L)->registry, lua_tostring(L, -1), digits, &f) != AMBIT_OK)
    ambit_lua_raise(L, &f);
  lua_pushstring(L, digits);
  return 2;
}

/* trust(folder): what lies there may be loaded, whoever may write there */
static int trust(lua_State *L) {
  ambit_failure f = { 0 };
  if (ambit_trust_folder(luaL_checkstring(L, 1), &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  return 0;
}

/* allow_shadow(): a plugin on AMBIT_PATH may have the kind and name of one of Ambit's own */
static int allow_shadow(lua_State *L) {
  (void)L;
  ambit_trust_shadows();
  return 0;
}

/* nearest(name, {candidate, ...}) -> the nearest one or nil */
static int nearest(lua_State *L) {
  const char *name = luaL_checkstring(L, 1);
  size_t n = (size_t)luaL_len(L, 2);
  const char **candidate = lua_newuserdatauv(L, (n + 1) * sizeof *candidate, 0);
  for (size_t i = 0; i < n; i++) {
    lua_rawgeti(L, 2, (lua_Integer)i + 1);
    candidate[i] = luaL_checkstring(L, -1);
    lua_pop(L, 1); /* the table keeps it */
  }
  lua_pushstring(L, ambit_names_nearest(name, candidate, n));
  return 1;
}

void ambit_lua_open_plugins(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "plugin", plugin }, { "list", list }, { "distrusted", distrusted },
    { "nearest", nearest }, { "trust", trust }, { "provenance", provenance }, { "loaded", loaded },
    { "sha256", sha256 }, { "kernel", kernel }, { "allow_shadow", allow_shadow }, { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
