/* request.h -- what the verbs share: options, lists, fields and reports between Lua tables and C. Arrays are Lua's
** (one userdata each, pushed). */
#ifndef AMBIT_LUA_REQUEST_H
#define AMBIT_LUA_REQUEST_H
#include "script/core.h"
#include "verbs/evaluate/evaluate.h"
#include "verbs/run/report.h"
#include "verbs/simulate/simulate.h"

ambit_option *ambit_lua_options(lua_State *L, int idx, size_t *n); /* {name, text, name, text, ...} */
double *ambit_lua_numbers(lua_State *L, int idx, size_t *n);       /* {x, ...} */
const char **ambit_lua_texts(lua_State *L, int idx, size_t *n);    /* {text, ...}; the texts stay the table's */
void ambit_lua_push_report(lua_State *L, const ambit_report *r);

/* (arithmetic, options, {expression}, {leaf}, {value}) at 1..5 */
ambit_evaluate_request ambit_lua_evaluate_request(lua_State *L);
/* {enclosure, ...}; partial [n]: 1 where it holds for a part of the data only, or NULL */
void ambit_lua_push_enclosures(lua_State *L, size_t n, const ambit_interval *x, const uint8_t *partial);

/* (system, solver, arithmetic or nil, solver options, arithmetic options, {initial}, {time}) at 1..7 */
ambit_simulate_request ambit_lua_simulate_request(lua_State *L);

/* Field of the table on top of the stack. */
void ambit_lua_set_number(lua_State *L, const char *key, double value);
void ambit_lua_set_count(lua_State *L, const char *key, uint32_t value);
void ambit_lua_set_text(lua_State *L, const char *key, const char *value);
#endif
