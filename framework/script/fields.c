/* fields.c -- requests and results of verbs as declared data. */
#include "script/fields.h"
#include "script/request.h"
#include <string.h>

/* -- tables to structs. The value of the field is on top of the stack. */

static _Noreturn void refuse(lua_State *L, const char *what, const ambit_lua_field *f, const char *expected) {
  ambit_lua_error(L, "core.%s: `%s`: expected %s, got %s", what, f->key, expected, luaL_typename(L, -1));
}

static lua_Integer whole(lua_State *L, const char *what, const ambit_lua_field *f, lua_Integer least) {
  int is_whole;
  lua_Integer n = lua_tointegerx(L, -1, &is_whole);
  if (!is_whole || n < least) refuse(L, what, f, least ? "a whole number" : "a whole number that is not negative");
  return n;
}

static uint32_t choice(lua_State *L, const char *what, const ambit_lua_field *f) {
  const char *const *name = f->of, *text = lua_tostring(L, -1);
  for (uint32_t k = 0; text && name[k]; k++)
    if (strcmp(name[k], text) == 0) return k;
  refuse(L, what, f, "one of its words");
}

static uint32_t small(lua_State *L, const char *what, const ambit_lua_field *f) {
  lua_Integer n = whole(L, what, f, 0);
  if (n > UINT32_MAX) refuse(L, what, f, "a smaller number");
  return (uint32_t)n;
}

static double number(lua_State *L, const char *what, const ambit_lua_field *f) {
  if (!lua_isnumber(L, -1)) refuse(L, what, f, "a number");
  return lua_tonumber(L, -1);
}

static const char *text(lua_State *L, const char *what, const ambit_lua_field *f) {
  if (lua_type(L, -1) != LUA_TSTRING) refuse(L, what, f, "a text");
  return lua_tostring(L, -1); /* the table keeps it */
}

static void read_one(lua_State *L, const char *what, const ambit_lua_field *f, void *at) {
  switch (f->kind) {
  case AMBIT_LUA_TEXT: *(const char **)at = text(L, what, f); break;
  case AMBIT_LUA_NUMBER: *(double *)at = number(L, what, f); break;
  case AMBIT_LUA_COUNT: *(uint32_t *)at = small(L, what, f); break;
  case AMBIT_LUA_SIGN: *(int32_t *)at = (int32_t)whole(L, what, f, -1); break;
  case AMBIT_LUA_SIZE: *(size_t *)at = (size_t)whole(L, what, f, 0); break;
  case AMBIT_LUA_WORK: *(uint64_t *)at = (uint64_t)whole(L, what, f, LUA_MININTEGER); break;
  case AMBIT_LUA_FLAG: *(bool *)at = lua_toboolean(L, -1); break;
  case AMBIT_LUA_SWITCH: *(uint32_t *)at = lua_toboolean(L, -1) != 0; break;
  case AMBIT_LUA_CHOICE: *(uint32_t *)at = choice(L, what, f); break;
  default: *(ambit_expr *)at = ambit_lua_to_expression(L, -1, NULL, f->key).e; break;
  }
  lua_pop(L, 1);
}

static ambit_interval *enclosures(lua_State *L, int idx, size_t n) {
  ambit_interval *x = lua_newuserdatauv(L, (n + 1) * sizeof *x, 0);
  for (size_t i = 0; i < n; i++) {
    lua_rawgeti(L, idx, (lua_Integer)i + 1);
    x[i] = ((const ambit_lua_enclosure *)luaL_checkudata(L, -1, AMBIT_TYPE_ENCLOSURE))->x;
    lua_pop(L, 1);
  }
  return x;
}

/* What the rows point to must live as long as they: it is kept in one table, so that the stack does not grow. */
static void *rows(lua_State *L, const char *what, int idx, const ambit_lua_fields *of, size_t n) {
  char *row = lua_newuserdatauv(L, (n + 1) * of->size, 0);
  memset(row, 0, (n + 1) * of->size);
  lua_newtable(L);
  int keep = lua_gettop(L);
  for (size_t i = 0; i < n; i++) {
    lua_rawgeti(L, idx, (lua_Integer)i + 1);
    ambit_lua_read(L, lua_gettop(L), what, of, row + i * of->size);
    while (lua_gettop(L) > keep) luaL_ref(L, keep);
  }
  return row;
}

static void *list(lua_State *L, const char *what, const ambit_lua_field *f, size_t n) {
  int idx = lua_gettop(L);
  switch (f->kind) {
  case AMBIT_LUA_TEXTS: return ambit_lua_texts(L, idx, &n);
  case AMBIT_LUA_NUMBERS: return ambit_lua_numbers(L, idx, &n);
  case AMBIT_LUA_EXPRESSIONS: return ambit_lua_to_array(L, idx, n);
  case AMBIT_LUA_ENCLOSURES: return enclosures(L, idx, n);
  case AMBIT_LUA_OPTIONS: return ambit_lua_options(L, idx, &n);
  default: return rows(L, what, idx, f->of, n);
  }
}

