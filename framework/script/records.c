/* records.c -- JSON lines from Lua: values and results; the steps of a run are written by its sink. */
#include "host/load.h"
#include "script/core.h"
#include "script/limit.h"
#include "script/provenance.h"
#include "host/slow.h"
#include <string.h>

/* -- the plugins that a record rests on stand before it */

static ambit_status write_plugin(ambit_records *r, const ambit_identity *id, ambit_failure *f) {
  ambit_records_begin(r, "plugin");
  ambit_records_text(r, "kind", id->kind);
  ambit_records_text(r, "name", id->name);
  ambit_records_text(r, "version", id->version);
  ambit_records_text(r, "file", id->file);
  ambit_records_text(r, "sha256", id->sha256);
  if (id->shadows) ambit_records_text(r, "shadows", "yes");
  return ambit_records_end(r, f);
}

static ambit_status write_plugins(void *user, ambit_failure *f) {
  ambit_lua *core = user;
  ambit_identity id;
  ambit_status status = AMBIT_OK;
  for (; core->recorded < ambit_registry_count(core->registry) && status == AMBIT_OK; core->recorded++) {
    status = ambit_provenance_plugin(core->registry, core->recorded, &id, f);
    if (status == AMBIT_OK) status = write_plugin(core->records, &id, f);
  }
  if (core->recorded_slow || status != AMBIT_OK || !ambit_slow_loaded()) return status;
  core->recorded_slow = true;
  status = ambit_provenance_slow(core->registry, &id, f);
  return status == AMBIT_OK ? write_plugin(core->records, &id, f) : status;
}

/* provenance_begin(): from now on each plugin is recorded before the first record that rests on it */
static int begin_provenance(lua_State *L) {
  ambit_lua *core = AMBIT_LUA(L);
  core->recorded = 0, core->recorded_slow = false;
  if (core->records) ambit_records_watch(core->records, write_plugins, core);
  return 0;
}

/* records_open(path): "-" is stdout */
static int open_records(lua_State *L) {
  ambit_lua *core = AMBIT_LUA(L);
  ambit_failure f = { 0 };
  if (core->records) ambit_lua_error(L, "records are being written already");
  if (ambit_records_open(luaL_checkstring(L, 1), &core->records, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  ambit_limit_records(core->records);
  return 0;
}

static int close_records(lua_State *L) {
  ambit_lua *core = AMBIT_LUA(L);
  ambit_failure f = { 0 };
  ambit_records *r = core->records;
  core->records = NULL;
  ambit_limit_records(NULL);
  if (r && ambit_records_close(r, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  return 0;
}

static void write_fields(lua_State *L, ambit_records *r, int idx);

static void write_field(lua_State *L, ambit_records *r, const char *key) {
  const ambit_lua_enclosure *x = luaL_testudata(L, -1, AMBIT_TYPE_ENCLOSURE);
  if (x) {
    ambit_records_interval(r, key, x->x);
  } else if (lua_istable(L, -1)) {
    ambit_records_open_object(r, key);
    write_fields(L, r, lua_gettop(L));
    ambit_records_close_object(r);
  } else if (lua_type(L, -1) == LUA_TNUMBER) {
    ambit_records_number(r, key, lua_tonumber(L, -1));
  } else if (lua_isboolean(L, -1)) {
    ambit_records_flag(r, key, lua_toboolean(L, -1));
  } else {
    ambit_records_text(r, key, luaL_tolstring(L, -1, NULL));
    lua_pop(L, 1);
  }
}

/* {key, value, key, value, ...}: the order is the order in the line */
static void write_fields(lua_State *L, ambit_records *r, int idx) {
  lua_Integer n = luaL_len(L, idx);
  luaL_checkstack(L, 8, "records nested too deeply");
  for (lua_Integer i = 1; i < n; i += 2) {
    lua_rawgeti(L, idx, i);
    const char *key = luaL_checkstring(L, -1);
    lua_rawgeti(L, idx, i + 1);
    write_field(L, r, key);
    lua_pop(L, 2);
  }
}

/* record(kind, {key, value, ...}): a value is a text, a number, an enclosure or a list of the same form */
static int record(lua_State *L) {
  ambit_lua *core = AMBIT_LUA(L);
  ambit_failure f = { 0 };
  const char *kind = luaL_checkstring(L, 1);
  luaL_checktype(L, 2, LUA_TTABLE);
  if (!core->records) return 0;
  if (strcmp(kind, "end") == 0) ambit_limit_records(NULL); /* it is the last one */
  ambit_records_begin(core->records, kind);
  write_fields(L, core->records, 2);
  if (ambit_records_end(core->records, &f) != AMBIT_OK && f.status != AMBIT_OK)
    ambit_lua_raise(L, &f); /* reported once */
  ambit_limit_recorded(core->records);
  return 0;
}

static int recording(lua_State *L) {
  lua_pushboolean(L, AMBIT_LUA(L)->records != NULL);
  return 1;
}

/* record_shift(enclosure): of the times of the runs that follow */
static int record_shift(lua_State *L) {
  ambit_lua *core = AMBIT_LUA(L);
  if (core->records) ambit_records_shift(core->records, ambit_lua_to_enclosure(L, 1, "record_shift").x);
  return 0;
}

static int hold_records(lua_State *L) {
  ambit_lua *core = AMBIT_LUA(L);
  if (core->records) ambit_records_hold(core->records);
  return 0;
}

/* records_release(keep): what was recorded since records_hold() is written, or dropped */
static int release_records(lua_State *L) {
  ambit_lua *core = AMBIT_LUA(L);
  ambit_failure f = { 0 };
  bool keep = lua_toboolean(L, 1);
  if (core->records && ambit_records_release(core->records, keep, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  return 0;
}

void ambit_lua_open_records(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "records_open", open_records }, { "records_close", close_records },
    { "record", record }, { "provenance_begin", begin_provenance }, { "recording", recording },
    { "record_shift", record_shift }, { "records_hold", hold_records }, { "records_release", release_records },
    { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
