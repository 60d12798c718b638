/* foreign.c -- functions that a plugin exports ("ambit.export/1"), bound to Lua by libffi; Lua functions as C
** callbacks.
**
** No Lua error crosses the plugin: an error inside a callback is kept, the callback returns NaN (or 0) at once from
** then on, and the error is raised again after the plugin has returned. Not for hot loops: about 30 ns a call.
*/
#include "script/core.h"
#include "script/signature.h"
#include "num/rounding.h"
#include <math.h>
#include <string.h>

typedef union word {
  int32_t i;
  int64_t l;
  double d;
  size_t n;
  const void *p;
  ffi_arg integer;
  ffi_sarg signed_integer;
} word;

typedef struct callback {
  lua_State *L;
  const ambit_signature *signature;
  int function; /* stack index of the Lua function */
  int *failed;  /* shared by the callbacks of one call: stack index of the error value, 0 = none */
  int slot;     /* stack index kept free for that value */
  ffi_closure *closure;
} callback;

/* -- a callback: C calls Lua */

typedef struct invocation {
  const callback *c;
  void **argument;
  void *result;
} invocation;

static void push_array(lua_State *L, const double *x, size_t n) {
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    lua_pushnumber(L, x[i]);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
}

static void push_value(lua_State *L, char kind, void **argument) {
  switch (kind) {
  case 'i': lua_pushinteger(L, *(int32_t *)argument[0]); break;
  case 'l': lua_pushinteger(L, *(int64_t *)argument[0]); break;
  case 'd': lua_pushnumber(L, *(double *)argument[0]); break;
  case 's': lua_pushstring(L, *(const char **)argument[0]); break;
  default: push_array(L, *(const double **)argument[0], *(size_t *)argument[1]); break;
  }
}

/* Runs protected: [1] the function, [2] the invocation. */
static int invoke(lua_State *L) {
  const invocation *call = lua_touserdata(L, 2);
  const ambit_signature *s = call->c->signature;
  luaL_checkstack(L, (int)s->count + 4, "too many arguments");
  lua_pushvalue(L, 1);
  void **argument = call->argument;
  for (size_t i = 0; i < s->count; i++) {
    push_value(L, s->kind[i], argument);
    argument += s->kind[i] == 'D' ? 2 : 1;
  }
  lua_call(L, (int)s->count, s->result == 'v' ? 0 : 1);
  if (s->result == 'v') return 0;
  int fits;
  if (s->result == 'd')
    *(double *)call->result = lua_tonumberx(L, -1, &fits);
  else
    *(ffi_sarg *)call->result = (ffi_sarg)lua_tointegerx(L, -1, &fits);
  if (!fits)
    luaL_error(
        L, "a callback must return %s, got %s", s->result == 'd' ? "a number" : "an integer", luaL_typename(L, -1));
  return 0;
}

static void call_back(const callback *c, invocation *call) {
  if (*c->failed || !lua_checkstack(c->L, 4)) return;
  lua_pushcfunction(c->L, invoke);
  lua_pushvalue(c->L, c->function);
  lua_pushlightuserdata(c->L, call);
  if (lua_pcall(c->L, 2, 0, 0) == LUA_OK) return;
  lua_replace(c->L, c->slot);
  *c->failed = c->slot;
}

/* The plugin may be in the middle of a computation in another rounding mode. */
static void on_call(ffi_cif *cif, void *result, void **argument, void *user) {
  const callback *c = user;
  invocation call = { c, argument, result };
  (void)cif;
  if (c->signature->result == 'd')
    *(double *)result = NAN;
  else if (c->signature->result != 'v')
    *(ffi_arg *)result = 0;
  ambit_rounding outside = ambit_round_nearest();
  call_back(c, &call);
  ambit_rounding_restore(outside);
}

/* -- a call: Lua calls C */

typedef struct function {
  const ambit_signature *signature;
  void (*call)(void);
  const char *name;
} function;

static double *array_of(lua_State *L, int idx, const char *name, size_t *n) {
  if (!lua_istable(L, idx))
    ambit_lua_error(L, "%s: argument %d: expected a list of numbers, got %s", name, idx, luaL_typename(L, idx));
  *n = (size_t)luaL_len(L, idx);
  double *x = lua_newuserdatauv(L, (*n + 1) * sizeof *x, 0);
  for (size_t i = 0; i < *n; i++) {
    int fits;
    lua_rawgeti(L, idx, (lua_Integer)i + 1);
    x[i] = lua_tonumberx(L, -1, &fits);
    if (!fits) ambit_lua_error(L, "%s: argument %d: element %d is no number", name, idx, (int)i + 1);
    lua_pop(L, 1);
  }
  return x;
}

static void word_of(lua_State *L, const function *fn, char kind, int idx, word *w) {
  int fits = 1;
  switch (kind) {
  case 'i': {
    lua_Integer n = lua_tointegerx(L, idx, &fits);
    if (fits && (n < INT32_MIN || n > INT32_MAX))
      ambit_lua_error(L, "%s: argument %d does not fit into 32 bits", fn->name, idx);
    w->i = (int32_t)n;
    break;
  }
  case 'l': w->l = lua_tointegerx(L, idx, &fits); break;
  case 'd': w->d = lua_tonumberx(L, idx, &fits); break;
  case 's':
    fits = lua_type(L, idx) == LUA_TSTRING;
    w->p = lua_tostring(L, idx);
    break;
  default:
    fits = lua_isfunction(L, idx);
    w->p = NULL;
    break;
  }
  static const char *const expected[] = { "an integer", "an integer", "a number", "text", "a function" };
  if (!fits)
    ambit_lua_error(L, "%s: argument %d: expected %s, got %s", fn->name, idx, expected[strchr("ilds(", kind) - "ilds("],
        luaL_typename(L, idx));
}

