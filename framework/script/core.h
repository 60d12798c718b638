/* core.h -- what the files of this layer share: one kernel state per Lua state, values, and how failures become Lua
** errors.
**
** This layer (framework/script, and *_lua.c of models and verbs) alone sees lua.h and ffi.h. It is thin: it checks
** types, calls the kernel and hands results back; everything that can be said in Lua (verbs, keys, shapes, messages
** about them) is said there.
**
** Errors: a Lua error is raised only with no kernel object open that Lua does not own, and never from inside a solver,
** an element or a C callback. Messages start with "file:line:" of the nearest line that is not Ambit's own.
*/
#ifndef AMBIT_LUA_CORE_H
#define AMBIT_LUA_CORE_H
#include <ambit/arena.h>
#include <ambit/status.h>
#include "graph/collect.h"
#include <ambit/graph.h>
#include <ambit/registry.h>
#include "verbs/run/records.h"
#include "models/unit.h"
#include <ambit/interval.h>
#include <lauxlib.h>
#include <lua.h>

/* One per Lua state, kept in the Lua registry. */
typedef struct ambit_lua {
  ambit_graph *graph;
  ambit_registry *registry;
  ambit_records *records;        /* JSON lines of `ambit run --json`, or NULL */
  size_t recorded;               /* plugins of the registry that are in them */
  bool recorded_slow;            /* the slow path of the elementary functions is */
  ambit_arena *arena;            /* texts that must live as long as the state */
  bool progress;                 /* draw a progress bar on stderr */
  struct ambit_profile *profile; /* of `ambit profile`, or NULL */
  double deadline;               /* when runs are stopped, s of CPU time of this process; 0: never */
  const char *text_mode;         /* "ambit", "watched", "lua": whose is arithmetic on texts (text.c); NULL: Lua's */
  char text_rounded[80];         /* "scene.lua:12: " where Lua's arithmetic rounded a text (text.c), or "" */
  bool text_wrapped;             /* a whole number of texts is known modulo 2^64 only */
  int depth;                     /* functions of the core that are running, at least; an error leaves it too large */
  ambit_holder holder;           /* of `boxes`, all expressions of this Lua state */
  struct ambit_lua_box *boxes;
} ambit_lua;

/* The functions of the core run in the standard floating-point environment, whatever the host program set. Pushes f
** as such a function and pops n values that are its own: AMBIT_LUA_OWN(1) .. AMBIT_LUA_OWN(n). */
void ambit_lua_push_function(lua_State *L, ambit_lua *core, lua_CFunction f, int n);
#define AMBIT_LUA(L) ((ambit_lua *)lua_touserdata(L, lua_upvalueindex(1)))
#define AMBIT_LUA_OWN(k) lua_upvalueindex(2 + (k))

#define AMBIT_TYPE_EXPRESSION "ambit.expression"
#define AMBIT_TYPE_ENCLOSURE "ambit.enclosure"
#define AMBIT_TYPE_MECHANISM "ambit.mechanism"
#define AMBIT_TYPE_SYSTEM "ambit.system"
#define AMBIT_TYPE_SCHEDULE "ambit.schedule"
#define AMBIT_TYPE_TRACK "ambit.track"

/* An expression and its dimension. Equal nodes may be of different dimension, so the graph does not know it. */
typedef struct ambit_lua_expression {
  ambit_expr e;
  ambit_dimension dimension;
} ambit_lua_expression;

/* As Lua keeps an expression: a holder of its node. */
typedef struct ambit_lua_box {
  ambit_lua_expression x; /* first: what luaL_checkudata gives */
  struct ambit_lua_box *next, **link;
} ambit_lua_box;

/* Marks the expressions of core->boxes. */
void ambit_lua_mark_boxes(ambit_holder *holder, ambit_graph *g);

/* An enclosure; flags: AMBIT_F_PARTIAL if some operation on the way left its domain; or AMBIT_LUA_SAMPLED (sampled.h).
** One that a script wrote down, `declared`, is a set of which all of `inner` is known to be meant; of what was computed
** no value is. */
#define AMBIT_LUA_SAMPLED 0x100u
typedef struct ambit_lua_enclosure {
  ambit_interval x;
  uint32_t flags;
  bool declared;
  ambit_interval inner;
} ambit_lua_enclosure;

/* "scene.lua:12: ", pushed; empty if no line of a script is active. */
void ambit_lua_where(lua_State *L);
/* Raises a Lua error "file:line: message". */
_Noreturn void ambit_lua_error(lua_State *L, const char *format, ...);
_Noreturn void ambit_lua_raise(lua_State *L, const ambit_failure *f);

ambit_lua_expression *ambit_lua_push_expression(lua_State *L, ambit_expr e); /* NO_EXPR: raises; OPEN dimension */
void ambit_lua_push_enclosure(lua_State *L, ambit_interval x, uint32_t flags);
/* A fresh datum made by the running line of the script, NULL: no name yet; raises where there is no memory. */
ambit_expr ambit_lua_datum(lua_State *L, const char *name, ambit_interval outer, ambit_interval inner);
/* the same with its kind: AMBIT_LEAF_UNKNOWN or AMBIT_LEAF_VARYING */
ambit_expr ambit_lua_leaf(lua_State *L, uint32_t leaf, const char *name, ambit_interval outer, ambit_interval inner);
/* Pushes a new table {expression, ...}. */
void ambit_lua_push_expressions(lua_State *L, size_t n, const ambit_expr *e);

