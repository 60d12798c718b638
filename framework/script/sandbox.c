/* sandbox.c -- the service that shuts the process in, for `--sandbox` (scripts/command/sandbox.lua). */
#include "script/core.h"
#include "script/request.h"
#include <ambit/sandbox.h>
#include <string.h>

static const ambit_sandbox_service *service(lua_State *L) {
  const ambit_plugin *plugin;
  ambit_failure f = { 0 };
  if (ambit_registry_plugin(AMBIT_LUA(L)->registry, "service", "sandbox", &plugin, &f) != AMBIT_OK)
    ambit_lua_raise(L, &f);
  const ambit_sandbox_service *s = plugin->get(AMBIT_SANDBOX_SERVICE);
  if (!s || s->size < sizeof *s) ambit_lua_error(L, "the plugin service/sandbox offers no %s", AMBIT_SANDBOX_SERVICE);
  return s;
}

/* sandbox({file or folder that may be read}, {folder that may be written to}, may it fork?) -> does the system itself
** keep files from the process?; nil, why: it is not shut in */
static int sandbox(lua_State *L) {
  ambit_sandbox_request q = { .size = sizeof q, .children = (uint32_t)lua_toboolean(L, 3) };
  q.read = ambit_lua_texts(L, 1, &q.nread);
  q.write = ambit_lua_texts(L, 2, &q.nwrite);
  char why[256] = "";
  int files = 0;
  if (service(L)->enter(&q, &files, why, sizeof why) != AMBIT_OK) {
    lua_pushnil(L);
    lua_pushstring(L, why);
    return 2;
  }
  lua_pushboolean(L, files);
  return 1;
}

void ambit_lua_open_sandbox(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "sandbox", sandbox }, { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
