/* multibody_lua.c -- the Lua module `multibody` of the tests: the oracle's accelerations, and motions. */
#include "multibody.h"
#include <lauxlib.h>
#include <lua.h>
#include <string.h>

static multibody_real number(lua_State *L, int idx, const char *key) {
  lua_getfield(L, idx, key);
  multibody_real x = luaL_optnumber(L, -1, 0);
  lua_pop(L, 1);
  return x;
}

static int integer(lua_State *L, int idx, const char *key) {
  lua_getfield(L, idx, key);
  int x = (int)luaL_checkinteger(L, -1);
  lua_pop(L, 1);
  return x;
}

/* The list at `key`, or zeros. */
static void numbers(lua_State *L, int idx, const char *key, int n, multibody_real *x) {
  bool there = lua_getfield(L, idx, key) == LUA_TTABLE;
  for (int i = 0; i < n; i++) {
    x[i] = 0;
    if (!there) continue;
    lua_geti(L, -1, i + 1);
    x[i] = luaL_checknumber(L, -1);
    lua_pop(L, 1);
  }
  lua_pop(L, 1);
}

static void flags(lua_State *L, int idx, const char *key, int n, bool *x) {
  bool there = lua_getfield(L, idx, key) == LUA_TTABLE;
  for (int i = 0; i < n; i++) {
    x[i] = there && lua_geti(L, -1, i + 1) != LUA_TNIL && lua_toboolean(L, -1);
    if (there) lua_pop(L, 1);
  }
  lua_pop(L, 1);
}

static void read_body(lua_State *L, int at, multibody_body *b) {
  b->parent = integer(L, at, "parent") - 1; /* 0: the world */
  lua_getfield(L, at, "slides");
  b->slides = lua_toboolean(L, -1);
  lua_pop(L, 1);
  numbers(L, at, "axis", 3, b->axis);
  numbers(L, at, "offset", 3, b->offset);
  numbers(L, at, "turn_axis", 3, b->turn_axis);
  numbers(L, at, "centre", 3, b->centre);
  numbers(L, at, "inertia", 6, b->inertia);
  b->turn = number(L, at, "turn");
  b->mass = number(L, at, "mass");
  b->torque = number(L, at, "torque");
  b->amplitude = number(L, at, "amplitude");
  b->rate = number(L, at, "rate");
  b->stiffness = number(L, at, "stiffness");
  b->rest = number(L, at, "rest");
  b->damping = number(L, at, "damping");
  b->armature = number(L, at, "armature");
  b->friction = number(L, at, "friction");
  b->creep = number(L, at, "creep");
  b->proportional = number(L, at, "proportional");
  b->derivative = number(L, at, "derivative");
  b->goal = number(L, at, "goal");
  b->swing = number(L, at, "swing");
  b->tempo = number(L, at, "tempo");
}

static int count(lua_State *L, const char *key, int most) {
  int n = 0;
  if (lua_getfield(L, 1, key) == LUA_TTABLE) n = (int)luaL_len(L, -1);
  lua_pop(L, 1);
  if (n > most) luaL_error(L, "multibody: at most %d %s", most, key);
  return n;
}

static void read_ties(lua_State *L, multibody *m) {
  for (int k = 0; k < m->ntie; k++) {
    lua_getfield(L, 1, "ties");
    lua_geti(L, -1, k + 1);
    int at = lua_gettop(L);
    m->tie[k] = (multibody_tie) { .follower = integer(L, at, "follower") - 1,
      .leader = integer(L, at, "leader") - 1,
      .ratio = number(L, at, "ratio"),
      .offset = number(L, at, "offset"),
      .swing = number(L, at, "swing"),
      .tempo = number(L, at, "tempo") };
    lua_pop(L, 2);
  }
}