/* The value at idx as an expression: number (exact), text (decimal it says, a unit allowed), expression, enclosure (a
** fresh unknown).
** wanted: SI unit that a dimension must agree with, or NULL. what: named in messages ("offset"), or NULL. */
ambit_lua_expression ambit_lua_to_expression(lua_State *L, int idx, const char *wanted, const char *what);
/* Raises where the number at idx may be a text that Lua has rounded (text.c). ambit_lua_to_... do so by themselves. */
void ambit_lua_check_number(lua_State *L, int idx, const char *what);
/* The value at idx as a set: enclosure, number, text, or an expression without unknowns. */
ambit_lua_enclosure ambit_lua_to_enclosure(lua_State *L, int idx, const char *what);
/* Raises an error if a script asks for == while it writes down a formula. */
void ambit_lua_refuse_equality(lua_State *L);
/* {expression, ...} at idx -> an array of n owned by Lua (pushed as one userdata above the stack). */
ambit_expr *ambit_lua_to_array(lua_State *L, int idx, size_t n);
bool ambit_lua_is_constant(lua_State *L, const ambit_lua_expression *x);
/* The dimension of the value at idx: of an expression, of a text with a unit; BARE for all else. */
ambit_dimension ambit_lua_dimension(lua_State *L, int idx, const char *what);
/* Of `op` between the two (unary: b ignored); raises a message that names both where they do not fit. */
ambit_dimension ambit_lua_dimension_op(
    lua_State *L, uint32_t op, ambit_dimension a, ambit_dimension b, const char *what);

/* profile.c: calls the running function once more, in a frame of the profile. */
int ambit_lua_call_framed(lua_State *L);
/* Is this the call that ambit_lua_call_framed made? */
bool ambit_lua_is_framed(lua_State *L);

/* Each adds its functions to the table on top of the stack (the state as upvalue). */
void ambit_lua_open_functions(lua_State *L, ambit_lua *core);  /* functions.c: sin, pow, ... */
void ambit_lua_open_expression(lua_State *L, ambit_lua *core); /* expression.c */
void ambit_lua_open_enclosure(lua_State *L, ambit_lua *core);  /* enclosure.c */
void ambit_lua_open_units(lua_State *L, ambit_lua *core);      /* units.c: dimensions of expressions */
void ambit_lua_open_data(lua_State *L, ambit_lua *core);       /* data.c: around, between, interval */
void ambit_lua_open_plugins(lua_State *L, ambit_lua *core);    /* plugins.c */
void ambit_lua_open_mechanism(lua_State *L, ambit_lua *core);  /* mechanism.c */
void ambit_lua_open_dynamics(lua_State *L, ambit_lua *core);   /* dynamics.c */
void ambit_lua_open_loops(lua_State *L, ambit_lua *core);      /* loops.c */
void ambit_lua_open_roots(lua_State *L, ambit_lua *core);      /* roots.c */
void ambit_lua_open_system(lua_State *L, ambit_lua *core);     /* system.c */
void ambit_lua_open_verbs(lua_State *L, ambit_lua *core);      /* verbs.c: evaluate, simulate */
void ambit_lua_open_sample(lua_State *L, ambit_lua *core);     /* sample.c */
void ambit_lua_open_variation(lua_State *L, ambit_lua *core);  /* variation.c */
void ambit_lua_open_term_tree(lua_State *L, ambit_lua *core);  /* term_tree.c */
void ambit_lua_open_structure(lua_State *L, ambit_lua *core);  /* structure.c */
void ambit_lua_open_source(lua_State *L, ambit_lua *core);     /* source.c */
void ambit_lua_open_difference(lua_State *L, ambit_lua *core); /* difference.c */
void ambit_lua_open_reduction(lua_State *L, ambit_lua *core);  /* reduction.c */
void ambit_lua_open_schedule(lua_State *L, ambit_lua *core);   /* schedule.c: the samples of a run */
void ambit_lua_open_watch(lua_State *L, ambit_lua *core);      /* watch.c: conditions along a run */
void ambit_lua_open_events(lua_State *L, ambit_lua *core);     /* events.c: zero crossings along a run */
void ambit_lua_open_track(lua_State *L, ambit_lua *core);      /* track.c: the recorded steps of a run */
void ambit_lua_open_records(lua_State *L, ambit_lua *core);    /* records.c: JSON lines */
void ambit_lua_open_output(lua_State *L, ambit_lua *core);     /* output.c: files, written as a whole */
void ambit_lua_open_process(lua_State *L, ambit_lua *core);    /* process.c: libraries, clocks, terminals */
void ambit_lua_open_child(lua_State *L, ambit_lua *core);      /* child.c: functions in processes of their own */
void ambit_lua_open_profile(lua_State *L, ambit_lua *core);    /* profile.c: where the time goes, counted work */
void ambit_lua_open_text(lua_State *L, ambit_lua *core);       /* text.c: arithmetic on texts */
void ambit_lua_open_foreign(lua_State *L, ambit_lua *core);    /* foreign.c: plugin exports by libffi */
void ambit_lua_open_sandbox(lua_State *L, ambit_lua *core);    /* sandbox.c: shuts the process in */

/* A metatable for the named type with the given functions, all with the state as upvalue; left on the stack. */
void ambit_lua_new_type(lua_State *L, ambit_lua *core, const char *type, const luaL_Reg *functions);
/* Ends a __gc of the object at 1: finalisers and tables with weak keys may still reach it, and whoever does is refused,
** since it has no type any more. Returns 0. */
int ambit_lua_retire(lua_State *L);
void ambit_lua_set_functions(lua_State *L, ambit_lua *core, const luaL_Reg *functions);

int luaopen_ambit_core(lua_State *L);
AMBIT_EXPORT int luaopen_ambit(lua_State *L);
#endif
