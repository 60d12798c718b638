/* system_lua.c -- x' = f(x, t) as a Lua value, from a mechanism or from equations written in Lua. */
#include "models/system_lua.h"
#include "algebra/implicit_change.h"
#include "graph/hull.h"
#include "graph/tape.h"
#include "script/request.h"
#include "verbs/run/unknowns.h"
#include <math.h>
#include <string.h>

static void mark(ambit_holder *holder, ambit_graph *g) {
  const ambit_system *s = &((const ambit_lua_system *)(const void *)holder)->system;
  if (s->state) ambit_graph_mark(g, s->nx, s->state);
  if (s->rate) ambit_graph_mark(g, s->nx, s->rate);
  if (s->invariant) ambit_graph_mark(g, s->ninvariant, s->invariant);
  for (size_t i = 0; i < s->njump; i++) {
    ambit_graph_mark(g, s->nx, s->jump[i].to);
    ambit_graph_mark(g, 1, &s->jump[i].period);
    ambit_graph_mark(g, 1, &s->jump[i].first);
  }
  const ambit_system_source *source = s->source;
  if (!source) return;
  if (source->mark) source->mark(source, g);
  if (source->rate) ambit_graph_mark(g, s->nx, source->rate);
  if (source->form.na == 0) return;
  ambit_graph_mark(g, source->form.na, source->form.unknown);
  ambit_graph_mark(g, source->form.na, source->form.residual);
  ambit_graph_mark(g, s->nx, source->form.rate);
}

ambit_lua_system *ambit_lua_push_system(lua_State *L) {
  ambit_lua_system *s = lua_newuserdatauv(L, sizeof *s, 1);
  memset(s, 0, sizeof *s);
  luaL_setmetatable(L, AMBIT_TYPE_SYSTEM);
  s->holder.mark = mark;
  ambit_graph_hold(AMBIT_LUA(L)->graph, &s->holder);
  s->arena = ambit_arena_open();
  if (!s->arena) ambit_lua_error(L, "out of memory");
  return s;
}

ambit_lua_system *ambit_lua_check_outline(lua_State *L, int idx) { return luaL_checkudata(L, idx, AMBIT_TYPE_SYSTEM); }