static void read_list(lua_State *L, const char *what, const ambit_lua_field *f, char *to) {
  size_t *count = (size_t *)(void *)(to + f->count);
  if (lua_type(L, -1) != LUA_TTABLE) refuse(L, what, f, "a list");
  size_t n = (size_t)luaL_len(L, -1) / (f->kind == AMBIT_LUA_OPTIONS ? 2 : 1);
  if ((f->flags & AMBIT_LUA_SAME) && n != *count)
    ambit_lua_error(L, "core.%s: `%s` has %d entries, not %d", what, f->key, (int)n, (int)*count);
  *count = n;
  void *made = list(L, what, f, n);
  memcpy(to + f->at, &made, sizeof made); /* a pointer of any type */
}

static void check_keys(lua_State *L, int idx, const char *what, const ambit_lua_fields *fields) {
  for (lua_pushnil(L); lua_next(L, idx); lua_pop(L, 1)) {
    const char *key = lua_type(L, -2) == LUA_TSTRING ? lua_tostring(L, -2) : "?";
    size_t i = 0;
    while (i < fields->n && strcmp(fields->field[i].key, key) != 0) i++;
    if (i == fields->n) ambit_lua_error(L, "core.%s: there is no field `%s`", what, key);
  }
}

void ambit_lua_read(lua_State *L, int idx, const char *what, const ambit_lua_fields *fields, void *to) {
  if (lua_type(L, idx) != LUA_TTABLE)
    ambit_lua_error(L, "core.%s: expected a table of fields, got %s", what, luaL_typename(L, idx));
  luaL_checkstack(L, 3 * (int)fields->n + 8, what);
  check_keys(L, idx, what, fields);
  for (size_t i = 0; i < fields->n; i++) {
    const ambit_lua_field *f = &fields->field[i];
    if (lua_getfield(L, idx, f->key) == LUA_TNIL) {
      lua_pop(L, 1);
      if (f->flags & AMBIT_LUA_NEEDED) ambit_lua_error(L, "core.%s: `%s` is missing", what, f->key);
    } else if (f->kind == AMBIT_LUA_OTHER) {
      lua_pop(L, 1);
    } else if (f->kind >= AMBIT_LUA_TEXTS) {
      read_list(L, what, f, to);
    } else {
      read_one(L, what, f, (char *)to + f->at);
    }
  }
}

/* -- structs to tables */

static void push_rows(lua_State *L, const ambit_lua_field *f, const char *from) {
  const ambit_lua_fields *of = f->of;
  const char *row;
  size_t n;
  memcpy(&row, from + f->at, sizeof row);
  memcpy(&n, from + f->count, sizeof n);
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    ambit_lua_push(L, of, row + i * of->size);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
}

static void push_numbers(lua_State *L, const ambit_lua_field *f, const char *from) {
  const double *x;
  size_t n;
  memcpy(&x, from + f->at, sizeof x);
  memcpy(&n, from + f->count, sizeof n);
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    lua_pushnumber(L, x[i]);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
}

static bool is_left_out(const ambit_lua_field *f, const void *at) {
  return (f->kind == AMBIT_LUA_BUFFER && !*(const char *)at) ||
         (f->kind == AMBIT_LUA_TEXT && !*(const char *const *)at) ||
         (f->kind == AMBIT_LUA_ENCLOSURE && ambit_interval_is_empty(*(const ambit_interval *)at));
}

static void push_one(lua_State *L, const ambit_lua_field *f, const void *at, const char *from) {
  switch (f->kind) {
  case AMBIT_LUA_TEXT: lua_pushstring(L, *(const char *const *)at); break;
  case AMBIT_LUA_BUFFER: lua_pushstring(L, at); break;
  case AMBIT_LUA_NUMBER: lua_pushnumber(L, *(const double *)at); break;
  case AMBIT_LUA_COUNT: lua_pushinteger(L, *(const uint32_t *)at); break;
  case AMBIT_LUA_SIGN: lua_pushinteger(L, *(const int32_t *)at); break;
  case AMBIT_LUA_SIZE: lua_pushinteger(L, (lua_Integer) * (const size_t *)at); break;
  case AMBIT_LUA_WORK: lua_pushinteger(L, (lua_Integer) * (const uint64_t *)at); break;
  case AMBIT_LUA_FLAG: lua_pushboolean(L, *(const bool *)at); break;
  case AMBIT_LUA_SWITCH: lua_pushboolean(L, *(const uint32_t *)at != 0); break;
  case AMBIT_LUA_ENCLOSURE: ambit_lua_push_enclosure(L, *(const ambit_interval *)at, 0); break;
  case AMBIT_LUA_NUMBERS: push_numbers(L, f, from); break;
  default: push_rows(L, f, from); break;
  }
}

void ambit_lua_write(lua_State *L, const ambit_lua_fields *fields, const void *from) {
  for (size_t i = 0; i < fields->n; i++) {
    const ambit_lua_field *f = &fields->field[i];
    const char *at = (const char *)from + f->at;
    if (is_left_out(f, at)) continue;
    push_one(L, f, at, from);
    lua_setfield(L, -2, f->key);
  }
}

void ambit_lua_push(lua_State *L, const ambit_lua_fields *fields, const void *from) {
  lua_createtable(L, 0, (int)fields->n);
  ambit_lua_write(L, fields, from);
}
