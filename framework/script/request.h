/* request.h -- what the verbs share: questions, options, lists and reports between Lua tables and C. Arrays are Lua's
** (one userdata each, pushed). Requests of one verb alone are declared beside it (script/fields.h). */
#ifndef AMBIT_LUA_REQUEST_H
#define AMBIT_LUA_REQUEST_H
#include "script/core.h"
#include <ambit/evaluate.h>
#include <ambit/report.h>
#include <ambit/simulate.h>

ambit_option *ambit_lua_options(lua_State *L, int idx, size_t *n); /* {name, text, name, text, ...} */
double *ambit_lua_numbers(lua_State *L, int idx, size_t *n);       /* {x, ...} */
const char **ambit_lua_texts(lua_State *L, int idx, size_t *n);    /* {text, ...}; the texts stay the table's */
void ambit_lua_push_report(lua_State *L, const ambit_report *r);

/* What is evaluated: { arithmetic = nil (the verb's own), options, expressions, leaves, values } at idx; leaves,
** values: the bindings. */
ambit_evaluate_request ambit_lua_read_question(lua_State *L, int idx, const char *what);
/* {enclosure, ...}; partial [n]: 1 where it holds for a part of the data only, or NULL */
void ambit_lua_push_enclosures(lua_State *L, size_t n, const ambit_interval *x, const uint8_t *partial);

/* What is run: { system, solver = "" (none), arithmetic, options, arithmetic_options, initial, times, final = { e } }
** at idx; final: the true end of a sampled system. */
ambit_simulate_request ambit_lua_read_flow(lua_State *L, int idx, const char *what);
/* the same; of the system the states are enough */
ambit_simulate_request ambit_lua_read_outline(lua_State *L, int idx, const char *what);

/* Field of the table on top of the stack. */
void ambit_lua_set_number(lua_State *L, const char *key, double value);
void ambit_lua_set_count(lua_State *L, const char *key, uint32_t value);
void ambit_lua_set_text(lua_State *L, const char *key, const char *value);
#endif
