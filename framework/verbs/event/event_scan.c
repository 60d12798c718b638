/* event_scan.c -- walks through a step in the order of time and says of each piece of it: g has this sign; or g may be
** 0 there, and its change has this sign, or none.
**
** A piece is settled if g has one sign over it; if g' has, because then the ends tell where g can be 0; or if the mean
** value form g(m) + g' (t - m) has. Otherwise it is halved. Depth and number of evaluations are bounded; what they do
** not settle may contain a zero.
*/
#include "verbs/event/event_inside.h"
#include "num/interval.h"

#define DEPTH 30          /* 1e-9 of a step */
#define DEPTH_AT_LEAST 6  /* once the evaluations of a step are used up */
#define DEPTH_IF_TIRED 2  /* and if those of the step before were, too */
#define EVALUATIONS 1000u /* of a step; a quarter of the last number where that was of no use */
#define TIRED_MOST 3u
#define EDGE_SHARE 64 /* the edges of a zero's interval are located to this share of it */
#define HALVINGS 64   /* at the most, of a double */

static int sign_of(ambit_interval x) {
  if (ambit_interval_is_empty(x)) return AMBIT_EVENT_NOWHERE;
  return x.lo > 0 ? 1 : x.hi < 0 ? -1 : 0;
}

static double middle(double a, double b) { return a + (b - a) / 2; }

static int sign_at(ambit_event_watch *w, const watched *e, double t) {
  return sign_of(ambit_event_watch_value(w, e, t, t).g);
}

/* At `sure` g has the sign; between `near` and `far` it may be 0: moves `sure` towards `near`, and `near` where g may
** be 0 towards `sure`, until what is between them matters little. */
static double find_edge(ambit_event_watch *w, const watched *e, double sure, double *near, double far, int sign) {
  for (int i = 0; i < HALVINGS && fabs(*near - sure) * EDGE_SHARE > fabs(far - *near); i++) {
    double m = middle(sure, *near);
    if (m == sure || m == *near) break;
    if (sign_at(w, e, m) == sign)
      sure = m;
    else
      *near = m;
  }
  return sure;
}

/* g changes one way only over (a, b): at a its sign is -way or unknown, at b way or unknown. */
static void locate(ambit_event_watch *w, watched *e, double a, double b, int way, bool sure_a, bool sure_b) {
  double p = a, q = b, first = sure_a ? b : a, last = sure_b ? a : b; /* first, last: where g may be 0 */
  for (int i = 0; sure_a && sure_b && i < HALVINGS; i++) {
    double m = middle(p, q);
    if (m == p || m == q) break;
    int sign = sign_at(w, e, m);
    if (!sign) {
      first = last = m;
      break;
    }
    if (sign == way)
      q = m;
    else
      p = m;
  }
  bool inside = first == last || !sure_a || !sure_b;
  if (sure_a && inside) p = find_edge(w, e, p, &first, last, -way);
  if (sure_b && inside) q = find_edge(w, e, q, &last, first, way);
  if (sure_a) ambit_event_watch_note_sign(w, e, -way);
  ambit_event_watch_note_zero(w, e, p, q, way, false);
  if (sure_b) ambit_event_watch_note_sign(w, e, way);
}

static void settle_monotone(ambit_event_watch *w, watched *e, double a, double b, int way) {
  int at_a = sign_at(w, e, a), at_b = sign_at(w, e, b);
  if (at_a == way || at_b == -way)
    ambit_event_watch_note_sign(w, e, at_a == way ? way : -way); /* later ones are beyond, earlier ones not there yet */
  else
    locate(w, e, a, b, way, at_a == -way, at_b == way);
}

/* By the mean value form about the middle: the sign of g over (a, b), or 0. */
static int sign_by_slope(ambit_event_watch *w, const watched *e, double a, double b, ambit_interval rate) {
  double m = middle(a, b);
  ambit_interval time = a < b ? (ambit_interval) { a, b } : (ambit_interval) { b, a };
  ambit_interval centre = ambit_event_watch_value(w, e, m, m).g;
  ambit_interval away = ambit_interval_mul(rate, ambit_interval_sub(time, (ambit_interval) { m, m }));
  return sign_of(ambit_interval_add(centre, away));
}

/* false: halve it */
static bool settle(ambit_event_watch *w, watched *e, double a, double b, bool last) {
  ambit_event_values at = ambit_event_watch_value(w, e, a, b);
  int sign = sign_of(at.g), way = sign_of(at.rate) * w->way;
  if (!sign && way) {
    settle_monotone(w, e, a, b, way);
    return true;
  }
  if (!sign && ambit_interval_is_bounded(at.rate)) sign = sign_by_slope(w, e, a, b, at.rate);
  if (sign)
    ambit_event_watch_note_sign(w, e, sign);
  else if (last)
    ambit_event_watch_note_zero(w, e, a, b, 0, at.torn);
  return sign || last;
}

void ambit_event_watch_scan(ambit_event_watch *w, watched *e) {
  struct {
    double end;
    int depth; /* of the piece that ends here: 2^-depth of the step */
  } open[DEPTH + 1];
  double at = w->start;
  size_t n = 0;
  if ((w->r->t_to - at) * w->way <= 0) return;
  open[n].end = w->r->t_to;
  open[n++].depth = 0;
  w->budget = EVALUATIONS >> (2 * e->tired);
  int least = e->tired ? DEPTH_IF_TIRED : DEPTH_AT_LEAST;
  while (n) {
    double b = open[n - 1].end, m = middle(at, b);
    int depth = open[n - 1].depth;
    bool last = depth >= (w->budget ? DEPTH : least) || m == at || m == b;
    if (settle(w, e, at, b, last)) {
      at = b;
      n--;
    } else {
      open[n - 1].depth = ++depth; /* both halves */
      open[n].end = m;
      open[n++].depth = depth;
    }
  }
  if (w->budget)
    e->tired -= e->tired > 0;
  else
    e->tired += e->tired < TIRED_MOST;
}