/* Everything that may raise happens here, before a closure exists. Callback words stay NULL. */
static void collect(lua_State *L, const function *fn, word *w) {
  const ambit_signature *s = fn->signature;
  if ((size_t)lua_gettop(L) != s->count)
    ambit_lua_error(L, "%s: expected %d arguments, got %d", fn->name, (int)s->count, lua_gettop(L));
  luaL_checkstack(L, 3 * AMBIT_SIGNATURE_MAX, "too many arguments");
  for (size_t i = 0; i < s->count; i++) {
    int idx = (int)i + 1;
    if (s->kind[i] == 'D') {
      w[0].p = array_of(L, idx, fn->name, &w[1].n);
      w += 2;
    } else {
      word_of(L, fn, s->kind[i], idx, w);
      w += s->kind[i] == '(' ? 2 : 1;
    }
  }
}

/* Makes the closures; returns how many, or -1. */
static int open_callbacks(lua_State *L, const ambit_signature *s, word *w, callback *c, int *failed) {
  int n = 0;
  size_t at = 0;
  for (size_t i = 0; i < s->count; i++) {
    if (s->kind[i] == '(') {
      void *code;
      lua_pushnil(L);
      c[n] = (callback) { L, s->callback[i], (int)i + 1, failed, lua_gettop(L),
        ffi_closure_alloc(sizeof(ffi_closure), &code) };
      if (!c[n].closure) return -1;
      ffi_cif *cif = (ffi_cif *)(uintptr_t)&s->callback[i]->cif; /* libffi takes it without const */
      if (ffi_prep_closure_loc(c[n].closure, cif, on_call, &c[n], code) != FFI_OK) return -1;
      n++;
      w[at].p = code;
      w[at + 1].p = NULL;
    }
    at += s->kind[i] == '(' || s->kind[i] == 'D' ? 2 : 1;
  }
  return n;
}

static int push_result(lua_State *L, char kind, const word *r) {
  switch (kind) {
  case 'v': return 0;
  case 'i': lua_pushinteger(L, (int32_t)r->integer); return 1;
  case 'l': lua_pushinteger(L, r->l); return 1;
  case 'd': lua_pushnumber(L, r->d); return 1;
  default: lua_pushstring(L, r->p); return 1;
  }
}

static int call(lua_State *L) {
  const function *fn = lua_touserdata(L, AMBIT_LUA_OWN(1));
  const ambit_signature *s = fn->signature;
  word w[2 * AMBIT_SIGNATURE_MAX] = { { 0 } }, result = { 0 };
  void *address[2 * AMBIT_SIGNATURE_MAX];
  callback c[AMBIT_SIGNATURE_MAX] = { { 0 } };
  int failed = 0;
  for (size_t i = 0; i < s->c_count; i++) address[i] = &w[i];
  collect(L, fn, w);
  int opened = open_callbacks(L, s, w, c, &failed);
  if (opened >= 0) ffi_call((ffi_cif *)(uintptr_t)&s->cif, fn->call, &result, address);
  for (int i = 0; i < AMBIT_SIGNATURE_MAX; i++)
    if (c[i].closure) ffi_closure_free(c[i].closure);
  if (opened < 0) ambit_lua_error(L, "%s: the system allows no callbacks", fn->name);
  if (failed) {
    lua_pushvalue(L, failed);
    return lua_error(L);
  }
  return push_result(L, s->result, &result);
}

/* exports(kind, name) -> {name = function}, {name = {signature, doc}}; empty if the plugin exports none */
static int exports(lua_State *L) {
  ambit_lua *core = AMBIT_LUA(L);
  const ambit_plugin *plugin;
  ambit_failure f = { 0 };
  const char *kind = luaL_checkstring(L, 1), *name = luaL_checkstring(L, 2);
  if (ambit_registry_plugin(core->registry, kind, name, &plugin, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  const ambit_exports *e = NULL;
  if (ambit_registry_exports(core->registry, plugin, &e, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  lua_newtable(L);
  lua_newtable(L);
  for (uint32_t i = 0; e && i < e->count; i++) {
    function *fn = ambit_arena_alloc(core->arena, sizeof *fn);
    if (!fn) ambit_lua_error(L, "out of memory");
    fn->signature = ambit_signature_read(core->arena, e->function[i].signature, &f);
    if (!fn->signature) ambit_lua_error(L, "plugin %s.%s, function %s: %s", kind, name, e->function[i].name, f.message);
    fn->call = e->function[i].call;
    fn->name = e->function[i].name;
    lua_pushlightuserdata(L, fn);
    ambit_lua_push_function(L, core, call, 1);
    lua_setfield(L, -3, fn->name);
    lua_createtable(L, 0, 2);
    lua_pushstring(L, e->function[i].signature);
    lua_setfield(L, -2, "signature");
    lua_pushstring(L, e->function[i].doc);
    lua_setfield(L, -2, "doc");
    lua_setfield(L, -2, fn->name);
  }
  return 2;
}

void ambit_lua_open_foreign(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "exports", exports }, { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