static void read_mechanism(lua_State *L, multibody *m) {
  memset(m, 0, sizeof *m);
  m->n = count(L, "bodies", MULTIBODY_MOST);
  m->nloop = count(L, "loops", MULTIBODY_LOOPS);
  m->ntie = count(L, "ties", MULTIBODY_TIES);
  read_ties(L, m);
  numbers(L, 1, "gravity", 3, m->gravity);
  for (int i = 0; i < m->n; i++) {
    lua_getfield(L, 1, "bodies");
    lua_geti(L, -1, i + 1);
    read_body(L, lua_gettop(L), &m->body[i]);
    lua_pop(L, 2);
    if (m->body[i].parent >= i) luaL_error(L, "multibody: body %d comes before its parent", i + 1);
  }
  for (int i = 0; i < m->nloop; i++) {
    lua_getfield(L, 1, "loops");
    lua_geti(L, -1, i + 1);
    int at = lua_gettop(L);
    multibody_loop *l = &m->loop[i];
    l->a = integer(L, at, "a") - 1;
    l->b = integer(L, at, "b") - 1;
    numbers(L, at, "at_a", 3, l->at_a);
    numbers(L, at, "at_b", 3, l->at_b);
    flags(L, at, "along", 3, l->along);
    lua_pop(L, 2);
  }
}

static void push_states(lua_State *L, int n, const multibody_real *q, const multibody_real *v) {
  lua_createtable(L, 2 * n, 0);
  for (int i = 0; i < 2 * n; i++) {
    lua_pushnumber(L, (lua_Number)(i < n ? q[i] : v[i - n]));
    lua_rawseti(L, -2, i + 1);
  }
}

/* run { bodies, loops, ties, gravity, dependent, q, v, t, times, tolerance } -> { { q..., v... }, ... } at the times,
** which increase from t (0); nil, reason: there is no such motion. */
static int run(lua_State *L) {
  static multibody m; /* half a megabyte is much for a stack of the interpreter */
  multibody_real q[MULTIBODY_MOST], v[MULTIBODY_MOST], t = number(L, 1, "t"), tolerance = number(L, 1, "tolerance");
  bool dependent[MULTIBODY_MOST];
  read_mechanism(L, &m);
  numbers(L, 1, "q", m.n, q);
  numbers(L, 1, "v", m.n, v);
  flags(L, 1, "dependent", m.n, dependent);
  multibody_follow(&m, t, q, v);
  if (m.nloop && !multibody_close(&m, dependent, q, v)) return lua_pushnil(L), lua_pushliteral(L, "not closed"), 2;
  lua_getfield(L, 1, "times");
  int times = lua_gettop(L), n = (int)luaL_len(L, times);
  lua_createtable(L, n, 0);
  for (int k = 1; k <= n; k++) {
    lua_geti(L, times, k);
    multibody_real to = luaL_checknumber(L, -1);
    lua_pop(L, 1);
    if (!multibody_integrate(&m, t, to, tolerance, q, v)) return lua_pushnil(L), lua_pushliteral(L, "steps vanish"), 2;
    t = to;
    push_states(L, m.n, q, v);
    lua_rawseti(L, -2, k);
  }
  lua_pushinteger(L, (lua_Integer)m.evaluations);
  return 2;
}

/* accelerations { bodies, loops, ties, gravity, q, v, t } -> { a... }; nil, reason: singular */
static int accelerations(lua_State *L) {
  static multibody m;
  multibody_real q[MULTIBODY_MOST], v[MULTIBODY_MOST], a[MULTIBODY_MOST];
  read_mechanism(L, &m);
  numbers(L, 1, "q", m.n, q);
  numbers(L, 1, "v", m.n, v);
  if (!multibody_accelerations(&m, q, v, number(L, 1, "t"), a))
    return lua_pushnil(L), lua_pushliteral(L, "singular"), 2;
  lua_createtable(L, m.n, 0);
  for (int i = 0; i < m.n; i++) {
    lua_pushnumber(L, (lua_Number)a[i]);
    lua_rawseti(L, -2, i + 1);
  }
  return 1;
}

__attribute__((visibility("default"))) int luaopen_multibody(lua_State *L);
int luaopen_multibody(lua_State *L) {
  static const luaL_Reg functions[] = { { "accelerations", accelerations }, { "run", run }, { NULL, NULL } };
  luaL_newlib(L, functions);
  return 1;
}
