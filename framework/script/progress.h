/* progress.h -- one line on stderr that says how far a verb is; silent unless stderr is a terminal. */
#ifndef AMBIT_LUA_PROGRESS_H
#define AMBIT_LUA_PROGRESS_H
#include <stdbool.h>

typedef struct ambit_progress {
  bool on, drawn, colour;
  double next; /* s, when to draw again */
} ambit_progress;

void ambit_progress_begin(ambit_progress *p, bool wanted);
void ambit_progress_draw(ambit_progress *p, double done, const char *message); /* at most ten times a second */
void ambit_progress_end(ambit_progress *p);                                    /* clears the line */
#endif