ambit_lua_system *ambit_lua_check_system(lua_State *L, int idx) {
  ambit_lua_system *s = ambit_lua_check_outline(L, idx);
  ambit_failure f = { 0 };
  if (ambit_system_rates(&s->system, &s->system.rate, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  return s;
}

static int close(lua_State *L) {
  ambit_lua_system *s = ambit_lua_check_outline(L, 1);
  ambit_graph_release(&s->holder);
  ambit_arena_close(s->arena);
  memset(s, 0, sizeof *s);
  return ambit_lua_retire(L);
}

static const char *text_at(lua_State *L, ambit_arena *arena, int idx, lua_Integer i) {
  lua_rawgeti(L, idx, i);
  const char *text = ambit_arena_text(arena, luaL_checkstring(L, -1));
  lua_pop(L, 1);
  if (!text) ambit_lua_error(L, "out of memory");
  return text;
}

/* {invariant}, {name} at 5 and 6, or nothing */
static void add_invariants(lua_State *L, ambit_lua_system *s) {
  if (lua_isnoneornil(L, 5)) return;
  size_t n = (size_t)luaL_len(L, 5);
  const char **name = ambit_arena_alloc(s->arena, n * sizeof *name);
  ambit_expr *g = ambit_arena_alloc(s->arena, n * sizeof *g);
  if (!name || !g) ambit_lua_error(L, "out of memory");
  if (n) memcpy(g, ambit_lua_to_array(L, 5, n), n * sizeof *g);
  for (size_t i = 0; i < n; i++) name[i] = text_at(L, s->arena, 6, (lua_Integer)i + 1);
  s->system.ninvariant = n;
  s->system.invariant = g;
  s->system.invariant_name = name;
}

static ambit_expr *list_at(lua_State *L, int idx, size_t *n) {
  *n = lua_isnoneornil(L, idx) ? 0 : (size_t)luaL_len(L, idx);
  return *n ? ambit_lua_to_array(L, idx, *n) : NULL;
}

/* system, {leaf}, {value}, {g} at 7 .. 10: what the system was made of, if its implicit form can follow */
static void add_implicit(lua_State *L, ambit_lua_system *s) {
  if (lua_isnoneornil(L, 7)) return;
  ambit_failure f = { 0 };
  ambit_implicit_change change = { .of = &ambit_lua_check_outline(L, 7)->system };
  size_t nvalue;
  change.leaf = list_at(L, 8, &change.n);
  change.value = list_at(L, 9, &nvalue);
  change.g = list_at(L, 10, &change.nfurther);
  luaL_argcheck(L, nvalue == change.n && s->system.nx == change.of->nx + change.nfurther, 7, "does not fit");
  s->system.source = ambit_implicit_change_open(&change, s->arena, &f);
  if (f.status != AMBIT_OK) ambit_lua_raise(L, &f);
  lua_pushvalue(L, 7);
  lua_setiuservalue(L, 11, 1);
}

/* least and most of all states, infinite; false: no memory */
static bool open_bounds(ambit_lua_system *s, double **least, double **most) {
  size_t n = s->system.nx;
  *least = ambit_arena_alloc(s->arena, n * sizeof **least), *most = ambit_arena_alloc(s->arena, n * sizeof **most);
  for (size_t i = 0; *least && *most && i < n; i++) (*least)[i] = -INFINITY, (*most)[i] = INFINITY;
  return *least && *most;
}

/* those of the system that this one is with further states */
static void inherit_bounds(lua_State *L, ambit_lua_system *s) {
  if (lua_isnoneornil(L, 7)) return;
  const ambit_system *of = &ambit_lua_check_outline(L, 7)->system;
  double *least, *most;
  if (!of->least) return;
  if (!open_bounds(s, &least, &most)) ambit_lua_error(L, "out of memory");
  memcpy(least, of->least, of->nx * sizeof *least), memcpy(most, of->most, of->nx * sizeof *most);
  s->system.least = least, s->system.most = most;
}

/* system({name}, {unit}, {state}, {rate} [, {invariant}, {name} [, system, {leaf}, {value}, {g}]]): the last four: it
** is that system with values for leaves, and with further states g */
static int system_new(lua_State *L) {
  size_t n = (size_t)luaL_len(L, 1);
  lua_settop(L, 10);
  ambit_lua_system *s = ambit_lua_push_system(L);
  const char **name = ambit_arena_alloc(s->arena, n * sizeof *name),
             **unit = ambit_arena_alloc(s->arena, n * sizeof *unit);
  ambit_expr *state = ambit_arena_alloc(s->arena, n * sizeof *state),
             *rate = ambit_arena_alloc(s->arena, n * sizeof *rate);
  if (!name || !unit || !state || !rate) ambit_lua_error(L, "out of memory");
  memcpy(state, ambit_lua_to_array(L, 3, n), n * sizeof *state);
  memcpy(rate, ambit_lua_to_array(L, 4, n), n * sizeof *rate);
  lua_pop(L, 2);
  for (size_t i = 0; i < n; i++) {
    name[i] = text_at(L, s->arena, 1, (lua_Integer)i + 1);
    unit[i] = text_at(L, s->arena, 2, (lua_Integer)i + 1);
  }
  s->system = (ambit_system) {
    .graph = AMBIT_LUA(L)->graph, .nx = n, .name = name, .unit = unit, .state = state, .rate = rate
  };
  add_invariants(L, s);
  add_implicit(L, s);
  inherit_bounds(L, s);
  lua_settop(L, 11);
  return 1;
}

/* system_bound(system, {enclosure}): of its solutions only those are meant whose states stay within these */
static int system_bound(lua_State *L) {
  ambit_lua_system *s = ambit_lua_check_outline(L, 1);
  double *least, *most;
  luaL_argcheck(L, (size_t)luaL_len(L, 2) == s->system.nx, 2, "does not fit");
  if (!open_bounds(s, &least, &most)) ambit_lua_error(L, "out of memory");
  for (size_t i = 0; i < s->system.nx; i++) {
    lua_rawgeti(L, 2, (lua_Integer)i + 1);
    ambit_interval x = ambit_lua_to_enclosure(L, -1, "bounds of a state").x;
    least[i] = x.lo, most[i] = x.hi;
    lua_pop(L, 1);
  }
  s->system.least = least, s->system.most = most;
  return 0;
}

/* system_jump(system, period, first, {expression}): its states become these, every period from `first` on */
static int system_jump(lua_State *L) {
  ambit_lua_system *s = ambit_lua_check_outline(L, 1);
  ambit_system *system = &s->system;
  luaL_argcheck(L, (size_t)luaL_len(L, 4) == system->nx, 4, "does not fit");
  ambit_jump *jump = ambit_arena_alloc(s->arena, (system->njump + 1) * sizeof *jump);
  ambit_expr *to = ambit_arena_alloc(s->arena, system->nx * sizeof *to);
  if (!jump || !to) ambit_lua_error(L, "out of memory");
  if (system->njump) memcpy(jump, system->jump, system->njump * sizeof *jump);
  memcpy(to, ambit_lua_to_array(L, 4, system->nx), system->nx * sizeof *to);
  jump[system->njump] = (ambit_jump) { .period = ambit_lua_to_expression(L, 2, NULL, "period").e,
    .first = ambit_lua_to_expression(L, 3, NULL, "first").e,
    .to = to };
  system->jump = jump, system->njump++;
  return 0;
}

/* system_jumps(system) -> { { period, first, {expression} }, ... } */
static int system_jumps(lua_State *L) {
  const ambit_system *s = &ambit_lua_check_outline(L, 1)->system;
  lua_createtable(L, (int)s->njump, 0);
  for (size_t i = 0; i < s->njump; i++) {
    lua_createtable(L, 3, 0);
    ambit_lua_push_expression(L, s->jump[i].period);
    lua_rawseti(L, -2, 1);
    ambit_lua_push_expression(L, s->jump[i].first);
    lua_rawseti(L, -2, 2);
    ambit_lua_push_expressions(L, s->nx, s->jump[i].to);
    lua_rawseti(L, -2, 3);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  return 1;
}

/* system_right(system) -> {rate} */
static int system_right(lua_State *L) {
  const ambit_system *s = &ambit_lua_check_system(L, 1)->system;
  ambit_lua_push_expressions(L, s->nx, s->rate);
  return 1;
}

/* system_parts(system) -> {name}, {unit}, {state} */
static int system_parts(lua_State *L) {
  const ambit_system *s = &ambit_lua_check_outline(L, 1)->system;
  lua_createtable(L, (int)s->nx, 0);
  lua_createtable(L, (int)s->nx, 0);
  for (size_t i = 0; i < s->nx; i++) {
    lua_pushstring(L, s->name[i]);
    lua_rawseti(L, -3, (lua_Integer)i + 1);
    lua_pushstring(L, s->unit[i] ? s->unit[i] : "1");
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  ambit_lua_push_expressions(L, s->nx, s->state);
  return 3;
}

/* system_invariants(system) -> {expression} that vanish along every solution, {name} */
static int system_invariants(lua_State *L) {
  const ambit_system *s = &ambit_lua_check_outline(L, 1)->system;
  ambit_lua_push_expressions(L, s->ninvariant, s->invariant);
  lua_createtable(L, (int)s->ninvariant, 0);
  for (size_t i = 0; i < s->ninvariant; i++) {
    lua_pushstring(L, s->invariant_name[i]);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  return 2;
}

static void set_numbers(lua_State *L, const char *key, size_t n, const uint32_t *number, uint32_t first) {
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    lua_pushinteger(L, (lua_Integer)number[i] + first);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  lua_setfield(L, -2, key);
}

static void set_expressions(lua_State *L, const char *key, size_t n, const ambit_expr *e) {
  ambit_lua_push_expressions(L, n, e);
  lua_setfield(L, -2, key);
}

/* system_implicit(system) -> { unknowns, rates, residuals: expressions; stage_end, pivot: numbers }, or nil */
static int system_implicit(lua_State *L) {
  const ambit_system *s = &ambit_lua_check_outline(L, 1)->system;
  const ambit_implicit_form *form;
  ambit_failure f = { 0 };
  if (ambit_system_implicit(s, &form, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  if (!form) return 0;
  lua_createtable(L, 0, 5);
  set_expressions(L, "unknowns", form->na, form->unknown);
  set_expressions(L, "rates", s->nx, form->rate);
  set_expressions(L, "residuals", form->na, form->residual);
  set_numbers(L, "stage_end", form->nstage, form->stage_end, 0);
  set_numbers(L, "pivot", form->na, form->pivot, 1);
  return 1;
}

static uint32_t *numbers_at(lua_State *L, ambit_arena *arena, int idx, uint32_t first, size_t *n) {
  luaL_checktype(L, idx, LUA_TTABLE);
  *n = (size_t)lua_rawlen(L, idx);
  uint32_t *list = ambit_arena_alloc(arena, (*n + 1) * sizeof *list);
  if (!list) ambit_lua_error(L, "out of memory");
  for (size_t i = 0; i < *n; i++) {
    lua_rawgeti(L, idx, (lua_Integer)i + 1);
    list[i] = (uint32_t)(luaL_checkinteger(L, -1) - first);
    lua_pop(L, 1);
  }
  return list;
}

static ambit_status is_written(ambit_system_source *self, ambit_failure *f) {
  (void)self, (void)f;
  return AMBIT_OK;
}

/* system_give_implicit(system, form): the implicit form of a system that has none, as system_implicit has it */
static int system_give_implicit(lua_State *L) {
  static const char *const key[] = { "unknowns", "rates", "residuals", "stage_end", "pivot" };
  ambit_lua_system *s = ambit_lua_check_outline(L, 1);
  lua_settop(L, 2);
  for (size_t k = 0; k < 5; k++) lua_getfield(L, 2, key[k]); /* at 3 .. 7 */
  ambit_system_source *source = ambit_arena_alloc(s->arena, sizeof *source);
  for (int i = 3; i <= 7; i++) luaL_checktype(L, i, LUA_TTABLE);
  size_t na = (size_t)lua_rawlen(L, 3), nx = s->system.nx, nstage, npivot;
  ambit_expr *all = ambit_arena_alloc(s->arena, (nx + 2 * na + 1) * sizeof *all);
  if (!source || !all) ambit_lua_error(L, "out of memory");
  const uint32_t *stage_end = numbers_at(L, s->arena, 6, 0, &nstage), *pivot = numbers_at(L, s->arena, 7, 1, &npivot);
  luaL_argcheck(L,
      !s->system.source && (size_t)lua_rawlen(L, 4) == nx && (size_t)lua_rawlen(L, 5) == na && npivot == na, 2,
      "does not fit");
  memcpy(all, ambit_lua_to_array(L, 4, nx), nx * sizeof *all);
  memcpy(all + nx, ambit_lua_to_array(L, 3, na), na * sizeof *all);
  memcpy(all + nx + na, ambit_lua_to_array(L, 5, na), na * sizeof *all);
  *source = (ambit_system_source) {
    .written = true, .form = { na, nstage, all + nx, all, all + nx + na, stage_end, pivot }, .write = is_written
  };
  s->system.source = source;
  return 0;
}

/* -- the rates over a box, without a trace in the graph */

typedef struct over {
  ambit_system *s;
  ambit_arena *arena;
  size_t nin;
  ambit_expr *input; /* states, unknowns, time */
  ambit_interval *in;
} over;

/* {enclosure} of the states at 2, the time at 3 */
static void collect_inputs(lua_State *L, over *o) {
  ambit_graph *g = o->s->graph;
  ambit_failure f = { 0 };
  ambit_expr *leaf;
  size_t n;
  if (ambit_unknowns_leaves(g, o->arena, o->s->nx, o->s->rate, &n, &leaf, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  o->input = ambit_arena_alloc(o->arena, (o->s->nx + n + 1) * sizeof *o->input);
  o->in = ambit_arena_alloc(o->arena, (o->s->nx + n + 1) * sizeof *o->in);
  if (!o->input || !o->in) ambit_lua_error(L, "out of memory");
  for (size_t i = 0; i < o->s->nx; i++) {
    lua_rawgeti(L, 2, (lua_Integer)i + 1);
    o->input[o->nin] = o->s->state[i];
    o->in[o->nin++] = ambit_lua_to_enclosure(L, -1, "rates").x;
    lua_pop(L, 1);
  }
  for (size_t i = 0; i < n; i++) {
    const ambit_node *node = ambit_graph_node(g, leaf[i]);
    if (!ambit_leaf_is_uncertain(node->op)) continue;
    o->input[o->nin] = leaf[i];
    o->in[o->nin++] = node->value;
  }
  o->input[o->nin] = ambit_graph_time(g);
  o->in[o->nin++] = ambit_lua_to_enclosure(L, 3, "rates").x;
}

/* system_rates(system, {enclosure of each state}, time) -> {enclosure}, or nil where some rate is not known to be
** defined */
static int system_rates(lua_State *L) {
  lua_settop(L, 3);
  over o = { .s = &ambit_lua_check_system(L, 1)->system };
  o.arena = ambit_lua_push_system(L)->arena;
  collect_inputs(L, &o);
  const ambit_tape *t;
  ambit_failure f = { 0 };
  if (ambit_tape_seal(o.s->graph, o.arena, o.s->nx, o.s->rate, o.nin, o.input, 0, 0, &t, &f) != AMBIT_OK)
    ambit_lua_raise(L, &f);
  ambit_interval *slot = ambit_arena_alloc(o.arena, t->nslot * sizeof *slot),
                 *rate = ambit_arena_alloc(o.arena, o.s->nx * sizeof *rate);
  if (!slot || !rate) ambit_lua_error(L, "out of memory");
  if (ambit_hull(t, o.in, slot) & AMBIT_F_PARTIAL) return 0;
  for (size_t i = 0; i < o.s->nx; i++) rate[i] = slot[t->out[i]];
  ambit_lua_push_enclosures(L, o.s->nx, rate, 0);
  return 1;
}

void ambit_lua_open_system(lua_State *L, ambit_lua *core) {
  static const luaL_Reg meta[] = { { "__gc", close }, { NULL, NULL } };
  static const luaL_Reg functions[] = { { "system", system_new }, { "system_parts", system_parts },
    { "system_right", system_right }, { "system_jump", system_jump }, { "system_bound", system_bound },
    { "system_jumps", system_jumps }, { "system_invariants", system_invariants },
    { "system_implicit", system_implicit }, { "system_give_implicit", system_give_implicit },
    { "system_rates", system_rates }, { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
  ambit_lua_new_type(L, core, AMBIT_TYPE_SYSTEM, meta);
  lua_pop(L, 1);
}
