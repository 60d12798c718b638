/* track.h -- the recorded steps of a run: what Lua reads afterwards.
**
** Records are written by a sink while a solver runs, so this storage is not Lua's: nothing here may raise. It grows by
** doubling.
*/
#ifndef AMBIT_LUA_TRACK_H
#define AMBIT_LUA_TRACK_H
#include "lua/core.h"
#include <ambit/solver.h>

typedef struct ambit_track_step {
  double t_from, t_to;
  uint32_t kind, event, flags, order;
  bool tube;
} ambit_track_step;

typedef struct ambit_track {
  size_t nx, count, room_steps, room_values;
  ambit_track_step *step; /* [count] */
  double *value;          /* [count][4 nx]: lo, hi, tube lo, tube hi */
} ambit_track;

ambit_track *ambit_track_push(lua_State *L, size_t nx);
bool ambit_track_append(ambit_track *track, const ambit_record *r); /* false: out of memory */
#endif
