/* limit.h -- the limits that the command line gives a run: --time, --memory, --output.
**
** One that is reached stops the run as Ctrl-C does, but for good (interrupt.h). A run that has not ended some time
** later (a quarter of --time, at most 3 s) is ended where it stands, whatever it does: a long call of C hears no
** request. Its records are complete up to there in either case, and the last one says which limit it was.
*/
#ifndef AMBIT_LUA_LIMIT_H
#define AMBIT_LUA_LIMIT_H
#include "verbs/run/records.h"
#include <lua.h>

#define AMBIT_LIMIT_EXIT 5 /* exit code of a run that a limit ended */

typedef enum ambit_limit { AMBIT_LIMIT_TIME, AMBIT_LIMIT_MEMORY, AMBIT_LIMIT_OUTPUT, AMBIT_LIMITS } ambit_limit;

/* From now on: `time` seconds on the clock; bytes of memory of each process; bytes of what is printed and recorded.
** said: "10 s". NULL, or what stands in the way. [main thread, once for each] */
const char *ambit_limit_begin(lua_State *L, ambit_limit which, double most, const char *said);
/* Where the last record of a run goes that must be ended; NULL: nowhere, any more. */
void ambit_limit_records(const ambit_records *r);
/* To be called when a line has been recorded. */
void ambit_limit_recorded(const ambit_records *r);
/* An allocation has failed: that is the limit of memory, if there is one, which is then reached. */
void ambit_limit_blame_memory(void);
/* In a child process: it has no last record to write, and counts nothing. */
void ambit_limit_forget(void);
/* The code and the sentence (or NULL) of the limit that is reached; false: none is. */
bool ambit_limit_reached(const char **code, const char **sentence);
#endif
