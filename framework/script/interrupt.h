/* interrupt.h -- what stops a run before its end: Ctrl-C, SIGTERM, SIGHUP, a reader that has left (SIGPIPE), and limits
** (limit.h). A running verb is asked to stop, and its records stay; in plain Lua code an error is raised. A scene may
** catch that of a signal and go on; the third signal ends the process. That of a limit is raised in every line of the
** scene, again and again.
**
** A signal handler can only reach static data: this is the one place that has some, set only while a watch is on.
*/
#ifndef AMBIT_LUA_INTERRUPT_H
#define AMBIT_LUA_INTERRUPT_H
#include <lua.h>
#include <signal.h>
#include <stdbool.h>

/* The command: from here on these signals are ours (unless they are ignored, but for SIGINT); between verbs it raises
** "interrupted" in L. NULL: L is about to be closed. [main] */
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
/* A limit is reached: stops what runs, and whatever begins later. `sentence` is the error's, `code` the exit code.
** Safe in a signal handler. */
void ambit_interrupt_limit(const char *sentence, int code);
#endif
