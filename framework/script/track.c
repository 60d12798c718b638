/* track.c -- the recorded steps of a run. */
#include "script/track.h"
#include "base/vector.h"
#include "verbs/run/dense.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define FIRST_STEPS 4096 /* most runs never grow their track */

static ambit_track *self(lua_State *L) { return luaL_checkudata(L, 1, AMBIT_TYPE_TRACK); }

static int close(lua_State *L) {
  ambit_track *track = self(L);
  free(track->step);
  free(track->value);
  free(track->dense);
  ambit_held_set_clear(&track->set);
  memset(track, 0, sizeof *track);
  return ambit_lua_retire(L);
}

static bool reserve(ambit_track *track, size_t steps) {
  void *step = ambit_vector_reserve(track->step, &track->room_steps, steps, sizeof *track->step);
  if (!step) return false;
  track->step = step;
  void *value = ambit_vector_reserve(track->value, &track->room_values, steps * 4 * track->nx, sizeof *track->value);
  if (!value) return false;
  track->value = value;
  return true;
}

ambit_track *ambit_track_push(lua_State *L, size_t nx, uint32_t keep) {
  ambit_track *track = lua_newuserdatauv(L, sizeof *track, 0);
  memset(track, 0, sizeof *track);
  track->nx = nx;
  track->keep = keep;
  luaL_setmetatable(L, AMBIT_TYPE_TRACK);
  if (!reserve(track, keep & AMBIT_TRACK_LAST ? 2 : FIRST_STEPS)) ambit_lua_error(L, "out of memory");
  return track;
}

/* Where only the last step is wanted, the next one takes its place. */
static void forget_last(ambit_track *track) {
  if (!(track->keep & AMBIT_TRACK_LAST) || !track->count) return;
  if (track->step[track->count - 1].kind != AMBIT_REC_STEP) return;
  track->count--;
  if (track->step[track->count].ndense) track->count_dense = track->step[track->count].dense;
}

static bool append_dense(ambit_track *track, ambit_track_step *step, const ambit_record *r) {
  if (!(track->keep & AMBIT_TRACK_DENSE) || !r->ndense || !r->dense_mid || !r->dense_rad) return true;
  size_t n = track->nx * r->ndense, columns = r->dense_column ? track->nx * r->ncolumn * r->ncoef_column : 0;
  size_t end = track->count_dense + 2 * n + columns;
  double *dense = ambit_vector_reserve(track->dense, &track->room_dense, end, sizeof *dense);
  if (!dense) return false;
  track->dense = dense;
  step->ndense = r->ndense;
  step->ncolumn = columns ? r->ncolumn : 0;
  step->ncoef_column = r->ncoef_column;
  step->dense = track->count_dense;
  memcpy(dense + step->dense, r->dense_mid, n * sizeof *dense);
  memcpy(dense + step->dense + n, r->dense_rad, n * sizeof *dense);
  if (columns) memcpy(dense + step->dense + 2 * n, r->dense_column, columns * sizeof *dense);
  track->count_dense = end;
  return true;
}

static bool append_step(ambit_track *track, ambit_track_step *step, const ambit_record *r) {
  forget_last(track);
  return append_dense(track, step, r) && ambit_held_set_put(&track->set, r->nx, r->set);
}

bool ambit_track_append(ambit_track *track, const ambit_record *r) {
  size_t nx = track->nx, bytes = nx * sizeof(double);
  bool tube = r->tube_lo && r->tube_hi;
  ambit_track_step step = { .t_from = r->t_from, .t_to = r->t_to, .kind = r->kind, .event = r->event };
  step.flags = r->flags;
  step.order = r->order;
  step.tube = tube;
  if (r->kind == AMBIT_REC_STEP && !append_step(track, &step, r)) return false;
  if (!reserve(track, track->count + 1)) return false;
  double *value = track->value + track->count * 4 * nx;
  track->step[track->count++] = step;
  memcpy(value, r->lo, bytes);
  memcpy(value + nx, r->hi, bytes);
  if (tube) {
    memcpy(value + 2 * nx, r->tube_lo, bytes);
    memcpy(value + 3 * nx, r->tube_hi, bytes);
  }
  return true;
}

static const ambit_track_step *step_at(lua_State *L, const ambit_track *track, size_t *i) {
  lua_Integer n = luaL_checkinteger(L, 2);
  if (n < 1 || (size_t)n > track->count) ambit_lua_error(L, "there is no step %d", (int)n);
  *i = (size_t)n - 1;
  return &track->step[*i];
}

/* track_step(track, i) -> t_from, t_to, kind, event, order, has tube */
static int step(lua_State *L) {
  size_t i;
  const ambit_track_step *s = step_at(L, self(L), &i);
  lua_pushnumber(L, s->t_from);
  lua_pushnumber(L, s->t_to);
  lua_pushstring(L, s->kind == AMBIT_REC_EVENT ? "event" : "step");
  lua_pushinteger(L, s->event);
  lua_pushinteger(L, s->order);
  lua_pushboolean(L, s->tube);
  return 6;
}

/* track_value(track, i, state, tube) -> enclosure */
static int value(lua_State *L) {
  size_t i;
  const ambit_track *track = self(L);
  const ambit_track_step *s = step_at(L, track, &i);
  size_t state = (size_t)luaL_checkinteger(L, 3) - 1;
  bool tube = lua_toboolean(L, 4);
  if (state >= track->nx || (tube && !s->tube)) return 0;
  const double *v = track->value + i * 4 * track->nx + (tube ? 2 * track->nx : 0) + state;
  ambit_lua_push_enclosure(L, (ambit_interval) { v[0], v[track->nx] }, s->flags);
  return 1;
}

