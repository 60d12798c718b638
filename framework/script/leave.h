/* leave.h -- how the command's process ends: by its own word, or not.
**
** Exit code 0 means "done and proved", so nothing but the command may give it. exit() from anywhere else, a plugin or a
** library, is caught by handlers and becomes exit code 1 with a sentence. _exit() cannot be caught.
*/
#ifndef AMBIT_LUA_LEAVE_H
#define AMBIT_LUA_LEAVE_H
#include <stdbool.h>

/* Opens /dev/null in place of standard files that are closed, in a way that reading and writing fail: else the next
** file that is opened would take their places. False: impossible. */
bool ambit_leave_reserve_files(void);
/* From here on, in this process but not in its children, exit() is an error. False: out of memory. */
bool ambit_leave_guard(void);
/* What was printed goes out. False: some of it could not be written, now or before. */
bool ambit_leave_flush(void);
/* The same; the exit code becomes that of an error if some could not. The guard is off. */
int ambit_leave(int code);
/* From here on ambit_leave takes this exit code instead of what it is given, for what happens while Lua closes. */
void ambit_leave_with(int code);
#endif
