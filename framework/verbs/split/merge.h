/* merge.h -- where the pieces of a split meet: hulls by interval of time, which of them are complete, whether to go on.
**
** All functions may be called from any thread, except forward, which belongs to one thread at a time.
*/
#ifndef AMBIT_MERGE_H
#define AMBIT_MERGE_H
#include <ambit/arena.h>
#include <ambit/status.h>
#include <ambit/solver.h>
#include <stdbool.h>

typedef struct ambit_merge ambit_merge;

/* For the intervals between the instants of p; in the arena. */
ambit_status ambit_merge_open(ambit_arena *arena, const ambit_problem *p, uint32_t pieces, ambit_merge **m);
void ambit_merge_close(ambit_merge *m); /* NULL is allowed */

/* What one piece gives for one interval: ends and tubes, lo and hi [nx]; has_tube: of all its steps */
typedef struct ambit_merge_part {
  double *lo, *hi, *tube_lo, *tube_hi;
  uint32_t flags, order;
  bool has_tube;
} ambit_merge_part;

void ambit_merge_put(ambit_merge *m, uint32_t interval, const ambit_merge_part *part);
/* The piece holds no solution at all, so it adds nothing to the intervals behind the completed ones. */
void ambit_merge_put_nothing(ambit_merge *m, uint32_t piece, uint32_t completed, const ambit_failure *why);
/* The piece could not go on behind `completed` intervals. */
void ambit_merge_fail(ambit_merge *m, uint32_t piece, uint32_t completed, const ambit_failure *why);
/* -- of a merge of one piece that has ended, on one thread */

/* The hull of an interval, lo and hi [nx] each; NULL: it was not completed. */
const double *ambit_merge_hull(const ambit_merge *m, uint32_t interval);
/* Intersects it with what the run of a larger piece proved, where both say something and have something in common. */
void ambit_merge_narrow(ambit_merge *m, const ambit_merge *larger);
bool ambit_merge_is_complete(const ambit_merge *m); /* it came to the end, or holds no solution */
/* It becomes piece `piece` of m: its intervals, and its failure. */
void ambit_merge_join(ambit_merge *m, uint32_t piece, const ambit_merge *own);

/* Nothing that this piece can still do matters: somebody asked to stop, or another piece got less far. */
bool ambit_merge_is_over(ambit_merge *m, uint32_t piece, uint32_t completed);

/* Hands the intervals that all pieces have completed to the sink, and the progress; nonzero: stop. */
int32_t ambit_merge_forward(ambit_merge *m, ambit_sink *sink);
/* When all have ended: OK, or the failure of the piece that got least far; DOMAIN if none holds a solution. */
ambit_status ambit_merge_outcome(ambit_merge *m, ambit_failure *why);
#endif
