/* interrupt.c -- signals as a flag for verbs and as an error for Lua code. */
#include "lua/interrupt.h"
#include <lauxlib.h>
#include <string.h>
#include <unistd.h>

#define IMPATIENT 3 /* so many during one verb, or outside of any: leave at once */
#define BY_SIGNAL 128

static lua_State *volatile watched;                           /* NULL: nobody watches */
static volatile sig_atomic_t in_verb, pending, seen, waiting; /* seen: the first; waiting: outside of verbs */

static void raise_interrupted(lua_State *L, lua_Debug *frame) {
  (void)frame;
  lua_sethook(L, NULL, 0, 0);
  luaL_error(L, "interrupted");
}

static void on_signal(int number) {
  if (!seen) seen = number;
  if (in_verb) {
    pending = pending + 1;
    if (pending >= IMPATIENT) _exit(BY_SIGNAL + number);
  } else if (watched) {
    waiting = waiting + 1;
    if (waiting >= IMPATIENT) _exit(BY_SIGNAL + number);
    /* lua_sethook is safe in a signal handler */
    lua_sethook(watched, raise_interrupted, LUA_MASKCALL | LUA_MASKRET | LUA_MASKLINE | LUA_MASKCOUNT, 1);
  }
}

static void catch_signal(int number, struct sigaction *previous) {
  struct sigaction action;
  memset(&action, 0, sizeof action);
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigaction(number, &action, previous);
}

void ambit_interrupt_watch(lua_State *L) {
  static const int polite[] = { SIGTERM, SIGHUP };
  watched = L;
  catch_signal(SIGINT, NULL);
  for (size_t i = 0; i < sizeof polite / sizeof *polite; i++) {
    struct sigaction now;
    if (sigaction(polite[i], NULL, &now) == 0 && now.sa_handler != SIG_IGN) catch_signal(polite[i], NULL); /* nohup */
  }
}

void ambit_interrupt_begin(ambit_interrupt *i) {
  i->lent = watched == NULL;
  i->outer = in_verb;
  if (!i->outer) pending = 0;
  in_verb = 1;
  if (i->lent) catch_signal(SIGINT, &i->previous);
}

void ambit_interrupt_end(ambit_interrupt *i) {
  if (i->lent) sigaction(SIGINT, &i->previous, NULL);
  in_verb = i->outer;
}

bool ambit_interrupt_pending(void) { return pending != 0; }
bool ambit_interrupt_seen(void) { return seen != 0; }
int ambit_interrupt_code(void) { return seen ? BY_SIGNAL + seen : 0; }
