/* pace.c -- runs that slow down without end: over wide sets, steps shrink and shrink, and the end is out of reach.
**
** It does when four times as many steps win no more time: the longest step planned of steps (4 n, 8 n] is a
** quarter of that of steps (n, 2 n], or less. If steps go on to shrink at this rate, like exp(-rate t), the time that
** is left takes expm1(rate left) / (rate step) more of them; if these are too many, the run ends, after a small
** multiple of the steps that it took before that. Only sets over which slopes vary are judged, and only steps that
** the solver chose: where thin sets take tiny steps, the solution asks for them. Whoever gives `step_min` decides for
** himself.
*/
#include "control.h"

#define FIRST 128       /* steps of which nothing is concluded */
#define FALL 0.25       /* fall of steps over two doublings of their number */
#define TOO_MANY 0x1p22 /* steps: minutes even for small systems */
#define NEVER 0x1p34    /* steps, even if they shrink no more */

void pace_start(pace *p, double t) {
  *p = (pace) { .until = FIRST };
  p->stretch[2].from = t;
}

static double steps_ahead(double time_left, const stretch *then, const stretch *now) {
  double rate = log(then->longest / now->longest) / fabs(now->from - then->from);
  return expm1(rate * time_left) / (rate * now->longest);
}

static int is_out_of_reach(const options *o, double time_left, const pace *p) {
  const stretch *then = &p->stretch[0], *now = &p->stretch[2];
  if (o->patient || p->until < 8 * FIRST || now->longest >= o->step_max) return 0;
  if (2 * now->wide < p->until / 2) return 0;
  if (now->longest * NEVER < time_left) return now->longest < 2 * then->longest;
  return now->longest < FALL * then->longest && steps_ahead(time_left, then, now) > TOO_MANY;
}

int pace_is_hopeless(const options *o, double t, double end, double length, int wide, pace *p) {
  stretch *now = &p->stretch[2];
  now->wide += wide != 0;
  now->longest = larger(now->longest, length);
  if (++p->steps < p->until) return 0;
  int hopeless = is_out_of_reach(o, fabs(end - t), p);
  p->stretch[0] = p->stretch[1];
  p->stretch[1] = *now;
  *now = (stretch) { .from = t };
  p->until *= 2;
  return hopeless;
}
