/* events_lua.c -- events between Lua and the kernel's watch. */
#include "verbs/event/events_lua.h"
#include "script/request.h"
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

static lua_Integer integer_at(lua_State *L, int idx, size_t i) {
  lua_rawgeti(L, idx, (lua_Integer)i + 1);
  lua_Integer value = luaL_checkinteger(L, -1);
  lua_pop(L, 1);
  return value;
}

/* {name}, {g}, {direction}, {stop: 0 or 1}, {starts on the surface: 0 or 1}, {must leave it: 0 or 1} at first and
** behind it */
static ambit_event *read_events(lua_State *L, int first, size_t *n) {
  const char **name = ambit_lua_texts(L, first, n);
  ambit_expr *g = ambit_lua_to_array(L, first + 1, *n);
  ambit_event *event = lua_newuserdatauv(L, (*n + 1) * sizeof *event, 0);
  for (size_t k = 0; k < *n; k++)
    event[k] =
        (ambit_event) { name[k], g[k], (int32_t)integer_at(L, first + 2, k), (uint32_t)integer_at(L, first + 3, k),
          (uint32_t)integer_at(L, first + 4, k), (uint32_t)integer_at(L, first + 5, k) };
  return event;
}

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

/* events(system, {initial}, t_start, {name}, {g}, {direction}, {stop}, {starts_on}, {must_leave}, room, quiet, hold) */
static int events_new(lua_State *L) {
  const ambit_system *s = &ambit_lua_check_system(L, 1)->system;
  ambit_event_watch_request q = {
    .system = s, .t_start = luaL_checknumber(L, 3), .room = (size_t)luaL_checkinteger(L, 10)
  };
  bool quiet = lua_toboolean(L, 11), hold = lua_toboolean(L, 12);
  q.initial = ambit_lua_to_array(L, 2, s->nx);
  q.event = read_events(L, 4, &q.n);
  ambit_lua_events *w = push_events(L, s->nx);
  w->quiet = quiet;
  w->hold = hold;
  ambit_failure f = { 0 };
  if (ambit_event_watch_open(&q, &w->watch, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
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

ambit_lua_events *ambit_lua_find_events(lua_State *L, int first) {
  for (int i = first; i <= lua_gettop(L); i++) {
    ambit_lua_events *w = luaL_testudata(L, i, AMBIT_TYPE_EVENTS);
    if (w) return w;
  }
  return NULL;
}

void ambit_lua_events_begin(ambit_lua_events *w, ambit_simulate_request *q, ambit_receiver *to) {
  if (!w) return;
  w->sink = (ambit_sink) { sizeof(ambit_sink), emit, progress };
  w->to = to;
  if (w->quiet) to->records = NULL;
  if (w->hold) q->wish |= AMBIT_WISH_SET;
  q->wish |= AMBIT_WISH_DENSE;
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
  lua_createtable(L, 0, 6);
  ambit_lua_set_count(L, "event", e->event + 1);
  ambit_lua_set_text(L, "outcome", outcome_name(e->outcome));
  lua_pushboolean(L, e->rigorous != 0);
  lua_setfield(L, -2, "rigorous");
  ambit_lua_set_number(L, "direction", e->direction);
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
