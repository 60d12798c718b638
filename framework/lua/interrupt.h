/* interrupt.h -- Ctrl-C, SIGTERM and SIGHUP: the first asks a running verb to stop (its records stay), in plain Lua
** code it raises an error; the third ends the process.
**
** A signal handler can only reach static data: this is the one place that has some, set only while a watch is on.
*/
#ifndef AMBIT_LUA_INTERRUPT_H
#define AMBIT_LUA_INTERRUPT_H
#include <lua.h>
#include <signal.h>
#include <stdbool.h>

/* The command: from here on these signals are ours (SIGTERM and SIGHUP unless they are ignored); between verbs it raises "interrupted" in L. [main] */
void ambit_interrupt_watch(lua_State *L);
/* A verb begins or ends. A host that does not watch (a stock lua) lends its SIGINT for as long as the verb runs. Verbs
** that a callback of another one runs are stopped together with it. */
typedef struct ambit_interrupt {
  struct sigaction previous;
  bool lent;
  int outer; /* is another verb running? */
} ambit_interrupt;
void ambit_interrupt_begin(ambit_interrupt *i);
void ambit_interrupt_end(ambit_interrupt *i);
bool ambit_interrupt_pending(void); /* was this verb asked to stop? */
bool ambit_interrupt_seen(void);    /* was there any since the watch began? */
int ambit_interrupt_code(void);     /* the exit code of a process that it ended: 130 for Ctrl-C; 0: there was none */
#endif
