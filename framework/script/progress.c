/* progress.c -- the progress bar. */
#include "script/progress.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define CELLS 30
#define PERIOD 0.1 /* s */

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void ambit_progress_begin(ambit_progress *p, bool wanted) {
  const char *no_colour = getenv("NO_COLOR"), *term = getenv("TERM");
  memset(p, 0, sizeof *p);
  p->on = wanted && isatty(STDERR_FILENO) && !(term && strcmp(term, "dumb") == 0);
  p->colour = !(no_colour && *no_colour);
  if (p->on) p->next = now() + 2 * PERIOD; /* what is done at once shows no bar */
}

void ambit_progress_draw(ambit_progress *p, double done, const char *message) {
  if (!p->on) return;
  double t = now();
  if (t < p->next) return;
  p->next = t + PERIOD;
  p->drawn = true;
  if (!(done >= 0)) done = 0;
  if (done > 1) done = 1;
  int full = (int)(done * CELLS);
  char bar[CELLS + 1];
  memset(bar, '-', CELLS);
  memset(bar, '=', (size_t)full);
  bar[CELLS] = '\0';
  fprintf(stderr, "\r%s[%s]%s %3.0f %%  %.60s\033[K", p->colour ? "\033[36m" : "", bar, p->colour ? "\033[0m" : "",
      100 * done, message ? message : "");
  fflush(stderr);
}

void ambit_progress_end(ambit_progress *p) {
  if (p->drawn) fprintf(stderr, "\r\033[K");
  p->drawn = false;
}
