/* interrupt.c -- signals and limits as a flag for verbs and as an error for Lua code. */
#include "script/interrupt.h"
#include "script/embedded.h"
#include <lauxlib.h>
#include <string.h>
#include <unistd.h>

#define IMPATIENT 3 /* so many during one verb, or outside of any: leave at once */
#define BY_SIGNAL 128

static lua_State *volatile watched;                     /* NULL: nobody watches */
static volatile sig_atomic_t in_verb, pending, waiting; /* waiting: outside of verbs */
static volatile sig_atomic_t seen;                      /* the exit code that the first one gives; 0: none */
static const char *volatile limit;                      /* the sentence of the limit that is reached, or NULL */

/* Ambit's own Lua code is not disturbed by a limit: it has the results of verbs to record, and ends soon. */
static bool is_of_scene(lua_State *L, lua_Debug *frame) {
  lua_getinfo(L, "S", frame);
  return *frame->what != 'C' && strncmp(frame->source, AMBIT_CHUNK_PREFIX, sizeof AMBIT_CHUNK_PREFIX - 1) != 0;
}

static void raise_interrupted(lua_State *L, lua_Debug *frame) {
  if (limit && is_of_scene(L, frame)) luaL_error(L, "%s", limit);
  if (limit) return;
  lua_sethook(L, NULL, 0, 0);
  luaL_error(L, "interrupted");
}

/* lua_sethook is safe in a signal handler. */
static void set_hook(void) {
  lua_sethook(watched, raise_interrupted, LUA_MASKCALL | LUA_MASKRET | LUA_MASKLINE | LUA_MASKCOUNT, 1);
}

static void on_signal(int number) {
  if (number == SIGPIPE && seen) return; /* each text that nobody reads raises one */
  if (!seen) seen = BY_SIGNAL + number;
  if (in_verb) {
    pending = pending + 1;
    if (pending >= IMPATIENT) _exit(BY_SIGNAL + number);
  } else {
    waiting = waiting + 1;
    if (waiting >= IMPATIENT) _exit(BY_SIGNAL + number);
    if (watched) set_hook();
  }
}

void ambit_interrupt_limit(const char *sentence, int code) {
  if (limit) return;
  limit = sentence;
  seen = code;
  if (in_verb)
    pending = pending + 1;
  else if (watched)
    set_hook();
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
  static const int polite[] = { SIGTERM, SIGHUP, SIGPIPE };
  watched = L;
  if (!L) return;
  catch_signal(SIGINT, NULL);
  for (size_t i = 0; i < sizeof polite / sizeof *polite; i++) {
    struct sigaction now;
    if (sigaction(polite[i], NULL, &now) == 0 && now.sa_handler != SIG_IGN) catch_signal(polite[i], NULL); /* nohup */
  }
}

void ambit_interrupt_begin(ambit_interrupt *i) {
  i->lent = watched == NULL;
  i->outer = in_verb;
  if (!i->outer) pending = limit != NULL;
  in_verb = 1;
  if (i->lent) catch_signal(SIGINT, &i->previous);
}

void ambit_interrupt_end(ambit_interrupt *i) {
  if (i->lent) sigaction(SIGINT, &i->previous, NULL);
  in_verb = i->outer;
  if (limit && !in_verb && watched) set_hook();
}

bool ambit_interrupt_pending(void) { return pending != 0; }
bool ambit_interrupt_seen(void) { return seen != 0; }
int ambit_interrupt_code(void) { return seen; }
