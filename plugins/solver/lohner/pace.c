/* pace.c -- runs that slow down without end: over wide sets, steps shrink and shrink, and the end is out of reach.
**
** It does when four times as many steps win no more time: the longest step planned of steps (4 n, 8 n] is a
** quarter of that of steps (n, 2 n], or less. If steps go on to shrink at this rate, like exp(-rate t), the time that
** is left takes expm1(rate left) / (rate step) more of them; if these are too many, the run ends, after a small
** multiple of the steps that it took before that. Only sets over which slopes vary are judged, and only steps that
** the solver chose: where thin sets take tiny steps, the solution asks for them. Whoever gives `step_min` decides for
** himself.
*/
#include "lohner.h"

#define FIRST 128       /* steps of which nothing is concluded */
#define FALL 0.25       /* fall of steps over two doublings of their number */
#define TOO_MANY 0x1p22 /* steps: minutes even for small systems */
#define NEVER 0x1p34    /* steps, even if they shrink no more */

void lohner_start_pace(lohner *s) {
  s->pace = (pace) { .until = FIRST };
  s->pace.stretch[2].from = s->t;
}

static double time_left(const lohner *s) { return fabs(s->problem.time[s->problem.ntime - 1] - s->t); }

static double steps_ahead(const lohner *s, const stretch *then, const stretch *now) {
  double rate = log(then->longest / now->longest) / fabs(now->from - then->from);
  return expm1(rate * time_left(s)) / (rate * now->longest);
}

static int is_hopeless(const lohner *s) {
  const stretch *then = &s->pace.stretch[0], *now = &s->pace.stretch[2];
  if (s->options.patient || s->pace.until < 8 * FIRST || now->longest >= s->options.step_max) return 0;
  if (2 * now->wide < s->pace.until / 2) return 0;
  if (now->longest * NEVER < time_left(s)) return now->longest < 2 * then->longest;
  return now->longest < FALL * then->longest && steps_ahead(s, then, now) > TOO_MANY;
}

int lohner_steps_shrink(lohner *s) {
  pace *p = &s->pace;
  stretch *now = &p->stretch[2];
  now->wide += s->wide != 0;
  now->longest = larger(now->longest, s->guess);
  if (++p->steps < p->until) return 0;
  int hopeless = is_hopeless(s);
  p->stretch[0] = p->stretch[1];
  p->stretch[1] = *now;
  *now = (stretch) { .from = s->t };
  p->until *= 2;
  return hopeless;
}
