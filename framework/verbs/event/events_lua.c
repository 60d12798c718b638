/* events_lua.c -- events between Lua and the kernel's watch. */
#include "verbs/event/events_lua.h"
#include "script/fields.h"
#include "models/system_lua.h"
#include <stdlib.h>
#include <string.h>

static ambit_lua_events *self(lua_State *L) { return luaL_checkudata(L, 1, AMBIT_TYPE_EVENTS); }

static int release(lua_State *L) {
  ambit_lua_events *w = self(L);
  ambit_event_watch_close(w->watch);
  ambit_held_set_clear(&w->set);
  free(w->lo);
  memset(w, 0, sizeof *w);
  return ambit_lua_retire(L);
}

/* -- making one */

static ambit_lua_events *push_events(lua_State *L, size_t nx) {
  ambit_lua_events *w = lua_newuserdatauv(L, sizeof *w, 0);
  memset(w, 0, sizeof *w);
  luaL_setmetatable(L, AMBIT_TYPE_EVENTS);
  w->nx = nx;
  w->lo = calloc(2 * nx + 1, sizeof *w->lo);
  if (!w->lo) ambit_lua_error(L, "out of memory");
  w->hi = w->lo + nx;
  return w;
}

/* What events are looked for: those of `list`, of the run of `system` from `initial` at `start`. room: most that are
** kept; quiet: the run writes no records; hold: keep the set before the event that ends it. */
typedef struct settings {
  ambit_event_watch_request q;
  size_t nx;
  bool quiet, hold;
} settings;

static settings read_settings(lua_State *L, int idx) {
#define ONE(key, kind, member) AMBIT_LUA_ONE(ambit_event, key, kind, 0, member)
  static const ambit_lua_field event[] = { ONE("name", AMBIT_LUA_TEXT, name), ONE("g", AMBIT_LUA_EXPRESSION, g),
    ONE("direction", AMBIT_LUA_SIGN, direction), ONE("stop", AMBIT_LUA_SWITCH, stop),
    ONE("starts_on", AMBIT_LUA_SWITCH, starts_on), ONE("must_leave", AMBIT_LUA_SWITCH, must_leave) };
#undef ONE
  static const ambit_lua_fields events = AMBIT_LUA_FIELDS(ambit_event, event);
  static const ambit_lua_field field[] = { { .key = "system", .kind = AMBIT_LUA_OTHER },
    AMBIT_LUA_LIST(settings, "initial", AMBIT_LUA_EXPRESSIONS, AMBIT_LUA_NEEDED | AMBIT_LUA_SAME, q.initial, nx),
    AMBIT_LUA_ONE(settings, "start", AMBIT_LUA_NUMBER, AMBIT_LUA_NEEDED, q.t_start),
    { "list", AMBIT_LUA_ROWS, AMBIT_LUA_NEEDED, offsetof(settings, q.event), offsetof(settings, q.n), &events },
    AMBIT_LUA_ONE(settings, "room", AMBIT_LUA_SIZE, AMBIT_LUA_NEEDED, q.room),
    AMBIT_LUA_ONE(settings, "quiet", AMBIT_LUA_FLAG, 0, quiet),
    AMBIT_LUA_ONE(settings, "hold", AMBIT_LUA_FLAG, 0, hold) };
  static const ambit_lua_fields fields = AMBIT_LUA_FIELDS(settings, field);
  luaL_checktype(L, idx, LUA_TTABLE);
  lua_getfield(L, idx, "system");
  const ambit_system *s = &ambit_lua_check_system(L, lua_gettop(L))->system;
  settings w = { .q = { .system = s }, .nx = s->nx };
  ambit_lua_read(L, idx, "events", &fields, &w);
  return w;
}

