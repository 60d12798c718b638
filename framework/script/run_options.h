/* run_options.h -- what `simulate` is told besides system, solver and data: threads, split, keep, dense. */
#ifndef AMBIT_LUA_RUN_OPTIONS_H
#define AMBIT_LUA_RUN_OPTIONS_H
#include "script/core.h"
#include "verbs/simulate/simulate.h"

/* The table at idx (absent: nothing) into the request: threads, pieces (counts), dense (flag), and the lists unknown,
** name and parts of one length. Returns what the track shall keep (AMBIT_TRACK_*). Arrays are Lua's (pushed). */
uint32_t ambit_lua_run_options(lua_State *L, int idx, ambit_simulate_request *q);
#endif
