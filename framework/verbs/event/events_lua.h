/* events_lua.h -- events as Lua values: a watch is made from expressions, handed to one `simulate`, and read
** afterwards. */
#ifndef AMBIT_LUA_EVENTS_H
#define AMBIT_LUA_EVENTS_H
#include "script/receiver.h"
#include <ambit/event.h>
#include <ambit/simulate.h>

#define AMBIT_TYPE_EVENTS "ambit.events"

typedef struct ambit_lua_events {
  ambit_sink sink; /* first: between the watch and the receiver */
  ambit_receiver *to;
  ambit_event_watch *watch;
  size_t nx;
  bool quiet;  /* the steps are no steps of a run that a user asked for: no JSON lines */
  bool hold;   /* keep the set at the end of the last step before an event may have begun */
  bool frozen; /* an event that ends the run was found: nothing more is held */
  bool has_held;
  ambit_held_set set; /* the set held, at t_held, ... */
  double t_held;
  double *lo, *hi; /* [nx] ... and its hull */
} ambit_lua_events;

/* Around ambit_simulate; a NULL watch does nothing. */
void ambit_lua_events_begin(ambit_lua_events *w, ambit_simulate_request *q, ambit_receiver *to);
void ambit_lua_events_end(ambit_lua_events *w);
#endif