/* track_dense(track, i, state, t [, till]) -> enclosure at a time, or all times up to `till`, within the step; nil if
** it has no dense enclosure */
static int dense(lua_State *L) {
  size_t i;
  const ambit_track *track = self(L);
  const ambit_track_step *s = step_at(L, track, &i);
  size_t state = (size_t)luaL_checkinteger(L, 3) - 1, nx = track->nx, n = nx * s->ndense;
  double t = luaL_checknumber(L, 4), till = luaL_optnumber(L, 5, t);
  if (state >= nx || !s->ndense) return 0;
  const double *v = track->value + i * 4 * nx;
  const ambit_record r = { .t_from = s->t_from,
    .tube_lo = s->tube ? v + 2 * nx : NULL,
    .tube_hi = s->tube ? v + 3 * nx : NULL,
    .ndense = s->ndense,
    .ncolumn = s->ncolumn,
    .ncoef_column = s->ncoef_column,
    .dense_mid = track->dense + s->dense,
    .dense_rad = track->dense + s->dense + n,
    .dense_column = track->dense + s->dense + 2 * n };
  ambit_lua_push_enclosure(L, ambit_dense_state(&r, (uint32_t)state, (ambit_interval) { t, till }), s->flags);
  return 1;
}

/* track_set(track) -> {expression, ...}: the states at the end as functions of the run's unknowns; nil: not known */
static int set(lua_State *L) {
  const ambit_track *track = self(L);
  if (!track->set.set.nterm) return 0;
  ambit_expr *x = lua_newuserdatauv(L, track->nx * sizeof *x, 0);
  ambit_held_set_express(&track->set, AMBIT_LUA(L)->graph, track->nx, x);
  ambit_lua_push_expressions(L, track->nx, x);
  return 1;
}

/* The width of state i that the terms of degree 1 give over the box of the unknowns. */
static double linear_width(const ambit_set *s, size_t i) {
  double sum = 0;
  for (size_t t = 0; t < s->nterm; t++) {
    uint64_t degree = 0;
    for (size_t j = 0; j < s->nu; j++) degree += s->exponent[t * s->nu + j];
    if (degree == 1) sum += fabs(s->coefficient[i * s->nterm + t]);
  }
  return 2 * sum;
}

/* track_linear(track) -> {width of state i to first order in the run's unknowns, ...}, at the end; nil: not known */
static int linear(lua_State *L) {
  const ambit_track *track = self(L);
  const ambit_set *s = &track->set.set;
  if (!s->nterm) return 0;
  lua_createtable(L, (int)track->nx, 0);
  for (size_t i = 0; i < track->nx; i++) {
    lua_pushnumber(L, linear_width(s, i));
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  return 1;
}

static bool join(ambit_track *track, const ambit_track *more) {
  size_t nx = track->nx, n = more->count, nd = more->count_dense;
  if (!reserve(track, track->count + n)) return false;
  double *dense = ambit_vector_reserve(track->dense, &track->room_dense, track->count_dense + nd + 1, sizeof *dense);
  if (!dense) return false;
  track->dense = dense;
  if (nd) memcpy(dense + track->count_dense, more->dense, nd * sizeof *dense);
  memcpy(track->value + track->count * 4 * nx, more->value, n * 4 * nx * sizeof *track->value);
  for (size_t i = 0; i < n; i++) {
    track->step[track->count + i] = more->step[i];
    track->step[track->count + i].dense += track->count_dense;
  }
  track->count += n;
  track->count_dense += nd;
  return true;
}

/* track_join(track, more): the steps of `more`, which go on from its end, behind its own. The set at the end becomes
** that of `more`, which gets the other one: it is not to be used any more. */
static int extend(lua_State *L) {
  ambit_track *track = self(L), *more = luaL_checkudata(L, 2, AMBIT_TYPE_TRACK);
  if (more == track || more->nx != track->nx) ambit_lua_error(L, "these tracks do not go together");
  if (!join(track, more)) ambit_lua_error(L, "out of memory");
  ambit_held_set_swap(&track->set, &more->set);
  return 0;
}

static int count(lua_State *L) {
  lua_pushinteger(L, (lua_Integer)self(L)->count);
  return 1;
}

/* track_find(track, t) -> first step with t between its ends (nil: none), whether t is its very end. Steps ascend or
** descend. */
static int find(lua_State *L) {
  const ambit_track *track = self(L);
  double t = luaL_checknumber(L, 2);
  size_t lo = 0, hi = track->count;
  if (!hi) return 0;
  double sign = track->step[hi - 1].t_to < track->step[0].t_from ? -1 : 1;
  while (lo < hi) {
    size_t mid = lo + (hi - lo) / 2;
    if (track->step[mid].t_to * sign < t * sign)
      lo = mid + 1;
    else
      hi = mid;
  }
  while (lo < track->count && track->step[lo].kind != AMBIT_REC_STEP) lo++;
  if (lo == track->count || t * sign < track->step[lo].t_from * sign) return 0;
  lua_pushinteger(L, (lua_Integer)lo + 1);
  lua_pushboolean(L, track->step[lo].t_to == t);
  return 2;
}

void ambit_lua_open_track(lua_State *L, ambit_lua *core) {
  static const luaL_Reg meta[] = { { "__gc", close }, { NULL, NULL } };
  static const luaL_Reg functions[] = { { "track_step", step }, { "track_value", value }, { "track_count", count },
    { "track_find", find }, { "track_dense", dense }, { "track_set", set }, { "track_linear", linear },
    { "track_join", extend }, { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
  ambit_lua_new_type(L, core, AMBIT_TYPE_TRACK, meta);
  lua_pop(L, 1);
}
