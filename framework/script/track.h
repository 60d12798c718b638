/* track.h -- the recorded steps of a run: what Lua reads afterwards.
**
** Records are written by a sink while a solver runs, so this storage is not Lua's: nothing here may raise. It grows by
** doubling.
*/
#ifndef AMBIT_LUA_TRACK_H
#define AMBIT_LUA_TRACK_H
#include "script/core.h"
#include "script/held_set.h"
#include <ambit/solver.h>

#define AMBIT_TRACK_LAST 1u  /* of the steps, only the last is kept (and those before an event) */
#define AMBIT_TRACK_DENSE 2u /* the steps' dense enclosures are kept */

typedef struct ambit_track_step {
  double t_from, t_to;
  uint32_t kind, event, flags, order;
  bool tube;
  /* sizes of the dense enclosure (ambit_record), 0: none; where it is: middles, radii, columns */
  uint32_t ndense, ncolumn, ncoef_column;
  size_t dense;
} ambit_track_step;

typedef struct ambit_track {
  size_t nx, count, room_steps, room_values;
  ambit_track_step *step; /* [count] */
  double *value;          /* [count][4 nx]: lo, hi, tube lo, tube hi */
  uint32_t keep;          /* AMBIT_TRACK_* */
  double *dense;
  size_t count_dense, room_dense;
  ambit_held_set set; /* at the end of the last step */
} ambit_track;

ambit_track *ambit_track_push(lua_State *L, size_t nx, uint32_t keep);
bool ambit_track_append(ambit_track *track, const ambit_record *r); /* false: out of memory */
#endif