/* events(settings) -> what looks for them */
static int events_new(lua_State *L) {
  settings wanted = read_settings(L, 1);
  ambit_lua_events *w = push_events(L, wanted.nx);
  w->quiet = wanted.quiet;
  w->hold = wanted.hold;
  ambit_failure f = { 0 };
  if (ambit_event_watch_open(&wanted.q, &w->watch, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  return 1;
}

/* -- while the solver runs */

static bool hold(ambit_lua_events *w, const ambit_record *r) {
  const ambit_held_set *now = &w->to->track->set;
  if (!w->set.unknown && !ambit_held_set_begin(&w->set, w->to->graph, now->nu, now->unknown)) return false;
  if (!ambit_held_set_put(&w->set, r->nx, r->set)) return false;
  memcpy(w->lo, r->lo, r->nx * sizeof *w->lo);
  memcpy(w->hi, r->hi, r->nx * sizeof *w->hi);
  w->t_held = r->t_to;
  w->has_held = true;
  return true;
}

static int32_t emit(ambit_sink *s, const ambit_record *r) {
  ambit_lua_events *w = (ambit_lua_events *)(void *)s;
  if (w->hold && r->kind == AMBIT_REC_STEP && !w->frozen) {
    w->frozen = ambit_event_watch_stopped_by(w->watch) != SIZE_MAX;
    if (!w->frozen && !ambit_event_watch_is_open(w->watch) && !hold(w, r)) {
      ambit_fail(&w->to->failure, AMBIT_NOMEM, "out of memory for the records of this run");
      return 1;
    }
  }
  return w->to->sink.emit(&w->to->sink, r);
}

static int32_t progress(ambit_sink *s, double done, const char *message) {
  ambit_sink *outer = &((ambit_lua_events *)(void *)s)->to->sink;
  return outer->progress(outer, done, message);
}

void ambit_lua_events_begin(ambit_lua_events *w, ambit_simulate_request *q, ambit_receiver *to) {
  if (!w) return;
  w->sink = (ambit_sink) { sizeof(ambit_sink), emit, progress };
  w->to = to;
  if (w->quiet) to->records = NULL;
  if (w->hold) q->extras |= AMBIT_EXTRA_SET;
  q->extras |= AMBIT_EXTRA_DENSE;
  q->sink = ambit_event_watch_sink(w->watch, &w->sink);
}

void ambit_lua_events_end(ambit_lua_events *w) {
  if (!w) return;
  w->frozen = true;
  ambit_event_watch_end(w->watch);
  w->to = NULL;
}

/* -- reading it */

static const char *outcome_name(uint32_t outcome) {
  static const char *const names[] = { "", "crossed", "crosses", "touches", "part", "starts", "edge" };
  return names[outcome];
}

static void push_found(lua_State *L, const ambit_lua_events *w, const ambit_event_found *e) {
#define ONE(key, kind, member) AMBIT_LUA_ONE(ambit_event_found, key, kind, 0, member)
  static const ambit_lua_field field[] = { ONE("rigorous", AMBIT_LUA_SWITCH, rigorous),
    ONE("direction", AMBIT_LUA_SIGN, direction) };
#undef ONE
  static const ambit_lua_fields fields = AMBIT_LUA_FIELDS(ambit_event_found, field);
  lua_createtable(L, 0, 6);
  ambit_lua_write(L, &fields, e);
  lua_pushinteger(L, (lua_Integer)e->event + 1);
  lua_setfield(L, -2, "event");
  lua_pushstring(L, outcome_name(e->outcome));
  lua_setfield(L, -2, "outcome");
  ambit_lua_push_enclosure(L, (ambit_interval) { e->t_lo, e->t_hi }, 0);
  lua_setfield(L, -2, "t");
  lua_createtable(L, (int)w->nx, 0);
  for (size_t i = 0; i < w->nx; i++) {
    ambit_lua_push_enclosure(L, (ambit_interval) { e->lo[i], e->hi[i] }, 0);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  lua_setfield(L, -2, "x");
}

/* events_found(events) -> {{event, outcome, rigorous, direction, t, x}, ...}, index of the one that ended the run or
** nil, were there more than there is room for */
static int found(lua_State *L) {
  const ambit_lua_events *w = self(L);
  size_t n = ambit_event_watch_count(w->watch), by = ambit_event_watch_stopped_by(w->watch);
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    push_found(L, w, ambit_event_watch_found(w->watch, i));
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  if (by == SIZE_MAX)
    lua_pushnil(L);
  else
    lua_pushinteger(L, (lua_Integer)by + 1);
  lua_pushboolean(L, ambit_event_watch_is_full(w->watch));
  return 3;
}

/* events_set(events) -> t, {expression}: where the run was at the end of the last step before the event that ended it
** may have begun; nil: that is its start */
static int set(lua_State *L) {
  const ambit_lua_events *w = self(L);
  ambit_graph *g = AMBIT_LUA(L)->graph;
  if (!w->has_held) return 0;
  lua_pushnumber(L, w->t_held);
  ambit_expr *x = lua_newuserdatauv(L, (w->nx + 1) * sizeof *x, 0);
  if (w->set.set.nterm)
    ambit_held_set_express(&w->set, g, w->nx, x);
  else
    for (size_t i = 0; i < w->nx; i++)
      x[i] = ambit_graph_datum(g, NULL, NULL, (ambit_interval) { w->lo[i], w->hi[i] }, AMBIT_EMPTY);
  ambit_lua_push_expressions(L, w->nx, x);
  lua_remove(L, -2);
  return 2;
}

void ambit_lua_open_events(lua_State *L, ambit_lua *core) {
  static const luaL_Reg meta[] = { { "__gc", release }, { NULL, NULL } };
  static const luaL_Reg functions[] = { { "events", events_new }, { "events_found", found }, { "events_set", set },
    { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
  ambit_lua_new_type(L, core, AMBIT_TYPE_EVENTS, meta);
  lua_pop(L, 1);
}
